"""The points of a map, block by block, in spatial order and in the coordinates of the export."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from itertools import chain, product
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from recon4.errors import ConfigError
from recon4.export.selection import DELIVERED, PointSelection, shares_text
from recon4.export.tuning import POINT_EXPORT
from recon4.geometry.se3 import Array
from recon4.locales.coded import CodedText
from recon4.mapping.threads import Each, in_turn
from recon4.mapping.tile import Columns
from recon4.mapping.tiles import Tile, TileSet
from recon4.model.classes import PointClass
from recon4.progress import Progress, Silent

ToCrs = Callable[[Array], Array]
"""Map coordinates [m], (N, 3), to those of the CRS, (N, 3)."""


@dataclass(frozen=True, slots=True, eq=False)
class OutputCrs:
    """The coordinates in which a map is written, and what is added to the file."""

    crs: str | None = None
    """WKT or code of the CRS; None = that of the map, if it has one."""
    map_to_crs: ToCrs | None = None
    """Map coordinates to those of the CRS; None = the shift by the map's origin in it."""
    seal: Callable[[Path], None] | None = None
    """Adds a record to the file before it is read back, as that of the approval."""


CRS_OF_MAP = OutputCrs()
"""The CRS that the map itself names."""


@dataclass(frozen=True, slots=True, eq=False)
class Block:
    """Some points."""

    xyz: Array
    """Coordinates of the export, float64 (N, 3)."""
    columns: Columns
    """Further fields requested, and ``classification``."""

    def only(self, rows: NDArray[np.bool_] | slice) -> Block:
        """Some of them."""
        return Block(self.xyz[rows], {name: one[rows] for name, one in self.columns.items()})


@dataclass(frozen=True, slots=True, eq=False)
class PointSource:
    """A map, and the coordinates in which it is written."""

    tiles: TileSet
    transform: ToCrs
    """Map coordinates to those of the file."""
    crs: str
    """WKT or code of the CRS; empty = the map's local frame."""
    offset: NDArray[np.float64]
    """Whole meters near the middle of what is written in the coordinates of the file, (3,)."""
    selection: PointSelection
    """Which points are written."""
    count: int
    """Points that are written."""
    seal: Callable[[Path], None]
    """Adds a record to the finished file."""
    each: Each = in_turn
    """Threads that read a tile."""

    @staticmethod
    def of(
        map_: Path | TileSet,
        output: OutputCrs,
        selection: PointSelection = DELIVERED,
        *,
        progress: Progress | None = None,
    ) -> PointSource:
        """A map to be written. Of a part of it the points are counted first.

        Args:
            map_: Artifact of the stage ``map``, or what is open of it.
            output: CRS of the file; by default the shift by the map's origin in its own.
            selection: Which points are written.
            progress: Who watches while they are counted.

        Raises:
            ConfigError: If the map or the selection has no points.
        """
        source = PointSource.uncounted(map_, output, selection)
        return source if selection.is_whole else source._counted(progress or Silent())

    @staticmethod
    def uncounted(
        map_: Path | TileSet, output: OutputCrs, selection: PointSelection = DELIVERED
    ) -> PointSource:
        """As `of`, but ``count`` and ``offset`` are those of all points.

        Raises:
            ConfigError: If the map has no points.
        """
        tiles = TileSet.open(map_) if isinstance(map_, Path) else map_
        if not len(tiles):
            raise ConfigError(CodedText("export-map-empty"))
        shift = np.array(tiles.crs.origin_m if tiles.crs else (0.0, 0.0, 0.0))
        transform = output.map_to_crs or (lambda xyz_m: xyz_m + shift)
        crs = output.crs or (tiles.crs.wkt if tiles.crs else "")
        middle_m = np.mean(tiles.bounds_m, axis=0)
        offset = np.round(transform(middle_m[None])[0])
        seal = output.seal or (lambda path: None)
        count = len(tiles) + (tiles.strays if selection.left_out else 0)
        return PointSource(tiles, transform, crs, offset, selection, count, seal)

    def _counted(self, progress: Progress) -> PointSource:
        """The same with the number of points that are selected, and their middle."""
        count, low, high = 0, np.full(3, np.inf), np.full(3, -np.inf)
        progress.start("points", self.count, "points")
        for block in self._selected([], progress):
            count += len(block.xyz)
            # Column by column: along the rows of a narrow array NumPy takes five times as long.
            low = np.minimum(low, [column.min() for column in block.xyz.T])
            high = np.maximum(high, [column.max() for column in block.xyz.T])
        if not count:
            raise ConfigError(
                CodedText("export-nothing-chosen", tiles=shares_text(self.tiles.class_counts()))
            )
        return replace(self, count=count, offset=np.round((low + high) / 2.0))

    @property
    def intensity(self) -> str:
        """Of formats with one intensity: the normalized one, or the raw one without it."""
        return (
            "intensity_normalized" if "intensity_normalized" in self.tiles.fields else "intensity"
        )

    @property
    def crs_line(self) -> str:
        """The CRS on one line of ASCII, for heads of files."""
        return " ".join(self.crs.split()).encode("ascii", "replace").decode()

    def blocks(self, fields: list[str], progress: Progress | None) -> Iterator[Block]:
        """All points, tile by tile, with their classes; neighbors follow each other.

        The points that the map leaves out come last.
        """
        watch = progress or Silent()
        watch.start("export", self.count, "points")
        yield from self._selected(fields, watch)

    def _selected(self, fields: list[str], watch: Progress) -> Iterator[Block]:
        left_out = self.tiles.only_strays() if self.selection.left_out else ()
        for tile in chain(self.tiles, left_out):
            if len(tile) and self.may_have(tile):
                for block in self._of_tile(tile, fields):
                    yield block
                    watch.advance(len(block.xyz))

    def _of_tile(self, tile: Tile, fields: list[str]) -> Iterator[Block]:
        stated = ["classification"] if "classification" in tile.fields else []
        columns = tile.read_in_space(["xyz", *fields, *stated], self.each)
        if not stated:
            columns["classification"] = _earlier_classification(tile)
        origin_m = np.array(tile.origin_m)
        if not self.selection.is_whole:
            rows = self.selection.rows(columns, origin_m)
            columns = {name: column[rows] for name, column in columns.items()}
        for first in range(0, len(columns["xyz"]), POINT_EXPORT.block):
            part = {n: one[first : first + POINT_EXPORT.block] for n, one in columns.items()}
            block = Block(self.transform(part.pop("xyz") + origin_m), part)
            if self.selection.box_m is not None:
                block = block.only(self.selection.in_box(block.xyz))
            if len(block.xyz):
                yield block

    def may_have(self, tile: Tile) -> bool:
        """Whether a tile may have points in the box and the clip."""
        margin_m = POINT_EXPORT.tile_margin_m
        low_m, high_m = np.array(tile.low_m), np.array(tile.high_m)
        if not self.selection.may_have_inside(low_m, high_m, margin_m=margin_m):
            return False
        if self.selection.box_m is None:
            return True
        corners = np.array(list(product(*zip(low_m, high_m, strict=True))))
        return self.selection.may_have(self.transform(corners), margin_m=margin_m)

    def count_of(self, tile: Tile, *, limit: int) -> int:
        """How many of the first points of a tile are wanted; these are an even sample."""
        fields = ["xyz", *(["classification"] if "classification" in tile.fields else [])]
        read = tile.read(fields, limit=limit)
        columns: Columns = {"classification": np.zeros(len(read["xyz"]), np.uint8), **read}
        origin_m = np.array(tile.origin_m)
        rows = self.selection.rows(columns, origin_m)
        if self.selection.box_m is None:
            return len(rows)
        xyz = self.transform(columns["xyz"][rows] + origin_m)
        return int(np.count_nonzero(self.selection.in_box(xyz)))


def _earlier_classification(tile: Tile) -> NDArray[np.uint8]:
    """Classes of the points of a tile in spatial order, (N,), in a map from before there were any.

    Such maps have stray returns only, as low or high noise.
    """
    if not tile.left_out:
        return np.zeros(len(tile), np.uint8)
    alone = ~tile.read_in_space(["normal"])["normal"].any(axis=1)
    return np.where(alone, PointClass.HIGH_NOISE, PointClass.LOW_NOISE).astype(np.uint8)
