"""IMU against LiDARs from floor normals and gravity (requirements V-CAL-2; V §2.3).

At several inclinations of the backpack the normal of the floor, seen by the LiDARs, and the
direction of gravity, measured at rest by the accelerometer, are the same vertical. With
``A = sum n_i g_i^T`` and its singular value decomposition ``R_body_imu = U E V^T``.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from recon4.calibration.tuning_methods import GRAVITY_ALIGNMENT
from recon4.errors import CalibrationError
from recon4.geometry.se3 import Array
from recon4.locales.coded import CodedText


@dataclass(frozen=True, slots=True, eq=False)
class GravityAlignment:
    """Rotation of the IMU from verticals."""

    R_body_imu: Array
    """(3, 3)."""
    residual_rad: Array
    """Angle between floor normal and gravity at each inclination, (N,)."""
    singular: Array
    """Singular values of the mean of ``n g^T``, (3,): the second one shows how well the rotation
    about gravity is observed."""

    @property
    def heading_observable(self) -> bool:
        """Whether the inclinations differ enough to observe the rotation about gravity."""
        return bool(self.singular[1] > GRAVITY_ALIGNMENT.min_spread)


def align_gravity(normal_body: Array, force_imu: Array) -> GravityAlignment:
    """Rotation of the IMU that makes floor normals and gravity the same vertical.

    Args:
        normal_body: Normals of the floor in the body frame (z up), of either sign, (N, 3).
        force_imu: What the accelerometer reads at rest, which points up, (N, 3).

    Raises:
        CalibrationError: If there are fewer than two pairs, or a vector has no direction.
    """
    n, g = (_unit(v) for v in (normal_body, force_imu))
    if len(n) != len(g) or len(n) < GRAVITY_ALIGNMENT.min_pairs:
        raise CalibrationError(
            CodedText(
                "gravity-pairs",
                min_pairs=GRAVITY_ALIGNMENT.min_pairs,
                floors=len(n),
                gravities=len(g),
            )
        )
    n = n * np.where(n[:, 2:] < 0.0, -1.0, 1.0)  # a floor's normal points up
    U, singular, Vt = np.linalg.svd(n.T @ g / len(n))
    E = np.diag([1.0, 1.0, np.sign(np.linalg.det(U @ Vt))])
    R_body_imu = U @ E @ Vt
    cosine = np.abs(np.sum(n * (g @ R_body_imu.T), axis=1))
    return GravityAlignment(R_body_imu, np.arccos(np.clip(cosine, 0.0, 1.0)), singular)


def _unit(vectors: Array) -> Array:
    v = np.asarray(vectors, np.float64).reshape(-1, 3)
    length = np.linalg.norm(v, axis=1, keepdims=True)
    if not np.isfinite(v).all() or not (length > 0.0).all():
        raise CalibrationError(CodedText("directions-finite"))
    return np.asarray(v / length)
