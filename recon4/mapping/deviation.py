"""How well the position of each point of the map is known, from the covariances of the poses."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from recon4.geometry.se3 import Array
from recon4.kernels.deviation import worst_deviation


@dataclass(frozen=True, slots=True, eq=False)
class PoseCovariances:
    """Positions of the multiframes and the covariances of their poses."""

    position_m: Array
    """In the map [m], (F, 3)."""
    cov: Array
    """Turn about the pose's own origin, then shift, in the axes of the map, (F, 6, 6)."""


def point_deviations(
    poses: PoseCovariances, p_map: Array, frame_id: NDArray[np.uint32]
) -> NDArray[np.float16]:
    """Standard deviations of points along their worst axis, from their poses alone.

    The noise of the range and what a fitted surface gains are not in them: they say where the
    walk is uncertain. A covariance is constant during its multiframe.

    Args:
        poses: One a multiframe.
        p_map: Points in the map [m], (N, 3).
        frame_id: Multiframe of each, (N,).

    Returns:
        One standard deviation [m], (N,).
    """
    out = np.empty(len(frame_id), np.float32)
    worst_deviation(
        np.ascontiguousarray(p_map), np.ascontiguousarray(frame_id),
        np.ascontiguousarray(poses.position_m), np.ascontiguousarray(poses.cov), out,
    )  # fmt: skip
    # What is beyond 65 km is as good as unknown, and stays a number.
    return np.minimum(out, np.finfo(np.float16).max).astype(np.float16)
