"""Upright surfaces of a storey, tile by tile, as cells seen from above."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from recon4.geometry.se3 import Array
from recon4.mapping.tiles import Tile, TileSet
from recon4.products.storeys import BuildingStorey, Levels
from recon4.products.tuning import STOREYS, WALL_CELLS

Masks = NDArray[np.uint64]


@dataclass(frozen=True, slots=True, eq=False)
class WallCells:
    """Cells of upright surfaces; a cell has one direction of normals."""

    p: Array
    """Mean place of its points in the map, x and y [m], (N, 2)."""
    n: Array
    """Unit normal, towards the side it was seen from, (N, 2)."""
    heights: Masks
    """Bit k: there is a surface k steps of `WALL_CELLS.bit_m` above the floor, (N,)."""
    high: NDArray[np.bool_]
    """Whether it reaches the ceiling, (N,)."""

    def __len__(self) -> int:
        return len(self.p)

    @property
    def weight(self) -> Array:
        """At how many heights there is a surface, (N,)."""
        return np.bitwise_count(self.heights).astype(np.float64)

    def only(self, rows: NDArray[np.bool_] | NDArray[np.intp]) -> WallCells:
        """Some of them."""
        return WallCells(self.p[rows], self.n[rows], self.heights[rows], self.high[rows])


def wall_cells(tiles: TileSet, storey: BuildingStorey, levels: Levels) -> WallCells:
    """The upright surfaces of a storey.

    Memory is that of the cells, whatever the number of points.

    Args:
        tiles: The map.
        storey: One of its storeys.
        levels: Its level surfaces.
    """
    low_m, high_m = storey.floor_m, storey.floor_m + WALL_CELLS.bits * WALL_CELLS.bit_m
    met = [tile for tile in tiles if tile.high_m[2] >= low_m and tile.low_m[2] <= high_m]
    parts = [_of_tile(tile, storey.floor_m) for tile in met]
    keys = np.concatenate([key for key, _, _ in parts] or [np.empty((0, 3), np.int64)])
    sums = np.concatenate([one for _, one, _ in parts] or [np.empty((0, 5))])
    masks = np.concatenate([mask for _, _, mask in parts] or [np.empty(0, np.uint64)])
    _, sums, masks = _merged(keys, sums, masks)
    length = np.maximum(np.linalg.norm(sums[:, 3:], axis=1), 1e-9)
    cells = WallCells(
        sums[:, 1:3] / sums[:, :1], sums[:, 3:] / length[:, None], masks, np.zeros(len(sums), bool)
    )
    ceiling = _Ceiling.of(levels, storey)
    return WallCells(cells.p, cells.n, cells.heights, _reach(cells, ceiling))


def _of_tile(tile: Tile, floor_m: float) -> tuple[NDArray[np.int64], Array, Masks]:
    """Keys (cell x, y, sector), sums (count, x, y, normal x, y) and heights of a tile's cells."""
    columns = tile.read(["xyz", "normal"])
    normal = columns["normal"].astype(np.float64)
    p = columns["xyz"].astype(np.float64) + tile.origin_m
    bit = np.floor((p[:, 2] - floor_m) / WALL_CELLS.bit_m)
    upright = (np.abs(normal[:, 2]) < WALL_CELLS.upright) & normal.any(axis=1)
    rows = upright & (p[:, 2] > floor_m + WALL_CELLS.clear_m) & (bit < WALL_CELLS.bits)
    p, normal, bit = p[rows], normal[rows], bit[rows].astype(np.uint64)
    n = normal[:, :2] / np.linalg.norm(normal[:, :2], axis=1, keepdims=True)
    turn = np.arctan2(n[:, 1], n[:, 0]) / (2.0 * np.pi) * WALL_CELLS.sectors
    sector = np.round(turn).astype(np.int64) % WALL_CELLS.sectors
    cell = np.floor(p[:, :2] / WALL_CELLS.cell_m).astype(np.int64)
    sums = np.column_stack([np.ones(len(p)), p[:, :2], n])
    return _merged(np.column_stack([cell, sector]), sums, np.uint64(1) << bit)


def _merged(
    keys: NDArray[np.int64], sums: Array, masks: Masks
) -> tuple[NDArray[np.int64], Array, Masks]:
    """Rows with the same key as one: sums added, masks joined."""
    if not len(keys):
        return keys, sums, masks
    order = np.lexsort(keys.T)
    keys = keys[order]
    first = np.flatnonzero(np.r_[True, np.any(np.diff(keys, axis=0) != 0, axis=1)])
    joined = np.bitwise_or.reduceat(masks[order], first)
    return keys[first], np.add.reduceat(sums[order], first, axis=0), joined


@dataclass(frozen=True, slots=True, eq=False)
class _Ceiling:
    """Height of the ceiling over the floor at each place."""

    corner: NDArray[np.int64]
    height_m: Array
    """(X, Y)."""

    @staticmethod
    def of(levels: Levels, storey: BuildingStorey) -> _Ceiling:
        from scipy.ndimage import distance_transform_edt

        low, high = STOREYS.ceiling_m
        over = levels.z_m - storey.floor_m
        least = (STOREYS.column_m / STOREYS.cell_m) ** 2 * STOREYS.cell_m**2 / 4.0
        rows = ~levels.up & (over > low) & (over < high) & (levels.area_m2 >= least)
        rows &= levels.z_m <= storey.ceiling_m + WALL_CELLS.below_ceiling_m
        if not rows.any():
            return _Ceiling(np.zeros(2, np.int64), np.full((1, 1), STOREYS.usual_m))
        column, height = levels.column[rows], over[rows]
        corner = column.min(axis=0)
        grid = np.zeros(column.max(axis=0) - corner + 1)
        np.maximum.at(grid, tuple((column - corner).T), height)
        nearest = distance_transform_edt(grid == 0.0, return_distances=False, return_indices=True)
        return _Ceiling(corner, grid[tuple(nearest)])

    def at(self, p: Array) -> Array:
        """Height over the floor at places of the map [m], (N, 2) -> (N,)."""
        column = np.floor(p / STOREYS.column_m).astype(np.int64) - self.corner
        column = np.clip(column, 0, np.array(self.height_m.shape) - 1)
        out: Array = self.height_m[tuple(column.T)]
        return out


def _reach(cells: WallCells, ceiling: _Ceiling) -> NDArray[np.bool_]:
    """Whether cells reach the ceiling before them, (N,)."""
    before = ceiling.at(cells.p + WALL_CELLS.front_m * cells.n)
    needed = np.minimum(before - WALL_CELLS.below_ceiling_m, WALL_CELLS.high_m)
    top = np.floor(np.log2(np.maximum(cells.heights.astype(np.float64), 1.0)))
    out: NDArray[np.bool_] = (top + 1.0) * WALL_CELLS.bit_m >= needed
    return out
