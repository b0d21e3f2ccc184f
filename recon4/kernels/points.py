"""Kernel that moves many points by one pose."""

from __future__ import annotations

import numpy as np
from numba import njit
from numpy.typing import NDArray


@njit(cache=True, nogil=True, error_model="numpy")
def transform_points(
    R_a_b: NDArray[np.float64],
    t_a_b: NDArray[np.float64],
    p_b: NDArray[np.float32],
    p_a: NDArray[np.float64],
) -> None:
    """Transform points from b to a, in one pass over them.

    A matrix product, with the conversion to float64, takes nine times as long.

    Args:
        R_a_b: Rotation, (3, 3).
        t_a_b: Translation [m], (3,).
        p_b: Points in b [m], (N, 3).
        p_a: Receives the points in a [m], (N, 3).
    """
    for n in range(len(p_b)):
        x, y, z = np.float64(p_b[n, 0]), np.float64(p_b[n, 1]), np.float64(p_b[n, 2])
        for axis in range(3):
            p_a[n, axis] = (
                R_a_b[axis, 0] * x + R_a_b[axis, 1] * y + R_a_b[axis, 2] * z + t_a_b[axis]
            )
