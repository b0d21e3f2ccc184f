"""Attitude of the body during a capture: the gyroscope, pulled towards the vertical."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from recon4.geometry.se3 import SE3, Array, proper
from recon4.kernels.imu_chain import level_by_gravity
from recon4.live.mapper.tuning import LIVE_ATTITUDE
from recon4.model.rig import Rig
from recon4.model.samples import ImuSamples
from recon4.model.trajectory import Times, Trajectory
from recon4.recording.samples.measured_channels import feels_gravity
from recon4.registration.motion import imu_in_body, level_rotation

NOT_UPRIGHT, NO_FORCES = "not-upright", "no-forces"
"""Remarks: `recon4.live.findings` has their words."""


def is_upright(up_body: Array) -> bool:
    """Whether the mean specific force (3,) lies near the z axis of the body."""
    return bool(up_body[2] > LIVE_ATTITUDE.min_upright * np.linalg.norm(up_body))


class LiveAttitude:
    """Integrates the samples of an IMU as they come in; the heading drifts."""

    def __init__(self, rig: Rig) -> None:
        self._rig = rig
        self._offset_ns = round(1e9 * rig.imu_clock_offset_s)
        self._t_ns: Times = np.zeros(0, np.int64)
        self._R: Array = np.zeros((0, 3, 3))
        """``R_world_body``, (N, 3, 3)."""
        self._hole_ns = 0
        """End of the last time without samples [ns]."""
        self._last: tuple[Array, Array] | None = None
        """Turn rate and specific force of the last sample."""
        self._silent = 0
        """Number of samples without accelerations."""
        self.remark = ""
        """Code of why the IMU is not used; empty = it is."""

    def extend(self, imu: ImuSamples) -> None:
        """Add samples; those that are not later than the ones before are left out."""
        known = np.isfinite(imu.gyro_rad_s).all(axis=1) & feels_gravity(imu.accel_m_s2)
        self._expect_forces(known)
        t_ns = imu.t_ns + self._offset_ns
        known &= t_ns > (self._t_ns[-1] if len(self._t_ns) else -1)
        if self.remark or not known.any():
            return
        gyro, accel = imu_in_body(
            ImuSamples(t_ns[known], imu.gyro_rad_s[known], imu.accel_m_s2[known]), self._rig
        )
        t_ns = t_ns[known]
        if self._last is None:
            self._begin(t_ns, gyro, accel)
            return
        if t_ns[0] - self._t_ns[-1] > LIVE_ATTITUDE.longest_hole_ns:
            self._hole_ns = int(t_ns[0])
        gyro, accel = (np.vstack([a, b]) for a, b in zip(self._last, (gyro, accel), strict=True))
        self._integrate(np.append(self._t_ns[-1:], t_ns), gyro, accel)

    def covers(self, first_ns: int, last_ns: int) -> bool:
        """Whether the attitude is known over a time, without a hole."""
        if len(self._t_ns) < 2 or first_ns < max(int(self._t_ns[0]), self._hole_ns):
            return False
        return last_ns <= int(self._t_ns[-1]) + LIVE_ATTITUDE.sure_ns

    def trajectory(self) -> Trajectory:
        """``R_world_body`` of the last seconds; positions are zero."""
        return Trajectory(self._t_ns, SE3(self._R, np.zeros((len(self._t_ns), 3))))

    def _expect_forces(self, known: NDArray[np.bool_]) -> None:
        """Give up an IMU that begins without accelerations."""
        self._silent += int(np.count_nonzero(~known))
        if self._last is None and not known.any() and self._silent > LIVE_ATTITUDE.most_silent:
            self.remark = NO_FORCES

    def _begin(self, t_ns: Times, gyro: Array, accel: Array) -> None:
        up = accel.mean(axis=0)
        if not is_upright(up):
            self.remark = NOT_UPRIGHT
            return
        self._t_ns, self._R = t_ns[:1], level_rotation(up)[None]
        self._integrate(t_ns, gyro, accel)

    def _integrate(self, t_ns: Times, gyro: Array, accel: Array) -> None:
        """Continue from the last attitude, which is that of the first of these samples."""
        self._last = gyro[-1:], accel[-1:]
        if len(t_ns) < 2:
            return
        R = np.empty((len(t_ns), 3, 3))
        R[0] = self._R[-1]
        for k, step_ns in enumerate(np.diff(t_ns).tolist()):
            rows = slice(k, k + 2)
            level_by_gravity(
                gyro[rows], accel[rows], 1e-9 * step_ns, LIVE_ATTITUDE.gain_per_s, R[rows]
            )
        R[-1] = proper(R[-1:])[0]
        kept = self._t_ns > t_ns[-1] - LIVE_ATTITUDE.kept_ns
        self._t_ns = np.concatenate([self._t_ns[kept], t_ns[1:]])
        self._R = np.concatenate([self._R[kept], R[1:]])
