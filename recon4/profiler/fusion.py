"""From the IMU and the poses of 2-D SLAM to a trajectory with six degrees of freedom (L §3).

L fuses them in an extended Kalman filter that runs forward. Here the whole walk is a chain of
states: the same model, solved for all times at once, so later scans correct earlier poses too.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from recon4.geometry.se3 import SE3, Array, so3_exp
from recon4.model.trajectory import Times, Trajectory
from recon4.profiler.at_rest import AtRest
from recon4.profiler.imu_chain import (
    Drive,
    ImuChain,
    Information,
    initial_chain,
    linearize,
    rotation_error,
)
from recon4.profiler.tuning_solve import FUSION


@dataclass(frozen=True, slots=True, eq=False)
class PlanarPoses:
    """Poses in the plane by 2-D SLAM."""

    t_ns: Times
    """Times [ns], (N,)."""
    T_map_laser: SE3
    """Of the laser; height, roll and pitch have no meaning, a batch of N."""
    cov: Array
    """Covariance of x, y [m] and heading [rad], (N, 3, 3)."""
    T_body_laser: SE3
    """Mounting of the laser."""


def attitude(drive: Drive) -> Trajectory:
    """Roll and pitch of the body by the IMU alone; position and heading have no meaning.

    While a person walks, the accelerations of the steps hide the vertical; that the velocity stays
    that of a person tells them apart over the whole walk.
    """
    chain = initial_chain(drive)
    if drive.has_imu:
        for _ in range(3):
            chain = chain.moved(linearize(chain).solve(level_walk(chain)))
    knots = linearize(chain).trajectory()
    return Trajectory(knots.t_ns, SE3(knots.T_a_b.R, np.zeros_like(knots.T_a_b.t)))


def fuse(drive: Drive, poses: PlanarPoses | None) -> ImuChain:
    """States that fit the IMU and the planar poses.

    Args:
        drive: IMU samples.
        poses: By 2-D SLAM; None = by the IMU alone, which drifts unless it is at rest.
    """
    chain = initial_chain(drive)
    rest = AtRest.of(drive)
    if poses is not None and len(poses.t_ns):
        chain = _with_heading(chain, poses)
    for _ in range(FUSION.rounds):
        measured = level_walk(chain)
        if poses is not None:
            measured = measured + _planar(chain, poses)
        else:
            measured = measured + rest.information(chain)
        step = linearize(chain).solve(measured)
        chain = chain.moved(step)
        if np.abs(step[:, 3:6]).max() < FUSION.small_m:
            break
    return chain


def level_walk(chain: ImuChain) -> Information:
    """Weak knowledge of a walk: the height stays about the same; without an IMU also the tilt."""
    intervals = len(chain) - 1
    found = Information.none(intervals)
    per_knot = chain.drive.step_s * chain.drive.steps
    weight = per_knot / FUSION.height_sd_m**2
    found.H[:, 5, 5] += weight
    found.g[:, 5] += weight * chain.vector[:-1, 2]
    if not chain.drive.has_imu:
        tilt = rotation_error(_upright(chain.R), chain.R)[:-1, 0:2]
        found.H[:, [0, 1], [0, 1]] += per_knot / FUSION.tilt_sd_rad**2
        found.g[:, 0:2] += per_knot / FUSION.tilt_sd_rad**2 * tilt
    return found


def _planar(chain: ImuChain, poses: PlanarPoses) -> Information:
    """Normal equations of heading, x and y of the laser at the times of the planar poses."""
    knot_ns = chain.drive.knot_ns
    inside = (poses.t_ns >= knot_ns[0]) & (poses.t_ns < knot_ns[-1])
    t_ns, R, t = poses.t_ns[inside], poses.T_map_laser.R[inside], poses.T_map_laser.t[inside]
    information = np.linalg.inv(poses.cov[inside])
    left = np.searchsorted(knot_ns, t_ns, side="right") - 1
    s = (t_ns - knot_ns[left]) / (knot_ns[left + 1] - knot_ns[left])
    T_map_body = linearize(chain).trajectory().at(t_ns)
    T_map_laser = T_map_body @ poses.T_body_laser
    heading = _wrapped(_heading(T_map_laser.R) - _heading(R))
    r = np.column_stack([T_map_laser.t[:, 0:2] - t[:, 0:2], heading])
    # Rotation about the body's position, then shift: the laser is a lever arm away.
    arm = T_map_laser.t - T_map_body.t
    J = np.zeros((len(t_ns), 3, 6))
    J[:, 0, 1], J[:, 0, 2], J[:, 0, 3] = arm[:, 2], -arm[:, 1], 1.0
    J[:, 1, 0], J[:, 1, 2], J[:, 1, 4] = -arm[:, 2], arm[:, 0], 1.0
    J[:, 2, 2] = 1.0
    both = np.stack([1.0 - s, s], axis=1)
    H6 = np.einsum("nji,njk,nkl->nil", J, information, J)
    g6 = np.einsum("nji,njk,nk->ni", J, information, r)
    found = Information.none(len(knot_ns) - 1)
    H = np.einsum("na,nb,nij->naibj", both, both, H6).reshape(-1, 12, 12)
    g = np.einsum("na,ni->nai", both, g6).reshape(-1, 12)
    np.add.at(found.H, left, H)
    np.add.at(found.g, left, g)
    return found


def _wrapped(angle_rad: Array) -> Array:
    return np.asarray((angle_rad + np.pi) % (2.0 * np.pi) - np.pi, dtype=np.float64)


def _with_heading(chain: ImuChain, poses: PlanarPoses) -> ImuChain:
    """The chain with the planar poses as start: its heading would take many steps to turn."""
    knot_ns = chain.drive.knot_ns
    planar = Trajectory(poses.t_ns, poses.T_map_laser).at(
        np.clip(knot_ns, poses.t_ns[0], poses.t_ns[-1])
    )
    turn = np.zeros((len(knot_ns), 3))
    R_body_laser = poses.T_body_laser.R
    turn[:, 2] = _heading(planar.R) - _heading(chain.R @ R_body_laser)
    positions = planar.t - so3_exp(turn) @ chain.R @ poses.T_body_laser.t
    positions[:, 2] = 0.0
    start = Trajectory(knot_ns, SE3(so3_exp(turn) @ chain.R, positions))
    return chain.following(start)


def _heading(R: Array) -> Array:
    return np.asarray(np.arctan2(R[:, 1, 0], R[:, 0, 0]), dtype=np.float64)


def _upright(R: Array) -> Array:
    """Rotations of the same heading without tilt."""
    turn = np.zeros((len(R), 3))
    turn[:, 2] = _heading(R)
    return so3_exp(turn)
