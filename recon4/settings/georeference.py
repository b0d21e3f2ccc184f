"""Settings of the stage `level`: leveling and georeferencing."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

from recon4.settings.require import require


@dataclass(frozen=True, slots=True, kw_only=True)
class LevelSettings:
    """Horizontal alignment (V §2.9, requirements A8)."""

    source: Literal["auto", "imu", "floor", "none"] = "auto"
    """``auto``: the IMU if there is one, else the dominant floor."""


@dataclass(frozen=True, slots=True, kw_only=True)
class GnssSettings:
    """Georeferencing by GNSS/INS (requirements A10)."""

    enabled: bool = True
    """Use the positions when the recording has them."""
    crs: str = ""
    """EPSG code of the map's horizontal (and vertical) CRS, as ``EPSG:5514+8357``.
    Empty = UTM zone of the place with ellipsoidal heights."""
    min_quality: Literal["single", "differential", "float", "fixed"] = "single"
    """Fixes of lower quality are not used."""
    correlation_s: float = 5.0
    """Errors of fixes nearer in time than this are alike; so many count as one [s]. Larger leaves
    more of the shape of the map to SLAM."""
    min_sd_m: float = 0.01
    """No fix is better than this, whatever it promises [m]."""
    gate_m: float = 1.0
    """A fix farther than this plus ``gate_relative`` from the track laid rigidly over all fixes is
    an outlier [m]."""
    gate_relative: float = 0.02
    """Drift of SLAM that may hide in that distance, per metre of track."""
    tilt_sd_rad: float = 0.005
    """How well the levelled map is horizontal [rad]."""
    judge_edges: bool = True
    """Turn down edges of the graph that contradict the positions."""
    min_extent_m: float = 3.0
    """Fixes must span at least this for a heading [m]."""
    seed: int = 4
    """Seed of the draws that find the first alignment."""

    def __post_init__(self) -> None:
        require(self.correlation_s >= 0.0, "correlation_s must be 0 or more", self.correlation_s)
        require(self.min_sd_m > 0.0, "min_sd_m must be above 0", self.min_sd_m)
        require(self.tilt_sd_rad > 0.0, "tilt_sd_rad must be above 0", self.tilt_sd_rad)
