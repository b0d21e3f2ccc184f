"""Settings of the stage `level`: leveling and georeferencing."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated, Literal

from recon4.settings.require import Checked, ValueRange, require


@dataclass(frozen=True, slots=True, kw_only=True)
class LevelSettings(Checked):
    """Leveling (V §2.9, requirements A8)."""

    source: Literal["auto", "imu", "floor", "none"] = "auto"
    """``auto``: the IMU if there is one, else the dominant floor."""


@dataclass(frozen=True, slots=True, kw_only=True)
class GnssSettings(Checked):
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
    geoid_separation_m: Annotated[float, ValueRange(-120, 120, "m")] = 0.0
    """Height of the geoid above the ellipsoid at the place, added to orthometric heights [m]."""
    min_quality: Literal["single", "differential", "float", "fixed"] = "single"
    """Fixes of lower quality are not used."""
    judge_edges: bool = True
    """Reject edges of the graph that contradict the GNSS positions."""

    def check(self) -> None:
        """Orthometric heights need the separation of the geoid."""
        require(
            (self.heights == "orthometric") == (self.geoid_separation_m != 0.0),
            "geoid",
            (self.heights, self.geoid_separation_m),
        )
