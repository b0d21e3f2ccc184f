"""Kernels of fitted surfaces: planes through the returns in 3 x 3 x 3 cells."""

from __future__ import annotations

import numpy as np
from numba import njit
from numpy.typing import NDArray

from recon4.kernels.moments import MOMENTS, add_point, plane_of
from recon4.kernels.surface_cells import (
    OWN_COLUMN,
    column_of,
    main_axis,
)
from recon4.kernels.surface_shapes import is_bent, own_offset, write_plane

_CALM_COS = 0.9
"""A window is calm if the normals of its cells differ less from that of its middle."""


@njit(cache=True, nogil=True, error_model="numpy")
def side_moments(
    xyz: NDArray[np.float32],
    to_sensor: NDArray[np.float32],
    weight: NDArray[np.float32],
    starts: NDArray[np.int32],
    normals: NDArray[np.float64],
    todo: NDArray[np.bool_],
    moments: NDArray[np.float64],
    views: NDArray[np.float64],
) -> None:
    """Moments of each cell by the side its returns were seen from, about the tile's origin.

    Args:
        xyz: Points [m], (N, 3).
        to_sensor: Vectors to the sensor [m], (N, 3).
        weight: Of each point, (N,).
        starts: Of `find_cells`, (C + 1,).
        normals: That define the two sides of each cell, zeros = one side only, (C, 3).
        todo: Cells to compute; the others keep their sums, (C,).
        moments: Receives the sums, (C, 2, MOMENTS).
        views: Receives the sums of the unit vectors to the sensor and their weight, (C, 2, 4).
    """
    for c in range(len(todo)):
        if not todo[c]:
            continue
        moments[c] = 0.0
        views[c] = 0.0
        nx, ny, nz = normals[c]
        left = starts[c + 1] - starts[c]
        for s in range(2):
            m0 = m1 = m2 = m3 = m4 = m5 = m6 = m7 = m8 = m9 = vx = vy = vz = 0.0
            if left == 0:
                break
            for p in range(starts[c], starts[c + 1]):
                u, v, w = to_sensor[p, 0], to_sensor[p, 1], to_sensor[p, 2]
                if (nx * u + ny * v + nz * w < 0.0) != (s == 1):
                    continue
                left -= 1
                n = np.float64(weight[p])
                x, y, z = np.float64(xyz[p, 0]), np.float64(xyz[p, 1]), np.float64(xyz[p, 2])
                m0 += n
                m1 += n * x
                m2 += n * y
                m3 += n * z
                m4 += n * x * x
                m5 += n * x * y
                m6 += n * x * z
                m7 += n * y * y
                m8 += n * y * z
                m9 += n * z * z
                scale = n / np.sqrt(u * u + v * v + w * w + np.float32(1e-6))
                vx += scale * u
                vy += scale * v
                vz += scale * w
            moments[c, s] = (m0, m1, m2, m3, m4, m5, m6, m7, m8, m9)
            views[c, s] = (vx, vy, vz, m0)


@njit(cache=True, nogil=True, error_model="numpy")
def window_normals(
    starts: NDArray[np.int32],
    begin: NDArray[np.int32],
    near: NDArray[np.int32],
    moments: NDArray[np.float64],
    views: NDArray[np.float64],
    least: int,
    normals: NDArray[np.float64],
    support: NDArray[np.int32],
) -> None:
    """Normal of the plane through the 3 x 3 x 3 cells around each cell, towards the sensors.

    Args:
        starts: Of `find_cells`, (C + 1,).
        begin: Of `list_neighbors`, (C + 1,).
        near: Of `list_neighbors`.
        moments: Of all points of each cell on the first side, (C, 2, MOMENTS).
        views: Of the same points, (C, 2, 4).
        least: Fewer points have no normal.
        normals: Receives unit normals, or zeros, (C, 3).
        support: Receives the points of the window, (C,).
    """
    total, found = np.zeros(MOMENTS), np.zeros(7)
    for c in range(len(normals)):
        m0 = m1 = m2 = m3 = m4 = m5 = m6 = m7 = m8 = m9 = 0.0
        points = 0
        for q in range(begin[c], begin[c + 1]):
            m = moments[near[q], 0]
            m0 += m[0]
            m1 += m[1]
            m2 += m[2]
            m3 += m[3]
            m4 += m[4]
            m5 += m[5]
            m6 += m[6]
            m7 += m[7]
            m8 += m[8]
            m9 += m[9]
            points += starts[near[q] + 1] - starts[near[q]]
        support[c] = points
        normals[c] = 0.0
        total[:] = (m0, m1, m2, m3, m4, m5, m6, m7, m8, m9)
        if points < least or not plane_of(total, found):
            continue
        v = views[c, 0]
        sign = -1.0 if found[0] * v[0] + found[1] * v[1] + found[2] * v[2] < 0.0 else 1.0
        for d in range(3):
            normals[c, d] = sign * found[d]


@njit(cache=True, nogil=True, error_model="numpy")
def seen_from_behind(
    to_sensor: NDArray[np.float32],
    starts: NDArray[np.int32],
    normals: NDArray[np.float64],
    out: NDArray[np.bool_],
) -> None:
    """Mark the cells with returns from behind their normal.

    Args:
        to_sensor: Vectors to the sensor [m], (N, 3).
        starts: Of `find_cells`, (C + 1,).
        normals: Of each cell, (C, 3).
        out: Receives the marks, (C,).
    """
    for c in range(len(normals)):
        nx, ny, nz = normals[c]
        out[c] = False
        for p in range(starts[c], starts[c + 1]):
            out[c] |= nx * to_sensor[p, 0] + ny * to_sensor[p, 1] + nz * to_sensor[p, 2] < 0.0


@njit(cache=True, nogil=True, error_model="numpy")
def near_moments(
    xyz: NDArray[np.float32],
    to_sensor: NDArray[np.float32],
    weight: NDArray[np.float32],
    starts: NDArray[np.int32],
    normals: NDArray[np.float64],
    planes: NDArray[np.float64],
    gate: float,
    moments: NDArray[np.float64],
) -> None:
    """Take the points far from the planes of their cells out of the moments.

    Args:
        xyz: Points [m], (N, 3).
        to_sensor: Vectors to the sensor [m], (N, 3).
        weight: Of each point, (N,).
        starts: Of `find_cells`, (C + 1,).
        normals: That define the two sides of each cell, (C, 3).
        planes: Planes of both sides, (C, 2, PLANE).
        gate: Farther points are taken out [standard deviations].
        moments: Of `side_moments`, changed in place, (C, 2, MOMENTS).
    """
    for c in range(len(planes)):
        nx, ny, nz = normals[c]
        for s in range(2):
            if not planes[c, s, 4] > 0.0:
                continue
            u, v, w, offset = planes[c, s, 0], planes[c, s, 1], planes[c, s, 2], planes[c, s, 3]
            reach = gate * planes[c, s, 4]
            for p in range(starts[c], starts[c + 1]):
                x, y, z = np.float64(xyz[p, 0]), np.float64(xyz[p, 1]), np.float64(xyz[p, 2])
                if abs(u * x + v * y + w * z - offset) <= reach:
                    continue
                dot = nx * to_sensor[p, 0] + ny * to_sensor[p, 1] + nz * to_sensor[p, 2]
                if (dot < 0.0) == (s == 1):
                    add_point(moments[c, s], -np.float64(weight[p]), x, y, z)
            # Weights are whole numbers: what is left of none is rounding.
            if moments[c, s, 0] < 0.5:
                moments[c, s] = 0.0


@njit(cache=True, nogil=True, error_model="numpy")
def view_axes(
    to_sensor: NDArray[np.float32],
    weight: NDArray[np.float32],
    starts: NDArray[np.int32],
    planes: NDArray[np.float64],
    axes: NDArray[np.float64],
    changed: NDArray[np.bool_],
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
        changed: Receives which cells, (C,).
    """
    m = np.zeros((3, 3))
    v, u = np.zeros(3), np.zeros(3)
    for c in range(len(planes)):
        changed[c] = not (planes[c, 0, 4] > 0.0 or planes[c, 1, 4] > 0.0)
        if not changed[c]:
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
def around(
    marked: NDArray[np.bool_],
    begin: NDArray[np.int32],
    near: NDArray[np.int32],
    out: NDArray[np.bool_],
) -> None:
    """Mark the cells with a marked one among the 3 x 3 x 3 around them.

    Args:
        marked: Cells, (C,).
        begin: Of `list_neighbors`, (C + 1,).
        near: Of `list_neighbors`.
        out: Receives the marks, (C,).
    """
    for c in range(len(marked)):
        out[c] = False
        for q in range(begin[c], begin[c + 1]):
            out[c] |= marked[near[q]]


@njit(cache=True, nogil=True, error_model="numpy")
def window_planes(
    begin: NDArray[np.int32],
    near: NDArray[np.int32],
    at: NDArray[np.uint8],
    normals: NDArray[np.float64],
    moments: NDArray[np.float64],
    views: NDArray[np.float64],
    least_cos: float,
    limits: NDArray[np.float64],
    todo: NDArray[np.bool_],
    planes: NDArray[np.float64],
    calm: NDArray[np.bool_],
) -> None:
    """Planes through the 3 x 3 x 3 cells around each cell, for both sides.

    Args:
        begin: Of `list_neighbors`, (C + 1,).
        near: Of `list_neighbors`.
        at: Of `list_neighbors`.
        normals: Of each cell, (C, 3).
        moments: Of `side_moments`, (C, 2, MOMENTS).
        views: Of `side_moments`, (C, 2, 4).
        least_cos: Cells whose normals differ more are left out.
        limits: Least weight, largest standard deviation across [m], least along [m], the limit of
            `is_bent` [m], ratio of the variance that does not depend on the incidence angle,
            standard deviation of a cell's own offset [m], least weight beside all returns of the
            window, (7,).
        todo: Cells to compute; the others keep their planes, (C,).
        planes: Receives the planes; 0 as standard deviation = none, (C, 2, PLANE).
        calm: Receives whether all cells of the window have similar normals, (C,).
    """
    total, found, columns = np.zeros(MOMENTS), np.zeros(7), np.zeros((9, 4))
    for c in range(len(todo)):
        if not todo[c]:
            continue
        quiet = True
        nx, ny, nz = normals[c]
        along = main_axis(normals[c])
        for s in range(2):
            planes[c, s, 4] = 0.0
            if moments[c, s, 0] <= 0.0:
                continue
            m0 = m1 = m2 = m3 = m4 = m5 = m6 = m7 = m8 = m9 = vx = vy = vz = vw = 0.0
            every = 0.0
            columns[:] = 0.0
            for q in range(begin[c], begin[c + 1]):
                o = near[q]
                every += moments[o, 0, 0] + moments[o, 1, 0]
                j = column_of(at[q], along)
                dot = nx * normals[o, 0] + ny * normals[o, 1] + nz * normals[o, 2]
                quiet &= abs(dot) > _CALM_COS
                # Noise crosses the borders along the normal: a tail alone is no surface.
                if abs(dot) < least_cos and j != OWN_COLUMN:
                    continue
                t = s if dot >= 0.0 else 1 - s
                m = moments[o, t]
                if not m[0] > 0.0:
                    continue
                m0 += m[0]
                m1 += m[1]
                m2 += m[2]
                m3 += m[3]
                m4 += m[4]
                m5 += m[5]
                m6 += m[6]
                m7 += m[7]
                m8 += m[8]
                m9 += m[9]
                vx += views[o, t, 0]
                vy += views[o, t, 1]
                vz += views[o, t, 2]
                vw += views[o, t, 3]
                columns[j, 0] += m[0]
                columns[j, 1] += m[1]
                columns[j, 2] += m[2]
                columns[j, 3] += m[3]
            total[:] = (m0, m1, m2, m3, m4, m5, m6, m7, m8, m9)
            # A chance plane through the tail of another surface's noise has few of the returns.
            if m0 < max(limits[0], limits[6] * every) or not plane_of(total, found):
                continue
            if is_bent(columns, found, limits[3]):
                continue
            # Noise lies along the beam: across a surface seen obliquely it is less.
            facing = (found[0] * vx + found[1] * vy + found[2] * vz) / vw
            facing = min(1.0, facing * facing + limits[4])
            if found[4] > facing * limits[1] ** 2 or found[5] < limits[2] ** 2:
                continue
            sign = 1.0
            if (found[0] * nx + found[1] * ny + found[2] * nz < 0.0) != (s == 1):
                sign = -1.0
            write_plane(planes[c, s], found, sign, total)
            planes[c, s, 10] = own_offset(planes[c, s], columns[OWN_COLUMN], limits[5])
        calm[c] = quiet
