"""Observability of a 2-D pose: which directions the lines determine, and how well.

In a corridor without doors all lines are parallel: the registration converges wherever along them
the pose lies. As in `recon4.registration.degeneracy`, the information that errors of the normals
alone create is removed.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from recon4.geometry.se3 import Array
from recon4.slam2d.tuning_matching import OBSERVABILITY_2D


@dataclass(frozen=True, slots=True, eq=False)
class Observed:
    """What the lines determine of a pose."""

    information: Array
    """For yaw, x, y, reduced by what errors of the normals create, (3, 3)."""
    degeneracy: float
    """Smallest eigenvalue of the normalized information of x, y: 0 unobservable, 1/2 isotropic."""
    weak_sd_m: float
    """Standard deviation of the position along its weakest direction [m]."""
    weak_direction: Array
    """Unit vector of that direction, (2,)."""


def observed(H: Array, normal_noise_rad: float) -> Observed:
    """Reduce the information of a registration and describe its weakest direction.

    Args:
        H: Information for yaw, x, y, (3, 3).
        normal_noise_rad: Standard deviation of the normal of a line [rad].
    """
    weight = float(H[1, 1] + H[2, 2])
    if weight <= 0.0:
        return Observed(
            np.zeros((3, 3)), 0.0, OBSERVABILITY_2D.unobserved_sd_m, np.array([1.0, 0.0])
        )
    # The rotation in meters at the typical distance, so that it compares with shifts.
    arm_m = max(float(np.sqrt(H[0, 0] / weight)), 1e-3)
    scale = np.array([1.0 / arm_m, 1.0, 1.0])
    normalized, V = np.linalg.eigh(scale[:, None] * H * scale / weight)
    kept = np.clip(1.0 - normal_noise_rad**2 / np.maximum(normalized, 1e-12), 0.0, 1.0)
    unscaled = V.T / scale
    information = weight * unscaled.T @ ((kept * np.maximum(normalized, 0.0))[:, None] * unscaled)
    # The position alone: the rotation is eliminated (Schur complement).
    of_turn = max(float(information[0, 0]), 1e-9)
    coupling = information[1:, 0]
    position = information[1:, 1:] - np.outer(coupling, coupling) / of_turn
    values, vectors = np.linalg.eigh((position + position.T) / 2.0)
    least = max(float(values[0]), OBSERVABILITY_2D.unobserved_sd_m**-2)
    return Observed(information, max(float(values[0]), 0.0) / weight, least**-0.5, vectors[:, 0])
