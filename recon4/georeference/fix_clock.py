"""A clock of the fixes that is wrong by seconds: GPS time for UTC, or a receiver without time.

The audit of the antenna looks for small errors, by how fast the body moves. Seconds show in the
shape of the walk: where it begins, turns and stops.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from recon4.geometry.se3 import Array
from recon4.georeference.tuning_clocks import FIX_CLOCK
from recon4.model.trajectory import Times, Trajectory


def coarse_clock_s(trajectory: Trajectory, t_ns: Times, p_fix: Array) -> float:
    """Seconds to be added to fixes so that their track has the shape of the trajectory's; 0 = none.

    Args:
        trajectory: ``T_a_body`` with z up; its heading and place do not matter.
        t_ns: Times of the fixes, increasing [ns], (N,).
        p_fix: East and north of them [m], (N, 2).
    """
    if len(t_ns) < FIX_CLOCK.min_steps:
        return 0.0
    begin_ns = np.arange(t_ns[0], t_ns[-1] - FIX_CLOCK.step_ns, FIX_CLOCK.step_ns)
    begin_ns = begin_ns[_gap_ns(t_ns, begin_ns) <= FIX_CLOCK.gap_ns]
    if len(begin_ns) < FIX_CLOCK.min_steps:
        return 0.0
    of_fixes = _displacements(begin_ns, t_ns, p_fix)
    size_m = np.abs(of_fixes)
    usual = size_m <= FIX_CLOCK.gross * np.percentile(size_m, 95.0)
    begin_ns, of_fixes = begin_ns[usual], of_fixes[usual]
    grid_s = np.arange(
        -FIX_CLOCK.largest_s, FIX_CLOCK.largest_s + 0.5 * FIX_CLOCK.grid_s, FIX_CLOCK.grid_s
    )
    differ = np.array([_differ(trajectory, begin_ns, of_fixes, clock_s=clock) for clock in grid_s])
    if not np.isfinite(differ).any():
        return 0.0
    best = int(np.nanargmin(differ))
    # Of the same fixes: those that another clock leaves out may be worse than the others.
    same = _inside(trajectory, begin_ns, clock_s=float(grid_s[best]))
    at_stamps = _differ(trajectory, begin_ns[same], of_fixes[same], clock_s=0.0)
    clear = differ[best] < FIX_CLOCK.clearly * at_stamps or np.isnan(at_stamps)
    return float(grid_s[best]) if clear and abs(grid_s[best]) >= FIX_CLOCK.least_s else 0.0


def _gap_ns(t_ns: Times, begin_ns: Times) -> Times:
    """Longest time between fixes around each displacement [ns], (K,)."""
    first = np.searchsorted(t_ns, begin_ns, side="right") - 1
    last = np.minimum(np.searchsorted(t_ns, begin_ns + FIX_CLOCK.step_ns), len(t_ns) - 1)
    gaps = np.append(np.diff(t_ns), 0)
    return np.maximum.reduceat(gaps, np.stack([first, last], axis=1).ravel())[::2]


def _differ(
    trajectory: Trajectory, begin_ns: Times, of_fixes: NDArray[np.complex128], *, clock_s: float
) -> float:
    """Mean square difference of the displacements at the best heading [m²]; NaN = no overlap."""
    inside = _inside(trajectory, begin_ns, clock_s=clock_s)
    if inside.sum() < max(FIX_CLOCK.min_steps, FIX_CLOCK.min_overlap * len(begin_ns)):
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
    within = (moved_ns >= trajectory.t_ns[0]) & (
        moved_ns + FIX_CLOCK.step_ns <= trajectory.t_ns[-1]
    )
    return np.asarray(within, np.bool_)


def _displacements(begin_ns: Times, t_ns: Times, p: Array) -> NDArray[np.complex128]:
    """East and, as imaginary part, north by which positions (N, 2) move in a step, (M,)."""
    # float64 represents nanoseconds exactly only after the start is subtracted.
    at, known = (np.asarray(times - t_ns[0], np.float64) for times in (begin_ns, t_ns))
    east, north = (
        np.interp(at + FIX_CLOCK.step_ns, known, x) - np.interp(at, known, x) for x in p.T
    )
    return np.asarray(east + 1j * north)
