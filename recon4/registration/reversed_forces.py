"""Whether an accelerometer states its forces with the wrong sign, as the motion of the LiDARs says.

Some drivers publish gravity (-9.8 m/s² along the axis that points up at rest) where the specific
force is expected. Gravity alone cannot tell: a sensor may hang upside down. But then its forces
follow the motion that the LiDARs measure, and reversed ones contradict it.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from recon4.geometry.se3 import SE3, Array
from recon4.model.frames import RecordedFrames
from recon4.model.samples import ImuSamples
from recon4.model.trajectory import Times, Trajectory
from recon4.registration.motion import imu_in_body
from recon4.registration.odometry import Odometry
from recon4.registration.step import OdometryStep
from recon4.registration.tuning_imu import REVERSED_FORCES
from recon4.settings.reads import OdometryReads


def with_opposite_forces(imu: ImuSamples) -> ImuSamples:
    """The same samples with the sign of all accelerations turned."""
    return replace(imu, accel_m_s2=-imu.accel_m_s2)


def reversed_forces(frames: RecordedFrames, settings: OdometryReads) -> float | None:
    """Correlation of measured forces and motion, -1 to 1, if the forces are reversed; else None.

    Only a body that stands on its head by its accelerometer is looked at: the LiDARs alone track
    the stretches in which it is shaken most.

    Args:
        frames: The multiframes with their rig and IMU.
        settings: Of the odometry.
    """
    imu = frames.imu
    if imu is None or len(imu) < 2 or not settings.odometry.use_imu:
        return None
    _, accel = imu_in_body(imu, frames.rig)
    up = accel.mean(axis=0)
    if not np.arctan2(np.hypot(up[0], up[1]), up[2]) > REVERSED_FORCES.upside_down_rad:
        return None  # also NaN: no accelerometer
    measured, moved = [], []
    for rows in _shaken(frames.t_mid_ns, imu.t_ns, accel):
        odometry = Odometry(frames.rig, settings)
        steps = [odometry.push(frames[k]) for k in rows]
        pair = _changes_of_speed([step for step in steps if not step.lost], imu.t_ns, accel)
        measured.append(pair[0])
        moved.append(pair[1])
    found = _correlation(np.concatenate(measured), np.concatenate(moved))
    return found if found < -REVERSED_FORCES.least else None


def _shaken(t_mid_ns: Times, imu_ns: Times, accel: Array) -> list[range]:
    """The windows of multiframes in which the forces change most, at most two."""
    size = min(REVERSED_FORCES.frames, len(t_mid_ns))
    starts = np.arange(0, len(t_mid_ns) - size + 1, max(size // 2, 1))
    cuts = np.searchsorted(imu_ns, np.stack([t_mid_ns[starts], t_mid_ns[starts + size - 1]]))
    shaking = np.array(
        [accel[a:b].var(axis=0).sum() if b - a > 1 else 0.0 for a, b in cuts.T.tolist()]
    )
    first = int(np.argmax(shaking))
    apart = np.abs(starts - starts[first]) >= size
    second = [int(np.argmax(np.where(apart, shaking, -1.0)))] if apart.any() else []
    return [range(int(starts[k]), int(starts[k]) + size) for k in (first, *second)]


def _changes_of_speed(
    steps: Sequence[OdometryStep], imu_ns: Times, accel: Array
) -> tuple[Array, Array]:
    """Changes of the mean velocity, from one interval to the next [m/s], (N, 3) each.

    Returns:
        By the forces, whose mean is gravity; by the positions of the LiDARs.
    """
    t_ns = np.array([step.t_mid_ns for step in steps], np.int64)[:: REVERSED_FORCES.each]
    if len(t_ns) < REVERSED_FORCES.least_knots:
        return np.empty((0, 3)), np.empty((0, 3))
    rows = np.flatnonzero((imu_ns >= t_ns[0]) & (imu_ns <= t_ns[-1]))
    if len(rows) < len(t_ns):
        return np.empty((0, 3)), np.empty((0, 3))
    poses = SE3.stack(step.T_odom_body for step in steps)
    walk = Trajectory(np.array([step.t_mid_ns for step in steps], np.int64), poses)
    force = np.einsum("nij,nj->ni", walk.at(imu_ns[rows]).R, accel[rows])
    t_s = 1e-9 * (imu_ns[rows] - t_ns[0])
    speed = _integral(force - force.mean(axis=0), t_s)
    knots_s = 1e-9 * (t_ns - t_ns[0])
    shift = _integral(speed, t_s)
    felt = np.stack([np.interp(knots_s, t_s, axis) for axis in shift.T], axis=1)
    seen = poses.t[:: REVERSED_FORCES.each]
    steps_s = np.diff(knots_s)[:, None]
    of_forces, of_lidars = (np.diff(np.diff(p, axis=0) / steps_s, axis=0) for p in (felt, seen))
    return of_forces, of_lidars


def _integral(values: Array, t_s: Array) -> Array:
    """Integral from the first time on, by the trapezoidal rule, (N, 3)."""
    pieces = np.diff(t_s)[:, None] * (values[1:] + values[:-1]) / 2.0
    return np.concatenate([np.zeros((1, values.shape[1])), np.cumsum(pieces, axis=0)])


def _correlation(one: Array, other: Array) -> float:
    """Of all axes together, -1 to 1; 0 if there is nothing to compare."""
    product = float(np.sqrt((one**2).sum() * (other**2).sum()))
    return float((one * other).sum()) / product if product > 0.0 else 0.0
