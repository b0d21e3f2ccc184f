"""A clock of the fixes that is wrong by seconds: GPS time for UTC, or a receiver without time.

The audit of the antenna looks for small errors, by how fast the body moves. Seconds show in the
shape of the walk: where it begins, turns and stops.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from recon4.geometry.se3 import Array
from recon4.model.trajectory import Times, Trajectory

_LARGEST_S, _GRID_S = 30.0, 0.25
_STEP_NS = 500_000_000
"""Displacements over this time are compared [ns]."""
_GAP_NS = 1_500_000_000
"""Displacements across longer gaps between fixes are not compared: the path there is unknown."""
_LEAST_S = 0.5
"""Smaller errors are left to the audit [s]."""
_MIN_STEPS, _MIN_OVERLAP = 30, 0.5
"""Displacements that both tracks must have: their number, and their ratio of all."""
_GROSS = 2.0
"""Larger displacements than this multiple of the 95th percentile are gross errors of a fix."""
_CLEARLY = 0.25
"""The tracks at the clock that is found differ by less than this ratio of those at the stamps."""


def coarse_clock_s(trajectory: Trajectory, t_ns: Times, p_fix: Array) -> float:
    """Seconds to be added to fixes so that their track has the shape of the trajectory's; 0 = none.

    Args:
        trajectory: ``T_a_body`` with z up; its heading and place do not matter.
        t_ns: Times of the fixes, increasing [ns], (N,).
        p_fix: East and north of them [m], (N, 2).
    """
    if len(t_ns) < _MIN_STEPS:
        return 0.0
    begin_ns = np.arange(t_ns[0], t_ns[-1] - _STEP_NS, _STEP_NS)
    begin_ns = begin_ns[_gap_ns(t_ns, begin_ns) <= _GAP_NS]
    if len(begin_ns) < _MIN_STEPS:
        return 0.0
    of_fixes = _displacements(begin_ns, t_ns, p_fix)
    size_m = np.abs(of_fixes)
    usual = size_m <= _GROSS * np.percentile(size_m, 95.0)
    begin_ns, of_fixes = begin_ns[usual], of_fixes[usual]
    grid_s = np.arange(-_LARGEST_S, _LARGEST_S + 0.5 * _GRID_S, _GRID_S)
    differ = np.array([_differ(trajectory, begin_ns, of_fixes, clock_s=clock) for clock in grid_s])
    if not np.isfinite(differ).any():
        return 0.0
    best = int(np.nanargmin(differ))
    # Of the same fixes: those that another clock leaves out may be worse than the others.
    same = _inside(trajectory, begin_ns, clock_s=float(grid_s[best]))
    at_stamps = _differ(trajectory, begin_ns[same], of_fixes[same], clock_s=0.0)
    clear = differ[best] < _CLEARLY * at_stamps or np.isnan(at_stamps)
    return float(grid_s[best]) if clear and abs(grid_s[best]) >= _LEAST_S else 0.0


def _gap_ns(t_ns: Times, begin_ns: Times) -> Times:
    """Longest time between fixes around each displacement [ns], (K,)."""
    first = np.searchsorted(t_ns, begin_ns, side="right") - 1
    last = np.minimum(np.searchsorted(t_ns, begin_ns + _STEP_NS), len(t_ns) - 1)
    gaps = np.append(np.diff(t_ns), 0)
    return np.maximum.reduceat(gaps, np.stack([first, last], axis=1).ravel())[::2]


def _differ(
    trajectory: Trajectory, begin_ns: Times, of_fixes: NDArray[np.complex128], *, clock_s: float
) -> float:
    """Mean square difference of the displacements at the best heading [m²]; NaN = no overlap."""
    inside = _inside(trajectory, begin_ns, clock_s=clock_s)
    if inside.sum() < max(_MIN_STEPS, _MIN_OVERLAP * len(begin_ns)):
        return float("nan")
    moved_ns = begin_ns[inside] + round(1e9 * clock_s)
    seen = _displacements(moved_ns, trajectory.t_ns, trajectory.T_a_b.t[:, :2])
    fixed = of_fixes[inside]
    together = abs(np.vdot(seen, fixed))
    total = np.vdot(seen, seen).real + np.vdot(fixed, fixed).real - 2.0 * together
    return float(total) / len(fixed)


def _inside(trajectory: Trajectory, begin_ns: Times, *, clock_s: float) -> NDArray[np.bool_]:
    """Which displacements lie in the trajectory, (K,)."""
    moved_ns = begin_ns + round(1e9 * clock_s)
    within = (moved_ns >= trajectory.t_ns[0]) & (moved_ns + _STEP_NS <= trajectory.t_ns[-1])
    return np.asarray(within, np.bool_)


def _displacements(begin_ns: Times, t_ns: Times, p: Array) -> NDArray[np.complex128]:
    """East and, as imaginary part, north by which positions (N, 2) move in `_STEP_NS`, (M,)."""
    # float64 represents nanoseconds exactly only after the start is subtracted.
    at, known = (np.asarray(times - t_ns[0], np.float64) for times in (begin_ns, t_ns))
    east, north = (np.interp(at + _STEP_NS, known, x) - np.interp(at, known, x) for x in p.T)
    return np.asarray(east + 1j * north)
