"""Kernels of fitted surfaces: the cells of a tile, their neighbors, their planes as numbers.

Cells are those of the map's grid. A plane of a cell is a row of `PLANE` numbers. It is oriented:
its normal points to the sensors that saw it, and only returns seen from that side count for it.
So the two faces of a thin wall are two planes.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numba import njit
from numpy.typing import NDArray

from recon4.kernels.voxels import PER_METER

PLANE = 11
"""Unit normal x y z, offset n · p [m], standard deviation across [m] (0 = none), weight,
planarity, middle of its returns x y z [m] (NaN = not known), offset at the cell itself [m]."""
SLOTS = 3
"""Planes of a cell: a surface, an edge of two, a corner of three."""
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
    means: NDArray[np.float32],
    to_sensor: NDArray[np.float32],
    weight: NDArray[np.float32],
) -> None:
    """Unpack what the fits need of records.

    The position is the center of a voxel of several returns: the record kept is the one nearest to
    the sensor, which lies in front of their mean.

    Args:
        f4: The records as float32, (N, 8).
        i2: The records as int16, (N, 16).
        u1: The records as uint8, (N, 32).
        voxel_m: Edge of a voxel [m].
        means: Receives unbiased positions [m], (N, 3).
        to_sensor: Receives the vectors to the sensor [m], (N, 3).
        weight: Receives the returns of each voxel, (N,).
    """
    per_m = 1.0 / voxel_m
    for n in range(len(f4)):
        several = u1[n, 31] > 1
        for d in range(3):
            x = f4[n, d]
            means[n, d] = (np.floor(x * per_m) + 0.5) * voxel_m if several else x
            to_sensor[n, d] = i2[n, 10 + d] * np.float32(1.0 / PER_METER)
        weight[n] = u1[n, 31]


@njit(cache=True, nogil=True, error_model="numpy", inline="always")
def _cell_at(xyz: NDArray[np.float32], p: int, cell_m: float, side: int, halo: int) -> int:
    """Index of the cell of a point."""
    cell = 0
    for d in range(2, -1, -1):
        c: Any = np.int64(np.floor(xyz[p, d] / cell_m)) + halo
        cell = cell * side + min(max(c, 0), side - 1)
    return cell


@njit(cache=True, nogil=True, error_model="numpy")
def find_cells(
    xyz: NDArray[np.float32],
    cell_m: float,
    side: int,
    halo: int,
    starts: NDArray[np.int32],
    cells: NDArray[np.int32],
    where: NDArray[np.int32],
) -> int:
    """Runs of points in the same cell; the points are in the order of their cells.

    Args:
        xyz: Points from the tile's origin [m], (N, 3) or more columns.
        cell_m: Edge of a cell [m].
        side: Cells along tile and halo.
        halo: Cells of the halo.
        starts: Receives the first point of each cell, and N after the last, int32 (N + 1,).
        cells: Receives the index of each cell, int32 (N,).
        where: Receives the row of each cell index; filled with -1 before, int32 (side**3,).

    Returns:
        Number of cells.
    """
    count = 0
    low, high = np.empty(3), np.empty(3)
    high[:] = -np.inf
    for p in range(len(xyz)):
        x, y, z = xyz[p, 0], xyz[p, 1], xyz[p, 2]
        if low[0] <= x < high[0] and low[1] <= y < high[1] and low[2] <= z < high[2]:
            continue
        cell = _cell_at(xyz, p, cell_m, side, halo)
        # Rounding can put a point on a border into the next cell; it stays in its run.
        if where[cell] >= 0:
            continue
        where[cell] = count
        cells[count] = cell
        starts[count] = p
        count += 1
        for d in range(3):
            low[d] = (cell % side - halo) * cell_m
            high[d] = low[d] + cell_m
            cell //= side
    starts[count] = len(xyz)
    return count


@njit(cache=True, nogil=True, error_model="numpy")
def number_cells(
    xyz: NDArray[np.float32], cell_m: float, side: int, halo: int, out: NDArray[np.int32]
) -> None:
    """Index of the cell of each point, as in `find_cells`, int32 (N,)."""
    for p in range(len(xyz)):
        out[p] = _cell_at(xyz, p, cell_m, side, halo)


@njit(cache=True, nogil=True, error_model="numpy")
def center_of(cell: int, side: int, halo: int, cell_m: float) -> tuple[float, float, float]:
    """Center of a cell from the tile's origin [m]."""
    i = cell % side
    j = (cell // side) % side
    k = cell // (side * side)
    middle = 0.5 - halo
    return (i + middle) * cell_m, (j + middle) * cell_m, (k + middle) * cell_m


@njit(cache=True, nogil=True, error_model="numpy")
def find_rings(
    cells: NDArray[np.int32], side: int, low: int, high: int, out: NDArray[np.uint8]
) -> None:
    """How far each cell is from the border: 0 = outermost, its window is incomplete; 2 = inside.

    Args:
        cells: Of `find_cells`, (C,).
        side: Cells along tile and halo.
        low: First row of cells along y that there is.
        high: First row beyond.
        out: Receives 0, 1 or 2, (C,).
    """
    for c in range(len(cells)):
        i, j, k = cells[c] % side, cells[c] // side % side, cells[c] // (side * side)
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
def list_neighbors(
    cells: NDArray[np.int32],
    where: NDArray[np.int32],
    side: int,
    begin: NDArray[np.int32],
    near: NDArray[np.int32],
    at: NDArray[np.uint8],
) -> int:
    """List the cells with points among the 3 x 3 x 3 around each cell, itself included.

    Args:
        cells: Of `find_cells`, (C,).
        where: Of `find_cells`.
        side: Cells along tile and halo.
        begin: Receives the first entry of each cell, and their number after the last, (C + 1,).
        near: Receives the rows of the cells, int32 (27 C,).
        at: Receives which of the 27 each is: i + 3 j + 9 k, 13 = the cell itself, (27 C,).

    Returns:
        Number of entries.
    """
    count = 0
    for c in range(len(cells)):
        begin[c] = count
        cell = cells[c]
        ci, cj, ck = cell % side, cell // side % side, cell // (side * side)
        for k in range(max(ck - 1, 0), min(ck + 2, side)):
            for j in range(max(cj - 1, 0), min(cj + 2, side)):
                for i in range(max(ci - 1, 0), min(ci + 2, side)):
                    o = where[(k * side + j) * side + i]
                    if o >= 0:
                        near[count] = o
                        at[count] = (i - ci + 1) + 3 * (j - cj + 1) + 9 * (k - ck + 1)
                        count += 1
    begin[len(cells)] = count
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
def distance_in_front(
    plane: NDArray[np.float64], xyz: NDArray[np.float32], to_sensor: NDArray[np.float32], p: int
) -> float:
    """Signed distance of a point to an oriented plane [m]; inf if it was seen from behind."""
    if plane[0] * to_sensor[p, 0] + plane[1] * to_sensor[p, 1] + plane[2] * to_sensor[p, 2] <= 0.0:
        return np.inf
    return plane[0] * xyz[p, 0] + plane[1] * xyz[p, 1] + plane[2] * xyz[p, 2] - plane[3]
