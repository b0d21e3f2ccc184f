"""The points of a map, block by block, in spatial order and in the coordinates of the export."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from itertools import chain
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from recon4.errors import ConfigError
from recon4.export.tuning import POINT_EXPORT
from recon4.geometry.se3 import Array
from recon4.mapping.tile import Columns
from recon4.mapping.tiles import Tile, TileSet
from recon4.model.classes import PointClass
from recon4.progress import Progress, Silent

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
    """Further fields requested, and ``classification``."""


@dataclass(frozen=True, slots=True, eq=False)
class PointSource:
    """A map, and the coordinates in which it is written."""

    tiles: TileSet
    transform: ToCrs
    """Map coordinates to those of the file."""
    crs: str
    """WKT or code of the CRS; empty = the map's local frame."""
    offset: NDArray[np.float64]
    """Whole meters near its middle in the coordinates of the file, (3,)."""
    left_out: TileSet | None = None
    """Points that the map leaves out, if they are written, too."""

    @staticmethod
    def of(map_: Path | TileSet, output: OutputCrs, *, all_points: bool = False) -> PointSource:
        """A map to be written.

        Args:
            map_: Artifact of the stage ``map``, or what is open of it.
            output: CRS of the file; by default the shift by the map's origin in its own.
            all_points: Also the points that the map leaves out (`recon4.model.classes`).

        Raises:
            ConfigError: If the map has no points.
        """
        tiles = TileSet.open(map_) if isinstance(map_, Path) else map_
        if not len(tiles):
            raise ConfigError("the map has no points, there is nothing to export")
        shift = np.array(tiles.crs.origin_m if tiles.crs else (0.0, 0.0, 0.0))
        transform = output.map_to_crs or (lambda xyz_m: xyz_m + shift)
        crs = output.crs or (tiles.crs.wkt if tiles.crs else "")
        middle_m = np.mean(tiles.bounds_m, axis=0)
        offset = np.round(transform(middle_m[None])[0])
        left_out = tiles.only_strays() if all_points else None
        return PointSource(tiles, transform, crs, offset, left_out)

    @property
    def count(self) -> int:
        """Points that are written."""
        return len(self.tiles) + len(self.left_out or ())

    @property
    def intensity(self) -> str:
        """Of formats with one intensity: the normalized one, or the raw one without it."""
        return (
            "intensity_normalized" if "intensity_normalized" in self.tiles.fields else "intensity"
        )

    def blocks(self, fields: list[str], progress: Progress | None) -> Iterator[Block]:
        """All points, tile by tile, with their classes; neighbors follow each other.

        The points that the map leaves out come last.
        """
        watch = progress or Silent()
        watch.start("export", self.count, "points")
        for tile in chain(self.tiles, self.left_out or ()):
            columns = tile.read_in_space(["xyz", *fields])
            columns["classification"] = _classification(tile)
            for first in range(0, len(tile), POINT_EXPORT.block):
                rows = slice(first, first + POINT_EXPORT.block)
                part = {name: column[rows] for name, column in columns.items()}
                xyz = part.pop("xyz") + np.array(tile.origin_m)
                yield Block(self.transform(xyz), part)
                watch.advance(len(xyz))


def _classification(tile: Tile) -> NDArray[np.uint8]:
    """Classes of the points of a tile in spatial order, (N,).

    Maps from before there were classes have stray returns only, as low or high noise.
    """
    if "classification" in tile.fields:
        return np.asarray(tile.read_in_space(["classification"])["classification"], np.uint8)
    if not tile.left_out:
        return np.zeros(len(tile), np.uint8)
    alone = ~tile.read_in_space(["normal"])["normal"].any(axis=1)
    return np.where(alone, PointClass.HIGH_NOISE, PointClass.LOW_NOISE).astype(np.uint8)
