"""Predicted motion from one scan to the next, and how certain it is."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from recon4.geometry.se2 import between, wrap
from recon4.geometry.se3 import Array
from recon4.model.laser_scans import LaserScans
from recon4.model.trajectory import Trajectory
from recon4.slam2d.tuning import Slam2dTuning
from recon4.slam2d.tuning_matching import PREDICTION_2D


@dataclass(frozen=True, slots=True, eq=False)
class Predicted:
    """A motion from one scan to the next."""

    motion: Array
    """Pose of the later scan in the earlier: x [m], y [m], yaw [rad], (3,)."""
    sd_m: float
    """Standard deviation of x and y [m]."""
    sd_rad: float
    """Standard deviation of the yaw [rad]."""
    drift_m: float
    """Growth of the error of the position if nothing else observes it [m]: errors of velocity and
    scale are the same from step to step, so they add up in full."""
    drift_rad: float
    """The same for the yaw [rad]."""


class MotionPredictor:
    """Predicts with the odometry of the recording, else with the velocity before; yaw by an IMU."""

    def __init__(
        self, scans: LaserScans, attitude: Trajectory | None, *, settings: Slam2dTuning
    ) -> None:
        """Choose the sources.

        Args:
            scans: All scans.
            attitude: Attitude of the laser at all scans; its positions are not used.
            settings: Whether odometry may be used, and the largest speed.
        """
        self._t_ns = scans.t_ns
        self._odometry = scans.odometry if settings.use_odometry else None
        self._settings = settings
        self._yaw: Array | None = None
        self._turn_rate: Array = np.full(len(scans), np.nan)
        if attitude is not None:
            R = attitude.at(scans.t_ns, slack_ns=1_000_000_000).R
            self._yaw = np.unwrap(np.arctan2(R[:, 1, 0], R[:, 0, 0]))
            self._turn_rate = _turn_rate(scans, attitude, self._yaw)

    @property
    def has_odometry(self) -> bool:
        """Whether the distance is measured, not extrapolated."""
        return self._odometry is not None

    def seconds(self, k: int) -> float:
        """Time from the scan before to scan ``k`` [s]."""
        return float(self._t_ns[k] - self._t_ns[k - 1]) / 1e9

    def velocity(self, k: int, poses: Array) -> Array:
        """Motion in one second before scan ``k``, in the axes of the last scan, (3,).

        The yaw of an IMU gives the turn rate during the scan: a walking body swings so fast that
        its turn of the last quarter of a second is another one.
        """
        found = self._past_velocity(k, poses)
        if np.isfinite(self._turn_rate[k]):
            found[2] = self._turn_rate[k]
        return found

    def _past_velocity(self, k: int, poses: Array) -> Array:
        before = k - 1
        while (
            before > 0 and self._t_ns[k - 1] - self._t_ns[before] < PREDICTION_2D.velocity_s * 1e9
        ):
            before -= 1
        span_s = float(self._t_ns[k - 1] - self._t_ns[before]) / 1e9
        if span_s <= 0.0 or span_s > 4.0 * PREDICTION_2D.velocity_s + PREDICTION_2D.long_gap_s:
            return np.zeros(3)
        moved = between(poses[k - 1], poses[before])
        return np.array([-moved[0], -moved[1], -moved[2]]) / span_s

    def predict(self, k: int, poses: Array) -> Predicted:
        """The motion from scan ``k - 1`` to scan ``k``.

        Args:
            k: Row of the scan.
            poses: Poses of the scans before, (k, 3) or more rows.
        """
        seconds = self.seconds(k)
        drift_m = 0.5 * self._settings.max_speed_m_s * seconds
        drift_rad = min(0.5 * self._settings.max_turn_rad_s * seconds, np.pi)
        if self._odometry is not None:
            motion = between(self._odometry[k - 1], self._odometry[k])
            distance = float(np.hypot(motion[0], motion[1]))
            turn = abs(float(motion[2]))
            drift_m = PREDICTION_2D.slip * distance
            drift_rad = 0.5 * (PREDICTION_2D.turn_slip * turn + PREDICTION_2D.turn_per_m * distance)
            sd_m = 0.005 + drift_m
            sd_rad = 0.003 + 2.0 * drift_rad
        elif seconds > PREDICTION_2D.long_gap_s:
            motion = np.zeros(3)
            sd_m, sd_rad = drift_m, drift_rad
        else:
            motion = self.velocity(k, poses) * seconds
            sd_m = 0.02 + 0.5 * PREDICTION_2D.acceleration_m_s2 * seconds**2
            sd_rad = 0.02 + 0.5 * PREDICTION_2D.acceleration_rad_s2 * seconds**2
        if self._yaw is not None:
            motion = np.array([motion[0], motion[1], wrap(self._yaw[k] - self._yaw[k - 1])])
            drift_rad = PREDICTION_2D.imu_rad_s * seconds
            sd_rad = 0.003 + 10.0 * drift_rad
        return Predicted(motion, sd_m, sd_rad, drift_m=drift_m, drift_rad=drift_rad)


def _turn_rate(scans: LaserScans, attitude: Trajectory, yaw: Array) -> Array:
    """Turn rate while each scan is measured [rad/s], (N,); NaN = its beams have no times."""
    span_ns = np.rint(1e9 * scans.duration_s).astype(np.int64)
    R = attitude.at(scans.t_ns + span_ns, slack_ns=1_000_000_000 + int(span_ns.max())).R
    turned = wrap(np.arctan2(R[:, 1, 0], R[:, 0, 0]) - yaw)
    return np.where(span_ns > 0, turned * 1e9 / np.maximum(span_ns, 1), np.nan)


class VarianceGrowth:
    """Variance of the motion since the last keyframe, by the predictions alone.

    While nothing observes the position, its error is that of a constant velocity or scale: it grows
    with time or distance, not with the root of it. The steps of its square are added, so that
    several keyframes in a row have the right sum.
    """

    def __init__(self) -> None:
        self.variance: Array = np.zeros(3)
        """For yaw [rad²], x and y [m²], (3,)."""
        self._blind_m = self._blind_rad = 0.0

    @property
    def sd_m(self) -> float:
        """Standard deviation of x and y [m]."""
        return float(np.sqrt(self.variance[1]))

    def add(self, predicted: Predicted) -> None:
        """Add a predicted motion."""
        after_m = self._blind_m + predicted.drift_m
        after_rad = self._blind_rad + predicted.drift_rad
        of_place = predicted.sd_m**2 + after_m**2 - self._blind_m**2
        of_turn = predicted.sd_rad**2 + after_rad**2 - self._blind_rad**2
        self.variance = self.variance + np.array([of_turn, of_place, of_place])
        self._blind_m, self._blind_rad = after_m, after_rad

    def observed(self, *, position: bool) -> None:
        """The laser observed the yaw, and the position if ``position``."""
        self._blind_rad = 0.0
        if position:
            self._blind_m = 0.0

    def restart(self) -> None:
        """A keyframe: the next motion begins."""
        self.variance = np.zeros(3)
