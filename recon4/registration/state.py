"""Index of each quantity in the vectors of the odometry filter."""

from __future__ import annotations

from dataclasses import dataclass

from recon4.kernels.imu import (
    ACCEL_BIAS,
    CLOCK,
    GRAVITY,
    GYRO_BIAS,
    GYRO_GAIN,
    POSITION,
    ROTATION,
    SIZE,
    VELOCITY,
)


@dataclass(frozen=True, slots=True, kw_only=True)
class StateIndex:
    """Rows of the error state (28,), its covariance (28, 28) and the vector of a state (25,)."""

    rotation: slice
    """Rotation error about the odometry frame's axes [rad]."""
    position: slice
    """Position of the body in the odometry frame [m]."""
    velocity: slice
    """Velocity of the body in the odometry frame [m/s]."""
    gyro_bias: slice
    """[rad/s]; without an IMU the negative turn rate."""
    accel_bias: slice
    """[m/s²]."""
    gravity: slice
    """Gravity in the odometry frame [m/s²]."""
    gyro_gain: slice
    """What the gyroscope's scale and axes miss, a (3, 3) matrix row by row: with it and the
    identity measured turn rates are multiplied."""
    clock: slice
    """How far the clock of the IMU is ahead of that of the LiDARs [s]."""
    unit: slice
    """Gain and clock: what belongs to the unit, wherever it is."""
    pose: slice
    """Rotation and position."""
    calibration: slice
    """Biases, gravity, gain and clock: what changes slowly."""


def _rows(first: int) -> slice:
    return slice(first, first + 3)


STATE = StateIndex(
    rotation=_rows(ROTATION),
    position=_rows(POSITION),
    velocity=_rows(VELOCITY),
    gyro_bias=_rows(GYRO_BIAS),
    accel_bias=_rows(ACCEL_BIAS),
    gravity=_rows(GRAVITY),
    gyro_gain=slice(GYRO_GAIN, CLOCK),
    clock=slice(CLOCK, SIZE),
    unit=slice(GYRO_GAIN, SIZE),
    pose=slice(ROTATION, VELOCITY),
    calibration=slice(GYRO_BIAS, SIZE),
)
"""Rows of the error state: the rotation is a tangent vector there."""

VECTOR = StateIndex(
    rotation=slice(0, 0),
    position=_rows(POSITION - 3),
    velocity=_rows(VELOCITY - 3),
    gyro_bias=_rows(GYRO_BIAS - 3),
    accel_bias=_rows(ACCEL_BIAS - 3),
    gravity=_rows(GRAVITY - 3),
    gyro_gain=slice(GYRO_GAIN - 3, CLOCK - 3),
    clock=slice(CLOCK - 3, SIZE - 3),
    unit=slice(GYRO_GAIN - 3, SIZE - 3),
    pose=_rows(POSITION - 3),
    calibration=slice(GYRO_BIAS - 3, SIZE - 3),
)
"""Rows of `MotionState.vector`: the rotation is kept as a matrix beside it."""

START = slice(0, 6)
"""Rows of the pose at the start of a frame in the joint error of a frame (34,)."""
END = slice(6, 6 + SIZE)
"""Rows of the state at the end of a frame in the joint error of a frame (34,)."""
END_POSE = slice(6, 12)
"""Rows of the pose at the end of a frame in the joint error of a frame (34,)."""
POSES = slice(0, 12)
"""Rows of both poses in the joint error of a frame (34,)."""
END_VELOCITY = slice(12, 15)
"""Rows of the velocity at the end of a frame in the joint error of a frame (34,)."""
END_MOTION = slice(12, 18)
"""Rows of velocity and gyroscope bias at the end of a frame in the joint error (34,)."""
