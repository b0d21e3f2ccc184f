"""Where the IMU is, as its forces show it beside the motion of the LiDARs.

Two shifts in a row differ by what the accelerometer feels between them, twice integrated. Forces
that were moved to the origin of the body with a wrong lever arm differ by what it does in turns::

    Δ²t = W(f) - W(R) b + h g - Δ²R δ        δ: true less assumed lever arm
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from recon4.geometry.se3 import Array
from recon4.model.rig import Rig
from recon4.model.samples import ImuSamples
from recon4.model.trajectory import Times, Trajectory
from recon4.registration.felt_motion import integrate_felt
from recon4.registration.tuning_imu import IMU_LEVER_ARM


@dataclass(frozen=True, slots=True, eq=False)
class LeverArmError:
    """By how much the lever arm of an IMU is wrong."""

    p_body: Array
    """What has to be added to it, in axes of the body [m], (3,)."""
    sd_m: float
    """Standard deviation of its length [m]."""

    @property
    def length_m(self) -> float:
        """Its length [m]."""
        return float(np.linalg.norm(self.p_body))


def wrong_lever_arm(
    t_ns: Times, trajectory: Trajectory, imu: ImuSamples, *, rig: Rig
) -> LeverArmError | None:
    """By how much the lever arm of an IMU is wrong; None = not, or not seen.

    Args:
        t_ns: Times of multiframes in a row that were tracked [ns], (N,).
        trajectory: ``T_odom_body``.
        imu: Its samples.
        rig: Where the IMU is.
    """
    if len(t_ns) < IMU_LEVER_ARM.min_frames:
        return None
    felt = integrate_felt(t_ns, trajectory, imu, rig=rig)
    if felt is None:
        return None
    T, dt_s = trajectory.at(t_ns), felt.dt_s[:, None, None]

    def bent(values: Array) -> Array:
        return np.diff(np.diff(values, axis=0) / dt_s, axis=0)

    mean = felt.shift / dt_s
    weighted = felt.speed[:-1] - mean[:-1] + mean[1:]  # of f and R, (K - 1, 3, 4)
    time_s = 0.5 * (dt_s[1:] + dt_s[:-1]) * np.eye(3)
    J = np.concatenate([-bent(T.R), -weighted[:, :, 1:], time_s], axis=2)
    r = bent(T.t[:, :, None])[:, :, 0] - weighted[:, :, 0]
    usable = ~(felt.missing[1:] | felt.missing[:-1])
    if usable.sum() < IMU_LEVER_ARM.min_frames:
        return None
    return _far(*_fitted(J[usable].reshape(-1, 9), r[usable].ravel()))


def _fitted(J: Array, r: Array) -> tuple[Array, Array]:
    """Lever arm and its covariance, by least squares in which few large residuals count less."""
    prior = np.diag(1.0 / np.repeat(IMU_LEVER_ARM.prior_sd, 3))
    weight = np.ones_like(r)
    for _ in range(IMU_LEVER_ARM.rounds):
        sd = 1.4826 * float(np.median(np.abs(r))) + 1e-9
        A = np.concatenate([J * (weight / sd)[:, None], prior])
        x = np.linalg.lstsq(A, np.concatenate([r * weight / sd, np.zeros(9)]), rcond=None)[0]
        off = np.abs(r - J @ x)
        sd = 1.4826 * float(np.median(off)) + 1e-9
        weight = np.sqrt(np.minimum(1.0, IMU_LEVER_ARM.huber * sd / np.maximum(off, sd)))
    variance = float(np.mean((r - J @ x) ** 2))
    cov = np.linalg.inv(J.T @ J / variance + prior @ prior)
    return np.asarray(x[:3], np.float64), np.asarray(cov[:3, :3], np.float64)


def _far(p_body: Array, cov: Array) -> LeverArmError | None:
    length_m = float(np.linalg.norm(p_body))
    if length_m < IMU_LEVER_ARM.least_m:
        return None
    along = p_body / length_m
    sd_m = float(np.sqrt(along @ cov @ along))
    known = IMU_LEVER_ARM.sigmas * sd_m < length_m
    return LeverArmError(p_body, sd_m) if known else None
