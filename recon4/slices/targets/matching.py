"""Names of found targets: a list of surveyed points is laid on them by the distances between them.

Two points as far from each other as two candidates, and with the same difference of height, say how
a leveled map lies in the survey. The position that puts most points on candidates counts; another
one as good, with other names, is reported.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from itertools import combinations

import numpy as np
from numpy.typing import NDArray

from recon4.geometry.se3 import SE3, Array, align_points
from recon4.model.targets import TargetKind
from recon4.slices.targets.candidate import TargetCandidate
from recon4.slices.tuning_targets import SPHERES, TARGET_MATCH


@dataclass(frozen=True, slots=True, eq=False)
class SurveyedPlace:
    """A surveyed point."""

    id: str
    p_site: Array
    """East, north, up near the origin, without distortion of scale [m], (3,)."""
    radius_m: float = 0.0
    """Of a sphere; 0 = it is none, or not stated."""


@dataclass(frozen=True, slots=True, eq=False)
class TargetMatch:
    """Which candidate is which surveyed point."""

    row_of: Mapping[str, int]
    """Id -> row of its candidate."""
    off_m: Mapping[str, float]
    """Id -> distance from its candidate after the rigid fit [m]."""
    T_map_site: SE3
    rmse_m: float
    ambiguous: tuple[str, ...]
    """Ids that are another candidate in a reading that fits as well."""


def match_targets(
    survey: Sequence[SurveyedPlace], found: Sequence[TargetCandidate]
) -> TargetMatch | None:
    """Name candidates on a leveled map.

    Args:
        survey: Surveyed points.
        found: What was found in the map.

    Returns:
        The best reading; None if no three points agree.
    """
    if min(len(survey), len(found)) < TARGET_MATCH.least:
        return None
    sites = np.array([one.p_site for one in survey])
    places = np.array([one.p_map for one in found])
    fits = _compatible(survey, found)
    positions = _positions(sites, places, fits)
    readings: dict[tuple[int, ...], _Reading] = {}
    for T in positions:
        one = _settled(T, sites, places, fits=fits)
        if one is not None and one.key not in readings:
            readings[one.key] = one
    if not readings:
        return None
    ranked = sorted(readings.values(), key=lambda one: (-one.count, one.rmse_m))
    best = ranked[0]
    limit_m = max(TARGET_MATCH.alike * best.rmse_m, TARGET_MATCH.alike_m)
    alike = [one for one in ranked[1:] if one.count == best.count and one.rmse_m <= limit_m]
    differ = {
        k
        for other in alike
        for k, (a, b) in enumerate(zip(best.key, other.key, strict=True))
        if a != b
    }
    named = np.flatnonzero(best.rows >= 0).tolist()
    return TargetMatch(
        row_of={survey[k].id: int(best.rows[k]) for k in named},
        off_m={survey[k].id: float(best.off_m[k]) for k in named},
        T_map_site=best.T_map_site,
        rmse_m=best.rmse_m,
        ambiguous=tuple(survey[k].id for k in sorted(differ)),
    )


@dataclass(frozen=True, slots=True, eq=False)
class _Reading:
    """A position of the survey and the candidates of its points."""

    T_map_site: SE3
    rows: NDArray[np.intp]
    """Candidate of each point, -1 = none, (N,)."""
    off_m: Array
    """(N,)."""
    rmse_m: float

    @property
    def key(self) -> tuple[int, ...]:
        return tuple(self.rows.tolist())

    @property
    def count(self) -> int:
        return int((self.rows >= 0).sum())


def _compatible(
    survey: Sequence[SurveyedPlace], found: Sequence[TargetCandidate]
) -> NDArray[np.bool_]:
    """Whether a point may be a candidate, (N, M): spheres of the same radius, where stated."""
    stated = any(one.radius_m > 0.0 for one in survey)
    out = np.ones((len(survey), len(found)), np.bool_)
    if not stated:
        return out
    for i, point in enumerate(survey):
        for k, one in enumerate(found):
            sphere = one.kind is TargetKind.SPHERE
            same = abs(one.size_m - point.radius_m) <= SPHERES.survey_off_m
            out[i, k] = (sphere and same) if point.radius_m > 0.0 else not sphere
    return out


def _positions(sites: Array, places: Array, fits: NDArray[np.bool_]) -> list[SE3]:
    """Positions of the survey by pairs of points, those that name most points first."""
    between = places[None] - places[:, None]
    apart = np.linalg.norm(between, axis=2)
    pairs = sorted(
        combinations(range(len(sites)), 2),
        key=lambda ij: -np.linalg.norm(np.subtract(*sites[[*ij]])),
    )
    counts, tried = list[tuple[int, SE3]](), 0
    for i, j in pairs:
        step = sites[j] - sites[i]
        length = float(np.linalg.norm(step))
        if np.hypot(*step[:2]) < TARGET_MATCH.least_apart_m:
            continue
        like = np.abs(apart - length) <= TARGET_MATCH.distance_m + TARGET_MATCH.relative * length
        like &= np.abs(between[..., 2] - step[2]) <= TARGET_MATCH.height_m
        like &= fits[i][:, None] & fits[j][None, :]
        a, b = np.nonzero(like)
        tried += len(a)
        if len(a):
            counts += _counted(sites, places, fits, pair=(i, j), ends=(a, b))
        if tried > TARGET_MATCH.most_trials:
            break
    counts.sort(key=lambda one: -one[0])
    most = counts[0][0] if counts else 0
    return [T for count, T in counts if count >= max(most - 1, TARGET_MATCH.least)]


def _counted(
    sites: Array,
    places: Array,
    fits: NDArray[np.bool_],
    *,
    pair: tuple[int, int],
    ends: tuple[NDArray[np.intp], NDArray[np.intp]],
) -> list[tuple[int, SE3]]:
    """How many points each position names that puts a pair of points on two candidates."""
    i, j = pair
    a, b = ends
    step, other = sites[j] - sites[i], places[b] - places[a]
    turn = np.arctan2(other[:, 1], other[:, 0]) - np.arctan2(step[1], step[0])
    out = []
    for k, yaw in enumerate(turn.tolist()):
        R = SE3.from_rpy(0.0, 0.0, yaw, t=[0.0] * 3).R
        middle = 0.5 * (places[a[k]] + places[b[k]])
        T = SE3(R, middle - R @ (0.5 * (sites[i] + sites[j])))
        off = np.linalg.norm((T @ sites)[:, None] - places, axis=2)
        count = int((np.where(fits, off, np.inf).min(axis=1) <= TARGET_MATCH.near_m).sum())
        if count >= TARGET_MATCH.least:
            out.append((count, T))
    return out


def _settled(T: SE3, sites: Array, places: Array, *, fits: NDArray[np.bool_]) -> _Reading | None:
    """The reading near a position, after rigid fits to the candidates it names."""
    rows = _named(T, sites, places, fits=fits, within_m=TARGET_MATCH.near_m)
    for _ in range(TARGET_MATCH.rounds):
        known = rows >= 0
        if known.sum() < TARGET_MATCH.least:
            return None
        T = _fit(sites[known], places[rows[known]])
        rows = _named(T, sites, places, fits=fits, within_m=TARGET_MATCH.fitted_m)
    known = rows >= 0
    if known.sum() < TARGET_MATCH.least:
        return None
    off = np.full(len(sites), np.nan)
    off[known] = np.linalg.norm((T @ sites[known]) - places[rows[known]], axis=1)
    return _Reading(T, rows, off, float(np.sqrt(np.mean(off[known] ** 2))))


def _named(
    T: SE3, sites: Array, places: Array, *, fits: NDArray[np.bool_], within_m: float
) -> NDArray[np.intp]:
    """The nearest candidate of each point, each named once; -1 = none, (N,)."""
    off = np.linalg.norm((T @ sites)[:, None] - places, axis=2)
    off = np.where(fits, off, np.inf)
    rows = np.full(len(sites), -1, np.intp)
    for flat in np.argsort(off, axis=None, kind="stable").tolist():
        i, k = divmod(flat, len(places))
        if off[i, k] > within_m:
            break
        if rows[i] < 0 and k not in rows:
            rows[i] = k
    return rows


def _fit(sites: Array, places: Array) -> SE3:
    """The rigid fit of least squares, tilted as far as leveling may have left a map."""
    if len(sites) > TARGET_MATCH.least:
        T = align_points(places, sites)
        if T.R[2, 2] >= np.cos(TARGET_MATCH.tilt_rad):
            return T
    return _upright_fit(sites, places)


def _upright_fit(sites: Array, places: Array) -> SE3:
    """The turn about the vertical and shift of least squares."""
    p, q = sites - sites.mean(axis=0), places - places.mean(axis=0)
    yaw = np.arctan2((p[:, 0] * q[:, 1] - p[:, 1] * q[:, 0]).sum(), (p[:, :2] * q[:, :2]).sum())
    R = SE3.from_rpy(0.0, 0.0, float(yaw), t=[0.0] * 3).R
    return SE3(R, places.mean(axis=0) - R @ sites.mean(axis=0))
