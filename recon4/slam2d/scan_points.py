"""The returns of a scan as points in a level frame at one time."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from recon4.geometry.se2 import transform
from recon4.geometry.se3 import SE3, Array
from recon4.model.laser_scans import LaserScans
from recon4.slam2d.tuning import Slam2dTuning
from recon4.slam2d.tuning_matching import SCAN_POINTS


@dataclass(frozen=True, slots=True, eq=False)
class ScanPoints:
    """Returns of a scan that are used."""

    points: Array
    """In the level frame of the laser: yaw as the laser, x and y horizontal [m], (P, 2)."""
    weights: Array
    """Weight of each: near walls have more returns per meter but no more information, (P,)."""


def scan_points(
    scans: LaserScans,
    k: int,
    *,
    settings: Slam2dTuning,
    R_level_laser: Array | None = None,
    motion: Array | None = None,
) -> ScanPoints:
    """The returns of scan ``k`` within the range limits, level and undistorted.

    Args:
        scans: All scans.
        k: Row of the scan.
        settings: Limits of range and height.
        R_level_laser: Roll and pitch of the laser, (3, 3); None = it is level.
        motion: Pose of the laser one second later: x [m], y [m], yaw [rad]; undistorts scans
            whose beams have times. None = it stands still.
    """
    ranges = scans.ranges(k).astype(np.float64)
    used = (ranges >= settings.min_range_m) & (ranges <= settings.max_range_m)
    ranges, angles = ranges[used], scans.angles_rad(k)[used]
    points = ranges[:, None] * np.stack([np.cos(angles), np.sin(angles)], axis=1)
    if motion is not None and scans.time_step_s[k] > 0.0:
        beams = np.flatnonzero(used)
        points = transform(beams[:, None] * scans.time_step_s[k] * motion, points)
    weights = np.clip(ranges * abs(scans.angle_step_rad[k]) / SCAN_POINTS.spacing_m, 0.1, 1.0)
    if R_level_laser is None:
        return ScanPoints(points, weights)
    level = points @ R_level_laser[:, :2].T
    inside = np.abs(level[:, 2]) <= settings.height_window_m
    return ScanPoints(level[inside, :2], weights[inside])


def leveling(T_world_laser: SE3) -> Array:
    """Roll and pitch of poses as rotations ``R_level_laser`` without yaw, (..., 3, 3)."""
    rpy = T_world_laser.rpy()
    zero = np.zeros_like(rpy[..., 2])
    roll = SE3.exp(np.stack([rpy[..., 0], zero, zero, zero, zero, zero], axis=-1)).R
    pitch = SE3.exp(np.stack([zero, rpy[..., 1], zero, zero, zero, zero], axis=-1)).R
    return np.asarray(pitch @ roll)
