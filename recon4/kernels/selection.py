"""Kernel of point selection."""

from __future__ import annotations

import numpy as np
from numba import njit
from numpy.typing import NDArray


@njit(cache=True, nogil=True, error_model="numpy")
def thin_near(
    xyz: NDArray[np.float32], sensor: NDArray[np.uint8], number: int, near_m: float, stride: int
) -> NDArray[np.intp]:
    """Rows of the points of one sensor; of those nearer than ``near_m``, one in ``stride``.

    Args:
        xyz: Points in the frames of their sensors [m], (N, 3).
        sensor: Number of the sensor of each, (N,).
        number: The sensor whose points are selected.
        near_m: Distance from the sensor below which points are left out [m].
        stride: The first of every ``stride`` points of the sensor is kept, wherever it lies.
    """
    rows = np.empty(len(xyz), np.intp)
    seen = size = 0
    for row in range(len(xyz)):
        if sensor[row] != number:
            continue
        x, y, z = xyz[row, 0], xyz[row, 1], xyz[row, 2]
        if seen % stride == 0 or x * x + y * y + z * z >= near_m * near_m:
            rows[size] = row
            size += 1
        seen += 1
    return rows[:size]
