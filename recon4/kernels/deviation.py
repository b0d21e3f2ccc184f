"""Kernel of point deviations: the covariance of a pose, carried to the points measured from it."""

from __future__ import annotations

import numpy as np
from numba import njit
from numpy.typing import NDArray


@njit(cache=True, nogil=True, error_model="numpy")
def worst_deviation(
    d: NDArray[np.float64],
    pose: NDArray[np.intp],
    cov: NDArray[np.float64],
    out: NDArray[np.float32],
) -> None:
    """Standard deviation of points along their worst axis.

    A point moves by δt + δr × d, so its covariance is ``J cov Jᵀ`` with ``J = [-[d]x, I]``.

    Args:
        d: Points from the position of their pose, in the axes of the covariances [m], (N, 3).
        pose: Row of each point's pose, (N,).
        cov: Covariances of (turn, shift) [rad, m], (P, 6, 6).
        out: Receives the square root of the largest eigenvalue [m], (N,).
    """
    j, m = np.zeros((3, 6)), np.zeros((3, 3))
    j[0, 3] = j[1, 4] = j[2, 5] = 1.0
    for k in range(len(d)):
        c = cov[pose[k]]
        x, y, z = d[k]
        j[0, 1], j[0, 2] = z, -y
        j[1, 0], j[1, 2] = -z, x
        j[2, 0], j[2, 1] = y, -x
        for a in range(3):
            for b in range(a, 3):
                s = 0.0
                for p in range(6):
                    if j[a, p] != 0.0:
                        for q in range(6):
                            s += j[a, p] * c[p, q] * j[b, q]
                m[a, b] = s
        out[k] = np.sqrt(max(_largest_eigenvalue(m), 0.0))


@njit(cache=True, nogil=True, error_model="numpy", inline="always")
def _largest_eigenvalue(m: NDArray[np.float64]) -> float:
    """Largest eigenvalue of a symmetric matrix given by its upper triangle, in closed form."""
    mean = (m[0, 0] + m[1, 1] + m[2, 2]) / 3.0
    off = m[0, 1] ** 2 + m[0, 2] ** 2 + m[1, 2] ** 2
    a, b, c = m[0, 0] - mean, m[1, 1] - mean, m[2, 2] - mean
    p = np.sqrt((a * a + b * b + c * c + 2.0 * off) / 6.0)
    if p == 0.0:
        return float(mean)
    det = (
        a * (b * c - m[1, 2] ** 2)
        - m[0, 1] * (m[0, 1] * c - m[1, 2] * m[0, 2])
        + m[0, 2] * (m[0, 1] * m[1, 2] - b * m[0, 2])
    )
    r = min(1.0, max(-1.0, det / (2.0 * p**3)))
    return float(mean + 2.0 * p * np.cos(np.arccos(r) / 3.0))
