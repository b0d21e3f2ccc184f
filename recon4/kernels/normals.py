"""Kernels of surface normals: moments of small cells, and a plane through each neighborhood."""

from __future__ import annotations

import numpy as np
from numba import njit
from numpy.typing import NDArray

from recon4.kernels.moments import MOMENTS, add_moved, add_point, smallest_eigenvector


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
        add_point(moments[count], 1.0, x, y, z)
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
    total = np.zeros(MOMENTS)
    for c in range(len(cells)):
        total[:] = 0.0
        for dk in range(-1, 2):
            for dj in range(-1, 2):
                first = cells[c] + (dk * shape[1] + dj) * shape[0] - 1
                # The window moves with the cell, so each of its nine rows only increases.
                row = rows[3 * dk + dj + 4]
                while row < len(cells) and cells[row] < first:
                    row += 1
                rows[3 * dk + dj + 4] = row
                while row < len(cells) and cells[row] <= first + 2:
                    dx = (cells[row] - first - 1) * cell_m
                    add_moved(total, moments[row], dx, dj * cell_m, dk * cell_m)
                    row += 1
        n, sx, sy, sz = total[0], total[1], total[2], total[3]
        counts[c] = np.int32(n)
        normals[c, :] = 0.0
        if n < min_points:
            continue
        a, b, d = total[4] / n, total[7] / n, total[9] / n
        a, b, d = a - (sx / n) ** 2, b - (sy / n) ** 2, d - (sz / n) ** 2
        e = total[5] / n - sx * sy / (n * n)
        f = total[6] / n - sx * sz / (n * n)
        g = total[8] / n - sy * sz / (n * n)
        x, y, z, _, _, _ = smallest_eigenvector(a, b, d, e, f, g, 1e-12)
        normals[c, 0], normals[c, 1], normals[c, 2] = x, y, z


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
