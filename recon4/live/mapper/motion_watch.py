"""What the motion of a walk shows of the mounts and clocks of a rig, while it goes on.

A rotation of the IMU about an axis shows in turns about the others, a position along it in the
acceleration that a lever arm of 1 m would have, a clock in the change of the turn rate. LiDARs that
see walls are known better than the IMU, so it stands for all.
"""

from __future__ import annotations

import numpy as np

from recon4.geometry.se3 import Array, skew, so3_log
from recon4.live.mapper.tuning import MOTION_WATCH
from recon4.live.protocol import Axis, Motion
from recon4.registration.step import OdometryStep

_NAMES = (*(("rotation", axis) for axis in "xyz"), *(("position", axis) for axis in "xyz"))


class MotionWatch:
    """Adds up over the multiframes what their motion shows."""

    def __init__(self) -> None:
        self._info = np.zeros(7)
        """Information on rotation and position about x, y, z of the body, and clock, (7,)."""
        self._last: OdometryStep | None = None
        self._rate: Array | None = None
        """Turn rate before [rad/s], (3,)."""
        self._still_s = self._longest_still_s = 0.0
        self._turned = np.zeros(2)
        """To the left and to the right [rad], (2,)."""
        self._tilts: Array | None = None
        """Least and most of the vertical along x and y of the body, (2, 2)."""

    def push(self, step: OdometryStep) -> None:
        """Add a multiframe; one that is lost says nothing."""
        before, self._last = self._last, step
        seconds = (step.t_mid_ns - before.t_mid_ns) * 1e-9 if before else 0.0
        if (
            step.lost
            or before is None
            or before.lost
            or not 0.0 < seconds <= MOTION_WATCH.longest_s
        ):
            self._rate = None
            return
        R_before, R = before.T_odom_body.R, step.T_odom_body.R
        rate = so3_log(R_before.T @ R) / seconds
        shift_m = step.T_odom_body.t - before.T_odom_body.t
        speed = float(np.linalg.norm(shift_m)) / seconds
        self._stand(
            np.linalg.norm(rate) < MOTION_WATCH.still_rad_s and speed < MOTION_WATCH.still_m_s,
            seconds,
        )
        turned = float((R @ rate)[2]) * seconds
        self._turned += [max(turned, 0.0), max(-turned, 0.0)]
        self._tilt(R)
        if self._rate is not None:
            self._learn(rate, (rate - self._rate) / seconds)
        self._rate = rate

    def message(self) -> Motion:
        """What was shown so far."""
        with np.errstate(divide="ignore"):
            sd = np.where(self._info > 0.0, self._info**-0.5, np.inf)
        tuning = MOTION_WATCH
        enough = np.repeat([tuning.enough_rad, tuning.enough_m, tuning.enough_s], [3, 3, 1])
        done = np.minimum((enough / sd) ** 2, 1.0)
        tilts = np.zeros(2) if self._tilts is None else np.rad2deg(np.ptp(self._tilts, axis=0))
        left, right = np.rad2deg(self._turned).tolist()
        return Motion(
            still_s=round(self._longest_still_s, 1),
            tilt_deg=[round(float(v), 1) for v in tilts],
            turned_deg=[round(left), round(right)],
            axes=[
                Axis(quantity=quantity, axis=axis, shown=round(float(part), 2))
                for (quantity, axis), part in zip((*_NAMES, ("clock", "")), done, strict=True)
            ],
        )

    def _stand(self, still: bool | np.bool_, seconds: float) -> None:
        self._still_s = self._still_s + seconds if still else 0.0
        self._longest_still_s = max(self._longest_still_s, self._still_s)

    def _tilt(self, R_odom_body: Array) -> None:
        """Widen the extremes of the tilt to the front and to the sides."""
        tilt = np.arcsin(np.clip(R_odom_body[2, :2], -1.0, 1.0))
        low, high = (tilt, tilt) if self._tilts is None else self._tilts
        self._tilts = np.stack([np.minimum(low, tilt), np.maximum(high, tilt)])

    def _learn(self, rate: Array, change: Array) -> None:
        lever = skew(change) + skew(rate) @ skew(rate)
        self._info[:3] += (rate @ rate - rate**2) / MOTION_WATCH.sd_rad_s**2
        self._info[3:6] += (lever**2).sum(axis=0) / MOTION_WATCH.sd_m_s2**2
        self._info[6] += change @ change / MOTION_WATCH.sd_rad_s2**2
