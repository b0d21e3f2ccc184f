"""Kernel of what the calibration of an HDL-64E corrects besides constants of its lasers."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numba import njit
from numpy.typing import NDArray


class LaserNumbers(NamedTuple):
    """Where the numbers of a laser are."""

    cos_el: int = 0
    sin_el: int = 1
    """Cosine and sine of the elevation of a laser."""
    aside: int = 2
    far: int = 3
    """Origin of its beam to the left, what was added to its distances [m]."""
    less_y: int = 4
    less_x: int = 5
    """Correction of far points minus that of near ones along y and x [m]."""
    focus: int = 6
    slope: int = 7
    """``256 (1 - focal distance / 131 m)²``, and by how much a unit of it raises the intensity."""
    least: int = 8
    most: int = 9
    """Bounds of the intensity."""
    numbers: int = 10
    """Of a laser."""


LASER = LaserNumbers()


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
        lasers: Numbers of each laser, see `LaserNumbers`, (L, 10).
    """
    for n in range(len(ring)):
        laser = lasers[ring[n]]
        aside, cos_el = laser[LASER.aside], laser[LASER.cos_el]
        x, y = xyz[n, 0], xyz[n, 1]
        square = max(x * x + y * y, np.float32(1e-6))
        flat = np.sqrt(max(square - aside * aside, np.float32(0.0)))
        cos_az = (x * flat + y * aside) / square
        sin_az = (x * aside - y * flat) / square
        less_y, less_x = laser[LASER.less_y], laser[LASER.less_x]
        along_y = less_y * ((abs(y) - np.float32(2.4)) / np.float32(22.64) - np.float32(1))
        along_x = less_x * ((abs(x) - np.float32(1.93)) / np.float32(23.11) - np.float32(1))
        xyz[n, 0] = x + along_x * cos_el * cos_az
        xyz[n, 1] = y - along_y * cos_el * sin_az
        xyz[n, 2] += np.float32(0.5) * (along_x + along_y) * laser[LASER.sin_el]
        nearer = np.float32(1) - (flat / cos_el - laser[LASER.far]) / np.float32(131.07)
        focus, slope = laser[LASER.focus], laser[LASER.slope]
        value = intensity[n] + slope * abs(focus - np.float32(256) * nearer * nearer)
        least, most = laser[LASER.least], laser[LASER.most]
        intensity[n] = np.uint16(min(max(value, least), most) + np.float32(0.5))
