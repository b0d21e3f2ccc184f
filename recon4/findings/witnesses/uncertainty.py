"""Whether the positions are known well enough, and what would help.

A local map is aligned before it is used: it is known well if its *shape* is, after the best rigid
alignment of the whole walk. A georeferenced map is used without any alignment, so its place on the
earth must be known, too. Relative to the first pose nobody uses a map: a heading that is a little
off there moves the far end, and bends nothing.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

from recon4.findings.walk_record import WalkRecord, path_length_m
from recon4.findings.witnesses.base import Witness, finding
from recon4.model.finding import Finding, Level, Value
from recon4.model.finding_kinds import FindingKind
from recon4.model.site_control import SITE_GRID
from recon4.model.trajectory import Trajectory
from recon4.pose_graph.uncertainty import PoseUncertainty
from recon4.pose_graph.uncertainty_files import uncertainty_figures


@dataclass(frozen=True, slots=True, kw_only=True)
class KnownLimits:
    """How well a map must be known: as the proving ground judges what is right."""

    shape_m: float = 0.05
    shape_per_meter: float = 0.001
    """A shape is known well if twice its expected RMS is at most this, and this part of the path …
    """
    worst: float = 3.0
    """… and the 2σ of each single position at most this multiple of it."""
    placed_m: float = 0.10
    """A place on the earth is known well if twice its expected RMS is at most this [m]."""
    unknown: float = 10.0
    """What exceeds its limit by this factor is unknown."""
    anywhere_m: float = 100.0
    """A larger 2σ is quoted as above this [m]."""
    helps: float = 0.8
    """A control point is proposed if it leaves less than this ratio of the largest deviation."""


LIMITS = KnownLimits()


class Uncertainty(Witness):
    """Covariances of the final poses against what a map is good for."""

    def check(self, walk: WalkRecord) -> Iterator[Finding]:
        """How well the shape of the map is known, and its place on the earth."""
        known = _known(walk)
        if known is None or walk.uncertainty is None or walk.final is None:
            return
        found = uncertainty_figures(walk.uncertainty, walk.final)
        known_m = 2.0 * found.largest_sd_m
        # Relative to the start it matters only where a control point may mend it.
        stated = found.on_earth or not known.fine
        helps = not known.fine and found.point_sd_m < LIMITS.helps * found.largest_sd_m
        point = {
            "point_from_s": found.point_from_s,
            "point_to_s": found.point_to_s,
            "point_m": 2.0 * found.point_sd_m,
        }
        values: dict[str, Value] = {
            "shape_m": known.shape_m,
            "shape_worst_m": known.worst_m,
            "limit_m": known.limit_m,
            "known_m": known_m,
            "at_s": found.at_s,
            "frame": _frame(walk) if found.on_earth else "start",
            "limited": stated and known_m < LIMITS.anywhere_m,
            "unlimited": stated and known_m >= LIMITS.anywhere_m,
        }
        yield finding(
            FindingKind.UNCERTAINTY,
            known.level,
            values | (point if helps else {}),
            span_s=None if known.fine else (found.at_s, found.at_s),
        )


def _frame(walk: WalkRecord) -> str:
    """The word for where a map is placed that control points or fixes hold."""
    in_grid = walk.level is not None and walk.level.crs == SITE_GRID
    return "site" if in_grid else "earth"


def is_known(walk: WalkRecord) -> bool:
    """Whether the map is stated to be known well: lost multiframes count as unknown."""
    known = _known(walk)
    return known is not None and known.fine


def known_to(walk: WalkRecord) -> dict[str, float]:
    """How well the shape of the map is known, ``shape_m``: 2σ [m]; empty = not stated."""
    known = _known(walk)
    return {} if known is None else {"shape_m": known.shape_m}


@dataclass(frozen=True, slots=True)
class _Known:
    """What is stated of a map, each 2σ [m], against its limits."""

    shape_m: float
    """Twice the expected RMS of all positions after the best alignment."""
    worst_m: float
    """2σ of the worst of them."""
    placed_m: float
    """Twice the expected RMS of all positions on the earth; 0 = a local map, which has no place."""
    limit_m: float
    """Of the shape."""

    @property
    def excess(self) -> float:
        """The largest of them as a multiple of its limit."""
        shape = max(self.shape_m, self.worst_m / LIMITS.worst) / self.limit_m
        return max(shape, self.placed_m / LIMITS.placed_m)

    @property
    def fine(self) -> bool:
        """Whether none exceeds its limit."""
        return self.excess <= 1.0

    @property
    def level(self) -> Level:
        """What it means for the map."""
        if self.fine:
            return Level.GOOD
        return Level.CHECK if self.excess <= LIMITS.unknown else Level.DO_NOT_USE


def _known(walk: WalkRecord) -> _Known | None:
    """None = not stated."""
    stated = walk.uncertainty
    if stated is None or walk.final is None or len(walk.final) < 2:
        return None
    return _Known(
        shape_m=2.0 * stated.shape_rms_m,
        worst_m=2.0 * float(stated.shape_sd_m.max()),
        placed_m=_placed_m(stated),
        limit_m=_limit_m(walk.final),
    )


def _placed_m(stated: PoseUncertainty) -> float:
    return 2.0 * stated.rms_m if stated.on_earth else 0.0


def _limit_m(final: Trajectory) -> float:
    return LIMITS.shape_m + LIMITS.shape_per_meter * float(path_length_m(final)[-1])
