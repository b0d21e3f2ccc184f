"""Kernel of point deviations: the covariance of a pose, carried to the points measured from it."""

from __future__ import annotations

import numpy as np
from numba import njit
from numpy.typing import NDArray


@njit(cache=True, nogil=True, error_model="numpy")
def worst_deviation(
    p_map: NDArray[np.float64],
    frame_id: NDArray[np.uint32],
    position_m: NDArray[np.float64],
    cov: NDArray[np.float64],
    out: NDArray[np.float32],
) -> None:
    """Standard deviation of points along their worst axis.

    A point at ``d`` from its pose moves by δt + δr × d, so its covariance is ``J cov Jᵀ`` with
    ``J = [-[d]x, I]``.

    Args:
        p_map: Points in the map [m], (N, 3).
        frame_id: Row of each point's pose, (N,).
        position_m: Positions of the poses in the map [m], (P, 3).
        cov: Covariances of (turn, shift) in the axes of the map [rad, m], (P, 6, 6).
        out: Receives the square root of the largest eigenvalue [m], (N,).
    """
    jc, m = np.empty((3, 6)), np.zeros((3, 3))
    for k in range(len(p_map)):
        c, at = cov[frame_id[k]], position_m[frame_id[k]]
        x, y, z = p_map[k, 0] - at[0], p_map[k, 1] - at[1], p_map[k, 2] - at[2]
        for q in range(6):
            jc[0, q] = z * c[1, q] - y * c[2, q] + c[3, q]
            jc[1, q] = x * c[2, q] - z * c[0, q] + c[4, q]
            jc[2, q] = y * c[0, q] - x * c[1, q] + c[5, q]
        m[0, 0] = z * jc[0, 1] - y * jc[0, 2] + jc[0, 3]
        m[0, 1] = x * jc[0, 2] - z * jc[0, 0] + jc[0, 4]
        m[0, 2] = y * jc[0, 0] - x * jc[0, 1] + jc[0, 5]
        m[1, 1] = x * jc[1, 2] - z * jc[1, 0] + jc[1, 4]
        m[1, 2] = y * jc[1, 0] - x * jc[1, 1] + jc[1, 5]
        m[2, 2] = y * jc[2, 0] - x * jc[2, 1] + jc[2, 5]
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
