"""Kernel of point pairs: normal equations of poses interpolated in time."""

from __future__ import annotations

import numpy as np
from numba import njit
from numpy.typing import NDArray


@njit(cache=True, nogil=True, error_model="numpy")
def accumulate_pairs(
    p: NDArray[np.float64],
    q: NDArray[np.float64],
    interval: NDArray[np.int64],
    fraction: NDArray[np.float64],
    center: NDArray[np.float64],
    H: NDArray[np.float64],
    g: NDArray[np.float64],
) -> None:
    """Sum the normal equations of ``|p - q|²`` over point pairs.

    A point moves by ``(1 - s) d_k + s d_k+1``, where ``d`` is a rotation about the center of its
    interval and a shift, both along the map's axes.

    Args:
        p: Points [m], (N, 3).
        q: Where they should be [m], (N, 3).
        interval: Interval of knots that each point belongs to, (N,).
        fraction: Time within the interval, 0..1, (N,).
        center: Centers of rotation [m], (K - 1, 3).
        H: (K - 1, 12, 12), added to.
        g: (K - 1, 12), added to.
    """
    J = np.zeros((3, 6))
    H6 = np.zeros((6, 6))
    g6 = np.zeros(6)
    for n in range(len(p)):
        k = interval[n]
        ax, ay, az = p[n, 0] - center[k, 0], p[n, 1] - center[k, 1], p[n, 2] - center[k, 2]
        # Rows x, y, z of the shift by a rotation: omega x a.
        J[0, 1], J[0, 2] = az, -ay
        J[1, 0], J[1, 2] = -az, ax
        J[2, 0], J[2, 1] = ay, -ax
        J[0, 3] = J[1, 4] = J[2, 5] = 1.0
        for i in range(6):
            g6[i] = 0.0
            for r in range(3):
                g6[i] += J[r, i] * (p[n, r] - q[n, r])
            for j in range(6):
                H6[i, j] = J[0, i] * J[0, j] + J[1, i] * J[1, j] + J[2, i] * J[2, j]
        s = fraction[n]
        a, b = 1.0 - s, s
        for i in range(6):
            g[k, i] += a * g6[i]
            g[k, 6 + i] += b * g6[i]
            for j in range(6):
                H[k, i, j] += a * a * H6[i, j]
                H[k, i, 6 + j] += a * b * H6[i, j]
                H[k, 6 + i, j] += a * b * H6[i, j]
                H[k, 6 + i, 6 + j] += b * b * H6[i, j]
