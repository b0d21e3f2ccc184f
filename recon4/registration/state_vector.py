"""Index of each quantity in the vectors of the odometry filter."""

from __future__ import annotations

from dataclasses import dataclass

from recon4.kernels.imu import ROWS


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
    rotation=_rows(ROWS.rotation),
    position=_rows(ROWS.position),
    velocity=_rows(ROWS.velocity),
    gyro_bias=_rows(ROWS.gyro_bias),
    accel_bias=_rows(ROWS.accel_bias),
    gravity=_rows(ROWS.gravity),
    gyro_gain=slice(ROWS.gyro_gain, ROWS.clock),
    clock=slice(ROWS.clock, ROWS.size),
    unit=slice(ROWS.gyro_gain, ROWS.size),
    pose=slice(ROWS.rotation, ROWS.velocity),
    calibration=slice(ROWS.gyro_bias, ROWS.size),
)
"""Rows of the error state: the rotation is a tangent vector there."""

VECTOR = StateIndex(
    rotation=slice(0, 0),
    position=_rows(ROWS.position - 3),
    velocity=_rows(ROWS.velocity - 3),
    gyro_bias=_rows(ROWS.gyro_bias - 3),
    accel_bias=_rows(ROWS.accel_bias - 3),
    gravity=_rows(ROWS.gravity - 3),
    gyro_gain=slice(ROWS.gyro_gain - 3, ROWS.clock - 3),
    clock=slice(ROWS.clock - 3, ROWS.size - 3),
    unit=slice(ROWS.gyro_gain - 3, ROWS.size - 3),
    pose=_rows(ROWS.position - 3),
    calibration=slice(ROWS.gyro_bias - 3, ROWS.size - 3),
)
"""Rows of `MotionState.vector`: the rotation is kept as a matrix beside it."""

START = slice(0, 6)
"""Rows of the pose at the start of a frame in the joint error of a frame (34,)."""
END = slice(6, 6 + ROWS.size)
"""Rows of the state at the end of a frame in the joint error of a frame (34,)."""
END_POSE = slice(6, 12)
"""Rows of the pose at the end of a frame in the joint error of a frame (34,)."""
POSES = slice(0, 12)
"""Rows of both poses in the joint error of a frame (34,)."""
END_VELOCITY = slice(12, 15)
"""Rows of the velocity at the end of a frame in the joint error of a frame (34,)."""
END_MOTION = slice(12, 18)
"""Rows of velocity and gyroscope bias at the end of a frame in the joint error (34,)."""
