"""A kernel that sums the points of a map in the pixels of an image."""

from __future__ import annotations

import numpy as np
from numba import njit
from numpy.typing import NDArray


@njit(cache=True, nogil=True, error_model="numpy")
def add_to_pixels(
    xyz: NDArray[np.float64],
    values: NDArray[np.float32],
    axes: tuple[int, int],
    corner: tuple[float, float],
    pixel_m: float,
    width: int,
    sums: NDArray[np.float64],
) -> None:
    """Add points to the pixels they lie in; row 0 is the top of the image.

    Args:
        xyz: Points in the frame of the map [m], (N, 3).
        values: What each has beside its height, float32 (N, K).
        axes: Axes of the map that point to the right and up.
        corner: Left and lower edge of the image [m].
        pixel_m: Edge of a pixel [m].
        width: Pixels of a row.
        sums: Points of each pixel, sum of their heights, sums of their values, (P, 2 + K).
    """
    right, up = axes
    left, bottom = corner
    height = len(sums) // width
    for n in range(len(xyz)):
        column = np.floor((xyz[n, right] - left) / pixel_m)
        row = height - 1 - np.floor((xyz[n, up] - bottom) / pixel_m)
        if not (0 <= column < width and 0 <= row < height):
            continue
        pixel = np.int64(row) * width + np.int64(column)
        sums[pixel, 0] += 1.0
        sums[pixel, 1] += xyz[n, 2]
        for k in range(values.shape[1]):
            sums[pixel, 2 + k] += values[n, k]
