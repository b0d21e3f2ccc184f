"""Kernels of surface normals: moments of small cells, and a plane through each neighborhood."""

from __future__ import annotations

import numpy as np
from numba import njit
from numpy.typing import NDArray

_LINE = 1e-3
"""Middle over largest eigenvalue below which points lie on a line and have no normal."""


@njit(cache=True, nogil=True, error_model="numpy")
def bounds(xyz: NDArray[np.floating], low: NDArray[np.float64], high: NDArray[np.float64]) -> None:
    """Write the smallest and largest coordinates of points (N, 3), N >= 1, to two float64 (3,)."""
    low[:] = np.inf
    high[:] = -np.inf
    for n in range(len(xyz)):
        for d in range(3):
            low[d] = min(low[d], xyz[n, d])
            high[d] = max(high[d], xyz[n, d])


@njit(cache=True, nogil=True, error_model="numpy")
def cell_keys(
    xyz: NDArray[np.float32],
    low: NDArray[np.int64],
    shape: NDArray[np.int64],
    cell_m: float,
    shift: int,
    out: NDArray[np.int64],
) -> bool:
    """Cell of each point, with the point's row in the lower ``shift`` bits, int64 (N,).

    Returns:
        Whether the keys are sorted already.
    """
    in_order = True
    for n in range(len(xyz)):
        i = np.int64(np.floor(xyz[n, 0] / cell_m)) - low[0]
        j = np.int64(np.floor(xyz[n, 1] / cell_m)) - low[1]
        k = np.int64(np.floor(xyz[n, 2] / cell_m)) - low[2]
        out[n] = (((k * shape[1] + j) * shape[0] + i) << shift) | n
        in_order &= n == 0 or out[n] > out[n - 1]
    return in_order


@njit(cache=True, nogil=True, error_model="numpy")
def cell_moments(
    xyz: NDArray[np.float32],
    order: NDArray[np.int64],
    shift: int,
    low: NDArray[np.int64],
    shape: NDArray[np.int64],
    cell_m: float,
    cells: NDArray[np.int64],
    moments: NDArray[np.float64],
) -> int:
    """Sums over the points of each cell, about the cell's center.

    Args:
        xyz: Points [m], (N, 3).
        order: Sorted result of `cell_keys`, (N,).
        shift: As given to it.
        low: First cell of the box, (3,).
        shape: Cells of the box, (3,).
        cell_m: Edge of a cell [m].
        cells: Receives the cell's index, increasing, int64 (N,).
        moments: Receives count, x, y, z, xx, xy, xz, yy, yz, zz, float64 (N, 10).

    Returns:
        Number of cells.
    """
    count = -1
    mask = (np.int64(1) << shift) - 1
    cx = cy = cz = 0.0
    for n in range(len(order)):
        cell = order[n] >> shift
        if count < 0 or cells[count] != cell:
            count += 1
            cells[count] = cell
            moments[count, :] = 0.0
            i = cell % shape[0]
            j = (cell // shape[0]) % shape[1]
            k = cell // (shape[0] * shape[1])
            cx = (low[0] + i + 0.5) * cell_m
            cy = (low[1] + j + 0.5) * cell_m
            cz = (low[2] + k + 0.5) * cell_m
        p = order[n] & mask
        x, y, z = xyz[p, 0] - cx, xyz[p, 1] - cy, xyz[p, 2] - cz
        m = moments[count]
        m[0] += 1.0
        m[1] += x
        m[2] += y
        m[3] += z
        m[4] += x * x
        m[5] += x * y
        m[6] += x * z
        m[7] += y * y
        m[8] += y * z
        m[9] += z * z
    return count + 1


@njit(cache=True, nogil=True, error_model="numpy")
def window_normals(
    cells: NDArray[np.int64],
    moments: NDArray[np.float64],
    shape: NDArray[np.int64],
    cell_m: float,
    min_points: int,
    normals: NDArray[np.float32],
    counts: NDArray[np.int32],
) -> None:
    """Normal of the plane through the 3 x 3 x 3 cells around each cell.

    Args:
        cells: Increasing cell indices, int64 (C,).
        moments: Of `cell_moments`, (C, 10).
        shape: Cells of the box, (3,); its outermost cells are empty.
        cell_m: Edge of a cell [m].
        min_points: Fewer points have no normal.
        normals: Receives unit normals, or zeros, float32 (C, 3).
        counts: Receives the points of the window, int32 (C,).
    """
    rows = np.zeros(9, np.int64)
    for c in range(len(cells)):
        n = sx = sy = sz = xx = xy = xz = yy = yz = zz = 0.0
        for dk in range(-1, 2):
            for dj in range(-1, 2):
                first = cells[c] + (dk * shape[1] + dj) * shape[0] - 1
                # The window moves with the cell, so each of its nine rows only increases.
                row = rows[3 * dk + dj + 4]
                while row < len(cells) and cells[row] < first:
                    row += 1
                rows[3 * dk + dj + 4] = row
                while row < len(cells) and cells[row] <= first + 2:
                    m = moments[row]
                    dx = (cells[row] - first - 1) * cell_m
                    dy, dz = dj * cell_m, dk * cell_m
                    row += 1
                    n += m[0]
                    sx += m[1] + m[0] * dx
                    sy += m[2] + m[0] * dy
                    sz += m[3] + m[0] * dz
                    xx += m[4] + 2.0 * dx * m[1] + m[0] * dx * dx
                    xy += m[5] + dx * m[2] + dy * m[1] + m[0] * dx * dy
                    xz += m[6] + dx * m[3] + dz * m[1] + m[0] * dx * dz
                    yy += m[7] + 2.0 * dy * m[2] + m[0] * dy * dy
                    yz += m[8] + dy * m[3] + dz * m[2] + m[0] * dy * dz
                    zz += m[9] + 2.0 * dz * m[3] + m[0] * dz * dz
        counts[c] = np.int32(n)
        normals[c, :] = 0.0
        if n < min_points:
            continue
        a, b, d = xx / n - (sx / n) ** 2, yy / n - (sy / n) ** 2, zz / n - (sz / n) ** 2
        e = xy / n - sx * sy / (n * n)
        f = xz / n - sx * sz / (n * n)
        g = yz / n - sy * sz / (n * n)
        smallest_eigenvector(a, b, d, e, f, g, normals[c])


@njit(cache=True, nogil=True, error_model="numpy")
def smallest_eigenvector(
    a: float, b: float, d: float, e: float, f: float, g: float, out: NDArray[np.floating]
) -> None:
    """Unit eigenvector of the smallest eigenvalue of ``[[a e f] [e b g] [f g d]]``.

    Eigenvalues by the trigonometric solution of the cubic (Smith 1961), the vector as the largest
    cross product of two rows of ``A - lambda I``. For points on a line or at one position ``out``
    is unchanged.
    """
    mean = (a + b + d) / 3.0
    off = e * e + f * f + g * g
    p = np.sqrt(((a - mean) ** 2 + (b - mean) ** 2 + (d - mean) ** 2 + 2.0 * off) / 6.0)
    if not p > 1e-12:
        return
    a0, b0, d0 = (a - mean) / p, (b - mean) / p, (d - mean) / p
    e0, f0, g0 = e / p, f / p, g / p
    half = 0.5 * (a0 * (b0 * d0 - g0 * g0) - e0 * (e0 * d0 - g0 * f0) + f0 * (e0 * g0 - b0 * f0))
    angle = np.arccos(min(1.0, max(-1.0, half))) / 3.0
    largest = mean + 2.0 * p * np.cos(angle)
    smallest = mean + 2.0 * p * np.cos(angle + 2.0 * np.pi / 3.0)
    if 3.0 * mean - largest - smallest < _LINE * largest:
        return
    a, b, d = a - smallest, b - smallest, d - smallest
    best = 0.0
    for rows in range(3):
        if rows == 0:
            x, y, z = e * g - f * b, f * e - a * g, a * b - e * e
        elif rows == 1:
            x, y, z = e * d - f * g, f * f - a * d, a * g - e * f
        else:
            x, y, z = b * d - g * g, g * f - e * d, e * g - b * f
        norm = x * x + y * y + z * z
        if norm > best:
            best = norm
            scale = 1.0 / np.sqrt(norm)
            out[0], out[1], out[2] = x * scale, y * scale, z * scale


@njit(cache=True, nogil=True, error_model="numpy")
def spread_to_points(
    order: NDArray[np.int64],
    shift: int,
    normals: NDArray[np.float32],
    counts: NDArray[np.int32],
    out_normals: NDArray[np.float32],
    out_counts: NDArray[np.int32],
) -> None:
    """Copy the normal and the count of each cell to its points; ``order`` as in `cell_moments`."""
    cell = -1
    previous = np.int64(-1)
    mask = (np.int64(1) << shift) - 1
    for n in range(len(order)):
        if order[n] >> shift != previous:
            previous = order[n] >> shift
            cell += 1
        p = order[n] & mask
        out_counts[p] = counts[cell]
        for i in range(3):
            out_normals[p, i] = normals[cell, i]
