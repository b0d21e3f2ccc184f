"""Where the body was when tracking was lost, and where it can be since."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from recon4.geometry.se3 import SE3, Array, so3_exp, so3_log
from recon4.live.mapper.tuning import LAST_KNOWN
from recon4.model.rig import Rig
from recon4.model.samples import ImuSamples


@dataclass(frozen=True, slots=True, eq=False)
class Reach:
    """Poses that the body can have reached unseen until an odometry begins again."""

    T_odom_body: SE3
    """Pose of the body when the odometry begins."""
    from_m: Array
    """Last known position in the map [m], (3,)."""
    within_m: float
    """Farthest that it can be from there [m]."""
    turned: tuple[Array, float] | None = None
    """``R_map_body`` by the gyroscope when the odometry begins, (3, 3), and how far from it the
    body can be turned [rad]; None = the turn is not known."""

    def contains(self, T_map_odom: SE3) -> bool:
        """Whether the body can have been there when the odometry began."""
        begun = T_map_odom @ self.T_odom_body
        if float(np.linalg.norm(begun.t - self.from_m)) > self.within_m:
            return False
        if self.turned is None:
            return True
        R, within_rad = self.turned
        return float(np.linalg.norm(so3_log(R.T @ begun.R))) <= within_rad

    def heading(self) -> tuple[float, float] | None:
        """Yaw of ``T_map_odom`` and how far it can be from that [rad]; None = any."""
        if self.turned is None:
            return None
        R = self.turned[0] @ self.T_odom_body.R.T
        return float(np.arctan2(R[1, 0], R[0, 0])), self.turned[1]


class LastKnown:
    """The last pose that is certain, and how the body turned since by its gyroscope."""

    def __init__(self, rig: Rig) -> None:
        self._R_body_imu = rig.T_body_imu.R
        self._T_map_body = SE3.identity()
        self._t_ns: int | None = None
        self._last: tuple[int, Array] | None = None
        """Time and turn rate of the newest sample."""
        self._turn: Array | None = None
        """Rotation since then, (3, 3); None = not known."""

    def set(self, T_map_body: SE3, t_ns: int) -> None:
        """The body is known to be here now."""
        self._T_map_body, self._t_ns = T_map_body, t_ns
        self._turn = np.eye(3) if self._last is not None else None

    def extend(self, imu: ImuSamples) -> None:
        """Add samples of the gyroscope, which continue the ones before."""
        for t_ns, rate in zip(imu.t_ns.tolist(), imu.gyro_rad_s @ self._R_body_imu.T, strict=True):
            if self._last is not None and self._turn is not None:
                before_ns, before = self._last
                step_ns = t_ns - before_ns
                known = 0 <= step_ns < LAST_KNOWN.longest_hole_ns and np.isfinite(rate).all()
                turn = so3_exp(0.5e-9 * step_ns * (before + rate))
                self._turn = self._turn @ turn if known else None
            self._last = t_ns, rate

    def reach(self, T_odom_body: SE3, t_ns: int, *, with_imu: bool) -> Reach | None:
        """Where the body can be.

        Args:
            T_odom_body: Its pose in an odometry that begins now.
            t_ns: Now.
            with_imu: Whether the gyroscope is trusted.

        Returns:
            None if it was never known where the body was.
        """
        if self._t_ns is None:
            return None
        unseen_s = 1e-9 * max(t_ns - self._t_ns, 0)
        within_m = LAST_KNOWN.slack_m + LAST_KNOWN.fastest_m_s * unseen_s
        turned = None
        if with_imu and self._turn is not None:
            within_rad = LAST_KNOWN.slack_rad + LAST_KNOWN.drift_rad_s * unseen_s
            turned = self._T_map_body.R @ self._turn, within_rad
        return Reach(T_odom_body, self._T_map_body.t, within_m, turned)
