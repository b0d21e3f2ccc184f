"""Directions in which a match only seems to hold."""

from __future__ import annotations

import numpy as np

from recon4.geometry.se3 import Array
from recon4.registration.plane_map import Match


def observable_directions(match: Match, normal_noise_rad: float) -> tuple[Array, Array]:
    """Normal equations without what errors of the planes' normals alone would make of them.

    On flat ground every normal should be vertical; that they are a little off holds the body
    sideways, and wrongly. Such errors add ``normal_noise_rad²`` a match to every direction, so
    that much is taken away: a direction held by less counts as free (compare Zhang & Singh 2016).

    Args:
        match: Normal equations of a round.
        normal_noise_rad: Standard deviation of a plane's normal [rad].

    Returns:
        ``H`` (12, 12) and ``g`` (12,) in the form of `Match`.
    """
    H6 = match.H[:6, :6] + match.H[:6, 6:] + match.H[6:, :6] + match.H[6:, 6:]
    weight = float(np.trace(H6[3:, 3:]))
    if weight <= 0.0:
        return match.H, match.g
    # Rotations in meters at the typical distance, so that they compare with shifts.
    arm_m = np.sqrt(float(np.trace(H6[:3, :3])) / weight)
    scale = np.repeat([1.0 / max(arm_m, 1e-3), 1.0], 3)
    normalized, V = np.linalg.eigh(scale[:, None] * H6 * scale / weight)
    kept = np.clip(1.0 - normal_noise_rad**2 / np.maximum(normalized, 1e-12), 0.0, 1.0)
    root = scale[:, None] * (V * np.sqrt(kept)) @ V.T / scale
    full = scale[:, None] * (V * kept) @ V.T / scale
    both = np.kron(np.eye(2), root)
    return both.T @ match.H @ both, np.kron(np.eye(2), full).T @ match.g
