"""Covariance of the shape of a walk: of its positions after the best rigid alignment.

A local map has no place of its own: it is aligned with something else before it is used. What
matters is how well its shape is known. Relative to the first pose a heading that is a little off
there moves the far end by centimeters, although the map is not bent at all. Geodesists know this as
the datum of a free network, by the S-transformation of Baarda: with errors ``e`` of all positions,

    e_aligned = P e,    P = I - J J⁺,    J = ∂(positions) / ∂(turn and shift of the whole walk)

so the covariance ``S`` of all positions becomes ``P S P``.
"""

from __future__ import annotations

import numpy as np

from recon4.geometry.se3 import Array, skew


def aligned_cov(cov: Array, p_map: Array) -> Array:
    """Covariance of each position after the best rigid alignment of all of them with the truth.

    Args:
        cov: Of all positions with each other, relative to anything, (3 N, 3 N).
        p_map: The positions, (N, 3).

    Returns:
        (N, 3, 3).
    """
    count = len(p_map)
    free = np.eye(3 * count) - _rigid_motions(p_map)
    aligned = (free @ cov @ free).reshape(count, 3, count, 3)
    own = np.arange(count)
    return np.asarray(aligned[own, :, own])


def _rigid_motions(p_map: Array) -> Array:
    """Projector onto turns and shifts of all positions together, (3 N, 3 N)."""
    arm = p_map - p_map.mean(axis=0)
    J = np.concatenate([-skew(arm), np.tile(np.eye(3), (len(arm), 1, 1))], axis=2).reshape(-1, 6)
    return J @ np.linalg.pinv(J)
