"""Write the map: the blocks of one tile after the other, and ``tiles.json`` last."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import asdict, dataclass, field
from functools import partial
from itertools import chain
from pathlib import Path
from types import TracebackType
from typing import BinaryIO, Self

import numpy as np
from numpy.typing import NDArray

from recon4.geometry.se3 import Array
from recon4.kernels.normals import bounds
from recon4.mapping.columns import BLOCKS, PATHS, index_dtype
from recon4.mapping.map_notes import MapNotes
from recon4.mapping.sensor_paths import SensorPaths
from recon4.mapping.threads import Each, in_turn
from recon4.mapping.tile import Columns
from recon4.mapping.tile_order import spatial_order, stored_blocks
from recon4.mapping.tile_packing import as_stored, pack
from recon4.model.trajectory import Times
from recon4.store.atomic import write_json
from recon4.store.formats import FORMATS
from recon4.store.frames import storing


@dataclass(slots=True, kw_only=True)
class TileRow:
    """A tile in ``tiles.json``; the fields are its keys."""

    ijk: list[int]
    origin_m: list[float]
    start: int = 0
    stop: int = 0
    strays: int = 0
    low_m: list[float] = field(default_factory=lambda: [np.nan] * 3)
    high_m: list[float] = field(default_factory=lambda: [np.nan] * 3)
    time_ns: list[int] = field(default_factory=list)
    """Times of its first and last point [ns], (2,)."""

    def extend(self, block: TileBlock) -> None:
        """Extend the bounds by the points of a block."""
        self.low_m = np.fmin(self.low_m, block.low_m).tolist()
        self.high_m = np.fmax(self.high_m, block.high_m).tolist()
        times = [*self.time_ns, *block.time_ns]
        self.time_ns = [min(times), max(times)]


@dataclass(frozen=True, slots=True)
class TileBlock:
    """A compressed block."""

    count: int
    data: list[bytes]
    """Of each field."""
    width: list[int]
    """Bytes of a number of each field."""
    low_m: list[float]
    high_m: list[float]
    """Bounds of its points in the map, as they will be read [m], (3,)."""
    time_ns: tuple[int, int]
    """Times of its first and last point [ns]."""


@dataclass(frozen=True, slots=True)
class PackedTile:
    """A tile as it will be stored."""

    row: TileRow
    count: int
    """Rows, stray returns included."""
    blocks: list[TileBlock]


class TileWriter:
    """Writes tiles one after the other; ``tiles.json`` last, if the block ends without error.

    Several threads may `pack` tiles, which takes nearly all of the time; one `write`s them.
    """

    def __init__(
        self,
        folder: Path,
        fields: Sequence[str],
        *,
        tile_m: float,
        paths: SensorPaths | None = None,
    ) -> None:
        """Nothing is written before the block begins.

        Args:
            folder: Receives ``tiles/`` and ``tiles.json``.
            fields: Names of those that are stored.
            tile_m: Edge of a tile [m].
            paths: Where the sensors were; None = not known, and no ranges of the points either.
        """
        self._folder = folder
        self.fields = list(fields)
        self.tile_m = tile_m
        self.paths = paths or SensorPaths()
        self._rows: list[TileRow] = []
        self._points = 0
        self._index: list[tuple[int, list[int], list[int]]] = []
        self._ends = [0] * len(self.fields)
        self._files: list[BinaryIO] = []
        self.notes = MapNotes()

    def __enter__(self) -> Self:
        with storing(self._folder):
            folder = self._folder / "tiles"
            folder.mkdir(parents=True)
            self._files = [(folder / f"{name}.zst").open("wb") for name in self.fields]
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, _: TracebackType | None
    ) -> None:
        with storing(self._folder):
            for file in self._files:
                file.close()
            if kind is None:
                self._finish()

    def append(self, ijk: tuple[int, int, int], columns: Columns, *, strays: int = 0) -> None:
        """Write the points of one tile in the given order; an empty tile is omitted.

        Args:
            ijk: Index in the grid of tiles.
            columns: Its fields.
            strays: How many of the last rows are stray returns.
        """
        points = len(columns["xyz"]) - strays
        parts = spatial_order(points), points + spatial_order(strays)
        blocks = (partial(_rows_of, columns, rows) for rows in chain(*map(stored_blocks, parts)))
        self.write(self.pack(ijk, blocks, points=points, strays=strays))

    def pack(
        self,
        ijk: tuple[int, int, int],
        blocks: Iterable[Callable[[], Columns]],
        *,
        points: int,
        strays: int,
        each: Each = in_turn,
    ) -> PackedTile:
        """Compress a tile.

        Args:
            ijk: Index in the grid of tiles.
            blocks: Make its fields, ``xyz`` and ``t_ns`` among them, block by block in the order
                of `stored_blocks`: first those of the points, then those of the stray returns.
            points: Rows of all blocks but those of stray returns.
            strays: Stray returns.
            each: Threads for the blocks.
        """
        origin_m = np.array(ijk) * self.tile_m
        row = TileRow(ijk=list(ijk), origin_m=origin_m.tolist())
        row.strays = strays
        packed: list[TileBlock] = []
        first = 0
        for block in each(partial(self._block, origin_m=origin_m), blocks):
            # A tile of strays only has their bounds: every tile has some.
            if first < points or not points:
                row.extend(block)
            packed.append(block)
            first += block.count
        return PackedTile(row, first, packed)

    def _block(self, make: Callable[[], Columns], *, origin_m: Array) -> TileBlock:
        columns = make()
        began_ns = self._began_ns(columns)
        within_ns = columns["t_ns"] - began_ns
        corners = np.empty((2, 3))
        bounds(np.ascontiguousarray(columns["xyz"], np.float32), *corners)
        low_m, high_m = as_stored("xyz", corners) + origin_m
        t_ns = began_ns + as_stored("t_ns", within_ns)
        columns = columns | {"t_ns": within_ns}
        made = [pack(name, columns[name]) for name in self.fields]
        return TileBlock(
            len(columns["xyz"]),
            [one.data for one in made],
            [one.width for one in made],
            low_m.tolist(),
            high_m.tolist(),
            (int(t_ns.min()), int(t_ns.max())),
        )

    def _began_ns(self, columns: Columns) -> Times:
        """Start of the multiframe of each point [ns], (N,); a reference has no multiframes."""
        if not self.paths.known:
            return np.zeros(len(columns["t_ns"]), np.int64)
        return self.paths.began_ns(columns["frame_id"])

    def write(self, tile: PackedTile) -> None:
        """Write the next tile; an empty one is omitted.

        Raises:
            StoreError: If it cannot be written (`NoSpace` when the disk is full).
        """
        if not tile.count:
            return
        tile.row.start = self._points
        tile.row.stop = self._points + tile.count - tile.row.strays
        self._rows.append(tile.row)
        with storing(self._folder):
            for block in tile.blocks:
                self._points += block.count
                for column, data in enumerate(block.data):
                    self._files[column].write(data)
                    self._ends[column] += len(data)
                self._index.append((self._points, list(self._ends), block.width))

    def _finish(self) -> None:
        folder = self._folder / "tiles"
        self.paths.save(folder / PATHS)
        np.save(folder / BLOCKS, np.array(self._index, dtype=index_dtype(self.fields)))
        rows = self._rows
        bounds = [
            np.min([row.low_m for row in rows], axis=0).tolist() if rows else None,
            np.max([row.high_m for row in rows], axis=0).tolist() if rows else None,
        ]
        times = [t for row in rows for t in row.time_ns]
        points = self._points - sum(row.strays for row in rows)
        facts: dict[str, object] = {"format": FORMATS.tiles, "points": points, "bounds_m": bounds}
        facts |= self.notes.to_json()
        facts["time_ns"] = [min(times), max(times)] if times else None
        facts |= {"tile_m": self.tile_m, "fields": self.fields, "tiles": list(_listed(rows))}
        write_json(self._folder / "tiles.json", facts)


def _rows_of(columns: Columns, rows: NDArray[np.intp]) -> Columns:
    return {name: np.take(values, rows, axis=0) for name, values in columns.items()}


def _listed(rows: Iterable[TileRow]) -> Iterator[dict[str, object]]:
    """Entries of ``tiles.json``; the number of stray returns only where there are some."""
    for row in rows:
        listed: dict[str, object] = {**asdict(row)}
        if not row.strays:
            del listed["strays"]
        yield listed
