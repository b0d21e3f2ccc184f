"""Tuning of georeferencing."""

from __future__ import annotations

from dataclasses import dataclass

from recon4.settings import GnssSettings


@dataclass(frozen=True, slots=True, kw_only=True)
class GnssTuning(GnssSettings):
    """Georeferencing by GNSS/INS (docs/georeference.md; requirements A10)."""

    correlation_s: float = 5.0
    """Correlation time of the errors of fixes [s]: fixes within it count as one. A larger value
    gives SLAM more influence on the shape of the map."""
    min_sd_m: float = 0.01
    """Smallest standard deviation of a fix, whatever the receiver reports [m]."""
    gate_m: float = 1.0
    """A fix farther than this plus ``gate_relative`` from the rigidly aligned trajectory is an
    outlier [m]."""
    gate_relative: float = 0.02
    """Allowance for the drift of SLAM in that distance, per meter of path length."""
    tilt_sd_rad: float = 0.005
    """Standard deviation of the tilt of the leveled map [rad]."""
    min_extent_m: float = 3.0
    """Smallest extent of the fixes for which a heading is estimated [m]."""
    seed: int = 4
    """Seed of the random draws of the initial alignment."""
