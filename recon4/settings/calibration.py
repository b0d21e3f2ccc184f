"""Settings of the stage `calibration`."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated, Literal

from recon4.settings.require import Checked, ValueRange


@dataclass(frozen=True, slots=True, kw_only=True)
class CalibrationSettings(Checked):
    """Audit of the rig file against the recording, and its calibration (requirements A2)."""

    mode: Literal["audit", "auto", "off"] = "audit"
    """``audit`` compares the rig file with the recording and warns; ``auto`` also calibrates it and
    uses the calibrated rig, if windows that were not used confirm it."""
    sensors: str = ""
    """Names of the LiDARs to calibrate, ``imu`` and ``gnss``, separated by commas; empty = all."""
    reference: str = ""
    """Name of the LiDAR whose mount and clock stay; empty = the first one that is enabled."""
    beams: bool = False
    """A calibration also estimates range, elevation and azimuth of each beam of the LiDARs."""

    @property
    def wanted(self) -> tuple[str, ...]:
        """The names in ``sensors``; empty = all."""
        return tuple(name.strip() for name in self.sensors.split(",") if name.strip())


@dataclass(frozen=True, slots=True, kw_only=True)
class RigSettings(Checked):
    """What is said of the rig in summary, report and approval; no stage depends on it."""

    max_age_days: Annotated[int, ValueRange(1, 36500, "days")] = 365
    """A rig that was calibrated more days before the walk is mentioned as old."""
