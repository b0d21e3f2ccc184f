"""The map as the viewer needs it: parts of tiles with values to color by, read when asked for.

Nothing but the coarsest sample is held in memory; the rest is read from the stage's files.
"""

from __future__ import annotations

import threading
from collections import OrderedDict
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from recon4.first_view.surfaces import cells_m2
from recon4.geometry.se3 import Array
from recon4.mapping.tile import DEVIATION
from recon4.mapping.tiles import Surface, TileSet
from recon4.mapping.tuning import TILES
from recon4_app.viewer.client.view import COLOR_BY, ColorBy
from recon4_app.viewer.cloud.lod import Chunk, Rows, TileBoxes, base_step, chunks_of
from recon4_app.viewer.cloud.palette import (
    Palette,
    Range,
    Rgb,
    distinct_colors,
    paint,
    sensor_colors,
    usual_range,
)
from recon4_app.viewer.tuning import CLOUD_PARTS

FIELD_OF: dict[ColorBy, str] = {
    "normalized intensity": "intensity_normalized",
    "raw intensity": "intensity",
    "height": "xyz",
    "time": "t_ns",
    "sensor": "sensor",
    "ring": "ring",
    "multiframe": "frame_id",
    "distance": "range_m",
    "uncertainty": DEVIATION,
}


@dataclass(frozen=True, slots=True, eq=False)
class CloudPart:
    """Points that are drawn together."""

    origin_m: Array
    """Origin of its coordinates in the map [m], (3,)."""
    p_part: NDArray[np.float32]
    """Points relative to it [m], (N, 3)."""

    def __len__(self) -> int:
        return len(self.p_part)


class Cloud:
    """A finished map."""

    def __init__(
        self, map_: Path | TileSet, *, began_ns: int = 0, surface: Surface = "fitted"
    ) -> None:
        """Open it.

        Args:
            map_: Folder of the stage ``map``, or what is open of it.
            began_ns: When the recording began [ns].
            surface: Where points are drawn; a map without fitted surfaces has them as measured.

        Raises:
            StoreError: If the map is missing or damaged.
        """
        if isinstance(map_, Path):
            map_ = TileSet.open(map_, kept_bytes=TILES.kept_bytes)
        self._every = map_
        self.tiles = self._every.on(surface)
        self.began_ns = began_ns
        step = base_step(len(self.tiles), CLOUD_PARTS.base_points)
        self._chunks = [chunks_of(len(tile), step) for tile in self.tiles]
        self._painted = _Painted(CLOUD_PARTS.painted_points)

    def __len__(self) -> int:
        return len(self.tiles)

    def on(self, surface: Surface) -> Cloud:
        """The same map on fitted surfaces or as measured, or what it leaves out, if anything."""
        if surface == "strays":
            return self._strays
        return self if surface == "fitted" else self._measured

    @cached_property
    def _measured(self) -> Cloud:
        if self.tiles.surface == "raw":
            return self
        return Cloud(self._every, began_ns=self.began_ns, surface="raw")

    @cached_property
    def _strays(self) -> Cloud:
        if not self.tiles.strays:
            return self
        return Cloud(self._every, began_ns=self.began_ns, surface="strays")

    @property
    def colors(self) -> tuple[ColorBy, ...]:
        """Attributes by which the points can be colored."""
        return tuple(color for color in COLOR_BY if FIELD_OF[color] in self.tiles.fields)

    @cached_property
    def boxes(self) -> TileBoxes:
        """Input of the selection of detail."""
        tiles = self.tiles.tiles
        low = np.array([tile.low_m for tile in tiles]).reshape(-1, 3)
        high = np.array([tile.high_m for tile in tiles]).reshape(-1, 3)
        sizes = tuple(np.array([len(rows) for rows in chunks]) for chunks in self._chunks)
        return TileBoxes(low, high, cells_m2(self.tiles), sizes)

    @cached_property
    def base(self) -> CloudPart:
        """The coarsest sample of the whole map."""
        low, high = self.tiles.bounds_m
        middle = (low + high) / 2.0 if len(self) else np.zeros(3)
        parts = [
            (tile.origin_m - middle + self._rows("xyz", (row, 0))).astype(np.float32)
            for row, tile in enumerate(self.tiles)
        ]
        return CloudPart(middle, np.concatenate(parts or [np.empty((0, 3), np.float32)]))

    def part(self, chunk: Chunk) -> CloudPart:
        """The points of a chunk."""
        origin_m = np.asarray(self.tiles.tiles[chunk[0]].origin_m, dtype=np.float64)
        return CloudPart(origin_m, np.ascontiguousarray(self._rows("xyz", chunk)))

    def name(self, chunk: Chunk | None) -> str:
        """A name for a chunk, None = the coarsest sample."""
        if chunk is None:
            return "base"
        return f"{'_'.join(map(str, self.tiles.tiles[chunk[0]].ijk))}/{chunk[1]}"

    def span(self, color_by: ColorBy) -> Range:
        """Values at the ends of a palette unless a person sets them."""
        return usual_range(self._base_values(color_by))

    def painted(
        self, chunk: Chunk | None, color_by: ColorBy, *, span: Range, palette: Palette
    ) -> NDArray[np.uint8]:
        """Colors of a chunk (None = the coarsest sample), (N, 3)."""

        def make() -> NDArray[np.uint8]:
            return colors(self.values(chunk, color_by), color_by, span=span, palette=palette)

        return self._painted.get((chunk, color_by, span, palette), make)

    def values(self, chunk: Chunk | None, color_by: ColorBy) -> NDArray[Any]:
        """What the points of a chunk (None = the coarsest sample) are colored by, (N,)."""
        return self._base_values(color_by) if chunk is None else self._values(chunk, color_by)

    def _rows(self, field: str, chunk: Chunk) -> NDArray[Any]:
        row, number = chunk
        rows: Rows = self._chunks[row][number]
        return self.tiles.tiles[row].read([field], rows=rows.index)[field]

    def _base_values(self, color_by: ColorBy) -> NDArray[Any]:
        kept: dict[ColorBy, NDArray[Any]] = self.__dict__.setdefault("_base", {})
        if color_by not in kept:
            parts = [self._values((row, 0), color_by) for row in range(len(self._chunks))]
            kept[color_by] = np.concatenate(parts or [np.empty(0, np.float32)])
        return kept[color_by]

    def _values(self, chunk: Chunk, color_by: ColorBy) -> NDArray[Any]:
        rows = self._rows(FIELD_OF[color_by], chunk)
        if color_by == "height":
            return rows[:, 2] + np.float32(self.tiles.tiles[chunk[0]].origin_m[2])
        if color_by == "time":
            return ((rows - self.began_ns) * 1e-9).astype(np.float32)
        return rows


def colors(
    values: NDArray[Any], color_by: ColorBy, *, span: Range, palette: Palette
) -> NDArray[np.uint8]:
    """Colors of values, (N,) -> (N, 3)."""
    if color_by == "sensor":
        return sensor_colors()[values.astype(np.intp) % len(sensor_colors())]
    if color_by == "multiframe":
        return distinct_colors(values)
    return paint(values, span, palette)


def sensor_names(names: tuple[str, ...]) -> tuple[tuple[str, Rgb], ...]:
    """Names of the sensors with their colors."""
    rows = sensor_colors().tolist()
    return tuple((name, tuple(rows[k % len(rows)])) for k, name in enumerate(names))


class _Painted:
    """Cache of colors; the least recently used are removed first."""

    def __init__(self, most: int) -> None:
        self._most = most
        self._points = 0
        self._kept: OrderedDict[Any, NDArray[np.uint8]] = OrderedDict()
        self._lock = threading.Lock()

    def get(self, key: Any, make: Any) -> NDArray[np.uint8]:
        """The colors cached under a key, computed if missing."""
        with self._lock:
            if key in self._kept:
                self._kept.move_to_end(key)
                return self._kept[key]
        made: NDArray[np.uint8] = make()
        with self._lock:
            if key not in self._kept:
                self._kept[key] = made
                self._points += len(made)
            while self._points > self._most:
                self._points -= len(self._kept.popitem(last=False)[1])
        return made
