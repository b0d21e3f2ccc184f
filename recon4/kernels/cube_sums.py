"""Kernels of sums over the points in the cubes of a grid."""

from __future__ import annotations

import numpy as np
from numba import njit
from numpy.typing import NDArray


@njit(cache=True, nogil=True, error_model="numpy")
def sort_into_cubes(
    p: NDArray[np.float64],
    edge_m: float,
    grid: NDArray[np.int64],
    local_m: NDArray[np.float64],
    key: NDArray[np.int64],
    count: NDArray[np.int64],
) -> None:
    """Number the cube of each point, and count the points of each cube.

    Args:
        p: Points [m], (N, 3).
        edge_m: Edge of a cube [m].
        grid: First cube and number of cubes along each axis, (2, 3).
        local_m: Receives the points from the middles of their cubes [m], (N, 3).
        key: Receives the numbers, in the order of the cubes, (N,).
        count: Points of each cube, zeros at first, (K,).
    """
    for n in range(len(p)):
        number = 0
        for axis in range(3):
            cube = np.floor(p[n, axis] / edge_m)
            local_m[n, axis] = p[n, axis] - (cube + 0.5) * edge_m
            number = number * grid[1, axis] + np.int64(cube) - grid[0, axis]
        key[n] = number
        count[number] += 1


@njit(cache=True, nogil=True, error_model="numpy")
def add_to_cubes(
    local_m: NDArray[np.float64],
    middle_m: NDArray[np.float64],
    row: NDArray[np.int32],
    key: NDArray[np.int64],
    sums: NDArray[np.float64],
) -> None:
    """Add coordinates and their products, in the order of the points.

    Args:
        local_m: Points from the middles of their cubes [m], (N, 3).
        middle_m: Subtracted from them [m], (3,).
        row: Row of the sums of each cube, -1 = none, (K,).
        key: Cube of each point, (N,).
        sums: x y z xx xy xz yy yz zz [m, m²], zeros at first, (C, 9).
    """
    for n in range(len(local_m)):
        c = row[key[n]]
        if c < 0:
            continue
        x = local_m[n, 0] - middle_m[0]
        y = local_m[n, 1] - middle_m[1]
        z = local_m[n, 2] - middle_m[2]
        sums[c, 0] += x
        sums[c, 1] += y
        sums[c, 2] += z
        sums[c, 3] += x * x
        sums[c, 4] += x * y
        sums[c, 5] += x * z
        sums[c, 6] += y * y
        sums[c, 7] += y * z
        sums[c, 8] += z * z
