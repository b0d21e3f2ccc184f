"""Kernels of slices: select points in a cut, project them, draw them as an image."""

from __future__ import annotations

import numpy as np
from numba import njit
from numpy.typing import NDArray


@njit(cache=True, nogil=True, error_model="numpy")
def select(
    xyz: NDArray[np.float32],
    axes: NDArray[np.float64],
    shift: NDArray[np.float64],
    low: NDArray[np.float64],
    high: NDArray[np.float64],
    rows: NDArray[np.int32],
) -> int:
    """Rows of the points inside a box that lies along the axes of a cut.

    The float32 points are relative to the origin of their tile; all else is float64.

    Args:
        xyz: Points from the tile's origin [m], float32 (N, 3).
        axes: Unit vectors u, v and normal of the cut, rows of (3, 3).
        shift: Coordinates of the tile's origin on these axes [m], (3,).
        low: Smallest coordinates on the axes [m], (3,); may be infinite.
        high: Largest coordinates on the axes [m], (3,).
        rows: Receives the rows, increasing, int32 (N,).

    Returns:
        Number of rows.
    """
    count = 0
    # The normal is tested first: it excludes most points.
    nx, ny, nz = axes[2, 0], axes[2, 1], axes[2, 2]
    low_d, high_d = low[2] - shift[2], high[2] - shift[2]
    for k in range(len(xyz)):
        x, y, z = np.float64(xyz[k, 0]), np.float64(xyz[k, 1]), np.float64(xyz[k, 2])
        d = nx * x + ny * y + nz * z
        if d < low_d or d > high_d:
            continue
        u = axes[0, 0] * x + axes[0, 1] * y + axes[0, 2] * z + shift[0]
        v = axes[1, 0] * x + axes[1, 1] * y + axes[1, 2] * z + shift[1]
        if u >= low[0] and u <= high[0] and v >= low[1] and v <= high[1]:
            rows[count] = k
            count += 1
    return count


@njit(cache=True, nogil=True, error_model="numpy")
def project(
    xyz: NDArray[np.float32],
    rows: NDArray[np.int32],
    axes: NDArray[np.float64],
    shift: NDArray[np.float64],
    uvd: NDArray[np.float64],
) -> None:
    """Coordinates u, v and distance from the plane of some points [m], float64 (M, 3)."""
    for m in range(len(rows)):
        k = rows[m]
        x, y, z = np.float64(xyz[k, 0]), np.float64(xyz[k, 1]), np.float64(xyz[k, 2])
        for a in range(3):
            uvd[m, a] = axes[a, 0] * x + axes[a, 1] * y + axes[a, 2] * z + shift[a]


@njit(cache=True, nogil=True, error_model="numpy")
def splat(
    uvd: NDArray[np.float64],
    values: NDArray[np.float32],
    corner: NDArray[np.float64],
    pixel_m: float,
    radius: int,
    count: NDArray[np.int32],
    total: NDArray[np.float64],
) -> None:
    """Draw points into an image: the count of each pixel and the sum of their values.

    Args:
        uvd: Coordinates on the cut [m], (M, 3).
        values: One per point, NaN = unknown (skipped), float32 (M,).
        corner: u of the left and v of the upper edge [m], (2,).
        pixel_m: Size of a pixel [m].
        radius: A point covers a disc of this radius [px]; 0 = one pixel.
        count: Points of each pixel, updated, int32 (H, W).
        total: Sum of their values, updated, float64 (H, W).
    """
    height, width = count.shape
    reach = (radius + 0.5) ** 2
    for m in range(len(uvd)):
        value = values[m]
        if np.isnan(value):
            continue
        x = int(np.floor((uvd[m, 0] - corner[0]) / pixel_m))
        y = int(np.floor((corner[1] - uvd[m, 1]) / pixel_m))
        for j in range(max(0, y - radius), min(height, y + radius + 1)):
            for i in range(max(0, x - radius), min(width, x + radius + 1)):
                if (i - x) ** 2 + (j - y) ** 2 <= reach:
                    count[j, i] += 1
                    total[j, i] += value


@njit(cache=True, nogil=True, error_model="numpy")
def first_of_pixels(
    uvd: NDArray[np.float64],
    corner: NDArray[np.float64],
    pixel_m: float,
    taken: NDArray[np.bool_],
    chosen: NDArray[np.int32],
) -> int:
    """Select the first point of each pixel; returns their number.

    The points of a tile are ordered as even samples of it, so the first is representative.

    Args:
        uvd: Coordinates on the cut [m], (M, 3).
        corner: As for `splat`.
        pixel_m: As for `splat`.
        taken: Pixels that have a point already, updated, bool (H, W).
        chosen: Receives the rows of the points, int32 (M,).
    """
    height, width = taken.shape
    count = 0
    for m in range(len(uvd)):
        x = int(np.floor((uvd[m, 0] - corner[0]) / pixel_m))
        y = int(np.floor((corner[1] - uvd[m, 1]) / pixel_m))
        if 0 <= x < width and 0 <= y < height and not taken[y, x]:
            taken[y, x] = True
            chosen[count] = m
            count += 1
    return count
