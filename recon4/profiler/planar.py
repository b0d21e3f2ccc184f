"""2-D SLAM of the backpack's laser, leveled by the IMU."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from recon4.geometry.se3 import SE3
from recon4.model.laser_scans import LaserScans
from recon4.model.laser_upright import turned_round
from recon4.model.rig import Rig
from recon4.model.trajectory import Trajectory
from recon4.profiler.clock_audit import ClockLag, clock_lag
from recon4.profiler.fusion import PlanarPoses, attitude
from recon4.profiler.imu_chain import Drive
from recon4.profiler.mirrored import is_mirrored
from recon4.profiler.tuning_solve import LEVELED_SCANS
from recon4.progress import Progress
from recon4.settings.reads import Slam2dReads
from recon4.slam2d.slam import Slam2dResult, slam2d


@dataclass(frozen=True, slots=True, eq=False)
class PlanarMap:
    """Planar poses with what 2-D SLAM found."""

    poses: PlanarPoses
    found: Slam2dResult
    mirrored: bool
    """The scans were turned over, because they turned against the gyroscope."""
    lag: ClockLag | None
    """Of the IMU against the 2-D laser; None = not known."""


def map_in_plane(
    scans: LaserScans | None,
    rig: Rig,
    drive: Drive,
    *,
    settings: Slam2dReads,
    progress: Progress,
) -> PlanarMap | None:
    """Run 2-D SLAM.

    Args:
        scans: Of the 2-D laser.
        rig: Its mounting.
        drive: The IMU, for the attitude.
        settings: Those of 2-D SLAM.
        progress: Counts scans.

    Returns:
        None if there is no 2-D laser, or it measured next to nothing.
    """
    row = rig.row_of("laser2d")
    if scans is None or row is None:
        return None
    R_map_body = attitude(drive)
    first, last = np.searchsorted(
        scans.t_ns,
        [R_map_body.t_ns[0] - LEVELED_SCANS.near_ns, R_map_body.t_ns[-1] + LEVELED_SCANS.near_ns],
    )
    if last - first < LEVELED_SCANS.min_scans:
        return None
    T_body_laser = rig.sensors[row].T_body_sensor
    T_map_laser = SE3(R_map_body.T_a_b.R @ T_body_laser.R, np.zeros_like(R_map_body.T_a_b.t))
    used, leveled = scans[slice(int(first), int(last))], Trajectory(R_map_body.t_ns, T_map_laser)
    mirrored = drive.has_imu and is_mirrored(used, leveled)
    found = slam2d(
        turned_round(used) if mirrored else used,
        attitude=leveled,
        settings=settings,
        progress=progress,
    )
    poses = _tracked(found, T_body_laser)
    blur_s = _blur_s(used, settings)
    lag = clock_lag(poses, R_map_body, blur_s=blur_s) if drive.has_imu else None
    return PlanarMap(poses, found, mirrored, lag)


def _blur_s(scans: LaserScans, settings: Slam2dReads) -> float:
    """Half the duration of a scan whose beams are not undistorted [s]: which one is not known."""
    scan_s = float(np.median(scans.duration_s))
    if scan_s == 0.0:
        return 0.5e-9 * float(np.median(np.diff(scans.t_ns)))
    is_distorted = settings.slam2d.method == "hector"
    return 0.5 * scan_s * is_distorted


def _tracked(found: Slam2dResult, T_body_laser: SE3) -> PlanarPoses:
    """Poses of the scans that were tracked, with their covariance in the map's axes."""
    tracked = ~found.steps.lost
    # By 2-D SLAM: heading, x, y in the axes of the laser.
    order = [1, 2, 0]
    cov = found.covariance[tracked][:, order][:, :, order]
    R = np.zeros((len(cov), 3, 3))
    R[:, :2, :2], R[:, 2, 2] = found.trajectory.T_a_b.R[tracked, :2, :2], 1.0
    cov = R @ cov @ np.swapaxes(R, 1, 2) + np.diag(np.array(LEVELED_SCANS.floor_sd) ** 2)
    trajectory = found.trajectory
    return PlanarPoses(trajectory.t_ns[tracked], trajectory.T_a_b[tracked], cov, T_body_laser)
