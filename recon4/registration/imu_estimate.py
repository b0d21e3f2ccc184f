"""What the odometry found out about an IMU: gain and axes of its gyroscope, and its clock.

Both are states of the filter (`recon4.registration.motion`): a scan that is registered to the map
shows how far the body turned, and when. The motion is corrected by them; what is far from what the
rig file and the unit should be is a warning.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from recon4.geometry.se3 import Array
from recon4.model.odometry_figures import ImuFault
from recon4.registration.motion import MotionState
from recon4.registration.state_vector import STATE, VECTOR
from recon4.registration.tuning_imu import IMU_ERRORS

_TURN = 0.5 * np.array(
    [
        [0, 0, 0, 0, 0, -1, 0, 1, 0],
        [0, 0, 1, 0, 0, 0, -1, 0, 0],
        [0, -1, 0, 1, 0, 0, 0, 0, 0],
    ]
)
"""Maps a gain to its rotation vector, (3, 9)."""


@dataclass(frozen=True, slots=True, eq=False)
class ImuEstimate:
    """Gain of the gyroscope and clock of the IMU, as a walk shows them."""

    gain: Array
    """See `StateIndex.gyro_gain`, (9,)."""
    gain_cov: Array
    """(9, 9)."""
    clock_s: float
    """How far the clock of the IMU is ahead of that of the LiDARs [s]."""
    clock_sd_s: float

    @staticmethod
    def of(state: MotionState) -> ImuEstimate:
        """From the last state of an odometry with an IMU."""
        gain, clock = STATE.gyro_gain, STATE.clock
        return ImuEstimate(
            state.vector[VECTOR.gyro_gain],
            state.P[gain, gain],
            float(state.vector[VECTOR.clock][0]),
            float(np.sqrt(state.P[clock, clock][0, 0])),
        )

    @property
    def faults(self) -> tuple[ImuFault, ...]:
        """What is far from right; none if all is in order."""
        return (*self._scale(), *self._axes(), *self._clock())

    def confirms(self, known: ImuEstimate) -> bool:
        """Whether it differs from what was known before the walk by less than a fault."""
        further = self.gain - known.gain
        return bool(
            abs(self.clock_s - known.clock_s) <= IMU_ERRORS.most_clock_s
            and np.abs(further[::4]).max() <= IMU_ERRORS.most_gain
            and np.linalg.norm(_TURN @ further) <= IMU_ERRORS.most_angle_rad
        )

    def _scale(self) -> tuple[ImuFault, ...]:
        scale, sd = self.gain[::4], np.sqrt(np.diag(self.gain_cov)[::4])
        far = (np.abs(scale) > IMU_ERRORS.most_gain) & (np.abs(scale) > IMU_ERRORS.sigmas * sd)
        if not far.any():
            return ()
        axis = int(np.argmax(np.where(far, np.abs(scale) / sd, 0.0)))
        # What is measured of a turn, relative to the turn itself.
        error = float(1.0 / (1.0 + scale[axis]) - 1.0)
        return (
            ImuFault(kind="gyroscope scale", value=error, sd=float(sd[axis]), axis="xyz"[axis]),
        )

    def _axes(self) -> tuple[ImuFault, ...]:
        turn = _TURN @ self.gain
        angle = float(np.linalg.norm(turn))
        if not angle > IMU_ERRORS.most_angle_rad:
            return ()
        along = turn / angle @ _TURN
        sd = float(np.sqrt(along @ self.gain_cov @ along))
        if angle < IMU_ERRORS.sigmas * sd:
            return ()
        return (ImuFault(kind="gyroscope rotation", value=angle, sd=sd),)

    def _clock(self) -> tuple[ImuFault, ...]:
        if not abs(self.clock_s) > max(
            IMU_ERRORS.most_clock_s, IMU_ERRORS.sigmas * self.clock_sd_s
        ):
            return ()
        return (ImuFault(kind="clock", value=self.clock_s, sd=self.clock_sd_s),)
