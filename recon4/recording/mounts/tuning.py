"""Tuning of the poses of sensors: transforms of bags, joints, checks of rig files."""

from __future__ import annotations

import numpy as np
from msgspec import Struct


class SameMountTuning(Struct, frozen=True, kw_only=True):
    """When two statements of a pose are the same."""

    rad: float = float(np.deg2rad(0.1))
    m: float = 1e-3
    """Two statements of one transform that differ by less are the same: programs round."""
    vertical: float = 1.0 - 1e-6
    """Sine of a pitch that counts as 90°."""
    stated: tuple[float, float] = (float(np.deg2rad(1.0)), 0.02)
    """Angle [rad] and distance [m] by which a rig file and a bag may differ."""
    calibrated: tuple[float, float] = (float(np.deg2rad(3.0)), 0.10)
    """The same for a rig that was calibrated: a bag has the drawing, and real parts differ from
    it."""
    farthest_m: float = 20.0
    """Sensors of one rig are not farther apart [m]."""


SAME_MOUNT = SameMountTuning()


class TransformTuning(Struct, frozen=True, kw_only=True):
    """Transforms that can be true (`transform_messages.py`)."""

    longest_m: float = 100.0
    """A part of a robot is not farther from another one [m]."""
    unit: float = 0.01
    """A quaternion whose squared length differs from 1 by more is refused, as by tf2."""


TRANSFORM_LIMITS = TransformTuning()


class SensorJointTuning(Struct, frozen=True, kw_only=True):
    """Sensors that turn on a joint (`head_angles.py`, `moving_mounts.py`)."""

    stuck_rad: float = float(np.deg2rad(0.05))
    """A head that turned by less stands [rad]."""
    stuck_ns: int = 3_000_000_000
    """A head that stands for longer is reported; a reversal takes some tenths of a second."""
    wait_ns: int = 2_000_000_000
    """A line waits this long for the next angle [ns]."""
    beyond_ns: int = 100_000_000
    """The first and the last motion continue for at most this time [ns]."""
    longest_ns: int = 250_000_000
    """Between two poses of a joint that moved, farther apart, its pose is not known [ns]."""
    stands: tuple[float, float] = (float(np.deg2rad(0.1)), 1e-3)
    """A joint that moved by less between two poses stood still [rad], [m]."""
    most_position: float = 1e9
    """Larger positions are none [rad or m]: a head that spins at 20 Hz takes weeks for them."""
    most_geared: float = 1e4
    """Larger factors, offsets and axes of a robot description are none."""
    tilt_steps: int = 65
    """Positions between its limits at which the tilt of a joint is looked at."""
    travel_m: float = 1.0
    """No joint of a sensor shifts it farther: what does is a pose in the world [m]."""
    off_axis: float = 0.1
    """A joint turns about one axis: turns about others are a smaller part of it than this."""


JOINTS = SensorJointTuning()
