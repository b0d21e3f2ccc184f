"""Observability: remove information that errors of the plane normals alone create."""

from __future__ import annotations

import numpy as np

from recon4.geometry.se3 import ROTATION, TRANSLATION, Array
from recon4.kernels.frame_fit import observable, reductions
from recon4.registration.plane_map import Match
from recon4.registration.state_vector import END_POSE, START
from recon4.registration.tuning_matching import DEGENERACY


def observable_directions(
    match: Match, normal_noise_rad: float, *, with_imu: bool = False
) -> tuple[Array, Array]:
    """Normal equations reduced by the information that noise of the normals creates.

    On flat ground every normal should be vertical. Small errors of the normals seem to constrain
    the horizontal position, wrongly. Such errors add ``normal_noise_rad²`` per match to every
    direction; this amount is subtracted. A direction with less information counts as unobservable
    (compare Zhang & Singh 2016).

    Curved walls create more of it, along a turn about their axis. Where a gyroscope measures the
    turn, a little information along one is not taken for more than that.

    Args:
        match: Normal equations of a round.
        normal_noise_rad: Standard deviation of a plane's normal [rad].
        with_imu: Whether a gyroscope measures turns.

    Returns:
        ``H`` (12, 12) and ``g`` (12,) in the form of `Match`.
    """
    feigned = DEGENERACY.curved_information if with_imu else 0.0
    return observable(match.H, match.g, normal_noise_rad, DEGENERACY.least_turn, feigned)


def of_rigid_pose(H: Array) -> Array:
    """Information on a correction that is the same at start and end, (…, 12, 12) -> (…, 6, 6)."""
    return np.asarray(
        H[..., START, START]
        + H[..., START, END_POSE]
        + H[..., END_POSE, START]
        + H[..., END_POSE, END_POSE]
    )


def observable_pose(H: Array, normal_noise_rad: float) -> tuple[Array, Array]:
    """The same for one rigid pose: reduced ``H`` (6, 6), rotation first, and what of a correction
    is kept, (6, 6): identity where everything is observed, zero where nothing is.
    """
    root, full = reductions(np.ascontiguousarray(H), normal_noise_rad, DEGENERACY.least_turn, 0.0)
    return root.T @ H @ root, full


def weakest_twist(H: Array) -> tuple[Array, float, float, float]:
    """The small motion that is observed least.

    Args:
        H: Information on a correction of one pose, (6, 6), rotation first.

    Returns:
        Turn [rad] and shift [m] of that motion, (6,), its size at the typical distance of the
        points being 1; the standard deviation of its size [m]; the typical distance [m]; the
        information on it per weight of the points, 1/3 = as on any shift among walls of all
        directions. NaN if nothing is observed.
    """
    weight, turning = (float(np.trace(H[part, part])) for part in (TRANSLATION, ROTATION))
    if not (weight > 0.0 and turning > 0.0 and np.isfinite(H).all()):
        return np.full(6, np.nan), float("nan"), float("nan"), float("nan")
    typical_m = np.sqrt(turning / weight)
    scale = np.repeat([1.0 / typical_m, 1.0], 3)
    information, directions = np.linalg.eigh(scale[:, None] * H * scale)
    sd_m = float(max(information[0], 1e-4) ** -0.5)
    relative = float(max(information[0], 0.0) / weight)
    return scale * directions[:, 0], sd_m, float(typical_m), relative
