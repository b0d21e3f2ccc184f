"""Windows of a walk that say most about the rig."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from recon4.geometry.se3 import Array, so3_log
from recon4.model.trajectory import Times, Trajectory


def choose_windows(
    trajectory: Trajectory,
    t_mid_ns: Times,
    unusable: NDArray[np.bool_],
    *,
    count: int,
    length: int,
) -> list[range]:
    """Multiframes of windows spread over the walk, where the body turns most about its axes.

    The walk is divided into equal parts; in each the window is chosen with the largest turning
    about the axis it turns least about. Windows with unusable multiframes are left out.

    Args:
        trajectory: ``T_odom_body``, dense.
        t_mid_ns: Middle of each multiframe [ns], (N,).
        unusable: Multiframes that no window may have, (N,).
        count: Largest number of windows.
        length: Multiframes of a window.
    """
    total = len(t_mid_ns)
    starts = np.arange(0, total - length + 1)
    if len(starts) == 0:
        return []
    excitation = _excitation(trajectory, t_mid_ns, length)
    before = np.concatenate([[0], np.cumsum(unusable)])
    usable = before[starts + length] == before[starts]
    parts = min(count, max(1, total // length))
    edges = np.linspace(0, total, parts + 1).astype(int)
    chosen = []
    for first, last in pairwise(edges):
        inside = usable & (starts >= first) & (starts + length <= max(last, first + length))
        if inside.any():
            best = int(starts[inside][np.argmax(excitation[inside])])
            chosen.append(range(best, best + length))
    return chosen


def _excitation(trajectory: Trajectory, t_mid_ns: Times, length: int) -> Array:
    """Smallest eigenvalue of the summed squares of the turns in each window [rad²]."""
    R = trajectory.at(t_mid_ns, slack_ns=10**9).R
    turn = so3_log(np.swapaxes(R[:-1], -1, -2) @ R[1:])
    squares = np.concatenate(
        [np.zeros((1, 3, 3)), np.cumsum(turn[:, :, None] * turn[:, None, :], axis=0)]
    )
    sums = squares[length - 1 :] - squares[: len(squares) - length + 1]
    smallest: Array = np.linalg.eigvalsh(sums)[:, 0]
    return smallest
