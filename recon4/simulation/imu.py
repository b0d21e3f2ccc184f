"""An inertial measurement unit on a walking body."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from recon4.geometry.se3 import Array
from recon4.model.rig import Rig
from recon4.model.samples import ImuSamples
from recon4.simulation.walk import Walk
from recon4.units import STANDARD_GRAVITY_M_S2


@dataclass(frozen=True, slots=True, kw_only=True)
class ImuModel:
    """Rate and errors of a MEMS unit; errors of zero make it perfect."""

    rate_hz: int = 200

    gyro_noise_rad_s_hz: float = float(np.deg2rad(0.005))
    """Noise density [rad/s/sqrt(Hz)]."""
    gyro_bias_rad_s: float = float(np.deg2rad(0.2))
    """Standard deviation of the bias at the start, each axis."""
    gyro_walk_rad_s: float = float(np.deg2rad(0.002))
    """Random walk of the bias [rad/s/sqrt(s)]."""
    accel_noise_m_s2_hz: float = 100e-6 * STANDARD_GRAVITY_M_S2
    """Noise density [m/s²/sqrt(Hz)]."""
    accel_bias_m_s2: float = 10e-3 * STANDARD_GRAVITY_M_S2
    """Standard deviation of the bias at the start, each axis."""
    accel_walk_m_s2: float = 50e-6 * STANDARD_GRAVITY_M_S2
    """Random walk of the bias [m/s²/sqrt(s)]."""

    @staticmethod
    def perfect() -> ImuModel:
        """No noise, no bias."""
        return ImuModel(
            gyro_noise_rad_s_hz=0.0,
            gyro_bias_rad_s=0.0,
            gyro_walk_rad_s=0.0,
            accel_noise_m_s2_hz=0.0,
            accel_bias_m_s2=0.0,
            accel_walk_m_s2=0.0,
        )


def simulate_imu(
    walk: Walk, rig: Rig, model: ImuModel, *, epoch_ns: int, rng: np.random.Generator
) -> ImuSamples:
    """Specific force and angular rate over the whole walk.

    With the IMU at ``l`` in the body, ``f = R_imu_map (a + α × l + ω × (ω × l) - g)``.
    """
    T_body_imu = rig.T_body_imu
    period_ns = 1_000_000_000 // model.rate_hz
    t_ns = np.arange(int(walk.seconds * model.rate_hz) + 1, dtype=np.int64) * period_ns
    t_s = 1e-9 * t_ns
    R_map_body = walk.poses(t_s).R
    omega = walk.angular_rate(t_s)
    # The angular acceleration only matters times the IMU's lever arm of centimeters.
    step_s = 1e-4
    alpha = (walk.angular_rate(t_s + step_s) - walk.angular_rate(t_s - step_s)) / (2.0 * step_s)
    lever = np.broadcast_to(T_body_imu.t, omega.shape)
    up = np.array([0.0, 0.0, STANDARD_GRAVITY_M_S2])
    force = np.einsum("nji,nj->ni", R_map_body, walk.acceleration(t_s) + up)
    force += np.cross(alpha, lever) + np.cross(omega, np.cross(omega, lever))
    gyro, accel = omega @ T_body_imu.R, force @ T_body_imu.R
    root_hz = np.sqrt(model.rate_hz)
    gyro += _errors(
        rng,
        len(t_ns),
        model.gyro_noise_rad_s_hz * root_hz,
        bias=model.gyro_bias_rad_s,
        step=model.gyro_walk_rad_s / root_hz,
    )
    accel += _errors(
        rng,
        len(t_ns),
        model.accel_noise_m_s2_hz * root_hz,
        bias=model.accel_bias_m_s2,
        step=model.accel_walk_m_s2 / root_hz,
    )
    offset_ns = round(1e9 * rig.imu_time_offset_s)
    return ImuSamples(epoch_ns + t_ns - offset_ns, gyro, accel)


def _errors(
    rng: np.random.Generator, count: int, white_sd: float, *, bias: float, step: float
) -> Array:
    """White noise, a bias at the start and its random walk, (count, 3)."""
    white = white_sd * rng.standard_normal((count, 3))
    steps = step * rng.standard_normal((count, 3))
    return white + bias * rng.standard_normal(3) + np.cumsum(steps, axis=0)
