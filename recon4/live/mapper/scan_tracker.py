"""2-D odometry of a running capture: the scans come in one by one."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from recon4.geometry.se3 import SE3, Array
from recon4.live.mapper.live_attitude import LiveAttitude
from recon4.live.mapper.tuning import SCAN_TRACKER
from recon4.model.laser_scans import LaserScans, joined_scans
from recon4.model.rig import Sensor
from recon4.model.trajectory import Trajectory
from recon4.slam2d.odometry import Odometry2d
from recon4.slam2d.scan_points import ScanPoints
from recon4.slam2d.tuning import Slam2dTuning


@dataclass(frozen=True, slots=True, eq=False)
class ScanStep:
    """What the odometry found of one scan."""

    t_ns: int
    """Time of its first beam [ns]."""
    end_ns: int
    """Time of its last beam [ns]."""
    pose: Array
    """``T_odom_laser``: x [m], y [m], yaw [rad], (3,)."""
    seen: ScanPoints
    """Its returns, level and undistorted."""
    match_ratio: float
    weak_sd_m: float
    """Standard deviation along the weakest direction by this scan alone [m]."""
    weak_rad: float
    """That direction in the odometry frame [rad]."""
    lost: bool
    """Whether the pose is only predicted."""
    restarted: bool
    """Whether the local map started again here."""
    keyframe: bool
    turn_rad_s: float
    """Turn rate since the scan before [rad/s]."""
    with_imu: bool
    """Whether the IMU leveled it and predicted its turn."""


class ScanTracker:
    """Runs `Odometry2d` on the last scans of a capture; its memory does not grow."""

    def __init__(self, laser: Sensor, settings: Slam2dTuning) -> None:
        self._laser, self._settings = laser, settings
        self._odometry: Odometry2d | None = None
        self._scans: LaserScans | None = None
        """The scans of the odometry."""

    def push(self, scan: LaserScans, attitude: LiveAttitude) -> ScanStep:
        """Register the next scan.

        Args:
            scan: One scan, later than those before.
            attitude: Of the body; it is used if it covers this scan and the one before.
        """
        scans = self._with(scan)
        known = len(scans) - 1
        R_world_laser = self._attitude(scans, attitude)
        if self._odometry is None:
            self._odometry = Odometry2d(scans, attitude=R_world_laser, settings=self._settings)
        else:
            self._odometry.advance(scans, known=known, attitude=R_world_laser)
        self._odometry.push(known)
        self._scans = scans
        return self._step(scans, known, with_imu=R_world_laser is not None)

    def _with(self, scan: LaserScans) -> LaserScans:
        """The scans that are still needed, and a new one."""
        before = self._scans
        if before is None:
            return scan
        first = int(np.searchsorted(before.t_ns, before.t_ns[-1] - SCAN_TRACKER.kept_ns)) - 1
        first = max(
            min(first, len(before) - SCAN_TRACKER.least), len(before) - SCAN_TRACKER.most, 0
        )
        return joined_scans([before[slice(first, len(before))], scan])

    def _attitude(self, scans: LaserScans, attitude: LiveAttitude) -> Trajectory | None:
        """``R_world_laser`` at these scans; None = the IMU does not cover them."""
        if not attitude.covers(int(scans.t_ns[0]), end_of(scans)):
            return None
        R_world_body = attitude.trajectory()
        R = R_world_body.T_a_b.R @ self._laser.T_body_sensor.R
        return Trajectory(R_world_body.t_ns, SE3(R, R_world_body.T_a_b.t))

    def _step(self, scans: LaserScans, k: int, *, with_imu: bool) -> ScanStep:
        assert self._odometry is not None
        steps = self._odometry.steps
        turn = 0.0
        if k:
            turned = float((steps.pose[k, 2] - steps.pose[k - 1, 2] + np.pi) % (2 * np.pi) - np.pi)
            turn = turned / (float(scans.t_ns[k] - scans.t_ns[k - 1]) * 1e-9)
        along = steps.weak_direction[k]
        return ScanStep(
            t_ns=int(scans.t_ns[k]),
            end_ns=end_of(scans),
            pose=steps.pose[k].copy(),
            seen=self._odometry.seen,
            match_ratio=float(steps.match_ratio[k]),
            weak_sd_m=float(steps.weak_sd_m[k]),
            weak_rad=float(np.arctan2(along[1], along[0])),
            lost=bool(steps.lost[k]),
            restarted=bool(steps.resets[k]),
            keyframe=bool(steps.keyframe[k]),
            turn_rad_s=abs(turn),
            with_imu=with_imu,
        )


def end_of(scans: LaserScans) -> int:
    """Time of the last beam of the last scan [ns]."""
    return int(scans.t_ns[-1]) + round(1e9 * float(scans.duration_s[-1]))
