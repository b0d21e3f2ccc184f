"""Pose of a frame relative to the last good scan: the prediction of odometry without an IMU."""

from __future__ import annotations

from collections import deque

import numpy as np
from msgspec import structs

from recon4.geometry.se3 import SE3, Array
from recon4.kernels.imu import place_points
from recon4.model.lidars import lidar_model
from recon4.model.multiframe import Multiframe
from recon4.model.rig import Rig, Sensor
from recon4.registration.bridge import RecentScans, SeenScan, sure_pose
from recon4.registration.carrier import CarrierPrior
from recon4.registration.in_body import in_body
from recon4.registration.result import StopReason
from recon4.registration.scan_registration import make_scan, search_scans
from recon4.registration.tuning import SCANS, ScanTuning
from recon4.registration.tuning_matching import SCAN_CHAIN
from recon4.registration.tuning_motion import BRIDGE, LOST


class ScanChain:
    """Registers each scan to the last one with a known pose, even far from the predicted pose.

    Scans are not undistorted: two consecutive ones are distorted alike. While frames are lost, the
    last good scan stays the target, so that returning to it ends the loss.
    """

    def __init__(self, settings: ScanTuning = SCANS) -> None:
        self._settings = structs.replace(settings, source_points=SCAN_CHAIN.source_points)
        self._last: SeenScan | None = None
        self._now: SeenScan | None = None
        self._recent = RecentScans(settings)
        self._bridged, self._tried_ns = False, 0
        self._T_odom_body, self._t_ns = SE3.identity(), 0
        self._motion = self._located = SE3.identity()
        self.is_sure = False
        """Whether most of the newest scan lies on the last good one."""
        self._ratios: deque[float] = deque(maxlen=LOST.usual_frames)
        self._ratio = 0.0
        """Of the points of the newest scan that lie on the last good one."""
        self._sure_scans = 0
        self._velocity_m_s: Array = np.zeros(3)
        """In axes of the last good scan."""

    @property
    def sure_scans(self) -> int:
        """How many scans in a row were located surely and kept."""
        return self._sure_scans

    @property
    def shares_usual(self) -> bool:
        """Whether the newest scan shares with the last good one what is usual for the place.

        On bare ground two scans of a tilted LiDAR share a third of their points, and in a turn
        less. What opens to another storey shares less than a third of the usual.
        """
        usual = float(np.median(self._ratios)) if self._ratios else np.inf
        return self._ratio >= LOST.usual_scan_ratio * usual

    @property
    def located(self) -> SE3:
        """Pose of the newest scan in the last good one, as estimated by `locate`."""
        return self._located

    @property
    def motion(self) -> SE3:
        """From the last good scan but one to the last."""
        return self._motion

    @property
    def last(self) -> tuple[SE3, int]:
        """Pose of the last good scan and its time [ns]."""
        return self._T_odom_body, self._t_ns

    def locate(self, points: Array, t_ns: int) -> SE3 | None:
        """Pose of a new scan in the last good one, or None.

        Args:
            points: In the body [m], (N, 3).
            t_ns: Middle of the scan [ns].
        """
        self._see(points)
        if self._last is None or self._now is None:
            return None
        prior = CarrierPrior.after(max((t_ns - self._t_ns) * 1e-9, 0.0), self._velocity_m_s)
        found = search_scans(
            self._last.scan,
            self._now.scan,
            initial=self._motion,
            settings=self._settings,
            prior=prior,
        )
        self._located = found.T_target_source
        self._ratio = found.match_ratio
        self.is_sure = found.match_ratio >= self._settings.confident_inlier_ratio
        # With two distorted scans the matches may oscillate: the inlier ratio decides.
        return None if found.stop is StopReason.TOO_FEW else found.T_target_source

    def bridge(self, points: Array, t_ns: int) -> SE3 | None:
        """Pose of a new scan in the last good one, however far away; None = not surely known.

        Args:
            points: In the body [m], (N, 3).
            t_ns: Middle of the scan [ns].
        """
        since_ns = t_ns - self._t_ns
        if self._last is None or not 0 < since_ns <= 1e9 * self._settings.bridge_s:
            return None
        if self._tried_ns > self._t_ns and t_ns - self._tried_ns < BRIDGE.tried_every_ns:
            return None
        self._tried_ns = t_ns
        now = self._see(points)
        found = sure_pose(
            self._recent.joined(
                self._last.scan,
                self._T_odom_body,
                since_ns=t_ns - round(1e9 * self._settings.bridge_s),
            ),
            now,
            self._last,
            initial=[SE3.identity(), self._motion],
            settings=self._settings,
        )
        self._bridged = self.is_sure = found is not None
        self._located = found or SE3.identity()
        return found

    def _see(self, points: Array) -> SeenScan:
        """Make a scan the newest one."""
        self._now = SeenScan(make_scan(points, self._settings), points)
        self.is_sure = self._bridged = False
        return self._now

    def keep(self, T_odom_body: SE3, t_ns: int) -> None:
        """Make the scan just located the last good one, with its pose and time [ns]."""
        self._sure_scans = self._sure_scans + 1 if self.is_sure else 0
        if self._last is not None:
            self._ratios.append(self._ratio)
        if self._bridged:  # how the body moved meanwhile says nothing of how it moves on
            self._motion, self._velocity_m_s = SE3.identity(), np.zeros(3)
        elif self._last is not None:
            self._motion = self._T_odom_body.inverse() @ T_odom_body
            seconds = max((t_ns - self._t_ns) * 1e-9, 1e-3)
            self._velocity_m_s = self._motion.R.T @ self._motion.t / seconds
        if self._now is not None:
            self._recent.keep(self._now.scan, T_odom_body, t_ns)
        self._last, self._T_odom_body, self._t_ns = self._now, T_odom_body, t_ns


def body_points(frame: Multiframe, rig: Rig, motion: SE3 | None = None) -> Array:
    """Points of the enabled sensors, in the body [m], (N, 3).

    Args:
        frame: Of the points.
        rig: Their sensors.
        motion: Of the body over the frame. Two scans of a LiDAR that spins are distorted alike, but
            a rosette sees each place at other times of its frames: its points are undistorted.
    """
    parts = [np.empty((0, 3))]
    for row, sensor in enumerate(rig.sensors):
        if sensor.enabled:
            own = frame.sensor == row
            points = in_body(sensor, frame.xyz[own])
            if motion is not None and _is_rosette(sensor):
                points = _undistorted(points, frame.dt_ns[own] / frame.duration_ns, motion)
            parts.append(points)
    return np.concatenate(parts)


def times_located(rig: Rig) -> int:
    """How often a scan of a rig is located, each time undistorted by the motion found before."""
    rosettes = any(_is_rosette(sensor) for sensor in rig.sensors if sensor.enabled)
    return SCAN_CHAIN.undistorted if rosettes else 1


def _is_rosette(sensor: Sensor) -> bool:
    return lidar_model(sensor.model).scanning == "rosette"


def _undistorted(points: Array, fraction: Array, motion: SE3) -> Array:
    """Points as the body would see them in the middle of a frame, (N, 3).

    Args:
        points: In the body at their times [m], (N, 3).
        fraction: These times, 0..1 from start to end, (N,).
        motion: Over the frame.
    """
    ends = np.array([0.0, 0.5, 1.0])
    T_middle_body = SE3.exp((ends[:, None] - 0.5) * motion.log())
    return place_points(ends, T_middle_body.R, T_middle_body.t, fraction, points)
