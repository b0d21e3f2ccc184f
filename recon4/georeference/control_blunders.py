"""Blunders of a survey by name: feet, exchanged axes, exchanged names, single points, a datum."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from enum import StrEnum

import numpy as np

from recon4.errors import GeoreferenceError
from recon4.geometry.se3 import Array
from recon4.georeference.control_fit import (
    ControlFit,
    MeasuredTarget,
    fit_control,
    snoop,
    with_sites,
)
from recon4.georeference.control_names import exchanged_among, exchanged_pair
from recon4.georeference.tuning_control import BLUNDERS
from recon4.locales.languages import ENGLISH
from recon4.locales.numbers import localized
from recon4.locales.texts import Texts, texts
from recon4.units import FOOT_M


class BlunderKind(StrEnum):
    """What may be wrong with a survey."""

    FEET = "feet"
    """Coordinates are feet, not meters."""
    FEET_UP = "feet-up"
    """Heights are feet, easting and northing are meters."""
    AXES = "axes"
    """Easting and northing are exchanged."""
    NAMES = "names"
    """Two points have each other's name."""
    RENAMED = "renamed"
    """Names of more points are exchanged, as by a list that is shifted by a line."""
    POINT = "point"
    """One point is elsewhere."""
    OFFSET = "offset"
    """Points have a common offset: another datum, another height of a prism or antenna."""
    CONTRADICTION = "contradiction"
    """They contradict each other, and too few control each other to say which is wrong."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Blunder:
    """A suspected blunder."""

    kind: BlunderKind
    points: tuple[str, ...]
    """Ids it is about; empty = all."""
    offset_m: tuple[float, float, float] | None = None
    """Surveyed minus fitted by the others: east, north, up [m]."""
    picks: tuple[str, ...] = ()
    """What each of the points is called in the map; empty = by its own name."""

    @property
    def text(self) -> str:
        """One sentence in English, with what to do."""
        return self.said(ENGLISH)

    def said(self, language: str) -> str:
        """One sentence in a language, with what to do."""
        say = texts(language, "report")
        names = [
            say.part("blunder", "renamed-one", {"survey": name, "pick": pick})
            for name, pick in zip(self.points, self.picks, strict=False)
        ]
        values = {
            "names": ", ".join(names) or say.part("blunder", "and", {}).join(self.points),
            "offset": _offset(self.offset_m, say),
        }
        return say.part("blunder", self.kind, values)


def _offset(offset_m: tuple[float, float, float] | None, say: Texts) -> str:
    if offset_m is None:
        return say.part("blunder", "far", {})
    length = localized(f"{float(np.linalg.norm(offset_m)):.3f}", say.language)
    east, north, up = (localized(f"{value:+z.3f}", say.language) for value in offset_m)
    values = {"length": length, "east": east, "north": north, "up": up}
    return say.part("blunder", "offset-of", values)


def named_blunders(
    targets: Sequence[MeasuredTarget], *, leveled: bool
) -> tuple[ControlFit, tuple[Blunder, ...]]:
    """Fit a map to control points and name what is wrong with them.

    Args:
        targets: Control points, found in the map.
        leveled: Whether the map's z axis is vertical.

    Returns:
        The fit of those that agree with each other, and the blunders.

    Raises:
        GeoreferenceError: As `fit_control`.
    """
    fit = fit_control(targets, leveled=leveled)
    whole = _of_all(targets, fit, leveled=leveled)
    if whole is not None:
        return whole[0], (whole[1],)
    pair = exchanged_pair(targets, fit, leveled=leveled)
    if pair is not None:
        names = tuple(targets[k].id for k in pair[1])
        return pair[0], (Blunder(kind=BlunderKind.NAMES, points=names),)
    found, failed = snoop(targets, leveled=leveled)
    if not failed and found.rmse_m >= BLUNDERS.least_m and found.sd0 > BLUNDERS.contradicting:
        return found, (Blunder(kind=BlunderKind.CONTRADICTION, points=()),)
    return found, tuple(_point(name, targets, failed, leveled=leveled) for name in failed)


def _of_all(
    targets: Sequence[MeasuredTarget], fit: ControlFit, *, leveled: bool
) -> tuple[ControlFit, Blunder] | None:
    """Feet or exchanged axes, if that explains the misfit."""
    p_site = np.array([one.p_site for one in targets])
    for kind, others in (
        (BlunderKind.FEET, p_site * FOOT_M),
        (BlunderKind.AXES, p_site[:, [1, 0, 2]]),
        (BlunderKind.FEET, p_site[:, [1, 0, 2]] * FOOT_M),
        (BlunderKind.FEET_UP, p_site * [1.0, 1.0, FOOT_M]),
    ):
        try:
            better = fit_control(with_sites(targets, others), leveled=leveled)
        except GeoreferenceError:
            continue
        if _explains(better, fit, targets):
            return better, Blunder(kind=kind, points=())
    return None


def _explains(tried: ControlFit, before: ControlFit, targets: Sequence[MeasuredTarget]) -> bool:
    """Whether another reading of the survey fits where its own does not."""
    p_map = np.array([one.p_map for one in targets])
    extent_m = float(np.linalg.norm(np.ptp(p_map, axis=0)))
    return (
        before.rmse_m >= BLUNDERS.least_m
        and tried.rmse_m <= min(BLUNDERS.most_m, 0.05 * extent_m)
        and tried.rmse_m**2 < BLUNDERS.better * before.rmse_m**2
    )


def _point(
    name: str, targets: Sequence[MeasuredTarget], failed: Sequence[str], *, leveled: bool
) -> Blunder:
    """A point that the others contradict, and by how much."""
    kept = [one for one in targets if one.id == name or one.id not in failed]
    test = next(one for one in fit_control(kept, leveled=leveled).tests if one.id == name)
    return Blunder(kind=BlunderKind.POINT, points=(name,), offset_m=test.blunder_m)


def with_exchanged_names(
    blunders: Sequence[Blunder], names: Sequence[str], p_site: Array, *, off_m: Array
) -> tuple[Blunder, ...]:
    """Two points that are off by each other's place become one blunder: exchanged names.

    Args:
        blunders: Suspected ones of control and check points.
        names: Ids of all points.
        p_site: Surveyed places [m], (N, 3).
        off_m: Map minus survey [m], (N, 3); NaN = not measured.
    """
    single = [one.points[0] for one in blunders if one.kind is BlunderKind.POINT]
    pairs = exchanged_among(p_site, off_m, [names.index(name) for name in single])
    gone = {names[k] for pair in pairs for k in pair}
    return (
        *(Blunder(kind=BlunderKind.NAMES, points=(names[i], names[j])) for i, j in pairs),
        *(one for one in blunders if one.kind is not BlunderKind.POINT or not gone & {*one.points}),
    )


def check_outliers(names: Sequence[str], off_m: Array) -> tuple[Blunder, ...]:
    """Check points far beyond what the others show of the map.

    Args:
        names: Their ids.
        off_m: Surveyed minus map, east, north, up [m], (N, 3); NaN = not measured.
    """
    if not len(off_m):
        return ()
    length = np.sqrt(np.nansum(off_m**2, axis=1))
    limit_m = max(BLUNDERS.check_m, BLUNDERS.check_ratio * float(np.median(length)))
    far = np.flatnonzero(length > limit_m)
    found = [(k, np.nan_to_num(off_m[k]).tolist()) for k in far.tolist()]
    return tuple(
        Blunder(kind=BlunderKind.POINT, points=(names[k],), offset_m=(x, y, z))
        for k, (x, y, z) in found
    )


def common_offset(names: Sequence[str], off_m: Array, *, sd_m: float) -> Blunder | None:
    """An offset that all points share although they placed nothing; None = there is none.

    Args:
        names: Their ids.
        off_m: Surveyed minus map, east, north, up [m], (N, 3); NaN = not measured.
        sd_m: Stated deviation of one of them [m].
    """
    measured = np.isfinite(off_m)
    if not len(off_m) or measured.sum(axis=0).max() < 3:
        return None
    with np.errstate(invalid="ignore"):
        mean = np.where(measured.sum(axis=0) >= 3, np.nanmean(off_m, axis=0), 0.0)
        spread = np.where(measured.sum(axis=0) >= 3, np.nanstd(off_m, axis=0), 0.0)
    of_mean = np.maximum(spread, sd_m) / np.sqrt(np.maximum(measured.sum(axis=0), 1))
    shared = (np.abs(mean) > BLUNDERS.offset_sd * of_mean) & (np.abs(mean) > BLUNDERS.offset_m)
    # What all points share is larger than what they do not.
    shared &= np.abs(mean) > 2.0 * spread
    if not shared.any():
        return None
    x, y, z = np.where(shared, mean, 0.0).tolist()
    return Blunder(kind=BlunderKind.OFFSET, points=tuple(names), offset_m=(x, y, z))
