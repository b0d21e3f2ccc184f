"""Keyframes of 2-D odometry: the nodes of the pose graph, with their returns."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from recon4.geometry.se2 import between, transform
from recon4.geometry.se3 import Array
from recon4.model.laser_scans import LaserScans
from recon4.model.trajectory import Times, Trajectory
from recon4.slam2d.line_map import stack_points
from recon4.slam2d.prediction import MotionPredictor
from recon4.slam2d.scan_points import ScanPoints, leveling, scan_points
from recon4.slam2d.steps import Steps2d
from recon4.slam2d.tuning import Slam2dTuning
from recon4.slam2d.tuning_graph import KEYFRAMES

Rows = NDArray[np.intp]


@dataclass(frozen=True, slots=True, eq=False)
class Keyframes:
    """Scans that are nodes of the graph; a batch of K."""

    rows: Rows
    """Row of each among the scans, (K,)."""
    t_ns: Times
    """Times [ns], (K,)."""
    pose: Array
    """Poses by odometry: x [m], y [m], yaw [rad], (K, 3)."""
    information: Array
    """Of the motion since the keyframe before, for yaw, x, y in the axes of the keyframe,
    (K, 3, 3); the first has none."""
    scans: tuple[ScanPoints, ...]
    """Returns, level and undistorted; none where tracking was lost."""
    run: Rows
    """Number of the stretch without a loose motion that each belongs to, (K,)."""
    path_m: Array
    """Path length up to each [m], (K,)."""

    def __len__(self) -> int:
        return len(self.rows)

    def around(self, k: int, reach: int) -> tuple[Array, Array]:
        """Returns of keyframe ``k`` and its neighbors in its frame.

        Args:
            k: The keyframe.
            reach: Neighbors before and after it.

        Returns:
            Points [m], (P, 2), and their weights, (P,).
        """
        near = [
            n
            for n in range(max(k - reach, 0), min(k + reach + 1, len(self)))
            if self.run[n] == self.run[k]
        ]
        points = [
            transform(between(self.pose[k], self.pose[n]), self.scans[n].points) for n in near
        ]
        return stack_points(points), np.concatenate([self.scans[n].weights for n in near])


def make_keyframes(
    scans: LaserScans, steps: Steps2d, *, attitude: Trajectory | None, settings: Slam2dTuning
) -> Keyframes:
    """Collect the keyframes of a finished odometry."""
    rows = np.flatnonzero(steps.keyframe)
    predictor = MotionPredictor(scans, attitude, settings=settings)
    level = None
    if attitude is not None:
        level = leveling(attitude.at(scans.t_ns[rows], slack_ns=1_000_000_000))
    nothing = ScanPoints(np.zeros((0, 2)), np.zeros(0))
    points = tuple(
        nothing
        if steps.lost[row] and not steps.resets[row]
        else scan_points(
            scans,
            int(row),
            settings=settings,
            R_level_laser=None if level is None else level[n],
            motion=predictor.velocity(int(row), steps.pose) if row > 1 else None,
        )
        for n, row in enumerate(rows)
    )
    information = steps.motion_information[rows]
    covariance = np.linalg.inv(information + 1e-9 * np.eye(3))
    loose = np.sqrt(covariance[:, 1, 1] + covariance[:, 2, 2]) > KEYFRAMES.loose_sd_m
    loose[:1] = False
    pose = steps.pose[rows]
    moved_m = np.hypot(*np.diff(pose[:, :2], axis=0).T)
    return Keyframes(
        rows=rows,
        t_ns=scans.t_ns[rows],
        pose=pose,
        information=information,
        scans=points,
        run=np.cumsum(loose | steps.resets[rows], dtype=np.intp),
        path_m=np.concatenate([[0.0], np.cumsum(moved_m)]),
    )
