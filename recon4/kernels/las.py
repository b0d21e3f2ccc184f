"""Kernel of coordinates in a LAS file."""

from __future__ import annotations

import numpy as np
from numba import njit
from numpy.typing import NDArray


@njit(cache=True, nogil=True, error_model="numpy")
def whole_steps(
    xyz: NDArray[np.float64],
    offset: NDArray[np.float64],
    scale: NDArray[np.float64],
    steps: NDArray[np.int32],
    corners: NDArray[np.float64],
) -> bool:
    """Coordinates in whole steps from an offset, and their bounds, in one pass over them.

    Args:
        xyz: Coordinates [m], (N, 3), N >= 1.
        offset: Of the file [m], (3,).
        scale: Step along each axis [m], (3,).
        steps: Receives the steps, axis by axis, (3, N).
        corners: Receives the smallest and largest coordinates [m], (2, 3).

    Returns:
        Whether all fit; False as well if one is not a number.
    """
    corners[0], corners[1] = np.inf, -np.inf
    fit = True
    for n in range(len(xyz)):
        for axis in range(3):
            value = xyz[n, axis]
            step = np.rint((value - offset[axis]) / scale[axis])
            fit &= abs(step) < 2**31 - 1
            steps[axis, n] = np.int32(step)
            corners[0, axis] = min(corners[0, axis], value)
            corners[1, axis] = max(corners[1, axis], value)
    return fit
