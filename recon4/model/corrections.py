"""Apply corrections of some poses to a dense trajectory."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from recon4.geometry.se3 import SE3, interpolate, poses_by_blocks
from recon4.model.trajectory import Times, Trajectory


def apply_corrections(dense: Trajectory, t_ns: Times, *, T_before: SE3, T_after: SE3) -> Trajectory:
    """Correct a dense trajectory by the corrections of its nodes.

    Between two nodes each pose is corrected rigidly with either of them, and the two results are
    interpolated (lerp, SLERP); so the result does not depend on the origin. Before the first and
    after the last node the correction of the nearest node applies.

    Args:
        dense: Poses ``T_a_b`` at any times.
        t_ns: Strictly increasing times of the nodes [ns], (N,), N >= 1.
        T_before: ``T_a_b`` of the nodes before, a batch of N. Normally ``dense.at(t_ns)``.
        T_after: ``T_c_b`` of the nodes after, a batch of N; ``c`` may be another frame than ``a``.

    Returns:
        ``T_c_b`` at the times of ``dense``.
    """
    assert len(t_ns) == len(T_before) == len(T_after) >= 1
    T_c_a = T_after @ T_before.inverse()
    if len(t_ns) == 1:
        return replace(dense, T_a_b=T_c_a[0] @ dense.T_a_b)

    def moved(rows: slice) -> SE3:
        at_ns, T_a_b = dense.t_ns[rows], dense.T_a_b[rows]
        left = np.clip(np.searchsorted(t_ns, at_ns, side="right") - 1, 0, len(t_ns) - 2)
        fraction = (at_ns - t_ns[left]) / (t_ns[left + 1] - t_ns[left])
        return interpolate(
            T_c_a[left] @ T_a_b, T_c_a[left + 1] @ T_a_b, np.clip(fraction, 0.0, 1.0)
        )

    return replace(dense, T_a_b=poses_by_blocks(moved, len(dense)))
