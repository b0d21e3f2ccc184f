"""What 2-D odometry found, as arrays."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from recon4.geometry.se3 import Array
from recon4.model.trajectory import Times
from recon4.slam2d.tuning_matching import OBSERVABILITY_2D


@dataclass(frozen=True, slots=True, eq=False)
class Steps2d:
    """What odometry found, one row per scan."""

    t_ns: Times
    """Time of each scan [ns], (N,)."""
    pose: Array
    """Pose in the odometry frame: x [m], y [m], yaw [rad], (N, 3)."""
    motion_information: Array
    """Information of the motion since the keyframe before, for yaw, x, y in the axes of the scan,
    (N, 3, 3)."""
    match_ratio: Array
    """Weighted fraction of the returns on lines of the local map, (N,)."""
    degeneracy: Array
    """0 = a direction is unobservable, 1/2 = isotropic, (N,)."""
    weak_sd_m: Array
    """Standard deviation by the laser along the weakest direction [m], (N,)."""
    weak_direction: Array
    """That direction in the odometry frame, (N, 2)."""
    lost: NDArray[np.bool_]
    """Whether the pose is only predicted, (N,)."""
    keyframe: NDArray[np.bool_]
    """Whether the scan became part of the local map, (N,)."""
    searched: NDArray[np.bool_]
    """Whether a correlative search found the pose, (N,)."""
    resets: NDArray[np.bool_]
    """Whether the local map started again here, (N,)."""


def empty_steps(t_ns: Times) -> Steps2d:
    """Rows of scans at these times [ns], nothing found yet."""
    n = len(t_ns)
    return Steps2d(
        t_ns=t_ns,
        pose=np.zeros((n, 3)),
        motion_information=np.zeros((n, 3, 3)),
        match_ratio=np.zeros(n),
        degeneracy=np.zeros(n),
        weak_sd_m=np.full(n, OBSERVABILITY_2D.unobserved_sd_m),
        weak_direction=np.zeros((n, 2)),
        lost=np.zeros(n, np.bool_),
        keyframe=np.zeros(n, np.bool_),
        searched=np.zeros(n, np.bool_),
        resets=np.zeros(n, np.bool_),
    )
