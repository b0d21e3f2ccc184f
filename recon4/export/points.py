"""The points of a map, block by block, in spatial order and in the coordinates of the export."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from recon4.errors import ConfigError
from recon4.export.tuning import POINT_EXPORT
from recon4.geometry.se3 import Array
from recon4.mapping.tile import Columns
from recon4.mapping.tiles import TileSet
from recon4.progress import Progress

ToCrs = Callable[[Array], Array]
"""Map coordinates [m], (N, 3), to those of the CRS, (N, 3)."""


@dataclass(frozen=True, slots=True, eq=False)
class OutputCrs:
    """The coordinates in which a map is written."""

    crs: str | None = None
    """WKT or code of the CRS; None = that of the map, if it has one."""
    map_to_crs: ToCrs | None = None
    """Map coordinates to those of the CRS; None = the shift by the map's origin in it."""


CRS_OF_MAP = OutputCrs()
"""The CRS that the map itself names."""


@dataclass(frozen=True, slots=True, eq=False)
class Block:
    """Some points."""

    xyz: Array
    """Coordinates of the export, float64 (N, 3)."""
    columns: Columns
    """Further fields requested."""
    strays: bool = False
    """Whether these are stray returns."""


def output_transform(tiles: TileSet, map_to_crs: ToCrs | None) -> ToCrs:
    """Transformation of points of the map for an export: as given, or by the map's origin."""
    if map_to_crs is not None:
        return map_to_crs
    shift = np.array(tiles.crs.origin_m if tiles.crs else (0.0, 0.0, 0.0))
    return lambda xyz_m: xyz_m + shift


def blocks(
    tiles: TileSet, fields: list[str], *, transform: ToCrs, progress: Progress
) -> Iterator[Block]:
    """All points, tile by tile; neighbors follow each other."""
    progress.start("export", len(tiles), "points")
    for tile in tiles:
        columns = tile.read(["xyz", *fields])
        order = tile.spatial_order()
        for first in range(0, len(tile), POINT_EXPORT.block):
            rows = order[first : first + POINT_EXPORT.block]
            xyz = np.take(columns["xyz"], rows, axis=0) + np.array(tile.origin_m)
            yield Block(
                transform(xyz), {name: np.take(columns[name], rows, axis=0) for name in fields}
            )
            progress.advance(len(rows))


def intensity_field(tiles: TileSet) -> str:
    """The intensities of a format with one of them: normalized, or raw if there are no others."""
    return "intensity_normalized" if "intensity_normalized" in tiles.fields else "intensity"


def center(tiles: TileSet, transform: ToCrs) -> NDArray[np.float64]:
    """Whole meters near the middle of the map in the coordinates of the export, (3,).

    Raises:
        ConfigError: If the map has no points.
    """
    if not len(tiles):
        raise ConfigError("the map has no points, there is nothing to export")
    low, high = tiles.bounds_m
    return np.round(transform(((low + high) / 2.0)[None])[0])
