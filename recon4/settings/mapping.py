"""Settings of the stage `map`."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

from recon4.settings.require import require


@dataclass(frozen=True, slots=True, kw_only=True)
class MapSettings:
    """The point map."""

    voxel_m: float = 0.01
    """Edge of a voxel [m]; the point with the shortest range in each is kept; 0 = keep all."""
    surface: Literal["raw", "fitted"] = "fitted"
    """Where points lie: where they were measured, or on the surface fitted to all returns around
    them, as far as there is one. Then tiles have both positions, and stray returns are marked."""
    range_noise_m: float = 0.015
    """Standard deviation of a range, to tell one surface from two [m]."""
    max_range_m: float = 60.0
    """Points farther from the sensor are not in the map [m]."""
    tile_m: float = 5.0
    """Edge of the tiles in which the map is built and stored [m]."""
    normal_cell_m: float = 0.05
    """Edge of a cell for normals [m]; a neighborhood has three cells along each axis."""
    min_neighborhood: int = 2
    """Points with fewer points in that neighborhood, themselves included, are noise; 1 = keep."""
    far_ratio: float = 0.0
    """Points with a range of more than this factor times the shortest one in their cubic meter are
    removed (requirements A13 O-9: 2); 0 = keep."""

    def __post_init__(self) -> None:
        require(0.0 <= self.voxel_m <= 1.0, "voxel_m must be 0 to 1", self.voxel_m)
        require(self.surface in {"raw", "fitted"}, "surface must be raw or fitted", self.surface)
        require(
            0.001 <= self.range_noise_m <= 0.05,
            "range_noise_m must be 0.001 to 0.05",
            self.range_noise_m,
        )
        require(0.0 < self.max_range_m <= 130.0, "max_range_m must be 0 to 130", self.max_range_m)
        require(self.normal_cell_m >= 0.01, "normal_cell_m must be over 0.01", self.normal_cell_m)
        require(
            1.0 <= self.tile_m <= 100.0
            and self.tile_m >= 4 * max(self.normal_cell_m, self.voxel_m),
            "tile_m must be 1 to 100 and at least four cells or voxels",
            self.tile_m,
        )
        require(
            self.min_neighborhood >= 1, "min_neighborhood must be 1 or more", self.min_neighborhood
        )
        require(
            self.far_ratio == 0.0 or self.far_ratio > 1.0,
            "far_ratio must be 0 or above 1",
            self.far_ratio,
        )
