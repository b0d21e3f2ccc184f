"""Figures of the stage ``odometry``: what it assumed, and what contradicts it."""

from __future__ import annotations

from enum import StrEnum
from typing import ClassVar, Literal

import msgspec

from recon4.model.figures import Figures, Point
from recon4.model.tried_hypotheses import ImuOutcome, TriedHypothesis


class HeightDoubt(msgspec.Struct, frozen=True, kw_only=True):
    """A stretch of the walk in which the IMU measures a height that the trajectory has not."""

    start_s: float
    """After the first pose [s]."""
    end_s: float
    rise_m: float
    """Up is positive [m]."""
    speed_m_s: float | None = None
    """Change of the vertical speed at its begin, of a ride of which only the begin or the end was
    recorded: ``rise_m`` is then assumed [m/s]."""
    largest_m_s2: float | None = None
    """Largest difference of vertical accelerations; None = it has the pattern of a ride [m/s²]."""
    usual_m_s2: float | None = None


class ImuChoice(msgspec.Struct, frozen=True, kw_only=True):
    """Which samples of the IMU the odometry uses, and why."""

    outcome: ImuOutcome
    bias_rad_s: Point | None = None
    """Of the gyroscope, subtracted."""
    with_m: float | None = None
    """Mean residual of the segments with what is not used [m]."""
    without_m: float | None = None
    """The same without it [m]."""


ImuFaultKind = Literal[
    "gyroscope scale",
    "gyroscope rotation",
    "gyroscope unit",
    "accelerometer scale",
    "accelerometer unit",
    "clock",
    "left-handed",
    "foreign",
]


class ImuFault(msgspec.Struct, frozen=True, kw_only=True):
    """What is wrong with an IMU, as the LiDARs show it."""

    kind: ImuFaultKind
    value: float = 0.0
    """Relative error of a scale, angle [rad], how far the clock is ahead [s], ratio of measured to
    expected values of a unit, explained part of the turning of a foreign IMU."""
    sd: float | None = None
    """Its standard deviation; None = not stated."""
    axis: str = ""
    """Of the body; empty = all."""


class ImuTurn(msgspec.Struct, frozen=True, kw_only=True):
    """An IMU that is mounted otherwise than its rig says; its samples were turned."""

    angle_rad: float
    """Angle of the rotation against the rig."""
    explained: float
    """Part of the turns of the LiDARs that its gyroscope measures by the rig, below 1 …"""
    explained_turned: float
    """… and turned, 0..1."""
    rpy_deg: tuple[float, float, float]
    """Its right mount on the body [°]."""


class ImuAxes(msgspec.Struct, frozen=True, kw_only=True):
    """Axes or signs that the driver of an IMU exchanges; its samples were repaired."""

    gyro: str
    """The right axes of its turn rates, of those that were recorded: "x, -y, z" …"""
    accel: str
    """… and of its accelerations."""


class TurnDoubt(msgspec.Struct, frozen=True, kw_only=True):
    """A stretch of the walk in which the LiDARs hardly observe a turn of the body."""

    start_s: float
    """After the first multiframe [s]."""
    end_s: float
    axis: tuple[float, float, float]
    """Unit vector, in odom axes."""
    center_m: tuple[float, float, float]
    """A point of the axis of the turn, from the first position, in odom axes [m]."""
    rate_sd_rad_s: float
    """How fast the error grows [rad/s]."""


class MovingOutcome(StrEnum):
    """What became of the points of moving objects."""

    KEPT = "kept"
    """There are few, or the settings keep them."""
    LEFT_OUT = "left out"
    NOT_SETTLED = "not settled"
    """Left out, but which points they are still changes from pass to pass of the odometry."""
    CONTRADICTED = "contradicted"
    """Left out, but the trajectory without them contradicts the fixes of a GNSS/INS."""
    NOT_HELD = "not held"
    """Kept, because what is left of the view does not hold the trajectory."""


class MovingFigures(msgspec.Struct, frozen=True, kw_only=True):
    """How much of the view people and vehicles fill in the course of a walk."""

    CROWDED: ClassVar[float] = 0.1
    """Ratio from which on they are announced. On walks without any it is below 0.06."""

    t_s: tuple[float, ...]
    """After the first multiframe [s]."""
    ratio: tuple[float, ...]
    """Ratio of the points that lie on moving objects at these times, 0..1."""
    outcome: MovingOutcome = MovingOutcome.KEPT
    points_left_out: int = 0
    """How many points on them no later stage sees."""

    @property
    def is_crowded(self) -> bool:
        """Whether they fill so much of the view that it is announced."""
        return max(self.ratio, default=0.0) >= self.CROWDED

    @property
    def is_severe(self) -> bool:
        """Whether they have pulled the trajectory along."""
        return self.outcome not in (MovingOutcome.KEPT, MovingOutcome.LEFT_OUT)


class LineFigures(msgspec.Struct, frozen=True, kw_only=True):
    """What the first trajectory of a rig with a profiler lacks."""

    walk_s: float
    """Length of the walk [s]."""
    laser: Literal["used", "none", "at other times"]
    """Scans of the 2-D laser."""
    laser_span_s: tuple[float, float] | None = None
    """Times that they cover, after the first line [s]."""
    silent_s: float = 0.0
    """Time without a scan [s]."""
    silent_from_s: float = 0.0
    imu: Literal["used", "none", "uncovered"] = "used"
    mirrored: bool = False
    """Whether the 2-D laser was found upside down."""
    imu_ahead_s: float | None = None
    """How far the clock of the IMU is ahead of that of the 2-D laser; None = it is not [s]."""
    bridged_s: float = 0.0
    """Time without a tracked scan, which the IMU bridges [s]."""
    rest_s: float = 0.0
    """Time at rest by the IMU, where no 2-D laser observes the motion [s]."""
    profiler_ahead_s: float | None = None
    """How far the clock of the profiler is ahead of both; None = it is not [s]."""
    mount_change: str = ""
    """Turn of the profiler that sharpens the map; empty = none."""


class OdometryFigures(Figures, frozen=True, kw_only=True):
    """Odometry of all multiframes."""

    multiframes: int
    lost: int
    """Multiframes where tracking was lost."""
    imu: bool = False
    """Whether the IMU was used."""
    imu_choice: ImuChoice | None = None
    """Which samples of it; None = there is none, or of an earlier version."""
    imu_turn: ImuTurn | None = None
    """How its samples were turned; None = they were not."""
    imu_axes: ImuAxes | None = None
    """Which of its axes were exchanged beside that; None = none."""
    forces_reversed: float | None = None
    """Correlation of forces and motion as recorded, -1 to 0: the sign of all accelerations was
    turned. None = it was not."""
    imu_faults: tuple[ImuFault, ...] = ()
    """What the filter corrected."""
    lines: LineFigures | None = None
    """Of a rig with a profiler."""
    gnss: bool = False
    """Whether fixes were used."""
    heights: tuple[HeightDoubt, ...] = ()
    """Rides that no LiDAR sees, and other contradictions of the heights."""
    turns: tuple[TurnDoubt, ...] = ()
    """Turns that no LiDAR observes."""
    moving: MovingFigures | None = None
    """People and vehicles in view; None = not searched for."""
    tried: tuple[TriedHypothesis, ...] = ()
    """What it tried to assume, and why one hypothesis was chosen; none in earlier versions."""
