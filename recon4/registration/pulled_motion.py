"""How unsure a motion is where moving objects may have pulled it along.

The covariance of each multiframe says what its points observe. If the points move, it is sure of
the motion of people: near these the motion is known only as well as people walk.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np

from recon4.geometry.se3 import Array
from recon4.model.odometry_figures import MovingFigures
from recon4.registration.moving import is_crowded_at
from recon4.registration.step import OdometryStep
from recon4.registration.walk_steps import WalkSteps


@dataclass(frozen=True, slots=True, kw_only=True)
class PulledTuning:
    """What a trajectory that people pull along may be wrong by."""

    along_m_s: float = 1.5
    """Speed of people who walk along [m/s] …"""
    along_rad_s: float = 0.5
    """… and how fast they turn, if no gyroscope says otherwise [rad/s]."""
    unseen_ns: int = 10_000_000_000
    """Who was found had walked along for this time [ns], maybe without being seen through."""


TUNING = PulledTuning()


def less_sure(
    steps: WalkSteps, moving: MovingFigures, *, with_imu: bool
) -> Iterator[tuple[int, OdometryStep]]:
    """Steps whose covariance says that moving objects may pull them along, with their numbers.

    Args:
        steps: Of the walk.
        moving: What became of the points of moving objects.
        with_imu: Whether a gyroscope knows the turns.
    """
    if not moving.is_severe:
        return
    t_ns = steps.column("t_mid_ns")
    crowded = is_crowded_at(t_ns, moving, within_ns=TUNING.unseen_ns)
    seconds = 1e-9 * float(np.median(np.diff(t_ns)))
    turn_sd = 0.0 if with_imu else TUNING.along_rad_s
    for number in np.flatnonzero(crowded).tolist():
        step = steps[number]
        cov = step.motion_cov + _pulled_cov(step, seconds, turn_sd)
        yield number, replace(step, motion_cov=cov)


def _pulled_cov(step: OdometryStep, seconds: float, turn_sd_rad_s: float) -> Array:
    """Covariance of the motion by which moving objects may pull a step along, (6, 6)."""
    speed_m_s = float(np.linalg.norm(step.T_dense.t[-1] - step.T_dense.t[0])) / seconds
    # As far as from standing still to walking, or from walking to what is faster than that.
    along_m_s = max(TUNING.along_m_s, speed_m_s - TUNING.along_m_s)
    sd = seconds * np.array([0.0, 0.0, turn_sd_rad_s, along_m_s, along_m_s, 0.0])
    return np.diag(sd**2)
