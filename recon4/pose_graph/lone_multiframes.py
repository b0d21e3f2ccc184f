"""Multiframes that do not observe the motion, among others that do.

The multiframes before and after a lone one are registered to the local map, not to it: what it
left unknown is an error of its own pose, and does not add up along the walk. With ``i`` and ``j``
the nearest multiframes around ``k`` that observe the motion, a body that is accelerated by
``a`` ~ N(0, σ_a²) between them is

    p_k = p̄_k + ½ a (t_k - t_i) (t_j - t_k),   p̄_k linear between p_i and p_j

so a reported position ``p̂_k`` is off by what it deviates from that line, and by the second term.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from recon4.geometry.se3 import Array
from recon4.model.trajectory import Times
from recon4.pose_graph.tuning_solve import LONE

_Mask = NDArray[np.bool_]


def bounds_by_neighbors(observed: _Mask, followed: _Mask, *, t_ns: Times, p_odom: Array) -> Array:
    """How wrong the position of each lone multiframe may be beside those around it.

    Args:
        observed: Whether the points of each observe its shift along all directions, (N,).
        followed: Whether the body was followed to it from the one before, (N,).
        t_ns: Middle of each, (N,).
        p_odom: Position at it [m], (N, 3).

    Returns:
        ``(p̂ - p̄)(p̂ - p̄)ᵀ + (½ σ_a (t - t_i) (t_j - t))² I`` [m²], (N, 3, 3); NaN = not lone.
    """
    bounds = np.full((len(observed), 3, 3), np.nan)
    first = np.searchsorted(t_ns, t_ns - LONE.around_ns)
    last = np.searchsorted(t_ns, t_ns + LONE.around_ns, side="right")
    for k in np.flatnonzero(~observed & followed).tolist():
        before, after = observed[first[k] : k], observed[k + 1 : last[k]]
        if not _mostly(before) or not _mostly(after):
            continue
        i, j = k - 1 - int(before[::-1].argmax()), k + 1 + int(after.argmax())
        if followed[i + 1 : j + 1].all():
            since_s, left_s = float(t_ns[k] - t_ns[i]) / 1e9, float(t_ns[j] - t_ns[k]) / 1e9
            line = (left_s * p_odom[i] + since_s * p_odom[j]) / (since_s + left_s)
            bent_m = 0.5 * LONE.speeds_up_m_s2 * since_s * left_s
            bounds[k] = np.outer(p_odom[k] - line, p_odom[k] - line) + bent_m**2 * np.eye(3)
    return bounds


def _mostly(observed: _Mask) -> bool:
    return bool(len(observed)) and bool(observed.mean() >= LONE.ratio)
