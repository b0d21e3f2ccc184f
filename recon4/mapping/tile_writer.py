"""Write the map: one ``.npy`` file per field, tile after tile, and ``tiles.json``."""

from __future__ import annotations

import os
from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass
from pathlib import Path
from types import TracebackType
from typing import BinaryIO, Self

import numpy as np
from numpy.typing import NDArray

from recon4.errors import StoreError
from recon4.mapping.columns import column_header, column_shape, row_offset
from recon4.mapping.map_notes import MapNotes
from recon4.mapping.tile import FIELDS, Columns
from recon4.store.atomic import raise_if_full, write_json
from recon4.store.formats import FORMATS


@dataclass(slots=True, kw_only=True)
class _TileRow:
    """A tile in ``tiles.json``; the fields are its keys."""

    ijk: list[int]
    origin_m: list[float]
    start: int
    stop: int
    strays: int = 0
    low_m: list[float]
    high_m: list[float]
    time_ns: list[int]
    """Times of its first and last point [ns], (2,)."""


class TileRows:
    """The rows of one tile, reserved in the files of a map, filled block by block.

    Tiles may be filled at the same time, each by one thread.
    """

    def __init__(self, files: Mapping[str, BinaryIO], row: _TileRow) -> None:
        self._files = files
        self._row = row
        self._at = row.start
        # A tile of strays only has their bounds: every tile has some.
        self._bounded = row.stop if row.stop > row.start else row.stop + row.strays

    def write(self, columns: Columns) -> None:
        """Write the next rows.

        Args:
            columns: All fields of the map.

        Raises:
            OSError: If they cannot be written.
        """
        count = len(columns["xyz"])
        for name, file in self._files.items():
            column = np.ascontiguousarray(columns[name], dtype=FIELDS[name][0])
            assert column.shape == column_shape(name, count), f"{name}: {column.shape}"
            _write_at(file, column.data.cast("B"), row_offset(name, self._at)[0])
        part = slice(max(0, min(count, self._bounded - self._at)))
        self._at += count
        if part.stop:
            self._extend_bounds(columns["xyz"][part], columns["t_ns"][part])

    def _extend_bounds(self, xyz: NDArray[np.float32], t_ns: NDArray[np.int64]) -> None:
        row, origin = self._row, np.array(self._row.origin_m)
        row.low_m = np.fmin(row.low_m, origin + xyz.min(axis=0)).tolist()
        row.high_m = np.fmax(row.high_m, origin + xyz.max(axis=0)).tolist()
        times = [*row.time_ns, int(t_ns.min()), int(t_ns.max())]
        row.time_ns = [min(times), max(times)]


class TileWriter:
    """Writes tiles one after the other; ``tiles.json`` last, if the block ends without error."""

    def __init__(self, folder: Path, fields: Sequence[str], *, tile_m: float) -> None:
        self._folder = folder
        self._fields = list(fields)
        self._tile_m = tile_m
        self._rows: list[_TileRow] = []
        self._points = 0
        self._files: dict[str, BinaryIO] = {}
        self.notes = MapNotes()

    def __enter__(self) -> Self:
        (self._folder / "tiles").mkdir(parents=True)
        for name in self._fields:
            self._files[name] = (self._folder / "tiles" / f"{name}.npy").open("wb")
            self._files[name].write(column_header(name, 0))
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, _: TracebackType | None
    ) -> None:
        try:
            for name, file in self._files.items():
                with file:
                    file.seek(0)
                    file.write(column_header(name, self._points))
        except OSError as failed:
            raise_if_full(failed, self._folder)
            raise StoreError(f"cannot write {self._folder}: {failed.strerror}") from failed
        if kind is None:
            self._write_list()

    def append(self, ijk: tuple[int, int, int], columns: Columns, *, strays: int = 0) -> None:
        """Write the points of one tile in the given order; an empty tile is omitted.

        Args:
            ijk: Index in the grid of tiles.
            columns: Its fields.
            strays: How many of the last rows are stray returns.
        """
        count = len(columns["xyz"])
        if count:
            self.reserve(ijk, count, strays=strays).write(columns)

    def reserve(self, ijk: tuple[int, int, int], count: int, *, strays: int = 0) -> TileRows:
        """The next rows, to be filled before the block ends; an empty tile is omitted.

        Args:
            ijk: Index in the grid of tiles.
            count: Points of the tile, stray returns included.
            strays: How many of the last rows are stray returns.
        """
        row = _TileRow(
            ijk=list(ijk),
            origin_m=(np.array(ijk) * self._tile_m).tolist(),
            start=self._points,
            stop=self._points + count - strays,
            strays=strays,
            low_m=[np.nan] * 3,
            high_m=[np.nan] * 3,
            time_ns=[],
        )
        if count:
            self._rows.append(row)
        self._points += count
        return TileRows(self._files, row)

    def _write_list(self) -> None:
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
        listed = [asdict(row) for row in rows]
        for row in listed:
            if not row["strays"]:
                del row["strays"]
        facts |= {"tile_m": self._tile_m, "fields": self._fields, "tiles": listed}
        write_json(self._folder / "tiles.json", facts)


def _write_at(file: BinaryIO, data: memoryview, offset: int) -> None:
    """Write all bytes at an offset, whatever other threads write elsewhere."""
    while data:
        done = os.pwrite(file.fileno(), data, offset)
        data, offset = data[done:], offset + done
