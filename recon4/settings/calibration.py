"""Settings of the stage `calibration`."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

from recon4.settings.require import require


@dataclass(frozen=True, slots=True, kw_only=True)
class CalibrationSettings:
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
    audit_windows: int = 4
    """Largest number of windows of the walk that are compared in an audit."""
    audit_window_s: float = 4.0
    """Length of each [s]."""
    windows: int = 8
    """Largest number of windows for a calibration; as many others confirm it."""
    window_s: float = 6.0
    """Length of each [s]."""
    points: int = 6_000_000
    """Largest number of points in all windows together, for the last rounds of a calibration."""

    def __post_init__(self) -> None:
        for name in ("audit_windows", "windows"):
            value = getattr(self, name)
            require(1 <= value <= 100, f"{name} must be 1 to 100", value)
        require(10_000 <= self.points <= 100_000_000, "points must be 1e4 to 1e8", self.points)
        for name in ("audit_window_s", "window_s"):
            seconds = getattr(self, name)
            require(1.0 <= seconds <= 20.0, f"{name} must be 1 to 20", seconds)

    @property
    def wanted(self) -> tuple[str, ...]:
        """The names in ``sensors``; empty = all."""
        return tuple(name.strip() for name in self.sensors.split(",") if name.strip())


@dataclass(frozen=True, slots=True, kw_only=True)
class RigSettings:
    """What is said of the rig in summary, report and approval; no stage depends on it."""

    max_age_days: int = 365
    """A rig that was calibrated more days before the walk is mentioned as old."""

    def __post_init__(self) -> None:
        require(
            1 <= self.max_age_days <= 36_500, "max_age_days must be 1 to 36500", self.max_age_days
        )


@dataclass(frozen=True, slots=True, kw_only=True)
class EntropySettings:
    """Calibration by the entropy of the map (requirements L-CAL-1)."""

    kernel_m: float = 0.03
    """Standard deviation of the kernel [m]; 3DTK uses 0.1."""
    min_gap_s: float = 0.5
    """Points of one LiDAR nearer in time do not count as neighbors [s]."""
    neighbors: int = 8
    """Number of nearest points among which a neighbor is looked for."""
    points: int = 12_000
    """Points of a window."""
    evaluations: int = 600
    """Largest number of evaluations of the cost."""
    tolerance: float = 1e-4
    """Powell's method stops when the cost changes less, relatively."""
