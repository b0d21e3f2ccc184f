"""What the odometry assumed, one row per hypothesis that it tried, and why one was chosen."""

from __future__ import annotations

from collections.abc import Sequence
from enum import StrEnum
from typing import Literal

import msgspec

ImuOutcome = Literal["as recorded", "bias removed", "accelerometer not used", "not used"]
"""Which samples of an IMU are used."""


class Because(StrEnum):
    """Why a hypothesis was tried."""

    START = "start"
    """Nothing is known yet: all points, the IMU that the windows chose."""
    BIAS = "gyroscope turns at the start"
    """Its mean over the first half second is more than the filter estimates by itself."""
    LIDARS_ALONE = "LiDARs alone"
    """They show whether they contradict the IMU."""
    GYROSCOPE_ALONE = "gyroscope alone"
    """It measures the turns that the LiDARs see, so only the accelerometer can be wrong."""
    SETTLED = "begun earlier"
    """A window that begins within a turn knows neither tilt nor velocity: tried from before it."""
    IMU_FAULTS = "IMU faults found"
    """The filter found scale, axes or clock of the IMU wrong; they are corrected from the start."""
    MOVING_BY_FIXES = "moving objects by fixes"
    """The trajectory of a GNSS/INS shows what moves."""
    MOVING_BY_WALK = "moving objects by walk"
    """The trajectory that was tracked before shows what moves."""
    AXES_REPAIRED = "IMU axes repaired"
    """The LiDARs have shown that its axes are not those of its rig."""
    CALIBRATED = "rig calibrated"
    """The calibration changed the rig; the points that were left out before stay out."""


class TrialVerdict(StrEnum):
    """What the comparison of a hypothesis with its rival says."""

    FIRST = "first"
    CLEARLY_BETTER = "clearly better"
    NO_WORSE = "no worse"
    LOSES_MORE = "loses more multiframes"
    SEES_TOO_LITTLE = "loses most multiframes"
    LARGER_RESIDUALS = "larger residuals"
    CONTRADICTS_FIXES = "contradicts the fixes"
    NOT_CLEARLY_BETTER = "not clearly better"
    TURNS_EXPLAINED = "gyroscope measures the turns"

    @property
    def wins(self) -> bool:
        """Whether the hypothesis is preferred to its rival."""
        return self in (self.FIRST, self.CLEARLY_BETTER, self.NO_WORSE)


class TriedHypothesis(msgspec.Struct, frozen=True, kw_only=True):
    """A hypothesis, what it was worth, and whether it was chosen."""

    because: Because
    imu: ImuOutcome | None = None
    """Which samples; None = no IMU was recorded."""
    corrected: bool = False
    """Whether it begins with the gain and the clock of the IMU that a walk before has found."""
    hidden_points: int = 0
    """Points on moving objects that are left out."""
    fixes: bool = False
    """Whether fixes of a GNSS/INS aid it."""
    whole: bool
    """Whether the whole recording was tracked; else short windows."""
    multiframes: int
    """Registered for it."""
    lost: int
    residual_m: float | None = None
    """Distance of the points from the local map that most multiframes stay below [m]."""
    contradicted: float | None = None
    """Ratio of the fixes that it contradicts, 0..1."""
    unexplained: float | None = None
    """Part of the turns that the LiDARs see alone and the gyroscope does not measure, 0.."""
    other_axes: float | None = None
    """What speaks for other axes of the gyroscope by these turns: a log likelihood ratio, twice."""
    moved_m: float | None = None
    """Largest distance of a position from the walk that suggested it [m]."""
    verdict: TrialVerdict
    chosen: bool = False
    """Whether the odometry is made of it; of windows: whether the walk began with it."""


def not_chosen(tried: Sequence[TriedHypothesis]) -> tuple[TriedHypothesis, ...]:
    """The rows of a choice that was made again otherwise."""
    return tuple(msgspec.structs.replace(row, chosen=False) for row in tried)


def walks_of(tried: Sequence[TriedHypothesis]) -> int:
    """How often the whole recording was tracked since the axes of its IMU are right."""
    whole = [row.because for row in tried if row.whole]
    return len(whole) - (
        whole.index(Because.AXES_REPAIRED) if Because.AXES_REPAIRED in whole else 0
    )
