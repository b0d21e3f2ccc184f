"""Kernel of point selection."""

from __future__ import annotations

import numpy as np
from numba import njit
from numpy.typing import NDArray


@njit(cache=True, nogil=True, error_model="numpy")
def thin_near(
    xyz: NDArray[np.float32],
    ring: NDArray[np.uint8],
    sensor: NDArray[np.uint8],
    number: int,
    near_m: float,
    stride: int,
    by_ring: bool,
) -> NDArray[np.intp]:
    """Rows of the points of one sensor; of those nearer than ``near_m``, one in ``stride``.

    Args:
        xyz: Points in the frames of their sensors [m], (N, 3).
        ring: Beam of each, (N,).
        sensor: Number of the sensor of each, (N,).
        number: The sensor whose points are selected.
        near_m: Distance from the sensor below which points are left out [m].
        stride: The first of every ``stride`` points of the sensor is kept, wherever it lies.
        by_ring: Whether they come ring by ring, so that most follow one that is near.
    """
    kept = np.zeros(len(xyz), np.bool_)
    ends = np.zeros(257, np.int64)
    seen = 0
    for row in range(len(xyz)):
        if sensor[row] != number:
            continue
        x, y, z = xyz[row, 0], xyz[row, 1], xyz[row, 2]
        if seen % stride == 0 or x * x + y * y + z * z >= near_m * near_m:
            kept[row] = True
            ends[np.int64(by_ring) * ring[row] + 1] += 1
        seen += 1
    ends = np.cumsum(ends)
    rows = np.empty(ends[-1], np.intp)
    for row in range(len(xyz)):
        if kept[row]:
            group = np.int64(by_ring) * ring[row]
            rows[ends[group]] = row
            ends[group] += 1
    return rows
