"""Gravity as an accelerometer measures it over a walk: its scale, and with it that of the unit.

Over a walk the accelerations of the body cancel out but for the change of its velocity; what is
left of the specific force, turned into the axes of the trajectory, is gravity and the bias. A
scale that is 3 % off is 0.3 m/s². The turn rates of such a unit are as wrong: the odometry finds
that by itself (`recon4.registration.imu_estimate`).
"""

from __future__ import annotations

import numpy as np

from recon4.geometry.se3 import Array
from recon4.model.rig import Rig
from recon4.model.samples import ImuSamples
from recon4.model.trajectory import Times, Trajectory
from recon4.registration.motion import imu_in_body
from recon4.registration.tuning_imu import IMU_GRAVITY
from recon4.units import STANDARD_GRAVITY_M_S2


def wrong_gravity(trajectory: Trajectory, imu: ImuSamples, rig: Rig) -> float | None:
    """Gravity as the accelerometer measures it [m/s²], if it is wrong; None = not wrong.

    Args:
        trajectory: ``T_odom_body``.
        imu: Its samples.
        rig: Where the IMU is.
    """
    first_ns = max(int(trajectory.t_ns[0]), int(imu.t_ns[0]))
    last_ns = min(int(trajectory.t_ns[-1]), int(imu.t_ns[-1]))
    seconds = (last_ns - first_ns) * 1e-9
    inside = (imu.t_ns >= first_ns) & (imu.t_ns <= last_ns)
    if seconds < IMU_GRAVITY.min_s or inside.sum() < 2:
        return None
    _, accel = imu_in_body(imu, rig)
    force = np.einsum("nij,nj->ni", trajectory.at(imu.t_ns[inside]).R, accel[inside]).mean(axis=0)
    ends = np.array([first_ns, last_ns - IMU_GRAVITY.speed_ns])
    gained = np.diff(_velocities(trajectory, ends), axis=0)[0]
    found = float(np.linalg.norm(force - gained / seconds))
    # NaN: no accelerometer
    return found if abs(found - STANDARD_GRAVITY_M_S2) > IMU_GRAVITY.most_m_s2 else None


def _velocities(trajectory: Trajectory, t_ns: Times) -> Array:
    """Mean velocities [m/s] over `IMU_GRAVITY.speed_ns` from these times on, (N, 3)."""
    moved = trajectory.at(t_ns + IMU_GRAVITY.speed_ns).t - trajectory.at(t_ns).t
    return np.asarray(moved / (IMU_GRAVITY.speed_ns * 1e-9))
