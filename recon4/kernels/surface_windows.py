"""Kernels of fitted surfaces: planes through the returns in 3 x 3 x 3 cells."""

from __future__ import annotations

import numpy as np
from numba import njit
from numpy.typing import NDArray

from recon4.kernels.moments import MOMENTS, add_moved, add_point, plane_of
from recon4.kernels.surface_cells import (
    center_of,
    distance_in_front,
    in_column,
    main_axis,
    neighbor,
)


@njit(cache=True, nogil=True, error_model="numpy")
def side_moments(
    xyz: NDArray[np.float32],
    to_sensor: NDArray[np.float32],
    weight: NDArray[np.float32],
    starts: NDArray[np.int32],
    cells: NDArray[np.int32],
    side: int,
    cell_m: float,
    normals: NDArray[np.float64],
    planes: NDArray[np.float64],
    gate: float,
    moments: NDArray[np.float64],
    views: NDArray[np.float64],
) -> None:
    """Moments of each cell by the side its returns were seen from.

    Args:
        xyz: Points [m], (N, 3).
        to_sensor: Vectors to the sensor [m], (N, 3).
        weight: Of each point, (N,).
        starts: Of `find_cells`, (C + 1,).
        cells: Of `find_cells`, (C,).
        side: Cells along tile and halo.
        cell_m: Edge of a cell [m].
        normals: That define the two sides of each cell, zeros = one side only, (C, 3).
        planes: Planes of both sides: points farther away than ``gate`` are left out, (C, 2, PLANE).
        gate: In standard deviations; 0 = all points.
        moments: Receives the sums, (C, 2, MOMENTS).
        views: Receives the sums of the unit vectors to the sensor, (C, 2, 3).
    """
    moments[:] = 0.0
    views[:] = 0.0
    for c in range(len(cells)):
        cx, cy, cz = center_of(cells[c], side, cell_m)
        nx, ny, nz = normals[c]
        for p in range(starts[c], starts[c + 1]):
            dot = nx * to_sensor[p, 0] + ny * to_sensor[p, 1] + nz * to_sensor[p, 2]
            s = 1 if dot < 0.0 else 0
            plane = planes[c, s]
            if gate > 0.0 and plane[4] > 0.0:
                away = plane[0] * xyz[p, 0] + plane[1] * xyz[p, 1] + plane[2] * xyz[p, 2] - plane[3]
                if abs(away) > gate * plane[4]:
                    continue
            add_point(moments[c, s], weight[p], xyz[p, 0] - cx, xyz[p, 1] - cy, xyz[p, 2] - cz)
            x, y, z = to_sensor[p, 0], to_sensor[p, 1], to_sensor[p, 2]
            scale = weight[p] / np.sqrt(x * x + y * y + z * z + 1e-6)
            views[c, s, 0] += scale * x
            views[c, s, 1] += scale * y
            views[c, s, 2] += scale * z


@njit(cache=True, nogil=True, error_model="numpy")
def view_axes(
    to_sensor: NDArray[np.float32],
    weight: NDArray[np.float32],
    starts: NDArray[np.int32],
    planes: NDArray[np.float64],
    axes: NDArray[np.float64],
) -> None:
    """Replace the normal of cells without a plane by the main axis of the directions to the sensor.

    The two faces of a thin wall have one common window and no clear normal; they were seen from
    opposite directions, which separates them.

    Args:
        to_sensor: Vectors to the sensor [m], (N, 3).
        weight: Of each point, (N,).
        starts: Of `find_cells`, (C + 1,).
        planes: Of `window_planes`, (C, 2, PLANE).
        axes: Normals of the cells, changed in place, (C, 3).
    """
    m = np.zeros((3, 3))
    v, u = np.zeros(3), np.zeros(3)
    for c in range(len(planes)):
        if planes[c, 0, 4] > 0.0 or planes[c, 1, 4] > 0.0:
            continue
        m[:] = 0.0
        for p in range(starts[c], starts[c + 1]):
            squared = 0.0
            for d in range(3):
                squared += to_sensor[p, d] ** 2
            for d in range(3):
                for e in range(3):
                    m[d, e] += weight[p] / squared * to_sensor[p, d] * to_sensor[p, e]
        v[0], v[1], v[2] = 0.6, 0.64, 0.48
        for _ in range(12):
            norm = 0.0
            for d in range(3):
                u[d] = m[d, 0] * v[0] + m[d, 1] * v[1] + m[d, 2] * v[2]
                norm += u[d] * u[d]
            if not norm > 0.0:
                break
            for d in range(3):
                v[d] = u[d] / np.sqrt(norm)
        axes[c, :] = v


@njit(cache=True, nogil=True, error_model="numpy")
def window_planes(
    cells: NDArray[np.int32],
    where: NDArray[np.int32],
    side: int,
    cell_m: float,
    normals: NDArray[np.float64],
    moments: NDArray[np.float64],
    views: NDArray[np.float64],
    least_cos: float,
    limits: NDArray[np.float64],
    planes: NDArray[np.float64],
) -> None:
    """Planes through the 3 x 3 x 3 cells around each cell, for both sides.

    Args:
        cells: Of `find_cells`, (C,).
        where: Of `find_cells`.
        side: Cells along tile and halo.
        cell_m: Edge of a cell [m].
        normals: Of each cell, (C, 3).
        moments: Of `side_moments`, (C, 2, MOMENTS).
        views: Of `side_moments`, (C, 2, 3).
        least_cos: Cells whose normals differ more are left out.
        limits: Least weight, largest standard deviation across [m], least along [m], the limit of
            `is_bent` [m], ratio of the variance that does not depend on the incidence angle, (5,).
        planes: Receives the planes; 0 as standard deviation = none, (C, 2, PLANE).
    """
    total = np.zeros(MOMENTS)
    found = np.zeros(7)
    columns, view = np.zeros((9, 4)), np.zeros(3)
    for c in range(len(cells)):
        for s in range(2):
            planes[c, s, 4] = 0.0
            if moments[c, s, 0] <= 0.0:
                continue
            total[:] = 0.0
            columns[:] = 0.0
            view[:] = 0.0
            along = main_axis(normals[c])
            for k in range(27):
                o = neighbor(cells[c], k, side, where)
                if o < 0:
                    continue
                di, dj, dk = k % 3 - 1, k // 3 % 3 - 1, k // 9 - 1
                dot = (
                    normals[c, 0] * normals[o, 0]
                    + normals[c, 1] * normals[o, 1]
                    + normals[c, 2] * normals[o, 2]
                )
                # Noise crosses the borders along the normal: a tail alone is no surface.
                if abs(dot) < least_cos and not in_column(di, dj, dk, along):
                    continue
                t = s if dot >= 0.0 else 1 - s
                m = moments[o, t]
                if m[0] > 0.0:
                    view += views[o, t]
                    add_moved(total, m, di * cell_m, dj * cell_m, dk * cell_m)
                    j = k // 3 if along == 0 else k % 3 + k // 9 * 3 if along == 1 else k % 9
                    columns[j, 0] += m[0]
                    columns[j, 1] += m[1] + m[0] * di * cell_m
                    columns[j, 2] += m[2] + m[0] * dj * cell_m
                    columns[j, 3] += m[3] + m[0] * dk * cell_m
            if total[0] < limits[0] or not plane_of(total, found):
                continue
            if is_bent(columns, found, limits[3]):
                continue
            # Noise lies along the beam: across a surface seen obliquely it is less.
            facing = found[0] * view[0] + found[1] * view[1] + found[2] * view[2]
            facing = min(1.0, (facing / total[0]) ** 2 + limits[4])
            if found[4] > facing * limits[1] ** 2 or found[5] < limits[2] ** 2:
                continue
            sign = 1.0
            dot = found[0] * normals[c, 0] + found[1] * normals[c, 1] + found[2] * normals[c, 2]
            if (dot < 0.0) != (s == 1):
                sign = -1.0
            cx, cy, cz = center_of(cells[c], side, cell_m)
            p = planes[c, s]
            p[0], p[1], p[2] = sign * found[0], sign * found[1], sign * found[2]
            p[3] = sign * found[3] + p[0] * cx + p[1] * cy + p[2] * cz
            p[4] = max(np.sqrt(found[4]), 1e-4)
            p[5] = total[0]


@njit(cache=True, nogil=True, error_model="numpy")
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
    sums[:] = 0.0
    for c in range(len(planes)):
        for s in range(planes.shape[1]):
            if not planes[c, s, 4] > 0.0:
                continue
            for p in range(starts[c], starts[c + 1]):
                away = distance_in_front(planes[c, s], xyz, to_sensor, p)
                if abs(away) < reach_m:
                    power = np.float64(weight[p])
                    for k in range(5):
                        sums[c, s, k] += power
                        power *= away


@njit(cache=True, nogil=True, error_model="numpy")
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
    where: NDArray[np.int32],
    side: int,
    sums: NDArray[np.float64],
    least_m: float,
    limit: float,
    planes: NDArray[np.float64],
    kept: NDArray[np.float64],
) -> None:
    """Remove planes that more than one surface has been put into, by the 3 x 3 x 3 cells around.

    Args:
        cells: Of `find_cells`, (C,).
        where: Of `find_cells`.
        side: Cells along tile and halo.
        sums: Of `shape_sums`, (C, 2, 5).
        least_m: As in `is_one_sheet`.
        limit: As in `is_one_sheet`.
        planes: Of both sides, (C, 2, PLANE).
        kept: Receives the planes, 0 as standard deviation of those removed, (C, 2, PLANE).
    """
    total = np.zeros(5)
    kept[:] = planes
    for c in range(len(cells)):
        for s in range(2):
            mine = planes[c, s]
            if not mine[4] > 0.0:
                continue
            total[:] = 0.0
            for k in range(27):
                o = neighbor(cells[c], k, side, where)
                if o < 0:
                    continue
                for t in range(2):
                    q = planes[o, t]
                    if q[4] > 0.0 and mine[0] * q[0] + mine[1] * q[1] + mine[2] * q[2] > 0.97:
                        total += sums[o, t]
            if not is_one_sheet(total, least_m, limit):
                kept[c, s, 4] = 0.0
