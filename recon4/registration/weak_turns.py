"""Stretches of the walk in which only the gyroscope holds a turn.

In a round hall, a silo or a round stairwell the surroundings look the same after a turn about their
axis. The planes fitted to a curved wall seem to observe that turn nevertheless, a little and
wrongly, and so do registered pairs: no residual shows the error, which grows with the time.

It is the shape of the surroundings that tells such a place: how much the points say of the turn in
proportion to what they say in all. Where few points are matched the deviation of a turn is as large
as in a round hall, but it is noise, which the covariance of the poses has, and which pairs reduce.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from recon4.geometry.se3 import ROTATION, TRANSLATION, Array
from recon4.model.odometry_figures import TurnDoubt
from recon4.model.tuning import OBSERVATION
from recon4.registration.step import OdometryStep
from recon4.registration.tuning_matching import DEGENERACY
from recon4.registration.tuning_motion import WEAK_TURNS
from recon4.registration.walk_steps import WalkSteps


def weak_turns(
    steps: WalkSteps, *, with_imu: bool, with_gravity: bool = False
) -> tuple[TurnDoubt, ...]:
    """Find the stretches of `OBSERVATION.weak_s` or more, in order of time.

    Args:
        steps: Of all multiframes.
        with_imu: Whether a gyroscope was used.
        with_gravity: Whether an accelerometer was, too: it holds turns that tilt the body. A level
            LiDAR far from all floors hardly observes such a turn, and cannot drift in it.
    """
    if len(steps) < 2:
        return ()
    t_ns = steps.column("t_mid_ns")
    t_s = 1e-9 * (t_ns - t_ns[0])
    rows = np.flatnonzero(
        [_is_weak(step) and not (with_gravity and _tilts(step)) for step in steps]
    )
    runs = np.split(rows, np.flatnonzero(np.diff(t_s[rows]) > WEAK_TURNS.bridged_s) + 1)
    rate = WEAK_TURNS.rate_sd_rad_s if with_imu else WEAK_TURNS.free_rate_sd_rad_s
    return tuple(
        _doubt([steps[k] for k in run], t_s[run], steps[0].T_odom_body.t, rate_sd_rad_s=rate)
        for run in runs
        if len(run) and t_s[run[-1]] - t_s[run[0]] >= OBSERVATION.weak_s
    )


def _is_weak(step: OdometryStep) -> bool:
    if step.lost or step.stationary:  # one is reported by itself, the other cannot drift
        return False
    by_shape = step.weak_twist_information < DEGENERACY.curved_information
    return (
        bool(by_shape and step.weak_twist_sd_m > WEAK_TURNS.weak_sd_m)
        and _turn_part(step) > DEGENERACY.least_turn
    )


def _tilts(step: OdometryStep) -> bool:
    """Whether the weakest turn is about an axis more level than upright, in odom axes (z up)."""
    turn = step.weak_twist[ROTATION]
    return bool(abs(turn[2]) < WEAK_TURNS.upright * np.linalg.norm(turn))


def _turn_part(step: OdometryStep) -> float:
    """Squared part of the turn in the weakest motion, at the typical distance of the points."""
    turn_m = float(np.linalg.norm(step.weak_twist[ROTATION])) * step.typical_m
    shift_m = float(np.linalg.norm(step.weak_twist[TRANSLATION]))
    return turn_m**2 / max(turn_m**2 + shift_m**2, 1e-12)


def _doubt(
    steps: Sequence[OdometryStep], t_s: Array, start_m: Array, *, rate_sd_rad_s: float
) -> TurnDoubt:
    """Axis and center of the turn from the weakest motions, which are the same turn all along."""
    turns = np.array([step.weak_twist[ROTATION] for step in steps])
    shifts = np.array([step.weak_twist[TRANSLATION] for step in steps])
    length_sq = np.sum(turns**2, axis=1, keepdims=True)
    axis = np.linalg.eigh((turns / length_sq).T @ turns)[1][:, -1]
    to_center = np.cross(turns, shifts) / length_sq
    centers = np.array([step.T_odom_body.t for step in steps]) + to_center - start_m
    x, y, z = np.median(centers, axis=0).tolist()
    return TurnDoubt(
        start_s=float(t_s[0]),
        end_s=float(t_s[-1]),
        axis=(float(axis[0]), float(axis[1]), float(axis[2])),
        center_m=(x, y, z),
        rate_sd_rad_s=rate_sd_rad_s,
    )
