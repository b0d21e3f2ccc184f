"""Coarse points of several tiles together: the upper level of a map as the page draws it.

A map of a billion points has thousands of tiles; to draw or to read some points of each one by one
costs more than the points. So up to 64 tiles that are near each other share a cube, which has the
first points of each. Any first part of a cube is an even sample of all of its tiles.

A file has the points of all cubes, of one kind of value:

    header   number of cubes, then how many of its points are in the sample of the whole map and
             how many there are, of each cube; unsigned, 32 bits
    xyz      cube after cube, as `recon4.first_view.points` says, within the box of the cube; then
             the tile of each point, counted within its cube: 11 bytes a point
    others   16-bit values: 2 bytes a point
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any, BinaryIO

import numpy as np
from numpy.typing import NDArray

from recon4.errors import ConfigError, StoreError
from recon4.first_view.points import (
    FIELD_OF,
    fractions,
    read_shown,
    sample_sizes,
    shape_and_class,
)
from recon4.first_view.points import steps as steps_from
from recon4.first_view.records import Stored
from recon4.first_view.tuning import MAP_CHUNKS
from recon4.locales.coded import CodedText
from recon4.mapping.tiles import TileSet
from recon4.mapping.tuning import TILES

Rows = NDArray[np.intp]


def cubes_of(tiles: TileSet) -> list[Rows]:
    """Rows of the tiles of each cube, ascending; halved along the longest edge until they fit."""
    ijk = np.array([tile.ijk for tile in tiles], np.int64).reshape(-1, 3)
    left, found = [np.arange(len(ijk))], []
    while left:
        rows = left.pop()
        if len(rows) <= MAP_CHUNKS.cube_tiles:
            found.append(np.sort(rows))
            continue
        axis = int(np.argmax(np.ptp(ijk[rows], axis=0)))
        rows = rows[np.argsort(ijk[rows, axis], kind="stable")]
        left += [rows[len(rows) // 2 :], rows[: len(rows) // 2]]
    return [rows for rows in found if len(rows)]


def coarse_sizes(tiles: TileSet) -> NDArray[np.int64]:
    """How many first points of each tile are in its cube, (T,); its sample is among them."""
    counts = np.array([len(tile) for tile in tiles], dtype=np.int64)
    strata = np.minimum(counts // TILES.strata, MAP_CHUNKS.coarse_points)
    return np.maximum(strata, sample_sizes(tiles))


def write_cubes(tiles: TileSet, stored: Stored, file: BinaryIO) -> None:
    """Write the points of all cubes.

    Raises:
        StoreError: If the map does not have the field, or a file is damaged.
    """
    cubes, sample, coarse = cubes_of(tiles), sample_sizes(tiles), coarse_sizes(tiles)
    counts = [(sample[rows].sum(), coarse[rows].sum()) for rows in cubes]
    file.write(np.array([len(cubes), *np.ravel(counts)], "<u4").tobytes())
    for rows in cubes:
        file.writelines(_columns(tiles, stored, rows, sizes=(sample[rows], coarse[rows])))


def _columns(
    tiles: TileSet, stored: Stored, rows: Rows, *, sizes: tuple[NDArray[np.int64], ...]
) -> Iterator[bytes]:
    sample, coarse = sizes
    some = [tiles.tiles[row] for row in rows.tolist()]
    place = np.concatenate([np.arange(count) for count in coarse])
    later = place >= np.repeat(sample, coarse)
    order = np.lexsort(((place + 0.5) / np.repeat(coarse, coarse), later))
    names = [FIELD_OF[stored]] if stored != "xyz" else ["xyz"]
    if stored == "xyz":
        names += [name for name in ("normal", "classification") if name in tiles.fields]
    parts = [
        read_shown(tile, names, slice(0, count))
        for tile, count in zip(some, coarse.tolist(), strict=True)
    ]
    found = {name: np.concatenate([part[name] for part in parts])[order] for name in names}
    if stored != "xyz":
        yield steps_from(stored, found[names[0]], tiles).tobytes()
        return
    slot = np.repeat(np.arange(len(rows), dtype=np.uint8), coarse)[order]
    low = np.min([tile.low_m for tile in some], axis=0)
    high = np.max([tile.high_m for tile in some], axis=0)
    origin = np.array([tile.origin_m for tile in some])
    yield fractions(found["xyz"] + (origin - low)[slot], high - low).tobytes()
    yield shape_and_class(found).tobytes()
    yield slot.tobytes()


@dataclass(frozen=True, slots=True)
class CubeFile:
    """A written file of cubes."""

    path: Path
    stored: Stored

    def sample(self) -> bytes:
        """The sample of the whole map: the first points of each cube, as parts.

        Raises:
            StoreError: If the file is damaged.
        """
        counts = self._counts()[:, 0].tolist()
        if sum(counts) * sum(self._widths) > MAP_CHUNKS.max_sample_bytes:
            raise StoreError(CodedText("file-sample-large", file=self.path.name, count=sum(counts)))
        return self.read(tuple((row, 0, count) for row, count in enumerate(counts) if count))

    def read(self, parts: tuple[tuple[int, int, int], ...]) -> bytes:
        """Points, part by part: row of the cube, the first of its points, the last + 1.

        Raises:
            ConfigError: If there are no such points.
            StoreError: If the file is damaged.
        """
        counts, widths = self._counts(), self._widths
        begins = np.concatenate([[0], np.cumsum(counts[:, 1], dtype=np.int64)]) * sum(widths)
        begins += counts.nbytes + 4
        data = []
        with self.path.open("rb") as file:
            for row, start, stop in parts:
                if row >= len(counts) or stop > counts[row, 1]:
                    raise ConfigError(
                        CodedText("map-lacks-points", start=start, stop=stop, tile=row)
                    )
                at = int(begins[row])
                for width in widths:
                    file.seek(at + width * start)
                    part = file.read(width * (stop - start))
                    if len(part) < width * (stop - start):
                        raise StoreError(CodedText("file-ends-early", file=self.path.name))
                    data.append(part)
                    at += width * int(counts[row, 1])
        return b"".join(data)

    @property
    def _widths(self) -> tuple[int, ...]:
        return MAP_CHUNKS.place_bytes if self.stored == "xyz" else MAP_CHUNKS.value_bytes

    def _counts(self) -> NDArray[Any]:
        with self.path.open("rb") as file:
            first = file.read(4)
            many = int.from_bytes(first, "little")
            counts = file.read(min(8 * many, self.path.stat().st_size))
        if len(first) < 4 or len(counts) < 8 * many:
            raise StoreError(CodedText("file-ends-early", file=self.path.name))
        return np.frombuffer(counts, "<u4").reshape(-1, 2)
