"""One rotation at a time, to the last bit as `recon4.geometry.se3` makes it of a batch.

An array of nine numbers costs NumPy as much as one of hundreds. The odometry makes a few dozen
rotations a multiframe; one at a time it is faster with numbers of Python. The order of operations
is that of the arrays. Sines, cosines and products of matrices are left to NumPy: those of other
libraries differ in their last bits.
"""

from __future__ import annotations

from math import isfinite, sqrt

import numpy as np
from numpy.typing import NDArray

_EYE = np.eye(3)


def is_single(values: NDArray[np.generic], *shape: int) -> bool:
    """Whether an array is one of double precision with this shape, and not a batch."""
    return values.shape == shape and values.dtype == np.float64


def single_quat(R: NDArray[np.float64]) -> NDArray[np.float64] | None:
    """Unit quaternion (x, y, z, w) of a rotation matrix, (3, 3) -> (4,); None if not finite."""
    (a, b, c), (d, e, f), (g, h, i) = R.tolist()
    trace = a + e + i
    if not isfinite(trace):
        return None
    squares = (2 * a - trace, 2 * e - trace, 2 * i - trace, trace)
    best = squares.index(max(squares))
    first = 1.0 + squares[best]
    if best == 0:
        quat = (first, b + d, c + g, h - f)
    elif best == 1:
        quat = (b + d, first, f + h, c - g)
    elif best == 2:
        quat = (c + g, f + h, first, d - b)
    else:
        quat = (h - f, c - g, d - b, first)
    x, y, z, w = quat
    norm = sqrt(x * x + y * y + z * z + w * w)
    return np.array((x / norm, y / norm, z / norm, w / norm))


def single_matrix(quat_xyzw: NDArray[np.float64]) -> NDArray[np.float64]:
    """Rotation matrix of a quaternion (x, y, z, w) that is normalized first, (4,) -> (3, 3)."""
    x, y, z, w = quat_xyzw.tolist()
    norm = sqrt(x * x + y * y + z * z + w * w)
    if not norm > 0.0:
        return np.full((3, 3), np.nan)
    V = single_skew(x / norm, y / norm, z / norm)
    return np.asarray(_EYE + 2.0 * (w / norm) * V + 2.0 * (V @ V))


def single_skew(x: float, y: float, z: float) -> NDArray[np.float64]:
    """Cross-product matrix, (3, 3)."""
    return np.array(((0.0, -z, y), (z, 0.0, -x), (-y, x, 0.0)))


def single_exp(omega: NDArray[np.float64], small: float) -> NDArray[np.float64]:
    """Rotation matrix of a rotation vector [rad], (3,) -> (3, 3). Rodrigues' formula.

    Args:
        omega: The rotation vector.
        small: At smaller angles its first terms are used [rad].
    """
    x, y, z = omega.tolist()
    angle = np.float64(sqrt(x * x + y * y + z * z))
    a, b = 1.0, 0.5
    if angle > small:
        a, b = np.sin(angle) / angle, (1.0 - np.cos(angle)) / (angle * angle)
    W = single_skew(x, y, z)
    return np.asarray(_EYE + a * W + b * (W @ W))


def single_log(quat_xyzw: NDArray[np.float64], small: float) -> NDArray[np.float64]:
    """Rotation vector [rad] of a unit quaternion (x, y, z, w), (4,) -> (3,).

    Args:
        quat_xyzw: The quaternion.
        small: Sine of half the angle below which twice that is the angle.
    """
    x, y, z, w = quat_xyzw.tolist()
    if w < 0.0:
        x, y, z, w = -x, -y, -z, -w
    norm = sqrt(x * x + y * y + z * z)
    scale = 2.0 * np.arctan2(norm, w) / norm if norm > small else 2.0
    return np.array((scale * x, scale * y, scale * z))
