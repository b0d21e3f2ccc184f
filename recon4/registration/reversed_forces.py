"""Whether an accelerometer states its forces with the wrong sign, as the motion of the LiDARs says.

Some drivers publish gravity (-9.8 m/s² along the axis that points up at rest) where the specific
force is expected. Gravity alone cannot tell: a sensor may hang upside down. But then its forces
follow the motion that the LiDARs measure, and reversed ones contradict it. An IMU that is turned
over against what its rig says contradicts it, too, and so does its gyroscope: only forces have a
wrong sign if that measures the turns of the LiDARs.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from recon4.geometry.se3 import SE3, Array, so3_log
from recon4.model.frames import RecordedFrames
from recon4.model.trajectory import Times, Trajectory
from recon4.registration.motion import imu_in_body
from recon4.registration.odometry import Odometry
from recon4.registration.step import OdometryStep
from recon4.registration.tuning_imu import REVERSED_FORCES
from recon4.settings.reads import OdometryReads


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
    gyro, accel = imu_in_body(imu, frames.rig)
    up = accel.mean(axis=0)
    if not np.arctan2(np.hypot(up[0], up[1]), up[2]) > REVERSED_FORCES.upside_down_rad:
        return None  # also NaN: no accelerometer
    speeds, turns = [], []
    for rows in _shaken(frames.t_mid_ns, imu.t_ns, accel):
        odometry = Odometry(frames.rig, settings)
        steps = [step for step in (odometry.push(frames[k]) for k in rows) if not step.lost]
        if is_covered(steps, imu.t_ns):
            speeds.append(changes_of_speed(steps, imu.t_ns, accel))
            turns.append(_turns(steps, imu.t_ns, gyro))
    found = _correlation(speeds)
    turned_over = _correlation(turns) < REVERSED_FORCES.least
    return None if turned_over or found > -REVERSED_FORCES.least else found


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


def is_covered(steps: Sequence[OdometryStep], imu_ns: Times) -> bool:
    """Whether there are positions enough to show a motion, and more samples than those."""
    knots = len(steps[:: REVERSED_FORCES.each])
    if knots < REVERSED_FORCES.least_knots:
        return False
    inside = (imu_ns >= steps[0].t_mid_ns) & (imu_ns <= steps[-1].t_mid_ns)
    return int(np.count_nonzero(inside)) >= knots


def changes_of_speed(
    steps: Sequence[OdometryStep], imu_ns: Times, accel: Array
) -> tuple[Array, Array]:
    """Changes of the mean velocity, from one interval to the next [m/s], (N, 3) each.

    Returns:
        By the forces, whose mean is gravity; by the positions of the LiDARs.
    """
    walk, knots_ns, inside = _walk_of(steps, imu_ns)
    t_s, knots_s = (1e-9 * (t_ns - knots_ns[0]) for t_ns in (imu_ns[inside], knots_ns))
    force = np.einsum("nij,nj->ni", walk.at(imu_ns[inside]).R, accel[inside])
    speed = _integral(force - force.mean(axis=0), t_s)
    felt = _at(knots_s, t_s, _integral(speed, t_s))
    steps_s = np.diff(knots_s)[:, None]
    of_forces, of_lidars = (
        np.diff(np.diff(p, axis=0) / steps_s, axis=0) for p in (felt, walk.at(knots_ns).t)
    )
    return of_forces, of_lidars


def _turns(steps: Sequence[OdometryStep], imu_ns: Times, gyro: Array) -> tuple[Array, Array]:
    """Turns from one pose to the next about the axes of the body [rad], (N, 3) each.

    Returns:
        By the gyroscope; by the attitudes of the LiDARs.
    """
    walk, knots_ns, inside = _walk_of(steps, imu_ns)
    t_s, knots_s = (1e-9 * (t_ns - knots_ns[0]) for t_ns in (imu_ns[inside], knots_ns))
    R = walk.at(knots_ns).R
    turned = np.diff(_at(knots_s, t_s, _integral(gyro[inside], t_s)), axis=0)
    return turned, so3_log(np.swapaxes(R[:-1], 1, 2) @ R[1:])


def _walk_of(
    steps: Sequence[OdometryStep], imu_ns: Times
) -> tuple[Trajectory, Times, NDArray[np.bool_]]:
    """The poses of some steps, the times at which they are compared, and the samples between."""
    t_ns = np.array([step.t_mid_ns for step in steps], np.int64)
    knots_ns = t_ns[:: REVERSED_FORCES.each]
    walk = Trajectory(t_ns, SE3.stack(step.T_odom_body for step in steps))
    return walk, knots_ns, (imu_ns >= knots_ns[0]) & (imu_ns <= knots_ns[-1])


def _at(knots_s: Array, t_s: Array, values: Array) -> Array:
    """Columns of values (N, 3) at some times, (K, 3)."""
    return np.stack([np.interp(knots_s, t_s, axis) for axis in values.T], axis=1)


def _integral(values: Array, t_s: Array) -> Array:
    """Integral from the first time on, by the trapezoidal rule, (N, 3)."""
    pieces = np.diff(t_s)[:, None] * (values[1:] + values[:-1]) / 2.0
    return np.concatenate([np.zeros((1, values.shape[1])), np.cumsum(pieces, axis=0)])


def _correlation(pairs: Sequence[tuple[Array, Array]]) -> float:
    """Of all pairs of vectors (N, 3) together, -1 to 1; 0 if there is nothing to compare."""
    products = [[(a * b).sum(), (a**2).sum(), (b**2).sum()] for a, b in pairs]
    both, one, other = np.sum(products, axis=0).tolist() if products else (0.0, 0.0, 0.0)
    return float(both / np.sqrt(one * other)) if one * other > 0.0 else 0.0
