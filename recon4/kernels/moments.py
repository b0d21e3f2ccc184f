"""Kernels of moments: weights, sums and products of points, and the plane through them.

Kernels of other files call these. Numba does not notice a change here in what it has compiled for
them: after one, remove ``recon4/kernels/__pycache__``.
"""

from __future__ import annotations

import numpy as np
from numba import njit
from numpy.typing import NDArray

MOMENTS = 10
"""weight, x, y, z, xx, xy, xz, yy, yz, zz about a center, as of a cell [m]."""
_LINE = 1e-3
"""Middle over largest eigenvalue below which points lie on a line and have no normal."""


@njit(cache=True, nogil=True, error_model="numpy", inline="always")
def add_point(m: NDArray[np.float64], w: float, x: float, y: float, z: float) -> None:
    """Add a weighted point to moments."""
    m[0] += w
    m[1] += w * x
    m[2] += w * y
    m[3] += w * z
    m[4] += w * x * x
    m[5] += w * x * y
    m[6] += w * x * z
    m[7] += w * y * y
    m[8] += w * y * z
    m[9] += w * z * z


@njit(cache=True, nogil=True, error_model="numpy")
def add_moved(
    out: NDArray[np.float64], m: NDArray[np.float64], dx: float, dy: float, dz: float
) -> None:
    """Add moments about a center that lies at (dx, dy, dz) from that of ``out``."""
    n = m[0]
    out[0] += n
    out[1] += m[1] + n * dx
    out[2] += m[2] + n * dy
    out[3] += m[3] + n * dz
    out[4] += m[4] + 2.0 * dx * m[1] + n * dx * dx
    out[5] += m[5] + dx * m[2] + dy * m[1] + n * dx * dy
    out[6] += m[6] + dx * m[3] + dz * m[1] + n * dx * dz
    out[7] += m[7] + 2.0 * dy * m[2] + n * dy * dy
    out[8] += m[8] + dy * m[3] + dz * m[2] + n * dy * dz
    out[9] += m[9] + 2.0 * dz * m[3] + n * dz * dz


@njit(cache=True, nogil=True, error_model="numpy")
def plane_of(m: NDArray[np.float64], out: NDArray[np.float64]) -> bool:
    """Plane through moments: unit normal, offset from the center, and three variances.

    Args:
        m: Moments.
        out: Receives normal (3,), offset [m], and the eigenvalues of the covariance, increasing
            [m²], (7,).

    Returns:
        Whether there is one: not for points on a line or at one position.
    """
    n = m[0]
    x, y, z = m[1] / n, m[2] / n, m[3] / n
    a, b, d = m[4] / n - x * x, m[7] / n - y * y, m[9] / n - z * z
    e, f, g = m[5] / n - x * y, m[6] / n - x * z, m[8] / n - y * z
    u, v, w, smallest, middle, largest = smallest_eigenvector(a, b, d, e, f, g, 1e-10)
    out[0], out[1], out[2] = u, v, w
    out[3] = u * x + v * y + w * z
    out[4], out[5], out[6] = max(smallest, 0.0), middle, largest
    return u != 0.0 or v != 0.0 or w != 0.0


@njit(cache=True, nogil=True, error_model="numpy")
def smallest_eigenvector(
    a: float, b: float, d: float, e: float, f: float, g: float, least: float
) -> tuple[float, float, float, float, float, float]:
    """Unit eigenvector of the smallest eigenvalue of ``[[a e f] [e b g] [f g d]]``.

    Eigenvalues by the trigonometric solution of the cubic (Smith 1961), the vector as the largest
    cross product of two rows of ``A - lambda I``.

    Args:
        a: First entry; the others as above.
        least: Below this spread of the eigenvalues the matrix counts as a multiple of the identity.

    Returns:
        The vector (zeros for points on a line or at one position) and the eigenvalues, increasing.
    """
    mean = (a + b + d) / 3.0
    off = e * e + f * f + g * g
    p = np.sqrt(((a - mean) ** 2 + (b - mean) ** 2 + (d - mean) ** 2 + 2.0 * off) / 6.0)
    if not p > least:
        return 0.0, 0.0, 0.0, mean, mean, mean
    a0, b0, d0 = (a - mean) / p, (b - mean) / p, (d - mean) / p
    e0, f0, g0 = e / p, f / p, g / p
    half = 0.5 * (a0 * (b0 * d0 - g0 * g0) - e0 * (e0 * d0 - g0 * f0) + f0 * (e0 * g0 - b0 * f0))
    angle = np.arccos(min(1.0, max(-1.0, half))) / 3.0
    largest = mean + 2.0 * p * np.cos(angle)
    smallest = mean + 2.0 * p * np.cos(angle + 2.0 * np.pi / 3.0)
    middle = 3.0 * mean - largest - smallest
    u = v = w = 0.0
    if middle < _LINE * largest:
        return u, v, w, smallest, middle, largest
    a, b, d = a - smallest, b - smallest, d - smallest
    best = 0.0
    for rows in range(3):
        if rows == 0:
            x, y, z = e * g - f * b, f * e - a * g, a * b - e * e
        elif rows == 1:
            x, y, z = e * d - f * g, f * f - a * d, a * g - e * f
        else:
            x, y, z = b * d - g * g, g * f - e * d, e * g - b * f
        norm = x * x + y * y + z * z
        if norm > best:
            best = norm
            scale = 1.0 / np.sqrt(norm)
            u, v, w = x * scale, y * scale, z * scale
    return u, v, w, smallest, middle, largest
