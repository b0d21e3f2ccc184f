"""Settings of the stage `level`: leveling and georeferencing."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

from recon4.settings.require import require


@dataclass(frozen=True, slots=True, kw_only=True)
class LevelSettings:
    """Leveling (V §2.9, requirements A8)."""

    source: Literal["auto", "imu", "floor", "none"] = "auto"
    """``auto``: the IMU if there is one, else the dominant floor."""


@dataclass(frozen=True, slots=True, kw_only=True)
class GnssSettings:
    """Georeferencing by GNSS/INS (requirements A10)."""

    enabled: bool = True
    """Use GNSS positions if the recording has any."""
    crs: str = ""
    """EPSG code of the map's horizontal (and vertical) CRS, as ``EPSG:5514+8357``.
    Empty = UTM zone of the position with ellipsoidal heights."""
    heights: Literal["as_recorded", "ellipsoidal", "orthometric"] = "as_recorded"
    """What the heights of the fixes are above: the ellipsoid, or the geoid (above sea level).
    ``as_recorded``: what the recording says. Where it says nothing they are taken as ellipsoidal,
    and the verdict is at best *check*."""
    geoid_separation_m: float = 0.0
    """Height of the geoid above the ellipsoid at the place, added to orthometric heights [m]."""
    min_quality: Literal["single", "differential", "float", "fixed"] = "single"
    """Fixes of lower quality are not used."""
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
    judge_edges: bool = True
    """Reject edges of the graph that contradict the GNSS positions."""
    min_extent_m: float = 3.0
    """Smallest extent of the fixes for which a heading is estimated [m]."""
    seed: int = 4
    """Seed of the random draws of the initial alignment."""

    def __post_init__(self) -> None:
        require(
            (self.heights == "orthometric") == (self.geoid_separation_m != 0.0),
            "heights = orthometric needs geoid_separation_m, and only it has one",
            (self.heights, self.geoid_separation_m),
        )
        require(
            -120.0 < self.geoid_separation_m < 120.0,
            "geoid_separation_m must be within ±120",
            self.geoid_separation_m,
        )
        require(self.correlation_s >= 0.0, "correlation_s must be 0 or more", self.correlation_s)
        require(self.min_sd_m > 0.0, "min_sd_m must be above 0", self.min_sd_m)
        require(self.tilt_sd_rad > 0.0, "tilt_sd_rad must be above 0", self.tilt_sd_rad)
