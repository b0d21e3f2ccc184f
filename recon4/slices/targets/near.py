"""Points of a map around many places, of which some tiles are kept at hand."""

from __future__ import annotations

from collections import OrderedDict
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from recon4.geometry.se3 import Array
from recon4.mapping.tiles import Tile, TileSet
from recon4.slices.tuning_targets import NEAR_POINTS


@dataclass(frozen=True, slots=True, eq=False)
class _Sorted:
    """Points of a tile by columns of a grid from above."""

    xyz: NDArray[np.float32]
    """From the origin of the tile [m], (N, 3)."""
    value: NDArray[np.float32]
    starts: NDArray[np.int64]
    """First row of each column of the grid, and the number of points."""
    size: int
    """Columns along an edge of the grid."""

    @staticmethod
    def of(tile: Tile, value: str, tile_m: float) -> _Sorted:
        found = tile.read(["xyz", value])
        size = int(np.ceil(tile_m / NEAR_POINTS.column_m)) + 1
        ij = np.clip((found["xyz"][:, :2] / NEAR_POINTS.column_m).astype(np.int64), 0, size - 1)
        key = ij[:, 0] * size + ij[:, 1]
        order = np.argsort(key, kind="stable")
        starts = np.searchsorted(key[order], np.arange(size * size + 1))
        return _Sorted(found["xyz"][order], found[value][order].astype(np.float32), starts, size)

    def around(self, p: Array, radius_m: float) -> tuple[Array, Array]:
        """Points in a ball around a place from the origin of the tile [m], and their values."""
        low, high = (
            np.clip(((p[:2] + d) / NEAR_POINTS.column_m).astype(int), 0, self.size - 1)
            for d in (-radius_m, radius_m)
        )
        rows = [
            slice(self.starts[i * self.size + low[1]], self.starts[i * self.size + high[1] + 1])
            for i in range(int(low[0]), int(high[0]) + 1)
        ]
        xyz = np.concatenate([self.xyz[part] for part in rows]).astype(np.float64)
        value = np.concatenate([self.value[part] for part in rows]).astype(np.float64)
        inside = ((xyz - p) ** 2).sum(axis=1) <= radius_m**2
        return xyz[inside], value[inside]


class PlacePoints:
    """Points of a map around places; the last tiles are kept."""

    def __init__(self, tiles: TileSet, value: str) -> None:
        """Begin.

        Args:
            tiles: The map.
            value: Name of the intensities.
        """
        self._tiles, self._value = tiles, value
        self._low_m = np.array([tile.low_m for tile in tiles]).reshape(-1, 3)
        self._high_m = np.array([tile.high_m for tile in tiles]).reshape(-1, 3)
        self._kept: OrderedDict[int, _Sorted] = OrderedDict()

    def in_order(self, places: Array, rows: NDArray[np.intp] | None = None) -> NDArray[np.intp]:
        """Rows of places (N, 3), those of a tile one after the other; ``rows`` names them."""
        edge = self._tiles.tile_m
        i, j, k = np.floor(places / edge).astype(np.int64).T if len(places) else np.zeros((3, 0))
        order = np.lexsort([k, j, i])
        return np.asarray(order if rows is None else rows[order], np.intp)

    def around(self, p_map: Array, radius_m: float) -> tuple[Array, Array]:
        """Points in a ball [m], (N, 3), and their intensities, (N,)."""
        parts = [(np.zeros((0, 3)), np.zeros(0))]
        meets = (self._low_m <= p_map + radius_m) & (self._high_m >= p_map - radius_m)
        for row in np.flatnonzero(meets.all(axis=1)).tolist():
            tile = self._tiles.tiles[row]
            xyz, value = self._sorted(row, tile).around(p_map - tile.origin_m, radius_m)
            parts.append((xyz + tile.origin_m, value))
        return np.concatenate([one[0] for one in parts]), np.concatenate([one[1] for one in parts])

    def _sorted(self, row: int, tile: Tile) -> _Sorted:
        if row not in self._kept:
            self._kept[row] = _Sorted.of(tile, self._value, self._tiles.tile_m)
            if len(self._kept) > NEAR_POINTS.tiles:
                self._kept.popitem(last=False)
        self._kept.move_to_end(row)
        return self._kept[row]
