"""Kernels of overlap: spherical z-buffers."""

from __future__ import annotations

import numpy as np
from numba import njit
from numpy.typing import NDArray


@njit(cache=True, nogil=True, error_model="numpy", inline="always")
def _bin(
    x: float, y: float, z: float, azimuth_bins: int, elevation_bins: int
) -> tuple[int, int, float]:
    range_m = np.sqrt(x * x + y * y + z * z)
    if range_m < 1e-6:
        return -1, -1, range_m
    column = int((np.arctan2(y, x) + np.pi) * azimuth_bins / (2.0 * np.pi))
    row = int((np.arcsin(min(max(z / range_m, -1.0), 1.0)) + 0.5 * np.pi) * elevation_bins / np.pi)
    return min(column, azimuth_bins - 1), min(row, elevation_bins - 1), range_m


@njit(cache=True, nogil=True, error_model="numpy")
def nearest_ranges(
    p: NDArray[np.float64], azimuth_bins: int, elevation_bins: int, min_points: int
) -> NDArray[np.float32]:
    """Smallest range in each bin of azimuth and elevation [m]; 0 = fewer points than needed.

    Args:
        p: Points in the frame of the buffer [m], (N, 3).
    """
    buffer = np.full((azimuth_bins, elevation_bins), np.float32(np.inf), np.float32)
    count = np.zeros((azimuth_bins, elevation_bins), np.int32)
    for k in range(len(p)):
        column, row, range_m = _bin(p[k, 0], p[k, 1], p[k, 2], azimuth_bins, elevation_bins)
        if column >= 0:
            count[column, row] += 1
            buffer[column, row] = min(buffer[column, row], np.float32(range_m))
    for column in range(azimuth_bins):
        for row in range(elevation_bins):
            if count[column, row] < min_points:
                buffer[column, row] = 0.0
    return buffer


@njit(cache=True, nogil=True, error_model="numpy", inline="always")
def _beside_surface(
    buffer: NDArray[np.float32],
    p: NDArray[np.float64],
    R: NDArray[np.float64],
    t: NDArray[np.float64],
) -> tuple[float, float]:
    """Range of a point in the buffer's frame, and of the surface in its bin, 0 = none."""
    x = R[0, 0] * p[0] + R[0, 1] * p[1] + R[0, 2] * p[2] + t[0]
    y = R[1, 0] * p[0] + R[1, 1] * p[1] + R[1, 2] * p[2] + t[1]
    z = R[2, 0] * p[0] + R[2, 1] * p[1] + R[2, 2] * p[2] + t[2]
    column, row, range_m = _bin(x, y, z, buffer.shape[0], buffer.shape[1])
    if column < 0:
        return range_m, 0.0
    return range_m, float(buffer[column, row])


@njit(cache=True, nogil=True, error_model="numpy")
def inside_ratio(
    buffer: NDArray[np.float32],
    p: NDArray[np.float64],
    R: NDArray[np.float64],
    t: NDArray[np.float64],
    relative: float,
    absolute_m: float,
) -> float:
    """Fraction of points, transformed by (R, t) to the buffer's frame, inside its view volume."""
    inside = 0
    for k in range(len(p)):
        range_m, surface_m = _beside_surface(buffer, p[k], R, t)
        if surface_m == 0.0:
            continue
        if range_m < surface_m * (1.0 + relative) + absolute_m:
            inside += 1
    return inside / max(len(p), 1)


@njit(cache=True, nogil=True, error_model="numpy")
def seen_through_ratio(
    buffer: NDArray[np.float32],
    p: NDArray[np.float64],
    R: NDArray[np.float64],
    t: NDArray[np.float64],
    relative: float,
    absolute_m: float,
) -> float:
    """Fraction of points where the buffer's sensor saw through to something farther away.

    Only points in filled bins count, no farther than the surface seen there. 0 if there are none.
    """
    known = through = 0
    for k in range(len(p)):
        range_m, surface_m = _beside_surface(buffer, p[k], R, t)
        if surface_m == 0.0:
            continue
        if range_m > surface_m * (1.0 + relative) + absolute_m:
            continue
        known += 1
        if range_m < surface_m * (1.0 - relative) - absolute_m:
            through += 1
    return through / max(known, 1)
