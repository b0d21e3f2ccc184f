"""Rows of the IMU in a window: what its samples say of the motion between knots.

Gyroscope: the rotation from one knot to the next. Accelerometer: the second difference of the
position of the IMU over three knots, which is the specific force weighted by a triangle; so no
velocity has to be estimated.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from recon4.calibration.tuning_joint import IMU_ROWS, WINDOWS
from recon4.calibration.window import Window
from recon4.geometry.se3 import Array, skew, so3_exp, so3_log
from recon4.model.rig import Rig
from recon4.model.samples import ImuSamples
from recon4.model.trajectory import Times
from recon4.registration.tuning import OdometryTuning

_FOURTH = 70.0
"""Variance of a difference of the fourth order of white noise of variance 1."""


@dataclass(frozen=True, slots=True)
class WindowBiases:
    """What is estimated of the IMU in each window by itself."""

    gyro_rad_s: Array
    """Bias of the gyroscope, body axes, (3,)."""
    accel_m_s2: Array
    """Bias of the accelerometer, body axes, (3,)."""
    gravity_m_s2: Array
    """Gravity in odometry axes, (3,)."""

    def plus(self, step: Array) -> WindowBiases:
        """After a step of the nine parameters."""
        return WindowBiases(
            self.gyro_rad_s + step[:3], self.accel_m_s2 + step[3:6], self.gravity_m_s2 + step[6:9]
        )


BIASES = 9
"""Number of parameters in `WindowBiases`."""


def measured_noise(samples: Sequence[ImuSamples], settings: OdometryTuning) -> OdometryTuning:
    """The settings with the noise densities that the samples themselves show.

    Differences of the fourth order remove the motion and leave the noise. Odometry assumes much
    more, because it also has to bridge what it does not model.

    Args:
        samples: Of some windows.
        settings: Upper bounds.
    """
    usable = [part for part in samples if len(part) > IMU_ROWS.min_samples]
    if not usable:
        return settings
    gyro = IMU_ROWS.safety * max(_density(part.t_ns, part.gyro_rad_s) for part in usable)
    accel = IMU_ROWS.safety * max(_density(part.t_ns, part.accel_m_s2) for part in usable)
    return replace(
        settings,
        gyro_noise=float(np.clip(gyro, IMU_ROWS.least_gyro, settings.gyro_noise)),
        accel_noise=float(np.clip(accel, IMU_ROWS.least_accel, settings.accel_noise)),
    )


def _density(t_ns: Times, values: Array) -> float:
    """Noise density per root of hertz by differences of the fourth order."""
    fourth = np.diff(values, n=4, axis=0)
    sd = 1.4826 * np.median(np.abs(fourth)) / np.sqrt(_FOURTH)
    density = float(sd) * np.sqrt(float(np.median(np.diff(t_ns))) * 1e-9)
    return density if np.isfinite(density) else np.inf


@dataclass(frozen=True, slots=True, eq=False)
class ImuRows:
    """Residuals divided by their standard deviation, with their derivatives."""

    J: Array
    """By the knots (6 each: rotation, position), the biases (9) and the IMU (7), (R, 6 K + 16)."""
    r: Array
    """(R,)."""


def imu_rows(
    window: Window, rig: Rig, biases: WindowBiases, *, settings: OdometryTuning
) -> ImuRows | None:
    """Residuals of gyroscope and accelerometer in a window; None without an IMU.

    Args:
        window: Its current trajectory is what they are compared with.
        rig: Current mount and clock of the IMU.
        biases: Current biases and gravity.
        settings: Noise densities.
    """
    imu = window.imu
    if imu is None or len(imu) < 2:
        return None
    J_gyro, r_gyro = _gyro_rows(window, rig, biases)
    J_gyro, r_gyro = (v / (settings.gyro_noise * np.sqrt(WINDOWS.knot_s)) for v in (J_gyro, r_gyro))
    if not np.isfinite(imu.accel_m_s2).all():
        return ImuRows(J_gyro, r_gyro)
    J_accel, r_accel = _accel_rows(window, rig, biases)
    sd = settings.accel_noise * np.sqrt(2.0 / 3.0 * WINDOWS.knot_s)
    return ImuRows(np.concatenate([J_gyro, J_accel / sd]), np.concatenate([r_gyro, r_accel / sd]))


def _gyro_rows(window: Window, rig: Rig, biases: WindowBiases) -> tuple[Array, Array]:
    knots = window.knots
    R = window.trajectory.at(window.knot_ns, slack_ns=10**8).R
    turn = _integrated(window, rig, biases)
    R_trajectory = np.swapaxes(R[:-1], -1, -2) @ R[1:]
    r = so3_log(np.swapaxes(so3_exp(turn), -1, -2) @ R_trajectory)
    J = np.zeros((knots - 1, 3, 6 * knots + BIASES + 7))
    k = np.arange(knots - 1)
    for i in range(3):
        for j in range(3):
            J[k, i, 6 * (k + 1) + j] = R[1:, j, i]
            J[k, i, 6 * k + j] = -R[1:, j, i]
        J[:, i, 6 * knots + i] = WINDOWS.knot_s
    first = 6 * knots + BIASES
    for j, axis in enumerate(np.eye(3)):
        turned = _rotated(rig, IMU_ROWS.eps_rad * axis)
        J[:, :, first + j] = -(_integrated(window, turned, biases) - turn) / IMU_ROWS.eps_rad
    later = replace(rig, imu_time_offset_s=rig.imu_time_offset_s + IMU_ROWS.eps_s)
    J[:, :, first + 6] = -(_integrated(window, later, biases) - turn) / IMU_ROWS.eps_s
    return J.reshape(-1, J.shape[2]), r.ravel()


def _integrated(window: Window, rig: Rig, biases: WindowBiases) -> Array:
    """Rotation vectors from knot to knot by the gyroscope [rad], (K - 1, 3)."""
    fine_s = _fine_times(window)
    rate = _sampled(window, rig, fine_s, accel=False) - biases.gyro_rad_s
    middle = 0.5 * (rate[:-1] + rate[1:]) * np.diff(fine_s)[:, None]
    R = np.broadcast_to(np.eye(3), (window.knots - 1, 3, 3))
    for step in middle.reshape(window.knots - 1, IMU_ROWS.fine, 3).swapaxes(0, 1):
        R = R @ so3_exp(step)
    return so3_log(R)


def _accel_rows(window: Window, rig: Rig, biases: WindowBiases) -> tuple[Array, Array]:
    knots, h, lever = window.knots, WINDOWS.knot_s, rig.T_body_imu.t
    T = window.trajectory.at(window.knot_ns, slack_ns=10**8)
    fine_s = _fine_times(window)
    fine_ns = window.start_ns + np.rint(fine_s * 1e9).astype(np.int64)
    R = window.trajectory.at(fine_ns, slack_ns=10**8).R
    force = _sampled(window, rig, fine_s, accel=True)
    force_odom = np.einsum("nij,nj->ni", R, force - biases.accel_m_s2)
    x = T.t + T.R @ lever
    r = (x[2:] - 2.0 * x[1:-1] + x[:-2]) / h - _weighted(force_odom) - h * biases.gravity_m_s2
    J = np.zeros((knots - 2, 3, 6 * knots + BIASES + 7))
    k = np.arange(1, knots - 1)[:, None]
    axes = np.arange(3)
    arm = skew(T.R @ lever)
    for side, factor in ((-1, 1.0), (0, -2.0), (1, 1.0)):
        of_knot = 6 * (k + side)
        J[k - 1, axes, of_knot + 3 + axes] = factor / h
        turned = skew(_weighted(force_odom, side)) - factor / h * arm[1 + side : knots - 1 + side]
        for j in range(3):
            J[k - 1, axes, of_knot + j] += turned[:, :, j]
    first = 6 * knots
    J[:, :, first + 3 : first + 6] = _weighted(R)
    J[:, axes, first + 6 + axes] = -h
    first += BIASES
    J[:, :, first : first + 3] = _weighted(R @ skew(force))
    J[:, :, first + 3 : first + 6] = (T.R[2:] - 2.0 * T.R[1:-1] + T.R[:-2]) / h
    slope = np.gradient(force, fine_s, axis=0)
    J[:, :, first + 6] = _weighted(np.einsum("nij,nj->ni", R, slope))
    return J.reshape(-1, J.shape[2]), r.ravel()


def _weighted(values: Array, side: int | None = None) -> Array:
    """Integral of values on the fine grid times a triangle around each inner knot [x s].

    With a ``side`` also times the hat function of the knot before (-1), at (0) or after (1) it.
    """
    offset = np.arange(-IMU_ROWS.fine, IMU_ROWS.fine + 1) / IMU_ROWS.fine
    weight = (1.0 - np.abs(offset)) * (WINDOWS.knot_s / IMU_ROWS.fine)
    if side is not None:
        weight = weight * np.maximum(0.0, 1.0 - np.abs(offset - side))
    shape = values.shape[1:]
    flat = values.reshape(len(values), -1)
    around = np.lib.stride_tricks.sliding_window_view(flat, 2 * IMU_ROWS.fine + 1, axis=0)[
        :: IMU_ROWS.fine
    ]
    return (around @ weight).reshape(-1, *shape)


def _fine_times(window: Window) -> Array:
    """Times on the fine grid [s], ((K - 1) n + 1,)."""
    count = (window.knots - 1) * IMU_ROWS.fine + 1
    times: Array = np.linspace(0.0, (window.knots - 1) * WINDOWS.knot_s, count)
    return times


def _sampled(window: Window, rig: Rig, t_s: Array, *, accel: bool) -> Array:
    """Turn rate or specific force in body axes at some times, (M, 3)."""
    imu = window.imu
    assert imu is not None
    change_s = rig.imu_clock_offset_s - window.recorded_rig.imu_clock_offset_s
    known_s = (imu.t_ns - window.start_ns) * 1e-9 + change_s
    values = imu.accel_m_s2 if accel else imu.gyro_rad_s
    at = np.stack([np.interp(t_s, known_s, values[:, axis]) for axis in range(3)], axis=1)
    return at @ rig.T_body_imu.R.T


def _rotated(rig: Rig, omega: Array) -> Rig:
    T = rig.T_body_imu
    return replace(rig, T_body_imu=replace(T, R=so3_exp(omega) @ T.R))
