"""Contours of a terrain, as DXF and GeoJSON."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from recon4.errors import ConfigError
from recon4.geometry.se3 import Array
from recon4.locales.coded import CodedText
from recon4.products.terrain import Terrain
from recon4.products.tuning import TERRAIN


@dataclass(frozen=True, slots=True, eq=False)
class Contour:
    """A line of one height."""

    height_m: float
    """In the heights of the file [m]."""
    index: bool
    """Whether it is drawn thicker, as every fifth."""
    p: Array
    """x and y in the map [m], (N, 2)."""


def contours(terrain: Terrain, *, interval_m: float, up_m: float = 0.0) -> list[Contour]:
    """Lines of equal height at multiples of an interval.

    Args:
        terrain: Heights; lines end where nothing was seen.
        interval_m: Between two lines [m].
        up_m: Added to the heights of the map: those of a CRS [m].

    Raises:
        ConfigError: If the interval is not positive, or there would be too many lines.
    """
    from contourpy import LineType, contour_generator
    from shapely import LineString

    if not interval_m > 0.0:
        raise ConfigError(CodedText("contours-interval", interval_m=interval_m))
    if not terrain.seen.any():
        return []
    height = terrain.height_m.astype(np.float64) + up_m
    low = int(np.ceil(np.nanmin(height) / interval_m))
    high = int(np.floor(np.nanmax(height) / interval_m))
    if high - low > TERRAIN.max_levels:
        raise ConfigError(
            CodedText("contours-many", max_levels=TERRAIN.max_levels, high=high - low)
        )
    x, y = terrain.centers_m()
    made = contour_generator(x, y, np.ma.masked_invalid(height), line_type=LineType.Separate)
    found = []
    for k in range(low, high + 1):
        for line in made.lines(k * interval_m):
            shape = LineString(np.asarray(line)).simplify(terrain.grid.pixel_m / 4.0)
            if shape.length >= TERRAIN.shortest_m:
                found.append(
                    Contour(k * interval_m, k % TERRAIN.index == 0, np.array(shape.coords))
                )
    return found
