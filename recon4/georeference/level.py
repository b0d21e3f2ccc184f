"""Leveling: the vertical direction of a map by INS or accelerometer (V §2.9, A8)."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from recon4.geometry.se3 import SE3, Array, mean_rotation, so3_exp
from recon4.georeference.ins_attitudes import ins_mount
from recon4.georeference.tuning_leveling import LEVELING
from recon4.model.rig import Rig
from recon4.model.samples import GnssSamples, ImuSamples
from recon4.model.trajectory import Times, Trajectory


@dataclass(frozen=True, slots=True, kw_only=True)
class LevelingRecord:
    """The leveling in ``georeference.json``; the fields are its keys, see `Leveling`."""

    source: str
    roll_deg: float
    pitch_deg: float
    tilt_deg: float
    spread_deg: float | None
    pairs: int
    trimmed: int


@dataclass(frozen=True, slots=True, eq=False)
class Leveling:
    """Rotation that levels a map, with its quality."""

    T_level_odom: SE3
    """A rotation about a horizontal axis: no heading, no shift."""
    source: str
    """``ins``, ``imu``, ``floor`` or ``none``."""
    pairs: int
    """Measurements used: (SLAM, IMU) pairs, or patches of floor."""
    trimmed: int
    """Measurements excluded as outliers."""
    spread_rad: float
    """Root mean square angle between a measurement and the result [rad]; NaN without any."""

    @property
    def tilt_rad(self) -> float:
        """Tilt of the map before leveling [rad]."""
        return float(np.arccos(np.clip(self.T_level_odom.R[2, 2], -1.0, 1.0)))

    def record(self) -> LevelingRecord:
        """What ``georeference.json`` has of it."""
        roll, pitch, _ = np.rad2deg(self.T_level_odom.rpy()).tolist()
        return LevelingRecord(
            source=self.source,
            roll_deg=roll,
            pitch_deg=pitch,
            tilt_deg=float(np.rad2deg(self.tilt_rad)),
            spread_deg=float(np.rad2deg(self.spread_rad)) if self.pairs else None,
            pairs=self.pairs,
            trimmed=self.trimmed,
        )


NOT_LEVELED = Leveling(SE3.identity(), "none", 0, 0, float("nan"))


def level(
    trajectory: Trajectory, imu: ImuSamples | None, rig: Rig, *, gnss: GnssSamples | None = None
) -> Leveling:
    """Level a map by IMU; ``source == "none"`` if that is not possible.

    Attitudes of an INS are preferred to the accelerometer. Without either, use
    `floor.level_by_floor`.

    Args:
        trajectory: ``T_odom_body``, dense.
        imu: Accelerometer and gyroscope, or None.
        rig: Mounting and time offsets.
        gnss: May hold attitudes.
    """
    if gnss is not None:
        leveling = level_by_attitude(trajectory, gnss, rig, imu=imu)
        if leveling.pairs >= LEVELING.min_pairs:
            return leveling
    if imu is not None:
        leveling = level_by_gravity(trajectory, imu, rig)
        if leveling.pairs >= LEVELING.min_pairs:
            return leveling
    return NOT_LEVELED


def tilt_to(up_odom: Array) -> SE3:
    """Rotation without heading that turns ``up_odom`` (3,) to (0, 0, 1)."""
    x, y, z = up_odom
    return SE3.from_rpy(
        float(np.arctan2(y, z)), float(np.arctan2(-x, np.hypot(y, z))), 0.0, t=[0] * 3
    )


def level_by_attitude(
    trajectory: Trajectory, gnss: GnssSamples, rig: Rig, *, imu: ImuSamples | None = None
) -> Leveling:
    """Average roll and pitch of an INS over the walk (V Eq. 2.13-2.16).

    The heading is that of the SLAM pose in the leveled frame; it is computed again after each
    average until the tilt converges (A0, A8). ``imu`` tells whose attitudes they are.
    """
    t_ns = gnss.t_ns
    rows = _covered(trajectory, t_ns) & np.isfinite(gnss.rpy_ned_rad[:, :2]).all(1)
    if rows.sum() < LEVELING.min_pairs:
        return NOT_LEVELED
    R_body_ins = ins_mount(gnss, rig, imu=imu, usual=rig.T_body_imu.R)
    R_odom_ins = trajectory.at(t_ns[rows]).R @ R_body_ins
    roll, pitch = gnss.rpy_ned_rad[rows, 0], gnss.rpy_ned_rad[rows, 1]
    # With y left and z up, a pitch about y right (nose up) has the opposite sign.
    R_flat_ins = so3_exp(_about(1, -pitch)) @ so3_exp(_about(0, roll))
    T_level_odom, kept = SE3.identity(), np.ones(len(roll), dtype=np.bool_)
    for _ in range(20):
        yaw = SE3(T_level_odom.R @ R_odom_ins, np.zeros((len(roll), 3))).rpy()[:, 2]
        R_level_odom = so3_exp(_about(2, yaw)) @ R_flat_ins @ np.swapaxes(R_odom_ins, 1, 2)
        ups = R_level_odom[:, 2, :]
        before, T_level_odom = T_level_odom, tilt_to(mean_rotation(R_level_odom[kept])[2])
        kept = _trimmed(_angles(ups, T_level_odom.R[2]))
        if np.abs(T_level_odom.R - before.R).max() < 1e-7:
            break
    angles = _angles(ups, T_level_odom.R[2])
    return _result(T_level_odom, "ins", angles, kept=kept)


def level_by_gravity(trajectory: Trajectory, imu: ImuSamples, rig: Rig) -> Leveling:
    """Level by the accelerometer, with the acceleration of the walker removed.

    Over each second the mean specific force in the odometry's frame is the reaction to gravity
    plus the change of speed (known from odometry) plus the bias in the IMU's frame:

        mean(R f) - (v1 - v0) / dt  =  g up  +  mean(R) b

    One robust least-squares fit over all seconds gives ``g up`` and ``b``.
    """
    windows = _windows(trajectory, imu, rig)
    if windows is None:
        return NOT_LEVELED
    force, R_mean = windows
    gravity, bias = np.median(force, axis=0), np.zeros(3)
    kept = np.zeros(len(force), dtype=np.bool_)
    for _ in range(10):
        off = np.linalg.norm(force - R_mean @ bias - gravity, axis=1)
        # The length of a three-dimensional normal error has its median at 1.54 deviations.
        before, kept = kept, off <= np.maximum(LEVELING.trim * np.median(off) / 1.538, 1e-9)
        if np.array_equal(before, kept):
            break
        gravity, bias = _fit_gravity(force[kept], R_mean[kept])
    angles = _angles(force - R_mean @ bias, gravity)
    return _result(tilt_to(gravity / np.linalg.norm(gravity)), "imu", angles, kept=kept)


def _windows(trajectory: Trajectory, imu: ImuSamples, rig: Rig) -> tuple[Array, Array] | None:
    """Mean force without acceleration [m/s²], (W, 3), and mean rotation, (W, 3, 3), by second."""
    t_ns = imu.t_ns
    rows = np.flatnonzero(_covered(trajectory, t_ns) & np.isfinite(imu.accel_m_s2).all(1))
    if len(rows) == 0:
        return None
    edges = np.arange(t_ns[rows[0]], t_ns[rows[-1]] + 1, LEVELING.window_ns)
    R_odom_imu = trajectory.at(t_ns[rows]).R @ rig.T_body_imu.R
    force = np.einsum("nij,nj->ni", R_odom_imu, imu.accel_m_s2[rows])
    at = np.searchsorted(t_ns[rows], edges)
    count = np.diff(at)
    full = count >= 0.8 * np.median(count) if len(count) else np.zeros(0, dtype=np.bool_)
    if full.sum() < LEVELING.min_pairs:
        return None
    mean_force = np.add.reduceat(force, at[:-1])[full] / count[full, None]
    R_mean = np.add.reduceat(R_odom_imu, at[:-1])[full] / count[full, None, None]
    speed = _speed(trajectory, rig, edges)
    return mean_force - (np.diff(speed, axis=0) / (LEVELING.window_ns / 1e9))[full], R_mean


def _speed(trajectory: Trajectory, rig: Rig, t_ns: Times) -> Array:
    """Velocity of the IMU in the odometry's frame [m/s], (M, 3)."""
    first, last = trajectory.t_ns[0], trajectory.t_ns[-1]
    before = np.clip(t_ns - LEVELING.speed_ns, first, last)
    after = np.clip(t_ns + LEVELING.speed_ns, first, last)
    p_imu = rig.T_body_imu.t
    moved = trajectory.at(after) @ p_imu - trajectory.at(before) @ p_imu
    return moved / ((after - before) / 1e9)[:, None]


def _fit_gravity(force: Array, R_mean: Array) -> tuple[Array, Array]:
    J = np.concatenate([np.broadcast_to(np.eye(3), R_mean.shape), R_mean], axis=2).reshape(-1, 6)
    H = J.T @ J / LEVELING.window_sd_m_s2**2
    H[3:, 3:] += np.eye(3) / LEVELING.bias_sd_m_s2**2
    b = J.T @ force.reshape(-1) / LEVELING.window_sd_m_s2**2
    x = np.asarray(np.linalg.solve(H, b), np.float64)
    return x[:3], x[3:]


def _covered(trajectory: Trajectory, t_ns: Times) -> NDArray[np.bool_]:
    return (t_ns >= trajectory.t_ns[0]) & (t_ns <= trajectory.t_ns[-1])


def _about(axis: int, angle_rad: Array) -> Array:
    out = np.zeros((len(angle_rad), 3))
    out[:, axis] = angle_rad
    return out


def _angles(directions: Array, axis: Array) -> Array:
    """Angles between (N, 3) and (3,) [rad]; exact also for small ones."""
    cross = np.linalg.norm(np.cross(directions, axis), axis=1)
    return np.arctan2(cross, directions @ axis)


def _trimmed(angles: Array) -> NDArray[np.bool_]:
    # The angle of a two-dimensional normal error has its median at 1.18 standard deviations.
    return angles <= np.maximum(LEVELING.trim * np.median(angles) / 1.1774, 1e-9)


def _result(T_level_odom: SE3, source: str, angles: Array, *, kept: NDArray[np.bool_]) -> Leveling:
    spread = float(np.sqrt(np.mean(angles[kept] ** 2)))
    return Leveling(T_level_odom, source, int(kept.sum()), int((~kept).sum()), spread)
