"""From the normal equations of a round of refinement to what holds each multiframe."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from recon4.geometry.se3 import ROTATION, TRANSLATION, Array
from recon4.model.support import SurfaceSupport
from recon4.model.trajectory import Times
from recon4.profiler.tuning_solve import SUPPORT
from recon4.registration.degeneracy import observable_pose, of_rigid_pose


def surface_support(
    t_mid_ns: Times,
    knot_ns: Times,
    *,
    H: Array,
    counts: NDArray[np.int64],
    normal_noise_rad: float,
) -> SurfaceSupport:
    """Sum the information around each multiframe and find its weakest direction.

    Args:
        t_mid_ns: Middle of each multiframe [ns], (N,).
        knot_ns: Knots of the chain [ns], (K,).
        H: Of the poses at start and end of each interval, as `Information.H`, (K - 1, 12, 12).
        counts: Points and matches of each interval, (K - 1, 2).
        normal_noise_rad: Standard deviation of a plane's normal [rad]: what it alone creates is no
            information.
    """
    summed = np.concatenate([np.zeros((1, 6, 6)), np.cumsum(of_rigid_pose(H), axis=0)])
    counted = np.concatenate([np.zeros((1, 2), np.int64), np.cumsum(counts, axis=0)])
    last = len(knot_ns) - 1
    first, stop = (
        np.clip(np.searchsorted(knot_ns, t_mid_ns + side * SUPPORT.around_ns), 0, last)
        for side in (-1, 1)
    )
    information = summed[stop] - summed[first]
    points, matches = (counted[stop] - counted[first]).T
    weak = [_weakest(one, normal_noise_rad) for one in information]
    return SurfaceSupport(
        t_mid_ns,
        matches / np.maximum(points, 1),
        np.array([sd_m for sd_m, _ in weak]),
        np.stack([direction for _, direction in weak]),
    )


def _weakest(H: Array, normal_noise_rad: float) -> tuple[float, Array]:
    """Standard deviation [m] and direction of the least known position; rotations are free."""
    reduced, _ = observable_pose(H, normal_noise_rad)
    of_turn = reduced[ROTATION, ROTATION] + 1e-6 * np.eye(3)
    coupling = reduced[ROTATION, TRANSLATION]
    position = reduced[TRANSLATION, TRANSLATION] - coupling.T @ np.linalg.solve(of_turn, coupling)
    values, vectors = np.linalg.eigh(0.5 * (position + position.T))
    return max(float(values[0]), SUPPORT.least) ** -0.5, vectors[:, 0]
