"""Kernels of fitted surfaces: the cells of a tile, their neighbors, their planes as numbers.

Cells are those of the map's grid. A plane is oriented: only returns seen from its front count for
it. So the two faces of a thin wall are two planes.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numba import njit
from numpy.typing import NDArray

from recon4.kernels.surface_records import PLANE, Cells, Neighbors, Returns
from recon4.kernels.voxels import PER_METER

_SEARCH = 16
"""Points searched first for the next row."""
OWN_COLUMN = 4
"""Of the nine columns of 3 x 3 x 3 cells along an axis, the one in the middle."""


@njit(cache=True, nogil=True, error_model="numpy")
def unpack_returns(
    f4: NDArray[np.float32],
    i2: NDArray[np.int16],
    u1: NDArray[np.uint8],
    voxel_m: float,
    out: Returns,
) -> None:
    """Unpack what the fits need of records.

    The position is the center of a voxel of several returns: the record kept is the one nearest to
    the sensor, which lies in front of their mean.

    Args:
        f4: The records as float32, (N, 8).
        i2: The records as int16, (N, 16).
        u1: The records as uint8, (N, 32).
        voxel_m: Edge of a voxel [m].
        out: Receives all but the first points of the cells.
    """
    per_m = 1.0 / voxel_m
    for n in range(len(f4)):
        several = u1[n, 31] > 1
        for d in range(3):
            x = f4[n, d]
            out.xyz[n, d] = (np.floor(x * per_m) + 0.5) * voxel_m if several else x
            out.to_sensor[n, d] = i2[n, 10 + d] * np.float32(1.0 / PER_METER)
        out.weight[n] = u1[n, 31]


@njit(cache=True, nogil=True, error_model="numpy", inline="always")
def _cell_at(xyz: NDArray[np.float32], p: int, cell_m: float, side: int, halo: int) -> int:
    """Index of the cell of a point."""
    cell = 0
    for d in range(2, -1, -1):
        c: Any = np.int64(np.floor(xyz[p, d] / cell_m)) + halo
        cell = cell * side + min(max(c, 0), side - 1)
    return cell


@njit(cache=True, nogil=True, error_model="numpy")
def find_cells(xyz: NDArray[np.float32], cells: Cells, first: NDArray[np.int32]) -> int:
    """Runs of points in the same cell; the points are in the order of their cells.

    Args:
        xyz: Points from the tile's origin [m], (N, 3) or more columns.
        cells: Receives the indices (N of them have room) and their rows, which were -1 before.
        first: Receives the first point of each cell, and N after the last, (N + 1,).

    Returns:
        Number of cells.
    """
    side, halo, cell_m = cells.side, cells.halo, cells.edge_m
    count = 0
    low, high = np.empty(3), np.empty(3)
    high[:] = -np.inf
    for p in range(len(xyz)):
        x, y, z = xyz[p, 0], xyz[p, 1], xyz[p, 2]
        if low[0] <= x < high[0] and low[1] <= y < high[1] and low[2] <= z < high[2]:
            continue
        cell = _cell_at(xyz, p, cell_m, side, halo)
        # Rounding can put a point on a border into the next cell; it stays in its run.
        if cells.row[cell] >= 0:
            continue
        cells.row[cell] = count
        cells.number[count] = cell
        first[count] = p
        count += 1
        for d in range(3):
            low[d] = (cell % side - halo) * cell_m
            high[d] = low[d] + cell_m
            cell //= side
    first[count] = len(xyz)
    return count


@njit(cache=True, nogil=True, error_model="numpy")
def number_cells(
    xyz: NDArray[np.float32], cell_m: float, side: int, halo: int, out: NDArray[np.int32]
) -> None:
    """Index of the cell of each point, as in `find_cells`, int32 (N,)."""
    for p in range(len(xyz)):
        out[p] = _cell_at(xyz, p, cell_m, side, halo)


@njit(cache=True, nogil=True, error_model="numpy")
def center_of(c: int, cells: Cells) -> tuple[float, float, float]:
    """Center of the cell of a row from the tile's origin [m]."""
    cell, side = cells.number[c], cells.side
    i = cell % side
    j = (cell // side) % side
    k = cell // (side * side)
    middle, edge_m = 0.5 - cells.halo, cells.edge_m
    return (i + middle) * edge_m, (j + middle) * edge_m, (k + middle) * edge_m


@njit(cache=True, nogil=True, error_model="numpy")
def find_rings(cells: Cells, low: int, high: int, out: NDArray[np.uint8]) -> None:
    """How far each cell is from the border: 0 = outermost, its window is incomplete; 2 = inside.

    Args:
        cells: Of `find_cells`.
        low: First row of cells along y that there is.
        high: First row beyond.
        out: Receives 0, 1 or 2, (C,).
    """
    side = cells.side
    for c in range(len(cells.number)):
        cell = cells.number[c]
        i, j, k = cell % side, cell // side % side, cell // (side * side)
        out[c] = min(i, j - low, k, side - 1 - i, high - 1 - j, side - 1 - k, 2)


@njit(cache=True, nogil=True, error_model="numpy")
def _row_of(
    xyz: NDArray[np.float32], p: int, voxel_m: float, cell_voxels: int, side: int, halo: int
) -> np.int64:
    """Row of cells of a point, j + side k: each coordinate within tile and halo."""
    row: Any = np.int64(0)
    for d in range(2, 0, -1):
        # As the voxels were numbered.
        v: Any = np.int64(np.floor(xyz[p, d] / voxel_m)) + halo * cell_voxels
        row = row * side + min(max(v, 0), side * cell_voxels - 1) // cell_voxels
    return np.int64(row)


@njit(cache=True, nogil=True, error_model="numpy")
def first_of_rows(
    xyz: NDArray[np.float32],
    voxel_m: float,
    cell_voxels: int,
    side: int,
    halo: int,
    out: NDArray[np.int64],
) -> None:
    """First point of each row of cells along x; the points are in the order of their voxels.

    Args:
        xyz: Points from the tile's origin [m], (N, 3) or more columns.
        voxel_m: Edge of a voxel [m].
        cell_voxels: Voxels along a cell.
        side: Cells along tile and halo.
        halo: Cells of the halo.
        out: Receives the points, row j + side k, and N after the last, (side**2 + 1,).
    """
    out[0] = 0
    for row in range(1, len(out)):
        low, high = out[row - 1], out[row - 1] + _SEARCH
        while high < len(xyz) and _row_of(xyz, high, voxel_m, cell_voxels, side, halo) < row:
            low, high = high, 2 * high - out[row - 1]
        high = min(high, len(xyz))
        while low < high:
            middle = (low + high) // 2
            if _row_of(xyz, middle, voxel_m, cell_voxels, side, halo) < row:
                low = middle + 1
            else:
                high = middle
        out[row] = low


@njit(cache=True, nogil=True, error_model="numpy")
def list_neighbors(cells: Cells, out: Neighbors) -> int:
    """List the cells with points among the 3 x 3 x 3 around each cell, itself included.

    Args:
        cells: Of `find_cells`.
        out: Receives the list; there is room for 27 C entries.

    Returns:
        Number of entries.
    """
    side = cells.side
    count = 0
    for c in range(len(cells.number)):
        out.first[c] = count
        cell = cells.number[c]
        ci, cj, ck = cell % side, cell // side % side, cell // (side * side)
        for k in range(max(ck - 1, 0), min(ck + 2, side)):
            for j in range(max(cj - 1, 0), min(cj + 2, side)):
                for i in range(max(ci - 1, 0), min(ci + 2, side)):
                    o = cells.row[(k * side + j) * side + i]
                    if o >= 0:
                        out.row[count] = o
                        out.offset[count] = (i - ci + 1) + 3 * (j - cj + 1) + 9 * (k - ck + 1)
                        count += 1
    out.first[len(cells.number)] = count
    return count


@njit(cache=True, nogil=True, error_model="numpy", inline="always")
def main_axis(normal: NDArray[np.float64]) -> int:
    """The axis nearest to a direction."""
    along = 0
    for d in range(1, 3):
        if abs(normal[d]) > abs(normal[along]):
            along = d
    return along


@njit(cache=True, nogil=True, error_model="numpy", inline="always")
def column_of(k: int, along: int) -> int:
    """Which of the nine columns along an axis a neighbor lies in; `OWN_COLUMN` = the cell's."""
    return k // 3 if along == 0 else k % 3 + k // 9 * 3 if along == 1 else k % 9


@njit(cache=True, nogil=True, error_model="numpy", inline="always")
def distance_in_front(plane: NDArray[np.float64], returns: Returns, p: int) -> float:
    """Signed distance of a point to an oriented plane [m]; inf if it was seen from behind."""
    xyz, to_sensor = returns.xyz, returns.to_sensor
    if plane[0] * to_sensor[p, 0] + plane[1] * to_sensor[p, 1] + plane[2] * to_sensor[p, 2] <= 0.0:
        return np.inf
    return plane[0] * xyz[p, 0] + plane[1] * xyz[p, 1] + plane[2] * xyz[p, 2] - plane[PLANE.offset]
