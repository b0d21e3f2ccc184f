"""Kernels of a chain of states joined by IMU samples: residuals, transitions, dense poses."""

from __future__ import annotations

import numpy as np
from numba import njit
from numpy.typing import NDArray

from recon4.kernels.imu import propagate

SIZE = 15
"""Error state of a knot: rotation, position, velocity, gyro bias, accelerometer bias."""


@njit(cache=True, nogil=True, error_model="numpy")
def _rotation_vector(D: NDArray[np.float64], out: NDArray[np.float64]) -> None:
    """Logarithm of a rotation by less than half a turn, (3, 3) -> (3,)."""
    trace = min(3.0, max(-1.0, D[0, 0] + D[1, 1] + D[2, 2]))
    angle = np.arccos(0.5 * (trace - 1.0))
    scale = 0.5 if angle < 1e-6 else 0.5 * angle / np.sin(angle)
    out[0] = scale * (D[2, 1] - D[1, 2])
    out[1] = scale * (D[0, 2] - D[2, 0])
    out[2] = scale * (D[1, 0] - D[0, 1])


@njit(cache=True, nogil=True, error_model="numpy")
def linearize_chain(
    gyro: NDArray[np.float64],
    accel: NDArray[np.float64],
    step_s: float,
    R: NDArray[np.float64],
    vector: NDArray[np.float64],
    noise: NDArray[np.float64],
    residual: NDArray[np.float64],
    transition: NDArray[np.float64],
    cov: NDArray[np.float64],
    dense_R: NDArray[np.float64],
    dense_p: NDArray[np.float64],
) -> None:
    """Predict every knot from the one before and compare.

    Args:
        gyro: Angular rate in the body at equal steps, the knots among them [rad/s], (G, 3).
        accel: Specific force in the body [m/s²], (G, 3).
        step_s: Time between two samples [s].
        R: ``R_map_body`` of the knots, (K, 3, 3).
        vector: Position, velocity, biases, gravity of the knots, (K, 15).
        noise: As in `recon4.kernels.imu.propagate`, (4,).
        residual: Knot minus prediction, filled, (K - 1, 15).
        transition: Of the error state, filled, (K - 1, 15, 15).
        cov: Of the prediction, filled, (K - 1, 15, 15).
        dense_R: Rotations at the samples of each interval, filled, (K - 1, M + 1, 3, 3).
        dense_p: Positions likewise, filled, (K - 1, M + 1, 3).
    """
    steps = dense_p.shape[1] - 1
    t_s = np.arange(steps + 1) * step_s
    nothing = np.zeros((18, 18))
    for k in range(len(R) - 1):
        first = k * steps
        rows = slice(first, first + steps + 1)
        R_all, p_all, v, Phi, P = propagate(
            t_s, gyro[rows], accel[rows], R[k], vector[k], nothing, noise
        )
        dense_R[k], dense_p[k] = R_all, p_all
        _rotation_vector(R[k + 1] @ R_all[steps].T, residual[k, 0:3])
        for i in range(3):
            residual[k, 3 + i] = vector[k + 1, i] - p_all[steps, i]
            residual[k, 6 + i] = vector[k + 1, 3 + i] - v[i]
        for i in range(6):
            residual[k, 9 + i] = vector[k + 1, 6 + i] - vector[k, 6 + i]
        transition[k] = Phi[:SIZE, :SIZE]
        cov[k] = P[:SIZE, :SIZE]


@njit(cache=True, nogil=True, error_model="numpy")
def level_by_gravity(
    gyro: NDArray[np.float64],
    accel: NDArray[np.float64],
    step_s: float,
    gain_per_s: float,
    R: NDArray[np.float64],
) -> None:
    """Rotations by the gyroscope, pulled slowly towards the vertical of the accelerometer.

    Args:
        gyro: Angular rate in the body [rad/s], (G, 3).
        accel: Specific force in the body [m/s²], (G, 3).
        step_s: Time between two samples [s].
        gain_per_s: Part of the tilt that is removed per second.
        R: ``R_map_body``; the first one is given, the others are filled, (G, 3, 3).
    """
    w = np.empty(3)
    for k in range(len(gyro) - 1):
        up = R[k] @ accel[k]
        length = np.sqrt(up[0] ** 2 + up[1] ** 2 + up[2] ** 2)
        pull = gain_per_s / max(length, 1e-6)
        # The rotation about map axes that turns the measured vertical towards z.
        wx, wy = up[1] * pull, -up[0] * pull
        for i in range(3):
            w[i] = 0.5 * (gyro[k, i] + gyro[k + 1, i]) + R[k, 0, i] * wx + R[k, 1, i] * wy
            w[i] *= step_s
        angle = np.sqrt(w[0] ** 2 + w[1] ** 2 + w[2] ** 2)
        a = 1.0 if angle < 1e-9 else np.sin(angle) / angle
        b = 0.5 if angle < 1e-9 else (1.0 - np.cos(angle)) / angle**2
        D = np.eye(3)
        K = np.array([[0.0, -w[2], w[1]], [w[2], 0.0, -w[0]], [-w[1], w[0], 0.0]])
        D += a * K + b * (K @ K)
        R[k + 1] = R[k] @ D
