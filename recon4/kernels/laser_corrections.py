"""Kernel of what the calibration of an HDL-64E corrects besides constants of its lasers."""

from __future__ import annotations

import numpy as np
from numba import njit
from numpy.typing import NDArray

COS_EL, SIN_EL = 0, 1
"""Cosine and sine of the elevation of a laser."""
ASIDE, FAR = 2, 3
"""Origin of its beam to the left, what was added to its distances [m]."""
LESS_Y, LESS_X = 4, 5
"""Correction of far points minus that of near ones along y and x [m]."""
FOCUS, SLOPE = 6, 7
"""``256 (1 - focal distance / 131 m)²``, and by how much a unit of it raises the intensity."""
LEAST, MOST = 8, 9
"""Bounds of the intensity."""
NUMBERS = 10


@njit(cache=True, nogil=True, fastmath=True, error_model="numpy")
def correct(
    xyz: NDArray[np.float32],
    intensity: NDArray[np.uint16],
    ring: NDArray[np.uint8],
    lasers: NDArray[np.float32],
) -> None:
    """Correct points and intensities in place.

    Args:
        xyz: Points with the correction of far ones [m], (N, 3).
        intensity: As measured, (N,).
        ring: Row of ``lasers`` of each, (N,).
        lasers: Numbers of each laser, see `COS_EL` to `MOST`, (L, NUMBERS).
    """
    for n in range(len(ring)):
        laser = lasers[ring[n]]
        x, y = xyz[n, 0], xyz[n, 1]
        square = max(x * x + y * y, np.float32(1e-6))
        flat = np.sqrt(max(square - laser[ASIDE] * laser[ASIDE], np.float32(0.0)))
        cos_az = (x * flat + y * laser[ASIDE]) / square
        sin_az = (x * laser[ASIDE] - y * flat) / square
        along_y = laser[LESS_Y] * ((abs(y) - np.float32(2.4)) / np.float32(22.64) - np.float32(1))
        along_x = laser[LESS_X] * ((abs(x) - np.float32(1.93)) / np.float32(23.11) - np.float32(1))
        xyz[n, 0] = x + along_x * laser[COS_EL] * cos_az
        xyz[n, 1] = y - along_y * laser[COS_EL] * sin_az
        xyz[n, 2] += np.float32(0.5) * (along_x + along_y) * laser[SIN_EL]
        nearer = np.float32(1) - (flat / laser[COS_EL] - laser[FAR]) / np.float32(131.07)
        value = intensity[n] + laser[SLOPE] * abs(laser[FOCUS] - np.float32(256) * nearer * nearer)
        intensity[n] = np.uint16(min(max(value, laser[LEAST]), laser[MOST]) + np.float32(0.5))
