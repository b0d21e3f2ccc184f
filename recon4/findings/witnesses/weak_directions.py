"""Stretches of the walk along which the LiDAR hardly observes one direction of the motion.

In a corridor without doors, a tunnel or an open field nearly all planes are parallel to one
direction. The registration then converges, and its residuals are small, wherever along that
direction the pose lies: neither convergence nor the match ratio shows the error.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from msgspec.structs import replace
from numpy.typing import NDArray

from recon4.findings.walk_record import WalkRecord
from recon4.findings.witnesses.base import Witness, finding
from recon4.findings.witnesses.tuning import WEAK_DIRECTION
from recon4.findings.witnesses.uncertainty import is_known, known_to
from recon4.geometry.se3 import Array
from recon4.model.finding import Finding, Level
from recon4.model.finding_kinds import FindingKind
from recon4.model.support import SurfaceSupport
from recon4.model.tuning import OBSERVATION


@dataclass(frozen=True, slots=True)
class WeakStretch:
    """Consecutive multiframes that observe one direction weakly."""

    start_s: float
    """After the first multiframe [s]."""
    end_s: float
    degeneracy: float
    """Median of the smallest eigenvalue of the mean of n n^T."""
    sd_m: float
    """Median standard deviation of a multiframe's LiDAR measurement [m]; NaN = not stated."""
    direction_odom: Array
    """Unit vector of the weak direction, in odom axes, (3,); NaN = unknown."""

    @property
    def seconds(self) -> float:
        """Duration [s]."""
        return self.end_s - self.start_s

    @property
    def horizontal(self) -> bool:
        """Whether the weak direction is closer to horizontal than to vertical."""
        return not abs(float(self.direction_odom[2])) > np.sqrt(0.5)


def held_by_surfaces(
    support: SurfaceSupport | None, lost: NDArray[np.bool_]
) -> NDArray[np.bool_] | None:
    """Of the multiframes that were lost, those that surfaces seen at other times hold.

    Args:
        support: Of the refinement.
        lost: Multiframes without a pose by the odometry, (N,).

    Returns:
        For each lost one; None if none is lost, or it was not worked out.
    """
    if support is None or not lost.any() or lost.all():
        return None
    usual = WEAK_DIRECTION.held_ratio * float(np.median(support.match_ratio[~lost]))
    held = (support.match_ratio >= usual) & (support.weak_sd_m <= OBSERVATION.weak_sd_m)
    return np.asarray(held[lost], np.bool_)


def weak_stretches(
    steps: Mapping[str, NDArray[np.generic]], support: SurfaceSupport | None = None
) -> list[WeakStretch]:
    """Find the stretches of `OBSERVATION.weak_s` or more, in order of time.

    Args:
        steps: Columns of ``steps.npz``. Files of earlier versions have no ``weak_direction``.
        support: Of line scans: what the refinement observes where the 2-D laser does not.
    """
    if "degeneracy" not in steps or len(steps["degeneracy"]) < 2:
        return []
    t_s = (steps["t_mid_ns"] - steps["t_mid_ns"][0]) / 1e9
    degeneracy = np.asarray(steps["degeneracy"], np.float64)
    directions = np.asarray(steps.get("weak_direction", np.full((len(t_s), 3), np.nan)), np.float64)
    sd_m = np.asarray(steps.get("weak_sd_m", np.full(len(t_s), np.nan)), np.float64)
    limit_m = np.where(
        steps.get("converged", True), OBSERVATION.weak_sd_m, WEAK_DIRECTION.unsure_sd_m
    )
    weak = np.where(np.isnan(sd_m), degeneracy < WEAK_DIRECTION.weak_degeneracy, sd_m > limit_m)
    if support is not None:
        weak &= support.weak_sd_m > OBSERVATION.weak_sd_m
    weak[0] = False  # there is no map yet to observe anything against
    weak &= ~np.asarray(steps["lost"], bool)  # lost tracking is reported by itself
    weak &= ~np.asarray(steps.get("stationary", np.zeros(len(t_s))), bool)  # it cannot drift
    rows = np.flatnonzero(weak)
    if not len(rows):
        return []
    runs = np.split(rows, np.flatnonzero(np.diff(t_s[rows]) > WEAK_DIRECTION.bridged_s) + 1)
    found = [
        WeakStretch(
            start_s=float(t_s[run[0]]),
            end_s=float(t_s[run[-1]]),
            degeneracy=float(np.median(degeneracy[run])),
            sd_m=float(np.median(sd_m[run])),
            direction_odom=_mean_direction(directions[run]),
        )
        for run in runs
    ]
    return [stretch for stretch in found if stretch.seconds >= OBSERVATION.weak_s]


def _mean_direction(directions: Array) -> Array:
    """Axis closest to all of them, whatever their signs."""
    known = directions[np.isfinite(directions).all(axis=1)]
    if not len(known):
        return np.full(3, np.nan)
    axis: Array = np.linalg.eigh(known.T @ known)[1][:, -1]
    return axis


class WeakStretches(Witness):
    """Stretches in which the LiDARs hardly observe a direction."""

    def check(self, walk: WalkRecord) -> Iterator[Finding]:
        """Each stretch, or what the profiler observes in place of the 2-D laser.

        Where the positions are known well all the same, because an accelerometer, loops or fixes
        hold them, a stretch is no fault of the map.
        """
        stretches = weak_stretches(walk.steps, walk.support)
        if not stretches and walk.support is not None:
            yield from _observed_by_profiler(weak_stretches(walk.steps))
        seconds = sum(stretch.seconds for stretch in stretches)
        georeferenced = walk.placement.gnss.georeferenced
        bad = seconds >= OBSERVATION.unobserved_s and not georeferenced
        level = Level.DO_NOT_USE if bad else Level.CHECK
        level = Level.NOTE if is_known(walk) else level
        for stretch in stretches:
            yield _finding(stretch, level, known_to(walk))


def _observed_by_profiler(planar: Sequence[WeakStretch]) -> Iterator[Finding]:
    if planar:
        yield finding(
            FindingKind.WEAK_LASER,
            Level.NOTE,
            {"seconds": sum(stretch.seconds for stretch in planar)},
            span_s=(planar[0].start_s, planar[0].end_s),
        )


def _finding(stretch: WeakStretch, level: Level, uncertainty: dict[str, float]) -> Finding:
    stated = bool(np.isfinite(stretch.sd_m))
    known = bool(np.isfinite(stretch.direction_odom).all())
    direction = "horizontal" if stretch.horizontal else "vertical"
    found = finding(
        FindingKind.WEAK_DIRECTION,
        level,
        {
            "degeneracy": stretch.degeneracy,
            "sd_m": stretch.sd_m if stated else WEAK_DIRECTION.unlimited_m,
            "known": stated and stretch.sd_m < WEAK_DIRECTION.unlimited_m,
            "unlimited": stated and stretch.sd_m >= WEAK_DIRECTION.unlimited_m,
            "unstated": not stated,
            "open": not uncertainty,
        }
        | uncertainty,
        span_s=(stretch.start_s, stretch.end_s),
    )
    return replace(found, direction=direction if known else "unknown")
