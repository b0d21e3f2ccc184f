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
from recon4.model.usability import OBSERVED_SD_M
from recon4.registration.frame_fit import FrameFit

_WEAK_SD_M = 0.06
"""Deviation of a position by the points of one multiframe at which half of the error remains [m].
Measured on walks with known truth: up to 2 cm the motion of half a second is wrong by 2 mm, at 5 cm
by 0.1 m, above 10 cm by 0.25 m (``docs/studies/covariances.md``)."""
_SPEED_M_S = 0.6
"""Standard deviation of the speed along a direction that nothing but the IMU knows [m/s]."""
_FREE_SPEED_M_S = 2.0
"""The same if there is no IMU: the registration of scans may slide either way [m/s]."""


_WALKING_M_S = 1.5
"""Motion along such a direction that is faster than a person walks is an error [m/s]."""


def unknown_speed_sd(speed_m_s: float, *, with_imu: bool) -> float:
    """Standard deviation of the speed along a direction that is not observed [m/s].

    Args:
        speed_m_s: Speed that was estimated; without information it may be anything [m/s].
        with_imu: Whether an IMU predicts the motion.
    """
    return max(_SPEED_M_S if with_imu else _FREE_SPEED_M_S, speed_m_s - _WALKING_M_S)


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
    if not np.isfinite(direction).all() or not weak_sd_m >= OBSERVED_SD_M:
        return cov
    ratio = (weak_sd_m / _WEAK_SD_M) ** 4
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
