"""Zero-velocity update without an IMU: a stationary body does not drift."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from recon4.geometry.se3 import SE3, Array
from recon4.registration.frame_fit import FrameFit, pose_correction
from recon4.registration.motion import Prediction
from recon4.registration.state import END_MOTION, END_POSE, POSES, START, VECTOR
from recon4.registration.tuning_motion import STILL


def is_stationary(T_scan_scan: SE3) -> bool:
    """Whether the motion between two consecutive scans is within its noise."""
    small = np.linalg.norm(T_scan_scan.t) < STILL.scans_m and T_scan_scan.angle() < STILL.scans_rad
    return bool(small)


def zero_velocity_update(fit: FrameFit, prediction: Prediction, T_odom_body: SE3) -> FrameFit:
    """The fit with the body stationary at an earlier pose, if the points are consistent with it.

    The chi-square of the hypothesis is ``d^T H d``: ``d`` is its difference from the fit and ``H``
    the information of the points. The reference pose stays the same, so errors do not accumulate.

    Args:
        fit: The fit without the hypothesis.
        prediction: The motion that the fit corrects.
        T_odom_body: The pose at which the body may still be.
    """
    delta = _standing(fit, prediction, T_odom_body)
    d = (delta - fit.delta)[POSES]
    if d @ fit.H_lidar @ d > STILL.chi2:
        return fit
    poses = len(prediction.t_s)
    return replace(fit, delta=delta, T_dense=SE3.stack([T_odom_body] * poses))


def _standing(fit: FrameFit, prediction: Prediction, T_odom_body: SE3) -> Array:
    """Correction that makes a predicted motion stationary at a pose, (34,)."""
    delta = fit.delta.copy()
    predicted, end = prediction.T_odom_body, prediction.end
    center = predicted.t[-1]
    for pose, k in ((delta[START], 0), (delta[END_POSE], -1)):
        pose[:] = pose_correction(predicted[k], T_odom_body, center)
    still = np.concatenate([end.vector[VECTOR.velocity], end.vector[VECTOR.gyro_bias]])
    delta[END_MOTION] = -still  # no velocity, no turn rate
    return delta
