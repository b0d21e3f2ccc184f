"""Kernels of fitted surfaces: the plane of a window, and whether its points lie on one sheet."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numba import njit
from numpy.typing import NDArray

from recon4.kernels.surface_cells import center_of, distance_in_front, main_axis
from recon4.kernels.surface_records import PLANE, Cells, Neighbors, Returns


class ShapeLimits(NamedTuple):
    """Which planes are looked at."""

    beside: float = 0.55
    """A plane farther from the middle of its cell does not cross it [cells along the main axis]."""
    thin: float = 0.9
    """The shape of distances is not looked at below this part of the least standard deviation."""


SHAPES = ShapeLimits()


@njit(cache=True, nogil=True, error_model="numpy", inline="always")
def write_plane(
    out: NDArray[np.float64], fitted: NDArray[np.float64], sign: float, total: NDArray[np.float64]
) -> None:
    """Write the plane through moments about the tile's origin.

    Args:
        out: Receives the plane, (11,).
        fitted: Of `plane_of`, (7,).
        sign: 1, or -1 to turn the normal.
        total: The moments, (MOMENTS,).
    """
    for d in range(4):
        out[d] = sign * fitted[d]
    out[PLANE.sigma] = max(np.sqrt(fitted[4]), 1e-4)
    out[PLANE.weight] = total[0]
    out[PLANE.planarity] = (fitted[5] - fitted[4]) / fitted[6]
    for d in range(3):
        out[PLANE.middle + d] = total[1 + d] / total[0]


@njit(cache=True, nogil=True, error_model="numpy", inline="always")
def own_offset(plane: NDArray[np.float64], column: NDArray[np.float64], bend_m: float) -> float:
    """Offset of the surface at a cell, which need not be quite flat [m].

    The nearest returns say where it is: those of the cell and of the two beyond it along the
    normal, because noise crosses their borders.

    Args:
        plane: Of the window, (11,).
        column: Weight and weighted sums x y z of the three cells.
        bend_m: Standard deviation of a cell's surface from the plane of its window [m].
    """
    if not column[0] > 0.0:
        return plane[PLANE.offset]
    offset, sigma = plane[PLANE.offset], plane[PLANE.sigma]
    x, y, z = column[1] / column[0], column[2] / column[0], column[3] / column[0]
    own = plane[0] * x + plane[1] * y + plane[2] * z - offset
    prior = bend_m * bend_m
    return offset + own * prior / (prior + sigma * sigma / column[0])


@njit(cache=True, nogil=True, error_model="numpy", inline="always")
def is_bent(columns: NDArray[np.float64], fitted: NDArray[np.float64], limit_m: float) -> bool:
    """Whether the parts of a window lie on both sides of its plane: an edge, or a round thing.

    Args:
        columns: Weight and weighted sums x y z of the columns of cells along the normal, (9, 4).
        fitted: Of `plane_of`, (7,).
        limit_m: Largest root mean square of their distances, beyond what noise explains [m].
    """
    squares = weights = 0.0
    parts = 0
    for j in range(9):
        w = columns[j, 0]
        if w > 0.0:
            away = (
                fitted[0] * columns[j, 1] + fitted[1] * columns[j, 2] + fitted[2] * columns[j, 3]
            ) / w - fitted[PLANE.offset]
            squares += w * away * away
            weights += w
            parts += 1
    return squares - parts * fitted[4] > weights * limit_m * limit_m


@njit(cache=True, nogil=True, error_model="numpy")
def shape_sums(
    returns: Returns, planes: NDArray[np.float64], reach_m: float, sums: NDArray[np.float64]
) -> None:
    """Powers 0 to 4 of the distances of each cell's points to each of its planes.

    Args:
        returns: Of the tile.
        planes: (C, K, 11).
        reach_m: Farther points are left out [m].
        sums: Receives the sums, (C, K, 5).
    """
    first = returns.first
    for c in range(len(planes)):
        for s in range(planes.shape[1]):
            s0 = s1 = s2 = s3 = s4 = 0.0
            plane = planes[c, s]
            if plane[PLANE.sigma] > 0.0:
                for p in range(first[c], first[c + 1]):
                    away = distance_in_front(plane, returns, p)
                    if abs(away) < reach_m:
                        power = np.float64(returns.weight[p])
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
        limit: Largest absolute skewness and smallest excess kurtosis of one surface, beyond one
            standard deviation of theirs.
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
    cells: Cells,
    neighbors: Neighbors,
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
        cells: Of `find_cells`.
        neighbors: Of `list_neighbors`.
        sums: Of `shape_sums`, (C, 2, 5).
        least_m: As in `is_one_sheet`.
        limit: As in `is_one_sheet`.
        planes: Of both sides, (C, 2, 11).
        kept: Receives which of them are one surface, (C, 2).
    """
    total = np.zeros(5)
    for c in range(len(planes)):
        cx, cy, cz = center_of(c, cells)
        for s in range(2):
            mine = planes[c, s]
            kept[c, s] = mine[PLANE.sigma] > 0.0
            away = mine[0] * cx + mine[1] * cy + mine[2] * cz - mine[PLANE.offset]
            if abs(away) > SHAPES.beside * cells.edge_m * abs(mine[main_axis(mine)]):
                kept[c, s] = False
                continue
            if mine[PLANE.sigma] < SHAPES.thin * least_m:
                continue
            t0 = t1 = t2 = t3 = t4 = 0.0
            nx, ny, nz = mine[0], mine[1], mine[2]
            for k in range(neighbors.first[c], neighbors.first[c + 1]):
                o = neighbors.row[k]
                for t in range(2):
                    q = planes[o, t]
                    if q[PLANE.sigma] > 0.0 and nx * q[0] + ny * q[1] + nz * q[2] > 0.97:
                        t0 += sums[o, t, 0]
                        t1 += sums[o, t, 1]
                        t2 += sums[o, t, 2]
                        t3 += sums[o, t, 3]
                        t4 += sums[o, t, 4]
            total[:] = (t0, t1, t2, t3, t4)
            kept[c, s] = is_one_sheet(total, least_m, limit)
