"""Where the rig of a map comes from: serial numbers, and date and accuracy of its calibration."""

from __future__ import annotations

from dataclasses import dataclass
from datetime import UTC, date, datetime

from recon4.model.rig import Rig, RigCalibration

_FIRST_YEAR = 2000
"""Earlier times are those of a clock that was never set."""


@dataclass(frozen=True, slots=True, kw_only=True)
class SensorOrigin:
    """One sensor of a rig."""

    name: str
    model: str
    serial: str
    """Serial number; empty = not known."""


@dataclass(frozen=True, slots=True, kw_only=True)
class RigOrigin:
    """The rig of a map as ``summary.json``, the report and an approval quote it."""

    name: str
    sensors: tuple[SensorOrigin, ...]
    calibration: RigCalibration | None
    """None = the rig file says nothing of it."""
    age_days: int | None
    """From the calibration to the walk [d]; None = one of them has no date."""
    max_age_days: int
    """An older calibration is mentioned [d]."""

    @staticmethod
    def of(rig: Rig, *, recorded_ns: int, max_age_days: int) -> RigOrigin:
        """What a rig file says of its origin.

        Args:
            rig: The rig that the map was made with.
            recorded_ns: Start of the recording [ns].
            max_age_days: From which age on a calibration is mentioned.
        """
        return RigOrigin(
            name=rig.name,
            sensors=tuple(
                SensorOrigin(name=one.name, model=one.model, serial=one.serial)
                for one in rig.sensors
            ),
            calibration=rig.calibration,
            age_days=_age_days(rig.calibration, recorded_ns),
            max_age_days=max_age_days,
        )

    @property
    def is_old(self) -> bool:
        """Whether the calibration is older than it should be."""
        return self.age_days is not None and self.age_days > self.max_age_days


def recording_day(recorded_ns: int) -> date | None:
    """Day of a recording, UTC; None = its clock was never set.

    Args:
        recorded_ns: Start of the recording [ns].
    """
    day = datetime.fromtimestamp(recorded_ns / 1e9, UTC).date()
    return day if day.year >= _FIRST_YEAR else None


def _age_days(calibration: RigCalibration | None, recorded_ns: int) -> int | None:
    day = recording_day(recorded_ns)
    if calibration is None or day is None:
        return None
    return (day - date.fromisoformat(calibration.date)).days
