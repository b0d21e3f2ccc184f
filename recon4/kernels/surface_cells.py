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

PLANE = 10
"""Unit normal x y z, offset n · p [m], standard deviation across [m] (0 = none), weight,
planarity, middle of its returns x y z [m] (NaN = not known)."""
SLOTS = 3
"""Planes of a cell: a surface, an edge of two, a corner of three."""


@njit(cache=True, nogil=True, error_model="numpy")
def find_cells(
    xyz: NDArray[np.float32],
    cell_m: float,
    side: int,
    starts: NDArray[np.int32],
    cells: NDArray[np.int32],
    where: NDArray[np.int32],
) -> int:
    """Runs of points in the same cell; the points are in the order of their cells.

    Args:
        xyz: Points from the tile's origin [m], (N, 3).
        cell_m: Edge of a cell [m].
        side: Cells along tile and halo.
        starts: Receives the first point of each cell, and N after the last, int32 (N + 1,).
        cells: Receives the index of each cell, int32 (N,).
        where: Receives the row of each cell index; filled with -1 before, int32 (side**3,).

    Returns:
        Number of cells.
    """
    count = 0
    last = -1
    for p in range(len(xyz)):
        cell = 0
        for d in range(2, -1, -1):
            c: Any = np.int64(np.floor(xyz[p, d] / cell_m)) + 1
            cell = cell * side + min(max(c, 0), side - 1)
        # Rounding can put a point on a border into the next cell; it stays in its run.
        if cell != last and where[cell] < 0:
            where[cell] = count
            cells[count] = cell
            starts[count] = p
            count += 1
            last = cell
    starts[count] = len(xyz)
    return count


@njit(cache=True, nogil=True, error_model="numpy")
def means_of_voxels(
    xyz: NDArray[np.float32],
    returns: NDArray[np.uint8],
    voxel_m: float,
    out: NDArray[np.float32],
) -> None:
    """Unbiased positions for the moments: the voxel's center for several returns.

    Of several returns the one nearest to the sensor was kept; it lies in front of their mean.

    Args:
        xyz: Points [m], (N, 3).
        returns: Returns in the voxel of each, (N,).
        voxel_m: Edge of a voxel [m].
        out: Receives the positions [m], (N, 3).
    """
    for p in range(len(xyz)):
        for d in range(3):
            out[p, d] = xyz[p, d]
            if returns[p] > 1:
                out[p, d] = (np.floor(xyz[p, d] / voxel_m) + 0.5) * voxel_m


@njit(cache=True, nogil=True, error_model="numpy")
def center_of(cell: int, side: int, cell_m: float) -> tuple[float, float, float]:
    """Center of a cell from the tile's origin [m]."""
    i = cell % side
    j = (cell // side) % side
    k = cell // (side * side)
    return (i - 0.5) * cell_m, (j - 0.5) * cell_m, (k - 0.5) * cell_m


@njit(cache=True, nogil=True, error_model="numpy", inline="always")
def neighbor(cell: int, k: int, side: int, where: NDArray[np.int32]) -> int:
    """Row of the k-th of the 3 x 3 x 3 cells around a cell, negative = empty; 13 is the cell."""
    at = cell + ((k // 9 - 1) * side + k // 3 % 3 - 1) * side + k % 3 - 1
    if at < 0 or at >= len(where):
        return -1
    return where[at]


@njit(cache=True, nogil=True, error_model="numpy", inline="always")
def main_axis(normal: NDArray[np.float64]) -> int:
    """The axis nearest to a direction."""
    along = 0
    for d in range(1, 3):
        if abs(normal[d]) > abs(normal[along]):
            along = d
    return along


@njit(cache=True, nogil=True, error_model="numpy", inline="always")
def in_column(di: int, dj: int, dk: int, along: int) -> bool:
    """Whether a neighbor lies in the same column of cells along an axis."""
    return (along == 0 or di == 0) and (along == 1 or dj == 0) and (along == 2 or dk == 0)


@njit(cache=True, nogil=True, error_model="numpy", inline="always")
def distance_in_front(
    plane: NDArray[np.float64], xyz: NDArray[np.float32], to_sensor: NDArray[np.float32], p: int
) -> float:
    """Signed distance of a point to an oriented plane [m]; inf if it was seen from behind."""
    if plane[0] * to_sensor[p, 0] + plane[1] * to_sensor[p, 1] + plane[2] * to_sensor[p, 2] <= 0.0:
        return np.inf
    return plane[0] * xyz[p, 0] + plane[1] * xyz[p, 1] + plane[2] * xyz[p, 2] - plane[3]
