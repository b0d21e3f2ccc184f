"""Kernels of fitted surfaces: the plane of a window, and whether its points lie on one sheet."""

from __future__ import annotations

import numpy as np
from numba import njit
from numpy.typing import NDArray

from recon4.kernels.surface_cells import (
    center_of,
    distance_in_front,
    main_axis,
)

_BESIDE = 0.55
"""A plane farther from the middle of its cell does not cross it [cells along the main axis]."""
_THIN = 0.9
"""The shape of distances is not looked at below this part of the least standard deviation."""


@njit(cache=True, nogil=True, error_model="numpy", inline="always")
def write_plane(
    out: NDArray[np.float64], found: NDArray[np.float64], sign: float, total: NDArray[np.float64]
) -> None:
    """Write the plane through moments about the tile's origin.

    Args:
        out: Receives the plane, (PLANE,).
        found: Of `plane_of`, (7,).
        sign: 1, or -1 to turn the normal.
        total: The moments, (MOMENTS,).
    """
    for d in range(4):
        out[d] = sign * found[d]
    out[4] = max(np.sqrt(found[4]), 1e-4)
    out[5] = total[0]
    out[6] = (found[5] - found[4]) / found[6]
    for d in range(3):
        out[7 + d] = total[1 + d] / total[0]


@njit(cache=True, nogil=True, error_model="numpy", inline="always")
def own_offset(plane: NDArray[np.float64], column: NDArray[np.float64], bend_m: float) -> float:
    """Offset of the surface at a cell, which need not be quite flat [m].

    The nearest returns say where it is: those of the cell and of the two beyond it along the
    normal, because noise crosses their borders.

    Args:
        plane: Of the window, (PLANE,).
        column: Weight and weighted sums x y z of the three cells.
        bend_m: Standard deviation of a cell's surface from the plane of its window [m].
    """
    if not column[0] > 0.0:
        return plane[3]
    x, y, z = column[1] / column[0], column[2] / column[0], column[3] / column[0]
    own = plane[0] * x + plane[1] * y + plane[2] * z - plane[3]
    prior = bend_m * bend_m
    return plane[3] + own * prior / (prior + plane[4] * plane[4] / column[0])


@njit(cache=True, nogil=True, error_model="numpy", inline="always")
def is_bent(columns: NDArray[np.float64], plane: NDArray[np.float64], limit_m: float) -> bool:
    """Whether the parts of a window lie on both sides of its plane: an edge, or a round thing.

    Args:
        columns: Weight and weighted sums x y z of the columns of cells along the normal, (9, 4).
        plane: Of `plane_of`, (7,).
        limit_m: Largest root mean square of their distances, beyond what noise explains [m].
    """
    squares = weights = 0.0
    parts = 0
    for j in range(9):
        w = columns[j, 0]
        if w > 0.0:
            away = (
                plane[0] * columns[j, 1] + plane[1] * columns[j, 2] + plane[2] * columns[j, 3]
            ) / w - plane[3]
            squares += w * away * away
            weights += w
            parts += 1
    return squares - parts * plane[4] > weights * limit_m * limit_m


@njit(cache=True, nogil=True, error_model="numpy")
def shape_sums(
    xyz: NDArray[np.float32],
    to_sensor: NDArray[np.float32],
    weight: NDArray[np.float32],
    starts: NDArray[np.int32],
    planes: NDArray[np.float64],
    reach_m: float,
    sums: NDArray[np.float64],
) -> None:
    """Powers 0 to 4 of the distances of each cell's points to each of its planes.

    Args:
        xyz: Points [m], (N, 3).
        to_sensor: Vectors to the sensor [m], (N, 3).
        weight: Of each point, (N,).
        starts: Of `find_cells`, (C + 1,).
        planes: (C, K, PLANE).
        reach_m: Farther points are left out [m].
        sums: Receives the sums, (C, K, 5).
    """
    for c in range(len(planes)):
        for s in range(planes.shape[1]):
            s0 = s1 = s2 = s3 = s4 = 0.0
            plane = planes[c, s]
            if plane[4] > 0.0:
                for p in range(starts[c], starts[c + 1]):
                    away = distance_in_front(plane, xyz, to_sensor, p)
                    if abs(away) < reach_m:
                        power = np.float64(weight[p])
                        s0 += power
                        power *= away
                        s1 += power
                        power *= away
                        s2 += power
                        power *= away
                        s3 += power
                        s4 += power * away
            sums[c, s] = (s0, s1, s2, s3, s4)


@njit(cache=True, nogil=True, error_model="numpy", inline="always")
def is_one_sheet(sums: NDArray[np.float64], least_m: float, limit: float) -> bool:
    """Whether distances can be the noise of one surface, by their skewness and kurtosis.

    Two sheets closer than twice the noise have one peak, but it is flat or oblique.

    Args:
        sums: Powers 0 to 4, (5,).
        least_m: A standard deviation below this is always one surface [m].
        limit: Largest absolute skewness and smallest excess kurtosis of one surface, beyond twice
            their standard deviations.
    """
    n = sums[0]
    if n < 8.0:
        return True
    a = sums[1] / n
    two = sums[2] / n - a * a
    if two < least_m * least_m:
        return True
    three = sums[3] / n - 3.0 * a * sums[2] / n + 2.0 * a**3
    four = sums[4] / n - 4.0 * a * sums[3] / n + 6.0 * a * a * sums[2] / n - 3.0 * a**4
    skew = abs(three) / two**1.5
    excess = four / (two * two) - 3.0
    return bool(skew < limit + np.sqrt(6.0 / n) and excess > -limit - np.sqrt(24.0 / n))


@njit(cache=True, nogil=True, error_model="numpy")
def drop_mixed(
    cells: NDArray[np.int32],
    side: int,
    halo: int,
    cell_m: float,
    begin: NDArray[np.int32],
    near: NDArray[np.int32],
    sums: NDArray[np.float64],
    least_m: float,
    limit: float,
    planes: NDArray[np.float64],
    kept: NDArray[np.bool_],
) -> None:
    """Find planes that more than one surface has been put into, by the 3 x 3 x 3 cells around.

    Planes beside their cell are dropped too: they were fitted to the end of a surface's noise, and
    behind an edge to that of two.

    Args:
        cells: Of `find_cells`, (C,).
        side: Cells along tile and halo.
        halo: Cells of the halo.
        cell_m: Edge of a cell [m].
        begin: Of `list_neighbors`, (C + 1,).
        near: Of `list_neighbors`.
        sums: Of `shape_sums`, (C, 2, 5).
        least_m: As in `is_one_sheet`.
        limit: As in `is_one_sheet`.
        planes: Of both sides, (C, 2, PLANE).
        kept: Receives which of them are one surface, (C, 2).
    """
    total = np.zeros(5)
    for c in range(len(planes)):
        cx, cy, cz = center_of(cells[c], side, halo, cell_m)
        for s in range(2):
            mine = planes[c, s]
            kept[c, s] = mine[4] > 0.0
            away = mine[0] * cx + mine[1] * cy + mine[2] * cz - mine[3]
            if abs(away) > _BESIDE * cell_m * abs(mine[main_axis(mine)]):
                kept[c, s] = False
                continue
            if mine[4] < _THIN * least_m:
                continue
            t0 = t1 = t2 = t3 = t4 = 0.0
            nx, ny, nz = mine[0], mine[1], mine[2]
            for k in range(begin[c], begin[c + 1]):
                o = near[k]
                for t in range(2):
                    q = planes[o, t]
                    if q[4] > 0.0 and nx * q[0] + ny * q[1] + nz * q[2] > 0.97:
                        t0 += sums[o, t, 0]
                        t1 += sums[o, t, 1]
                        t2 += sums[o, t, 2]
                        t3 += sums[o, t, 3]
                        t4 += sums[o, t, 4]
            total[:] = (t0, t1, t2, t3, t4)
            kept[c, s] = is_one_sheet(total, least_m, limit)
