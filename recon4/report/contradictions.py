"""Runs of GNSS fixes that agree with each other but not with the trajectory.

A single rejected fix is noise. Many in a row that lie beside the trajectory by the same amount are
a contradiction of two sensors: either the trajectory left the true path there, or GNSS did.
Multipath beside a building does that in every walk, so a run is a warning, no verdict.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from recon4.geometry.se3 import Array
from recon4.report.placement import GnssFacts

MIN_FIXES, MIN_SECONDS = 10, 1.0
"""Shorter runs count as noise."""
_BRIDGED_S = 1.0
"""Two runs with less than this between them are one [s]."""
_AGREEMENT = 0.25
"""Fixes of a run agree if their residuals change from one to the next by less than this part of
their size."""


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


def rejected_runs(gnss: GnssFacts) -> list[RejectedRun]:
    """Find them, in order of time.

    Args:
        gnss: The fixes with their residuals.
    """
    t_ns = np.asarray(gnss.t_ns, np.int64)
    rejected = np.flatnonzero(~np.asarray(gnss.used, bool))
    if not len(t_ns) or not len(rejected):
        return []
    residual_m = np.asarray(gnss.residual_enu_m, np.float64)
    t_s = (t_ns - t_ns[0]) / 1e9
    runs = np.split(rejected, np.flatnonzero(np.diff(t_s[rejected]) > _BRIDGED_S) + 1)
    return [
        RejectedRun(
            start_s=float(t_s[run[0]]),
            end_s=float(t_s[run[-1]]),
            fixes=len(run),
            horizontal_m=float(np.linalg.norm(residual_m[run, :2], axis=1).max()),
            height_m=float(np.abs(residual_m[run, 2]).max()),
        )
        for run in runs
        if len(run) >= MIN_FIXES
        and t_s[run[-1]] - t_s[run[0]] >= MIN_SECONDS
        and _agree(residual_m[run])
    ]


def _agree(residual_m: Array) -> bool:
    """Whether residuals (N, 3) change little from one fix to the next."""
    change_m = np.linalg.norm(np.diff(residual_m, axis=0), axis=1)
    size_m = np.linalg.norm(residual_m, axis=1)
    return bool(np.median(change_m) < _AGREEMENT * np.median(size_m))
