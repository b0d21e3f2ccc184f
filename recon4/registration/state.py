"""Where each quantity stands in the vectors of the odometry filter."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True, slots=True, kw_only=True)
class StateIndex:
    """Rows of the error state (18,), its covariance (18, 18) and the vector of a state (15,)."""

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
    pose: slice
    """Rotation and position."""
    calibration: slice
    """Both biases and gravity: what changes slowly."""


STATE = StateIndex(
    rotation=slice(0, 3),
    position=slice(3, 6),
    velocity=slice(6, 9),
    gyro_bias=slice(9, 12),
    accel_bias=slice(12, 15),
    gravity=slice(15, 18),
    pose=slice(0, 6),
    calibration=slice(9, 18),
)
"""Rows of the error state: the rotation is a tangent vector there."""

VECTOR = StateIndex(
    rotation=slice(0, 0),
    position=slice(0, 3),
    velocity=slice(3, 6),
    gyro_bias=slice(6, 9),
    accel_bias=slice(9, 12),
    gravity=slice(12, 15),
    pose=slice(0, 3),
    calibration=slice(6, 15),
)
"""Rows of `MotionState.vector`: the rotation is kept as a matrix beside it."""

START = slice(0, 6)
"""Rows of the pose at the start of a frame in the joint error of a frame (24,)."""
END = slice(6, 24)
"""Rows of the state at the end of a frame in the joint error of a frame (24,)."""
END_POSE = slice(6, 12)
"""Rows of the pose at the end of a frame in the joint error of a frame (24,)."""
POSES = slice(0, 12)
"""Rows of both poses in the joint error of a frame (24,)."""
END_MOTION = slice(12, 18)
"""Rows of velocity and gyroscope bias at the end of a frame in the joint error (24,)."""
