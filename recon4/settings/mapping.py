"""Settings of the stage `map`."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated, Literal

from recon4.settings.require import Checked, ValueRange, require


@dataclass(frozen=True, slots=True, kw_only=True)
class MapSettings(Checked):
    """The point map."""

    voxel_m: Annotated[float, ValueRange(0, 1, "m")] = 0.01
    """Edge of a voxel [m]; the point with the shortest range in each is kept; 0 = keep all."""
    surface: Literal["raw", "fitted"] = "fitted"
    """Where points lie: where they were measured, or on the surface fitted to all returns around
    them, as far as there is one. Then tiles have both positions, and stray returns are marked."""
    range_noise_m: Annotated[float, ValueRange(0, 0.05, "m")] = 0.0
    """Standard deviation of a range, to tell one surface from two [m]; 0 = of the least exact LiDAR
    in use, at least 15 mm."""
    max_range_m: Annotated[float, ValueRange(0.5, 130, "m")] = 60.0
    """Points farther from the sensor are not in the map [m]."""
    tile_m: Annotated[float, ValueRange(1, 100, "m")] = 5.0
    """Edge of the tiles in which the map is built and stored [m]."""
    normal_cell_m: Annotated[float, ValueRange(0.01, 1, "m")] = 0.05
    """Edge of a cell for normals [m]; a neighborhood has three cells along each axis."""
    min_neighborhood: Annotated[int, ValueRange(1, 27)] = 2
    """Points with fewer points in that neighborhood, themselves included, are noise; 1 = keep."""
    far_ratio: Annotated[float, ValueRange(0, 100)] = 0.0
    """Points with a range of more than this factor times the shortest one in their cubic meter are
    removed (requirements A13 O-9: 2); 0 = keep."""

    def check(self) -> None:
        """Tiles that hold several cells; known names; a factor that keeps the nearest points."""
        require(self.surface in {"raw", "fitted"}, "surface", self.surface)
        require(
            self.tile_m >= 4 * max(self.normal_cell_m, self.voxel_m),
            "tile",
            self.tile_m,
        )
        require(
            self.far_ratio == 0.0 or self.far_ratio > 1.0,
            "far-ratio",
            self.far_ratio,
        )
