"""Kernels of fitted surfaces: planes through the returns around each cell, points onto them.

Cells are those of the map's grid. A plane of a cell is a row of `PLANE` numbers. It is oriented:
its normal points to the sensors that saw it, and only returns seen from that side count for it.
So the two faces of a thin wall are two planes.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numba import njit
from numpy.typing import NDArray

PLANE = 7
"""Unit normal x y z, offset n · p [m], standard deviation across [m] (0 = none), weight,
planarity."""
SLOTS = 3
"""Planes of a cell: a surface, an edge of two, a corner of three."""
_MIN_TAIL = 250.0
"""A surface has this many times the returns of a cell that holds the end of its noise only."""
MOMENTS = 10
"""weight, x, y, z, xx, xy, xz, yy, yz, zz about the center of the cell [m]."""


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
def add_point(m: NDArray[np.float64], w: float, x: float, y: float, z: float) -> None:
    """Add a weighted point to moments."""
    m[0] += w
    m[1] += w * x
    m[2] += w * y
    m[3] += w * z
    m[4] += w * x * x
    m[5] += w * x * y
    m[6] += w * x * z
    m[7] += w * y * y
    m[8] += w * y * z
    m[9] += w * z * z


@njit(cache=True, nogil=True, error_model="numpy")
def add_moved(
    out: NDArray[np.float64], m: NDArray[np.float64], dx: float, dy: float, dz: float
) -> None:
    """Add moments about a center that lies at (dx, dy, dz) from that of ``out``."""
    n = m[0]
    out[0] += n
    out[1] += m[1] + n * dx
    out[2] += m[2] + n * dy
    out[3] += m[3] + n * dz
    out[4] += m[4] + 2.0 * dx * m[1] + n * dx * dx
    out[5] += m[5] + dx * m[2] + dy * m[1] + n * dx * dy
    out[6] += m[6] + dx * m[3] + dz * m[1] + n * dx * dz
    out[7] += m[7] + 2.0 * dy * m[2] + n * dy * dy
    out[8] += m[8] + dy * m[3] + dz * m[2] + n * dy * dz
    out[9] += m[9] + 2.0 * dz * m[3] + n * dz * dz


@njit(cache=True, nogil=True, error_model="numpy")
def plane_of(m: NDArray[np.float64], out: NDArray[np.float64]) -> bool:
    """Plane through moments: unit normal, offset from the center, and three variances.

    Args:
        m: Moments.
        out: Receives normal (3,), offset [m], and the eigenvalues of the covariance, increasing
            [m²], (7,).

    Returns:
        Whether there is one: not for points on a line or at one position.
    """
    n = m[0]
    x, y, z = m[1] / n, m[2] / n, m[3] / n
    a, b, d = m[4] / n - x * x, m[7] / n - y * y, m[9] / n - z * z
    e, f, g = m[5] / n - x * y, m[6] / n - x * z, m[8] / n - y * z
    mean = (a + b + d) / 3.0
    off = e * e + f * f + g * g
    p = np.sqrt(((a - mean) ** 2 + (b - mean) ** 2 + (d - mean) ** 2 + 2.0 * off) / 6.0)
    if not p > 1e-10:
        return False
    a0, b0, d0 = (a - mean) / p, (b - mean) / p, (d - mean) / p
    e0, f0, g0 = e / p, f / p, g / p
    half = 0.5 * (a0 * (b0 * d0 - g0 * g0) - e0 * (e0 * d0 - g0 * f0) + f0 * (e0 * g0 - b0 * f0))
    angle = np.arccos(min(1.0, max(-1.0, half))) / 3.0
    largest = mean + 2.0 * p * np.cos(angle)
    smallest = mean + 2.0 * p * np.cos(angle + 2.0 * np.pi / 3.0)
    middle = 3.0 * mean - largest - smallest
    if middle < 1e-3 * largest:
        return False
    a, b, d = a - smallest, b - smallest, d - smallest
    best = 0.0
    for rows in range(3):
        if rows == 0:
            u, v, w = e * g - f * b, f * e - a * g, a * b - e * e
        elif rows == 1:
            u, v, w = e * d - f * g, f * f - a * d, a * g - e * f
        else:
            u, v, w = b * d - g * g, g * f - e * d, e * g - b * f
        norm = u * u + v * v + w * w
        if norm > best:
            best = norm
            scale = 1.0 / np.sqrt(norm)
            out[0], out[1], out[2] = u * scale, v * scale, w * scale
    out[3] = out[0] * x + out[1] * y + out[2] * z
    out[4], out[5], out[6] = max(smallest, 0.0), middle, largest
    return best > 0.0


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
    """
    moments[:] = 0.0
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
        least_cos: Cells whose normals differ more are left out.
        limits: Least weight, largest standard deviation across [m], least along [m], (3,).
        planes: Receives the planes; 0 as standard deviation = none, (C, 2, PLANE).
    """
    total = np.zeros(MOMENTS)
    found = np.zeros(7)
    for c in range(len(cells)):
        for s in range(2):
            planes[c, s, 4] = 0.0
            if moments[c, s, 0] <= 0.0:
                continue
            total[:] = 0.0
            along = main_axis(normals[c])
            for dk in range(-1, 2):
                for dj in range(-1, 2):
                    for di in range(-1, 2):
                        at = cells[c] + (dk * side + dj) * side + di
                        if at < 0 or at >= len(where) or where[at] < 0:
                            continue
                        o = where[at]
                        dot = (
                            normals[c, 0] * normals[o, 0]
                            + normals[c, 1] * normals[o, 1]
                            + normals[c, 2] * normals[o, 2]
                        )
                        # Noise crosses the borders along the normal: a tail alone is no surface.
                        if abs(dot) < least_cos and not in_column(di, dj, dk, along):
                            continue
                        m = moments[o, s if dot >= 0.0 else 1 - s]
                        if m[0] > 0.0:
                            add_moved(total, m, di * cell_m, dj * cell_m, dk * cell_m)
            if total[0] < limits[0] or not plane_of(total, found):
                continue
            if found[4] > limits[1] ** 2 or found[5] < limits[2] ** 2:
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
                at = cells[c] + ((k // 9 - 1) * side + k // 3 % 3 - 1) * side + k % 3 - 1
                if at < 0 or at >= len(where) or where[at] < 0:
                    continue
                o = where[at]
                for t in range(2):
                    q = planes[o, t]
                    if q[4] > 0.0 and mine[0] * q[0] + mine[1] * q[1] + mine[2] * q[2] > 0.97:
                        total += sums[o, t]
            if not is_one_sheet(total, least_m, limit):
                kept[c, s, 4] = 0.0


@njit(cache=True, nogil=True, error_model="numpy")
def list_candidates(
    c: int,
    cells: NDArray[np.int32],
    where: NDArray[np.int32],
    side: int,
    cell_m: float,
    planes: NDArray[np.float64],
    apart: NDArray[np.float64],
    out: NDArray[np.float64],
) -> int:
    """Different planes among those of a cell and its 26 neighbors.

    Args:
        c: Row of the cell.
        cells: Of `find_cells`, (C,).
        where: Of `find_cells`.
        side: Cells along tile and halo.
        cell_m: Edge of a cell [m].
        planes: Of `window_planes`, (C, 2, PLANE).
        apart: Largest cosine, and smallest distance in the cell [standard deviations], of planes
            that are different, (2,).
        out: Receives the planes, (L, PLANE); those of the cell itself first.

    Returns:
        How many there are.
    """
    count = 0
    cx, cy, cz = center_of(cells[c], side, cell_m)
    for k in range(27):
        # The order starts at the cell itself.
        k = (k + 13) % 27
        at = cells[c] + ((k // 9 - 1) * side + k // 3 % 3 - 1) * side + k % 3 - 1
        if at < 0 or at >= len(where) or where[at] < 0:
            continue
        for s in range(2):
            p = planes[where[at], s]
            if not p[4] > 0.0:
                continue
            away = p[0] * cx + p[1] * cy + p[2] * cz - p[3]
            if abs(away) > cell_m + 2.0 * p[4]:
                continue
            new = count < len(out)
            for q in range(count):
                o = out[q]
                if (
                    o[0] * p[0] + o[1] * p[1] + o[2] * p[2] > apart[0]
                    and abs(away - (o[0] * cx + o[1] * cy + o[2] * cz - o[3])) < apart[1] * p[4]
                ):
                    new = False
                    break
            if new:
                out[count, :] = p
                count += 1
    return count


@njit(cache=True, nogil=True, error_model="numpy", inline="always")
def distance_in_front(
    plane: NDArray[np.float64], xyz: NDArray[np.float32], to_sensor: NDArray[np.float32], p: int
) -> float:
    """Signed distance of a point to an oriented plane [m]; inf if it was seen from behind."""
    if plane[0] * to_sensor[p, 0] + plane[1] * to_sensor[p, 1] + plane[2] * to_sensor[p, 2] <= 0.0:
        return np.inf
    return plane[0] * xyz[p, 0] + plane[1] * xyz[p, 1] + plane[2] * xyz[p, 2] - plane[3]


@njit(cache=True, nogil=True, error_model="numpy")
def choose_planes(
    xyz: NDArray[np.float32],
    to_sensor: NDArray[np.float32],
    weight: NDArray[np.float32],
    starts: NDArray[np.int32],
    cells: NDArray[np.int32],
    where: NDArray[np.int32],
    side: int,
    cell_m: float,
    planes: NDArray[np.float64],
    gate: float,
    least: float,
    slots: NDArray[np.float64],
    slot_of: NDArray[np.uint8],
) -> None:
    """Give each cell the planes that its returns support, one after the other.

    A cell at an edge has no clean plane of its own: its neighbors' planes reach into it.

    Args:
        xyz: Points [m], (N, 3).
        to_sensor: Vectors to the sensor [m], (N, 3).
        weight: Of each point, (N,).
        starts: Of `find_cells`, (C + 1,).
        cells: Of `find_cells`, (C,).
        where: Of `find_cells`.
        side: Cells along tile and halo.
        cell_m: Edge of a cell [m].
        planes: Of `window_planes`, (C, 2, PLANE).
        gate: Returns within that many standard deviations support a plane.
        least: Least support of a second plane; a tenth of it is enough for the first.
        slots: Receives the planes, (C, SLOTS, PLANE).
        slot_of: Receives the slot each point supports, SLOTS = none, (N,).
    """
    apart = np.array([0.99, 0.6])
    listed = np.empty((24, PLANE))
    for c in range(len(cells)):
        slots[c, :, 4] = 0.0
        for p in range(starts[c], starts[c + 1]):
            slot_of[p] = SLOTS
        count = list_candidates(c, cells, where, side, cell_m, planes, apart, listed)
        for slot in range(min(SLOTS, count)):
            best, chosen = 0.0, -1
            enough = least if slot else 0.1 * least
            for q in range(count):
                support = 0.0
                scale = 1.0 / (gate * listed[q, 4])
                for p in range(starts[c], starts[c + 1]):
                    if slot_of[p] == SLOTS:
                        away = scale * distance_in_front(listed[q], xyz, to_sensor, p)
                        if abs(away) < 1.0:
                            support += weight[p] * (1.0 - away * away)
                # A plane through the tail of another surface's noise has less weight than that one.
                if support > enough and support * listed[q, 5] > best:
                    best, chosen = support * listed[q, 5], q
            if chosen < 0 and slot == 0:
                chosen = whose_tail(listed, count, weight[starts[c] : starts[c + 1]])
            if chosen < 0:
                break
            slots[c, slot, :] = listed[chosen]
            for p in range(starts[c], starts[c + 1]):
                if slot_of[p] == SLOTS:
                    away = distance_in_front(listed[chosen], xyz, to_sensor, p)
                    if abs(away) < gate * listed[chosen, 4]:
                        slot_of[p] = slot


@njit(cache=True, nogil=True, error_model="numpy")
def whose_tail(listed: NDArray[np.float64], count: int, weight: NDArray[np.float32]) -> int:
    """The plane that a cell of few returns may be the noise of: the one with most; -1 = none.

    Args:
        listed: Planes near the cell, (L, PLANE).
        count: How many there are.
        weight: Returns of the cell's points, (P,).
    """
    best, chosen = _MIN_TAIL * weight.sum(), -1
    for q in range(count):
        if listed[q, 5] > best:
            best, chosen = listed[q, 5], q
    return chosen


@njit(cache=True, nogil=True, error_model="numpy")
def slot_moments(
    xyz: NDArray[np.float32],
    weight: NDArray[np.float32],
    starts: NDArray[np.int32],
    cells: NDArray[np.int32],
    side: int,
    cell_m: float,
    slot_of: NDArray[np.uint8],
    moments: NDArray[np.float64],
) -> None:
    """Moments of the points of each plane of each cell, (C, SLOTS, MOMENTS)."""
    moments[:] = 0.0
    for c in range(len(cells)):
        cx, cy, cz = center_of(cells[c], side, cell_m)
        for p in range(starts[c], starts[c + 1]):
            if slot_of[p] < SLOTS:
                m = moments[c, slot_of[p]]
                add_point(m, weight[p], xyz[p, 0] - cx, xyz[p, 1] - cy, xyz[p, 2] - cz)


@njit(cache=True, nogil=True, error_model="numpy")
def refit_planes(
    cells: NDArray[np.int32],
    where: NDArray[np.int32],
    side: int,
    cell_m: float,
    slots: NDArray[np.float64],
    moments: NDArray[np.float64],
    limits: NDArray[np.float64],
    out: NDArray[np.float64],
) -> None:
    """Fit every plane of every cell again, to its points in the 3 x 3 x 3 cells around.

    Args:
        cells: Of `find_cells`, (C,).
        where: Of `find_cells`.
        side: Cells along tile and halo.
        cell_m: Edge of a cell [m].
        slots: Planes so far, (C, SLOTS, PLANE).
        moments: Of `slot_moments`, (C, SLOTS, MOMENTS).
        limits: Least weight, largest standard deviation across [m], least along [m], standard
            deviation of a cell's own offset [m], (4,).
        out: Receives the planes, (C, SLOTS, PLANE).
    """
    total, column, found = np.zeros(MOMENTS), np.zeros(MOMENTS), np.zeros(7)
    for c in range(len(cells)):
        cx, cy, cz = center_of(cells[c], side, cell_m)
        for s in range(SLOTS):
            mine, new = slots[c, s], out[c, s]
            new[:] = mine
            if not mine[4] > 0.0:
                continue
            total[:] = 0.0
            column[:] = 0.0
            along = main_axis(mine)
            for k in range(27):
                at = cells[c] + ((k // 9 - 1) * side + k // 3 % 3 - 1) * side + k % 3 - 1
                if at < 0 or at >= len(where) or where[at] < 0:
                    continue
                o = where[at]
                dx, dy, dz = (
                    (k % 3 - 1) * cell_m,
                    (k // 3 % 3 - 1) * cell_m,
                    (k // 9 - 1) * cell_m,
                )
                x, y, z = cx + 0.5 * dx, cy + 0.5 * dy, cz + 0.5 * dz
                away = mine[0] * x + mine[1] * y + mine[2] * z - mine[3]
                for t in range(SLOTS):
                    q = slots[o, t]
                    if (
                        q[4] > 0.0
                        and mine[0] * q[0] + mine[1] * q[1] + mine[2] * q[2] > 0.96
                        and abs(q[0] * x + q[1] * y + q[2] * z - q[3] - away) < 0.7 * mine[4]
                    ):
                        add_moved(total, moments[o, t], dx, dy, dz)
                        if in_column(k % 3 - 1, k // 3 % 3 - 1, k // 9 - 1, along):
                            add_moved(column, moments[o, t], dx, dy, dz)
            if total[0] < limits[0] or not plane_of(total, found):
                continue
            dot = found[0] * mine[0] + found[1] * mine[1] + found[2] * mine[2]
            if found[5] < limits[2] ** 2 or abs(dot) < 0.94:
                continue
            sign = 1.0 if dot > 0.0 else -1.0
            new[0], new[1], new[2] = sign * found[0], sign * found[1], sign * found[2]
            away = sign * found[3]
            new[4] = max(np.sqrt(found[4]), 1e-4)
            new[5] = total[0]
            new[6] = (found[5] - found[4]) / found[6]
            # What the nearest returns say of a surface that is not quite flat: those of the cell
            # and of the two beyond it along the normal, because noise crosses their borders.
            m = column
            if m[0] > 0.0:
                own = (new[0] * m[1] + new[1] * m[2] + new[2] * m[3]) / m[0] - away
                prior = limits[3] ** 2
                away += own * prior / (prior + new[4] * new[4] / m[0])
            new[3] = away + new[0] * cx + new[1] * cy + new[2] * cz


@njit(cache=True, nogil=True, error_model="numpy")
def onto_planes(
    xyz: NDArray[np.float32],
    to_sensor: NDArray[np.float32],
    starts: NDArray[np.int32],
    slots: NDArray[np.float64],
    gate: float,
    slot_of: NDArray[np.uint8],
    shift: NDArray[np.float32],
) -> None:
    """Move every point along the normal onto the nearest plane of its cell.

    Args:
        xyz: Points [m], (N, 3).
        to_sensor: Vectors to the sensor [m], (N, 3).
        starts: Of `find_cells`, (C + 1,).
        slots: Planes of each cell, (C, SLOTS, PLANE).
        gate: Farther points keep their place [standard deviations].
        slot_of: Receives the plane of each point, SLOTS = none, (N,).
        shift: Receives the shift of each point [m], (N, 3).
    """
    side_of = np.zeros((SLOTS, SLOTS))
    for c in range(len(starts) - 1):
        count = 0
        while count < SLOTS and slots[c, count, 4] > 0.0:
            count += 1
        if count > 1:
            edge_sides(xyz, starts[c], starts[c + 1], slots[c], count, slot_of, side_of)
        for p in range(starts[c], starts[c + 1]):
            slot_of[p] = SLOTS
            shift[p, :] = 0.0
            best = gate
            for s in range(count):
                away = distance_in_front(slots[c, s], xyz, to_sensor, p)
                if abs(away) < best * slots[c, s, 4]:
                    best = abs(away) / slots[c, s, 4]
                    slot_of[p] = s
            if slot_of[p] == SLOTS:
                continue
            plane = slots[c, slot_of[p]]
            away = plane[0] * xyz[p, 0] + plane[1] * xyz[p, 1] + plane[2] * xyz[p, 2] - plane[3]
            for d in range(3):
                shift[p, d] = -away * plane[d]
            if count > 1:
                keep_inside(xyz, p, slots[c], count, slot_of[p], side_of, shift)


@njit(cache=True, nogil=True, error_model="numpy")
def facts_of_points(
    starts: NDArray[np.int32],
    slots: NDArray[np.float64],
    slot_of: NDArray[np.uint8],
    normal: NDArray[np.float32],
    facts: NDArray[np.float32],
) -> None:
    """Normal of each point's plane, and what is known of it.

    Args:
        starts: Of `find_cells`, (C + 1,).
        slots: Planes of each cell, (C, SLOTS, PLANE).
        slot_of: Plane of each point, SLOTS = none, (N,).
        normal: Normals [unit], kept where there is no plane, (N, 3).
        facts: Receives standard deviation across [m], returns and planarity; NaN, 0, 0 without a
            plane, (3, N).
    """
    for c in range(len(slots)):
        for p in range(starts[c], starts[c + 1]):
            facts[0, p], facts[1, p], facts[2, p] = np.nan, 0.0, 0.0
            if slot_of[p] < SLOTS:
                plane = slots[c, slot_of[p]]
                for d in range(3):
                    normal[p, d] = plane[d]
                for k in range(3):
                    facts[k, p] = plane[4 + k]


@njit(cache=True, nogil=True, error_model="numpy")
def find_strays(
    weight: NDArray[np.float32],
    starts: NDArray[np.int32],
    cells: NDArray[np.int32],
    where: NDArray[np.int32],
    side: int,
    slot_of: NDArray[np.uint8],
    ratio: float,
    stray: NDArray[np.bool_],
) -> None:
    """Mark points on no surface that are few beside the returns of the surfaces around them.

    Args:
        weight: Returns of each point, (N,).
        starts: Of `find_cells`, (C + 1,).
        cells: Of `find_cells`, (C,).
        where: Of `find_cells`.
        side: Cells along tile and halo.
        slot_of: Plane of each point, SLOTS = none, (N,).
        ratio: Largest ratio of such returns in the 3 x 3 x 3 cells around.
        stray: Receives the marks, (N,).
    """
    sums = np.zeros((len(cells), 2))
    for c in range(len(cells)):
        for p in range(starts[c], starts[c + 1]):
            sums[c, 0] += weight[p]
            if slot_of[p] == SLOTS:
                sums[c, 1] += weight[p]
    for c in range(len(cells)):
        few = False
        if sums[c, 1] > 0.0:
            every = loose = 0.0
            for k in range(27):
                at = cells[c] + ((k // 9 - 1) * side + k // 3 % 3 - 1) * side + k % 3 - 1
                if at >= 0 and at < len(where) and where[at] >= 0:
                    every += sums[where[at], 0]
                    loose += sums[where[at], 1]
            few = loose <= ratio * every
        for p in range(starts[c], starts[c + 1]):
            stray[p] = few and slot_of[p] == SLOTS


@njit(cache=True, nogil=True, error_model="numpy")
def edge_sides(
    xyz: NDArray[np.float32],
    first: int,
    stop: int,
    planes: NDArray[np.float64],
    count: int,
    slot_of: NDArray[np.uint8],
    out: NDArray[np.float64],
) -> None:
    """On which side of each plane of a cell the points of the others lie: 1, -1, 0 = both.

    Args:
        xyz: Points [m], (N, 3).
        first: First point of the cell.
        stop: The point after its last.
        planes: Of the cell, (SLOTS, PLANE).
        count: How many there are.
        slot_of: Plane of each point, (N,).
        out: Receives the sides: ``out[a, b]`` = points of a, side of b, (SLOTS, SLOTS).
    """
    for b in range(count):
        for a in range(count):
            front = behind = 0
            for p in range(first, stop):
                if slot_of[p] == a:
                    away = (
                        planes[b, 0] * xyz[p, 0]
                        + planes[b, 1] * xyz[p, 1]
                        + planes[b, 2] * xyz[p, 2]
                        - planes[b, 3]
                    )
                    front += away > 1.5 * planes[b, 4]
                    behind += away < -1.5 * planes[b, 4]
            out[a, b] = 0.0
            if front > 4 * behind:
                out[a, b] = 1.0
            elif behind > 4 * front:
                out[a, b] = -1.0


@njit(cache=True, nogil=True, error_model="numpy")
def keep_inside(
    xyz: NDArray[np.float32],
    p: int,
    planes: NDArray[np.float64],
    count: int,
    mine: int,
    side_of: NDArray[np.float64],
    shift: NDArray[np.float32],
) -> None:
    """Move a point that its plane puts beyond an edge onto the edge."""
    a = planes[mine]
    for b in range(count):
        q = planes[b]
        if b == mine or side_of[mine, b] == 0.0:
            continue
        away = -q[3]
        for d in range(3):
            away += q[d] * (xyz[p, d] + shift[p, d])
        if away * side_of[mine, b] >= 0.0:
            continue
        dot = a[0] * q[0] + a[1] * q[1] + a[2] * q[2]
        if abs(dot) > 0.9 or abs(away) > 3.0 * q[4]:
            continue
        # Within plane a, against the part of b's normal that lies in it.
        scale = away / (1.0 - dot * dot)
        for d in range(3):
            shift[p, d] -= scale * (q[d] - dot * a[d])
