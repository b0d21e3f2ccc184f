"""What a multiframe knows of the motion along a direction that the LiDAR hardly observes.

The information of the points along such a direction comes from noise of the normals and from the
pattern of the rings, which moves with the sensor. It is not merely weak but wrong, and in the same
way for seconds: in a tunnel the filter states millimeters a multiframe and is wrong by 4 cm.
Its covariance therefore says nothing there; the speed of the carrier bounds the error. That is the
bound while the walk goes on. Afterwards the accelerometer says more: `felt_motion`.
"""

from __future__ import annotations

import numpy as np

from recon4.geometry.se3 import TRANSLATION, Array
from recon4.model.tuning import OBSERVATION
from recon4.registration.frame_fit import FrameFit
from recon4.registration.tuning_motion import WEAK_MOTION


def unknown_speed_sd(speed_m_s: float, *, with_imu: bool) -> float:
    """Standard deviation of the speed along a direction that is not observed [m/s].

    Args:
        speed_m_s: Speed that was estimated; without information it may be anything [m/s].
        with_imu: Whether an IMU predicts the motion.
    """
    return max(
        WEAK_MOTION.speed_m_s if with_imu else WEAK_MOTION.free_speed_m_s,
        speed_m_s - WEAK_MOTION.walking_m_s,
    )


def weak_motion_cov(
    direction: Array, weak_sd_m: float, *, unknown_m: float, converged: bool = True
) -> Array:
    """Covariance to be added to the motion over a multiframe, (6, 6), rotation first.

    Args:
        direction: Unit vector of the weak direction, (3,); NaN = unknown, nothing is added.
        weak_sd_m: Standard deviation along it by the points alone [m].
        unknown_m: Standard deviation of the motion if nothing observes it [m].
        converged: If not, all directions are as weak as this one.
    """
    cov = np.zeros((6, 6))
    if not np.isfinite(direction).all() or not weak_sd_m >= OBSERVATION.observed_sd_m:
        return cov
    ratio = (weak_sd_m / WEAK_MOTION.weak_sd_m) ** 4
    sd_m = unknown_m * ratio / (1.0 + ratio)
    cov[TRANSLATION, TRANSLATION] = sd_m**2 * np.outer(direction, direction)
    if not converged:
        cov[TRANSLATION, TRANSLATION] = unknown_m**2 * np.eye(3)
    return cov


def unknown_motion_cov(fit: FrameFit, *, seconds: float, most_m: float = float("inf")) -> Array:
    """Covariance of the motion over a multiframe that its fit does not exclude, (6, 6).

    Args:
        fit: Of the multiframe; one at rest excludes all motion.
        seconds: Duration of the multiframe [s].
        most_m: Bound of the motion by something else [m].
    """
    if fit.stationary:
        return np.zeros((6, 6))
    moved_m = float(np.linalg.norm(fit.T_dense.t[-1] - fit.T_dense.t[0]))
    unknown_m = seconds * unknown_speed_sd(moved_m / seconds, with_imu=fit.with_imu)
    return weak_motion_cov(
        fit.match.weak_direction,
        fit.weak_sd_m,
        unknown_m=min(unknown_m, most_m),
        converged=fit.with_imu or fit.converged,
    )
