"""Motion that no LiDAR observes, as the accelerometer carries it: its part in odometry edges.

An odometry edge has one covariance. Along directions that the LiDARs observe it is several times
too large, and `ErrorModel` reduces it; along those that only the accelerometer carries it is as
large as its error. Which part of it is which does not follow from its size.
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise
from pathlib import Path

import numpy as np

from recon4.geometry.se3 import Array, matrix_from_quat
from recon4.model.trajectory import Times
from recon4.store.arrays import load_arrays


@dataclass(frozen=True, slots=True, eq=False)
class CarriedMotion:
    """Covariances of the shifts over multiframes along weak directions."""

    cov_odom: Array
    """[m²], (N, 3, 3)."""
    R_odom_body: Array
    """Attitude at each multiframe, (N, 3, 3)."""

    def between(self, frame_ids: Times) -> Array:
        """The same between consecutive nodes, in axes of the body at the later one, (M - 1, 3, 3).

        As in odometry edges the standard deviations of consecutive multiframes add up.

        Args:
            frame_ids: Multiframe of each node, (M,).
        """
        out = np.zeros((max(len(frame_ids) - 1, 0), 3, 3))
        for k, (first, last) in enumerate(pairwise(frame_ids.tolist())):
            R = self.R_odom_body[last]
            total = (last - first) * self.cov_odom[first + 1 : last + 1].sum(axis=0)
            out[k] = R.T @ total @ R
        return out


def load_carried_motion(odometry: Path) -> CarriedMotion:
    """Read it from the artifact of the stage ``odometry``.

    Raises:
        StoreError: If a file is missing or damaged.
    """
    names = ["weak_direction", "weak_motion_sd_m", "quat_xyzw"]
    steps = load_arrays(odometry / "steps.npz", names)
    along = np.nan_to_num(steps["weak_direction"]) * steps["weak_motion_sd_m"][:, None]
    return CarriedMotion(
        along[:, :, None] * along[:, None, :], matrix_from_quat(steps["quat_xyzw"])
    )
