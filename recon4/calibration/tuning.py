"""Tuning of audit and calibration of the rig."""

from __future__ import annotations

from dataclasses import dataclass

from msgspec import Struct

from recon4.settings import CalibrationSettings


@dataclass(frozen=True, slots=True, kw_only=True)
class CalibrationTuning(CalibrationSettings):
    """Windows that are compared (docs/explanation/calibration.md)."""

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


class EntropyTuning(Struct, frozen=True, kw_only=True):
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
