"""Kernel of the person who carries the sensors, as they see him."""

from __future__ import annotations

import math

import numpy as np
from numba import njit
from numpy.typing import NDArray


@njit(cache=True, nogil=True, error_model="numpy")
def carrier_range(
    shot: NDArray[np.float64],
    mount_R: NDArray[np.float64],
    mount_t: NDArray[np.float64],
    carrier: NDArray[np.float64],
    out: NDArray[np.float64],
) -> None:
    """Range at which each shot hits the carrier, an upright cylinder in the body.

    Args:
        shot: Azimuth clockwise, elevation [rad], then what is not used, (N, 7).
        mount_R: ``R_body_sensor``, (3, 3).
        mount_t: Sensor in the body [m], outside of the cylinder, (3,).
        carrier: x, y of the axis, radius, bottom, top [m], (5,).
        out: Ranges [m], filled; inf = the shot passes, (N,).
    """
    cx, cy = mount_t[0] - carrier[0], mount_t[1] - carrier[1]
    c = cx * cx + cy * cy - carrier[2] * carrier[2]
    for i in range(len(shot)):
        out[i] = np.inf
        ce = math.cos(shot[i, 1])
        sx, sy, sz = ce * math.cos(shot[i, 0]), -ce * math.sin(shot[i, 0]), math.sin(shot[i, 1])
        dx = mount_R[0, 0] * sx + mount_R[0, 1] * sy + mount_R[0, 2] * sz
        dy = mount_R[1, 0] * sx + mount_R[1, 1] * sy + mount_R[1, 2] * sz
        dz = mount_R[2, 0] * sx + mount_R[2, 1] * sy + mount_R[2, 2] * sz
        a = dx * dx + dy * dy
        half = cx * dx + cy * dy
        root = half * half - a * c
        if a < 1e-12 or root <= 0.0 or half >= 0.0:
            continue
        near, far = (-half - math.sqrt(root)) / a, (-half + math.sqrt(root)) / a
        z_near, z_far = mount_t[2] + dz * near, mount_t[2] + dz * far
        if carrier[3] <= z_near <= carrier[4]:
            out[i] = near
        elif z_near > carrier[4] > z_far:  # from above onto the top
            out[i] = (carrier[4] - mount_t[2]) / dz
