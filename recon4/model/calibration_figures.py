"""Figures of the stage ``calibration``: what a recording says of its rig file."""

from __future__ import annotations

from enum import StrEnum
from typing import Literal

import msgspec

from recon4.model.figures import Figures
from recon4.model.odometry_figures import ImuFault

IMU, GNSS = "imu", "gnss"
"""Names of the IMU and of the receiver among the sensors of a calibration."""
ParameterStatus = Literal["consistent", "off", "not observable"]
"""Of a parameter of the rig against the recording."""


class ParameterFigures(msgspec.Struct, frozen=True, kw_only=True):
    """What a recording says of one parameter of its rig."""

    sensor: str
    """Name of the LiDAR, `IMU` or `GNSS`."""
    quantity: str
    """``rotation``, ``position``, ``clock``; of a beam ``beam range``, ``beam elevation`` or
    ``beam azimuth``."""
    axis: str
    """Of the body: ``x``, ``y``, ``z``; empty for a clock; the ring of a beam."""
    unit: Literal["rad", "m", "s"]
    change: float
    """To be added to the rig file's value, in the unit."""
    sd: float | None
    """Standard deviation of the change, in the unit; None = not known."""
    status: ParameterStatus

    @property
    def is_severe(self) -> bool:
        """Whether a map that was made with the rig file's value must not be used.

        A lever arm or the clock of the GNSS receiver moves a map and bends it, the place of the IMU
        changes accelerations only: no wall doubles.
        """
        doubles = self.sensor != GNSS and (self.sensor, self.quantity) != (IMU, "position")
        return doubles and self.status == "off" and abs(self.change) > _SEVERE[self.unit]


_SEVERE = {"rad": 0.0087, "m": 0.03, "s": 0.01}
"""Larger differences (0.5°, 3 cm, 10 ms) make walls double."""


class RigScatter(msgspec.Struct, frozen=True, kw_only=True):
    """A parameter of a rig that does not stay the same during a walk."""

    sensor: str
    quantity: str
    axis: str
    unit: Literal["rad", "m", "s"]
    sd: float
    """How far the parts of the walk scatter, in the unit."""
    factor: float
    """How many times more than noise explains, over all parameters."""


class RigOutcome(StrEnum):
    """What came of comparing a rig with a recording; the words are in the catalog of findings."""

    OFF = "rig-switched-off"
    NO_LIDAR = "rig-no-lidar"
    NOTHING_TO_COMPARE = "rig-nothing-to-compare"
    NO_PLANES = "rig-no-planes"
    UNOBSERVED = "rig-unobserved"
    AGREES = "rig-agrees"
    CONTRADICTS = "rig-contradicts"
    CALIBRATED = "rig-calibrated"
    """Windows that were not used confirm it."""
    TOO_SHORT = "rig-too-short"
    """For another part of the walk to check the calibrated rig on."""
    BEAMS_AGREE = "rig-beams-agree"
    NOT_CONFIRMED = "rig-not-confirmed"
    OTHER_VALUES = "rig-other-values"
    """In another part of the walk, of the parameters that are named."""
    EXPLAINED_WORSE = "rig-explained-worse"
    NO_BETTER = "rig-no-better"


class GnssOutcome(StrEnum):
    """What came of comparing the receiver in a rig file with its fixes."""

    NOT_COMPARED = ""
    AGREES = "gnss-agrees"
    CONTRADICTS = "gnss-contradicts"
    ONLY_AIDED = "gnss-only-aided"
    """Without the fixes the walk shows no error of theirs."""
    TOO_SHORT = "gnss-too-short"
    OTHER_VALUES = "gnss-other-values"
    NO_BETTER = "gnss-no-better"
    CONFIRMED = "gnss-confirmed"
    """Fixes that were not used confirm the corrected receiver."""


class CalibrationOutcome(msgspec.Struct, frozen=True, kw_only=True):
    """Why a calibrated rig is used, or why not."""

    rig: RigOutcome = RigOutcome.OFF
    names: tuple[str, ...] = ()
    """Parameters that speak against it, or what is explained worse."""
    gnss: GnssOutcome = GnssOutcome.NOT_COMPARED
    gnss_names: tuple[str, ...] = ()
    """The same of the receiver."""


class CalibrationFigures(Figures, frozen=True, kw_only=True):
    """Audit of the rig against the recording and, if requested, its calibration."""

    parameters: tuple[ParameterFigures, ...] = ()
    """Change from the rig file; empty = nothing could be compared."""
    beams: tuple[ParameterFigures, ...] = ()
    """The same of single beams; ``axis`` is the ring. Empty = they were not estimated."""
    windows: int = 0
    """Number of windows of the walk they come from."""
    rms_m: float | None = None
    """Distance of the points from common planes after the estimate [m]."""
    applied: bool = False
    """Whether the calibrated rig is used from here on."""
    outcome: CalibrationOutcome | str = CalibrationOutcome()
    """Why it was applied, or why not; a sentence in projects of version 0.1."""
    imu_faults: tuple[ImuFault, ...] = ()
    """What no calibration corrects: wrong units, axes with a wrong sign."""
    exchanged: tuple[tuple[str, str], ...] = ()
    """Names of LiDARs that seem to have each other's mount in the rig file."""
    scatter: RigScatter | None = None
    """What differs most, if the rig does not stay the same during the walk."""
    changes: bool = False
    """Whether the rig does not stay the same during the walk."""

    @property
    def statuses(self) -> tuple[ParameterStatus, ...]:
        """Of each parameter, without those of single beams."""
        return tuple(row.status for row in self.parameters)

    @property
    def contradicts(self) -> bool:
        """Whether LiDARs and IMU contradict the rig file; fixes are compared with the map."""
        rows = (*self.parameters, *self.beams)
        off = any(row.status == "off" and row.sensor != GNSS for row in rows)
        return off or self.changes or bool(self.imu_faults or self.exchanged)

    @property
    def is_severe(self) -> bool:
        """Whether a map that was made with the rig file must not be used."""
        return self.changes or any(row.is_severe for row in self.parameters)
