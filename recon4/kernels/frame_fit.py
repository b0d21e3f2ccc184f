"""Kernels of the fit of one frame to planes: what its points observe, and its corrected poses."""

from __future__ import annotations

import numpy as np
from numba import njit
from numpy.typing import NDArray

from recon4.kernels.imu import rotation


@njit(cache=True, nogil=True, error_model="numpy")
def reductions(
    H: NDArray[np.float64], normal_noise_rad: float, least_turn: float, least_of_turn: float
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Matrices that remove from normal equations what noise of the normals creates.

    Args:
        H: Information on a correction of one pose, rotation first, (6, 6).
        normal_noise_rad: Standard deviation of a plane's normal [rad].
        least_turn: Squared part of the turn in a motion from which on it counts as a turn.
        least_of_turn: Turns with less information per weight of the points keep nothing of it.

    Returns:
        The square root for ``H``, and the whole for the gradient, (6, 6).
    """
    root, full = np.eye(6), np.eye(6)
    weight = H[3, 3] + H[4, 4] + H[5, 5]
    if weight <= 0.0:
        return root, full
    # Rotations in meters at the typical distance, so that they compare with shifts.
    scale = np.ones(6)
    scale[:3] = 1.0 / max(np.sqrt((H[0, 0] + H[1, 1] + H[2, 2]) / weight), 1e-3)
    normalized, V = np.linalg.eigh(np.outer(scale, scale) * H / weight)
    root[:] = 0.0
    full[:] = 0.0
    for k in range(6):
        kept = max(1.0 - normal_noise_rad**2 / max(normalized[k], 1e-12), 0.0)
        turn = V[0, k] ** 2 + V[1, k] ** 2 + V[2, k] ** 2
        if turn > least_turn and normalized[k] < least_of_turn:
            kept = 0.0
        for i in range(6):
            for j in range(6):
                part = scale[i] * V[i, k] * V[j, k] / scale[j]
                root[i, j] += np.sqrt(kept) * part
                full[i, j] += kept * part
    return root, full


@njit(cache=True, nogil=True, error_model="numpy")
def observable(
    H: NDArray[np.float64],
    g: NDArray[np.float64],
    normal_noise_rad: float,
    least_turn: float,
    least_of_turn: float,
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Normal equations of the poses at start and end, (12, 12) and (12,), reduced alike.

    The other arguments are those of `reductions`, which is asked about the motion that is the same
    at start and end.
    """
    root, full = reductions(
        H[:6, :6] + H[:6, 6:] + H[6:, :6] + H[6:, 6:], normal_noise_rad, least_turn, least_of_turn
    )
    both, whole = np.zeros((12, 12)), np.zeros((12, 12))
    for first in (0, 6):
        both[first : first + 6, first : first + 6] = root
        whole[first : first + 6, first : first + 6] = full
    return both.T @ H @ both, whole.T @ g


@njit(cache=True, nogil=True, error_model="numpy")
def corrected_poses(
    fraction: NDArray[np.float64],
    R: NDArray[np.float64],
    p: NDArray[np.float64],
    delta: NDArray[np.float64],
    center: NDArray[np.float64],
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Poses of a frame moved by corrections at its start and end, linearly in between.

    Args:
        fraction: 0 at the start of the frame, 1 at its end, (K,).
        R: Rotations, (K, 3, 3).
        p: Positions [m], (K, 3).
        delta: Turn and shift at the start, then at the end, (12,) or longer.
        center: Point about which they turn [m], (3,).

    Returns:
        Rotations (K, 3, 3) and positions (K, 3).
    """
    R_out, p_out = np.empty_like(R), np.empty_like(p)
    for k in range(len(fraction)):
        step = (1.0 - fraction[k]) * delta[:6] + fraction[k] * delta[6:12]
        turn = rotation(step[:3])
        for i in range(3):
            p_out[k, i] = center[i] + step[3 + i]
            for j in range(3):
                p_out[k, i] += turn[i, j] * (p[k, j] - center[j])
                R_out[k, i, j] = (
                    turn[i, 0] * R[k, 0, j] + turn[i, 1] * R[k, 1, j] + turn[i, 2] * R[k, 2, j]
                )
    return R_out, p_out
