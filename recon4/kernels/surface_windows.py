"""Kernels of fitted surfaces: planes through the returns in 3 x 3 x 3 cells."""

from __future__ import annotations

import numpy as np
from numba import njit
from numpy.typing import NDArray

from recon4.kernels.moments import MOMENTS, add_point, plane_of
from recon4.kernels.surface_cells import OWN_COLUMN, column_of, main_axis
from recon4.kernels.surface_records import PLANE, Neighbors, PlaneLimits, Returns, Sides
from recon4.kernels.surface_shapes import is_bent, own_offset, write_plane

_CALM_COS = 0.9
"""A window is calm if the normals of its cells differ less from that of its middle."""


@njit(cache=True, nogil=True, error_model="numpy")
def side_moments(returns: Returns, todo: NDArray[np.bool_], sides: Sides) -> None:
    """Sums of each cell's returns by the side they were seen from, about the tile's origin.

    Args:
        returns: Of the tile.
        todo: Cells to compute; the others keep their sums, (C,).
        sides: Its axes define the sides; receives the sums.
    """
    xyz, to_sensor, weight, first = returns
    axis, moments, views = sides
    for c in range(len(todo)):
        if not todo[c]:
            continue
        moments[c] = 0.0
        views[c] = 0.0
        nx, ny, nz = axis[c]
        left = first[c + 1] - first[c]
        for s in range(2):
            m0 = m1 = m2 = m3 = m4 = m5 = m6 = m7 = m8 = m9 = vx = vy = vz = 0.0
            if left == 0:
                break
            for p in range(first[c], first[c + 1]):
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
    returns: Returns,
    neighbors: Neighbors,
    sides: Sides,
    least: int,
    support: NDArray[np.int32],
) -> None:
    """Normal of the plane through the 3 x 3 x 3 cells around each cell, towards the sensors.

    Args:
        returns: Of the tile.
        neighbors: Of `list_neighbors`.
        sides: Sums of all points of a cell on its first side; its axes receive the normals, zeros
            where there is none.
        least: Fewer points have no normal.
        support: Receives the points of the window, (C,).
    """
    first, (axis, moments, views) = returns.first, sides
    total, fitted = np.zeros(MOMENTS), np.zeros(7)
    for c in range(len(axis)):
        m0 = m1 = m2 = m3 = m4 = m5 = m6 = m7 = m8 = m9 = 0.0
        points = 0
        for q in range(neighbors.first[c], neighbors.first[c + 1]):
            m = moments[neighbors.row[q], 0]
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
            points += first[neighbors.row[q] + 1] - first[neighbors.row[q]]
        support[c] = points
        axis[c] = 0.0
        total[:] = (m0, m1, m2, m3, m4, m5, m6, m7, m8, m9)
        if points < least or not plane_of(total, fitted):
            continue
        v = views[c, 0]
        sign = -1.0 if fitted[0] * v[0] + fitted[1] * v[1] + fitted[2] * v[2] < 0.0 else 1.0
        for d in range(3):
            axis[c, d] = sign * fitted[d]


@njit(cache=True, nogil=True, error_model="numpy")
def seen_from_behind(returns: Returns, axis: NDArray[np.float64], out: NDArray[np.bool_]) -> None:
    """Mark the cells with returns from behind their normal.

    Args:
        returns: Of the tile.
        axis: Normal of each cell, (C, 3).
        out: Receives the marks, (C,).
    """
    to_sensor, first = returns.to_sensor, returns.first
    for c in range(len(axis)):
        nx, ny, nz = axis[c]
        out[c] = False
        for p in range(first[c], first[c + 1]):
            out[c] |= nx * to_sensor[p, 0] + ny * to_sensor[p, 1] + nz * to_sensor[p, 2] < 0.0


@njit(cache=True, nogil=True, error_model="numpy")
def near_moments(returns: Returns, planes: NDArray[np.float64], gate: float, sides: Sides) -> None:
    """Take the points far from the planes of their cells out of the moments.

    Args:
        returns: Of the tile.
        planes: Planes of both sides, (C, 2, 11).
        gate: Farther points are taken out [standard deviations].
        sides: Of `side_moments`; the moments are changed in place.
    """
    xyz, to_sensor, weight, first = returns
    axis, moments, _ = sides
    for c in range(len(planes)):
        nx, ny, nz = axis[c]
        for s in range(2):
            if not planes[c, s, PLANE.sigma] > 0.0:
                continue
            u, v, w, offset = (
                planes[c, s, 0],
                planes[c, s, 1],
                planes[c, s, 2],
                planes[c, s, PLANE.offset],
            )
            reach = gate * planes[c, s, PLANE.sigma]
            for p in range(first[c], first[c + 1]):
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
    returns: Returns,
    planes: NDArray[np.float64],
    axis: NDArray[np.float64],
    changed: NDArray[np.bool_],
) -> None:
    """Replace the normal of cells without a plane by the main axis of the directions to the sensor.

    The two faces of a thin wall have one common window and no clear normal; they were seen from
    opposite directions, which separates them.

    Args:
        returns: Of the tile.
        planes: Of `window_planes`, (C, 2, 11).
        axis: Of the cells, changed in place, (C, 3).
        changed: Receives which cells, (C,).
    """
    _, to_sensor, weight, first = returns
    m = np.zeros((3, 3))
    v, u = np.zeros(3), np.zeros(3)
    for c in range(len(planes)):
        changed[c] = not (planes[c, 0, PLANE.sigma] > 0.0 or planes[c, 1, PLANE.sigma] > 0.0)
        if not changed[c]:
            continue
        m[:] = 0.0
        for p in range(first[c], first[c + 1]):
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
        axis[c, :] = v


@njit(cache=True, nogil=True, error_model="numpy")
def around(marked: NDArray[np.bool_], neighbors: Neighbors, out: NDArray[np.bool_]) -> None:
    """Mark the cells with a marked one among the 3 x 3 x 3 around them.

    Args:
        marked: Cells, (C,).
        neighbors: Of `list_neighbors`.
        out: Receives the marks, (C,).
    """
    for c in range(len(marked)):
        out[c] = False
        for q in range(neighbors.first[c], neighbors.first[c + 1]):
            out[c] |= marked[neighbors.row[q]]


@njit(cache=True, nogil=True, error_model="numpy")
def window_planes(
    neighbors: Neighbors,
    sides: Sides,
    least_cos: float,
    limits: PlaneLimits,
    todo: NDArray[np.bool_],
    planes: NDArray[np.float64],
    calm: NDArray[np.bool_],
) -> None:
    """Planes through the 3 x 3 x 3 cells around each cell, for both sides.

    Args:
        neighbors: Of `list_neighbors`.
        sides: Of `side_moments`.
        least_cos: Cells whose normals differ more are left out.
        limits: What is a plane.
        todo: Cells to compute; the others keep their planes, (C,).
        planes: Receives the planes, (C, 2, 11).
        calm: Receives whether all cells of the window have similar normals, (C,).
    """
    axis, moments, views = sides
    total, fitted, columns = np.zeros(MOMENTS), np.zeros(7), np.zeros((9, 4))
    for c in range(len(todo)):
        if not todo[c]:
            continue
        quiet = True
        nx, ny, nz = axis[c]
        along = main_axis(axis[c])
        for s in range(2):
            planes[c, s, PLANE.sigma] = 0.0
            if moments[c, s, 0] <= 0.0:
                continue
            m0 = m1 = m2 = m3 = m4 = m5 = m6 = m7 = m8 = m9 = vx = vy = vz = vw = 0.0
            every = 0.0
            columns[:] = 0.0
            for q in range(neighbors.first[c], neighbors.first[c + 1]):
                o = neighbors.row[q]
                every += moments[o, 0, 0] + moments[o, 1, 0]
                j = column_of(neighbors.offset[q], along)
                dot = nx * axis[o, 0] + ny * axis[o, 1] + nz * axis[o, 2]
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
            if m0 < max(limits.min_returns, limits.min_ratio * every) or not plane_of(
                total, fitted
            ):
                continue
            if is_bent(columns, fitted, limits.max_bend_m):
                continue
            # Noise lies along the beam: across a surface seen obliquely it is less.
            facing = (fitted[0] * vx + fitted[1] * vy + fitted[2] * vz) / vw
            facing = min(1.0, facing * facing + limits.isotropic)
            if fitted[4] > facing * limits.max_sigma_m**2 or fitted[5] < limits.min_along_m**2:
                continue
            sign = 1.0
            if (fitted[0] * nx + fitted[1] * ny + fitted[2] * nz < 0.0) != (s == 1):
                sign = -1.0
            write_plane(planes[c, s], fitted, sign, total)
            planes[c, s, PLANE.own_offset] = own_offset(
                planes[c, s], columns[OWN_COLUMN], limits.bend_m
            )
        calm[c] = quiet
