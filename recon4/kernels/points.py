"""Kernels that move many points by one pose, or by that of the sensor of each."""

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


@njit(cache=True, nogil=True, error_model="numpy")
def points_in_body(
    R_body_sensor: NDArray[np.float64],
    t_body_sensor: NDArray[np.float64],
    sensor: NDArray[np.uint8],
    xyz: NDArray[np.float32],
    p_body: NDArray[np.float64],
) -> None:
    """Transform the points of several sensors to the body.

    Args:
        R_body_sensor: Rotation of each sensor, (S, 3, 3).
        t_body_sensor: Its position [m], (S, 3).
        sensor: Number of the sensor of each point, (N,).
        xyz: Points in the frames of their sensors [m], (N, 3).
        p_body: Receives the points in the body [m], (N, 3).
    """
    for n in range(len(xyz)):
        R, t = R_body_sensor[sensor[n]], t_body_sensor[sensor[n]]
        x, y, z = np.float64(xyz[n, 0]), np.float64(xyz[n, 1]), np.float64(xyz[n, 2])
        for axis in range(3):
            p_body[n, axis] = R[axis, 0] * x + R[axis, 1] * y + R[axis, 2] * z + t[axis]
