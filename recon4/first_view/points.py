"""Points of a map as the page draws them: any first part of a tile is an even sample of it.

    xyz      x, y, z as 16-bit fractions of the tile's box, then normal (three signed bytes) and
             class of each point: 10 bytes a point
    others   16-bit values in the steps that the index names: 2 bytes a point

All little-endian, first the positions of all points, then their normals and classes.
"""

from __future__ import annotations

from functools import lru_cache
from typing import Any

import numpy as np
from numpy.typing import NDArray

from recon4.first_view.records import ColumnName, Stored
from recon4.first_view.tuning import MAP_CHUNKS
from recon4.geometry.se3 import Array
from recon4.mapping.tile import DEVIATION
from recon4.mapping.tiles import Tile, TileSet
from recon4.mapping.tuning import TILES

FIELD_OF: dict[ColumnName, str] = {
    "intensity": "intensity",
    "normalized": "intensity_normalized",
    "time": "t_ns",
    "uncertainty": DEVIATION,
    "thickness": "surface_sd_m",
}


def sample_sizes(tiles: TileSet) -> NDArray[np.int64]:
    """How many first points of each tile are in the sample of the whole map, (T,)."""
    counts = np.array([len(tile) for tile in tiles], dtype=np.int64)
    wanted = counts * min(1.0, MAP_CHUNKS.sample_points / max(len(tiles), 1))
    return np.minimum(np.ceil(wanted).astype(np.int64), counts)


@lru_cache(maxsize=256)
def _shown_order(count: int) -> NDArray[np.intp]:
    """Rows of the first stratum of a tile, which lies in spatial order, evenly spread, (S,).

    Sorted by their reversed bits every first part is an even sample.
    """
    bits = max(count - 1, 1).bit_length()
    rows = np.arange(count)
    reverse = np.zeros(count, np.int64)
    for bit in range(bits):
        reverse |= ((rows >> bit) & 1) << (bits - 1 - bit)
    return np.argsort(reverse, kind="stable")


def read_shown(tile: Tile, fields: list[str], rows: slice) -> dict[str, NDArray[Any]]:
    """Fields of a tile's points in the order in which they are shown.

    Args:
        tile: The tile.
        fields: Names of its fields.
        rows: First and last + 1, counted in that order.
    """
    stratum = len(tile) // TILES.strata
    if rows.start >= stratum:
        return tile.read(fields, rows=rows)
    first = tile.read(fields, rows=slice(0, stratum))
    order = _shown_order(stratum)[rows.start : rows.stop]
    found = {name: values[order] for name, values in first.items()}
    if rows.stop <= stratum:
        return found
    rest = tile.read(fields, rows=slice(stratum, rows.stop))
    return {name: np.concatenate([found[name], rest[name]]) for name in fields}


def steps_of(column: ColumnName, tiles: TileSet) -> tuple[float, float]:
    """Offset and scale of the stored values of a column."""
    if column == "time":
        seconds = max((tiles.last_ns - tiles.first_ns) / 1e9, 1.0)
        return 0.0, seconds / MAP_CHUNKS.value_steps
    if column == "intensity":
        return 0.0, 1.0
    return 0.0, MAP_CHUNKS.intensity_step if column == "normalized" else MAP_CHUNKS.length_step_m


def values_of(column: ColumnName, stored: NDArray[Any], tiles: TileSet) -> NDArray[np.float64]:
    """Values of a column in its unit from what the map stores, (N,)."""
    if column == "time":
        return np.asarray((stored - tiles.first_ns) / 1e9, dtype=np.float64)
    return stored.astype(np.float64)


def encoded(tiles: TileSet, row: int, stored: Stored, *, rows: slice) -> bytes:
    """Some points of a tile, in the order in which they are shown.

    Raises:
        StoreError: If the map does not have the field, or a file is damaged.
    """
    tile = tiles.tiles[row]
    if stored == "xyz":
        return b"".join(_places(tiles, tile, rows))
    field = FIELD_OF[stored]
    return steps(stored, read_shown(tile, [field], rows)[field], tiles).tobytes()


def _places(tiles: TileSet, tile: Tile, rows: slice) -> tuple[bytes, bytes]:
    known = [name for name in ("normal", "classification") if name in tiles.fields]
    found = read_shown(tile, ["xyz", *known], rows)
    low = np.array(tile.low_m) - tile.origin_m
    places = fractions(found["xyz"] - low, np.array(tile.high_m) - tile.low_m)
    return places.tobytes(), shape_and_class(found).tobytes()


def fractions(from_low_m: NDArray[Any], edge_m: Array) -> NDArray[np.uint16]:
    """Positions as 16-bit fractions of a box.

    Args:
        from_low_m: From its lowest corner [m], (N, 3).
        edge_m: Its edges [m], (3,).
    """
    part = np.clip(from_low_m / np.maximum(edge_m, 1e-6), 0.0, 1.0)
    return np.rint(MAP_CHUNKS.place_steps * part).astype("<u2")


def shape_and_class(found: dict[str, NDArray[Any]]) -> NDArray[np.int8]:
    """Normals and classes of points, as far as they are known, (N, 4)."""
    about = np.zeros((len(found["xyz"]), 4), np.int8)
    if "normal" in found:
        normal = np.nan_to_num(found["normal"].astype(np.float32))
        about[:, :3] = np.rint(127.0 * np.clip(normal, -1.0, 1.0)).astype(np.int8)
    if "classification" in found:
        about[:, 3] = found["classification"].view(np.int8)
    return about


def steps(column: ColumnName, stored: NDArray[Any], tiles: TileSet) -> NDArray[np.uint16]:
    """Values of a column in the steps of the index, (N,); the one after them = there is none."""
    offset, scale = steps_of(column, tiles)
    values = (values_of(column, stored, tiles) - offset) / scale
    found = np.clip(np.rint(values), 0.0, MAP_CHUNKS.value_steps)
    return np.where(np.isfinite(found), found, MAP_CHUNKS.value_steps + 1).astype("<u2")
