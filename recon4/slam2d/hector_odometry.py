"""2-D odometry as hector_slam does it, for comparison and for the published pipeline."""

from __future__ import annotations

import numpy as np

from recon4.geometry.se2 import between, compose, wrap
from recon4.geometry.se3 import Array
from recon4.model.laser_scans import LaserScans
from recon4.model.trajectory import Trajectory
from recon4.progress import Progress, track
from recon4.slam2d.hector import HectorMap
from recon4.slam2d.observability import observed
from recon4.slam2d.scan_points import leveling, scan_points
from recon4.slam2d.steps import Steps2d, empty_steps
from recon4.slam2d.tuning import HectorTuning, Slam2dTuning
from recon4.slam2d.tuning_matching import HECTOR_ODOMETRY


def run_hector(
    scans: LaserScans,
    *,
    attitude: Trajectory | None,
    settings: Slam2dTuning,
    hector: HectorTuning,
    progress: Progress,
) -> Steps2d:
    """Register all scans to one occupancy grid.

    Args:
        scans: At least one; their odometry is not used.
        attitude: Attitude of the laser at all scans; None = it is level.
        settings: Limits of range and height, distance of keyframes.
        hector: Constants of the method.
        progress: Counts scans.
    """
    steps, grids, key = empty_steps(scans.t_ns), HectorMap(hector), -1
    level, turn_rad = _attitude(scans, attitude)
    for k in track(range(len(scans)), progress, what="2-D odometry", unit="scans"):
        R = None if level is None else level[k]
        scan = scan_points(scans, k, settings=settings, R_level_laser=R)
        if k:
            turned = np.array([0.0, 0.0, turn_rad[k] - turn_rad[k - 1]])
            steps.pose[k] = compose(steps.pose[k - 1], turned)
        if len(scan.points) < HECTOR_ODOMETRY.fewest_points:
            steps.lost[k] = True
            continue
        if not grids.empty:
            match = grids.register(scan.points, steps.pose[k])
            found = observed(match.H, settings.normal_noise_rad)
            steps.pose[k], steps.match_ratio[k] = match.pose, match.match_ratio
            steps.degeneracy[k], steps.weak_sd_m[k] = found.degeneracy, found.weak_sd_m
            steps.weak_direction[k] = found.weak_direction
            steps.motion_information[k] = _in_scan_axes(match.H, match.pose)
            steps.lost[k] = match.match_ratio < settings.min_match_ratio
        grids.update(scan.points, steps.pose[k])
        if key < 0 or _is_keyframe(between(steps.pose[key], steps.pose[k]), settings):
            steps.keyframe[k], key = True, k
    return steps


def _attitude(scans: LaserScans, attitude: Trajectory | None) -> tuple[Array | None, Array]:
    """Leveling rotations of all scans, and their yaw by the IMU [rad]."""
    if attitude is None:
        return None, np.zeros(len(scans))
    T = attitude.at(scans.t_ns, slack_ns=1_000_000_000)
    return leveling(T), np.unwrap(np.arctan2(T.R[:, 1, 0], T.R[:, 0, 0]))


def _in_scan_axes(H: Array, pose: Array) -> Array:
    c, s = np.cos(pose[2]), np.sin(pose[2])
    turn = np.array([[1.0, 0.0, 0.0], [0.0, c, -s], [0.0, s, c]])
    return np.asarray(turn.T @ H @ turn)


def _is_keyframe(moved: Array, settings: Slam2dTuning) -> bool:
    far = float(np.hypot(moved[0], moved[1])) > settings.keyframe_m
    return far or abs(float(wrap(moved[2]))) > settings.keyframe_rad
