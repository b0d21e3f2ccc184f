"""Runs of GNSS fixes that agree with each other but not with the trajectory.

A single rejected fix is noise. Many in a row that lie beside the trajectory by the same amount are
a contradiction of two sensors: either the trajectory left the true path there, or GNSS did.
Multipath beside a building does that in every walk, so a run is a warning, no verdict. The more
fixes it has, the more likely the others are the wrong ones: then the whole map is out of place.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from recon4.geometry.se3 import Array
from recon4.model.trajectory import Times
from recon4.model.tuning import REJECTED_RUNS


@dataclass(frozen=True, slots=True)
class RejectedRun:
    """Consecutive fixes that were rejected although they agree with each other."""

    start_s: float
    """After the first usable fix [s]."""
    end_s: float
    fixes: int
    horizontal_m: float
    """Largest horizontal distance from the trajectory [m]."""
    height_m: float
    """Largest difference in height [m]."""

    @property
    def size_m(self) -> float:
        """Of both together [m]."""
        return float(np.hypot(self.horizontal_m, self.height_m))


def rejected_runs(t_ns: Times, used: NDArray[np.bool_], residual_m: Array) -> list[RejectedRun]:
    """Find them, in order of time.

    Args:
        t_ns: Times of the usable fixes [ns], (M,).
        used: Whether a fix is a GNSS prior, (M,).
        residual_m: Measured minus solved position, east, north, up [m], (M, 3).
    """
    rejected = np.flatnonzero(~used)
    if not len(t_ns) or not len(rejected):
        return []
    t_s = (t_ns - t_ns[0]) / 1e9
    runs = np.split(rejected, np.flatnonzero(np.diff(t_s[rejected]) > REJECTED_RUNS.bridged_s) + 1)
    return [
        RejectedRun(
            start_s=float(t_s[run[0]]),
            end_s=float(t_s[run[-1]]),
            fixes=len(run),
            horizontal_m=float(np.linalg.norm(residual_m[run, :2], axis=1).max()),
            height_m=float(np.abs(residual_m[run, 2]).max()),
        )
        for run in runs
        if len(run) >= REJECTED_RUNS.min_fixes
        and t_s[run[-1]] - t_s[run[0]] >= REJECTED_RUNS.min_s
        and _agree(residual_m[run])
    ]


def disputed_m(runs: Sequence[RejectedRun], *, fixes: int) -> float:
    """Standard deviation of the place of the map, as the rejected runs dispute it [m].

    With a ratio p of all fixes, they are right with the probability p² / (p² + (1 - p)²): one half
    if they are as many as the others, 1 % if they are a tenth.

    Args:
        runs: Those of a walk.
        fixes: Number of its usable fixes.
    """
    if not runs:
        return 0.0
    ratio = sum(run.fixes for run in runs) / fixes
    right = ratio**2 / (ratio**2 + (1.0 - ratio) ** 2)
    return float(np.sqrt(right) * max(run.size_m for run in runs))


def _agree(residual_m: Array) -> bool:
    """Whether residuals (N, 3) change little from one fix to the next."""
    change_m = np.linalg.norm(np.diff(residual_m, axis=0), axis=1)
    size_m = np.linalg.norm(residual_m, axis=1)
    return bool(np.median(change_m) < REJECTED_RUNS.agreement * np.median(size_m))
