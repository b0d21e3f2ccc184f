"""Passes of the odometry without moving objects, where these fill the view."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from dataclasses import replace as with_fields
from functools import partial
from typing import Protocol

import numpy as np
from msgspec.structs import replace
from numpy.typing import NDArray

from recon4.geometry.se3 import SE3, Array
from recon4.model.frames import RecordedFrames
from recon4.model.hidden import HiddenPoints
from recon4.model.odometry_figures import MovingFigures, MovingOutcome
from recon4.model.trajectory import Times, Trajectory
from recon4.registration.aiding import GnssAiding
from recon4.registration.moving import StandingFrames, find_moving, hide_moving, is_crowded_at
from recon4.registration.passes import OdometryPass
from recon4.registration.step import OdometryStep

_ROUNDS, _SETTLED_M = 4, 0.1
"""Most passes without moving objects; a trajectory is settled if the last one moved no position by
more than this [m]."""
_REJECTED = 0.1
"""A trajectory that contradicts a larger ratio of the fixes may have been pulled along."""
_ALONG_M_S, _ALONG_RAD_S = 1.5, 0.5
"""Speed of people who walk along [m/s], and without a gyroscope how fast they turn [rad/s]: what a
trajectory that they pull along may be wrong by."""
_UNSEEN_NS = 10_000_000_000
"""Who was found had walked along for this time [ns], maybe without being seen through."""


class Register(Protocol):
    """Registers all multiframes once."""

    def __call__(self, frames: RecordedFrames, /, *, trusted: bool) -> OdometryPass:
        """Odometry of these frames; ``trusted``: see `consistent_imu`."""


@dataclass(frozen=True, slots=True, eq=False)
class Found:
    """A pass, the moving objects in view and their points, which it has not used."""

    made: OdometryPass
    moving: MovingFigures
    hidden: HiddenPoints | None = None


def leave_out_moving(
    frames: RecordedFrames, made: OdometryPass, *, register: Register, aiding: GnssAiding | None
) -> Found:
    """Register again without moving objects, if these fill the view.

    A trajectory that they have pulled along shows them where others are, or not at all. If it
    contradicts the fixes of an INS, these show them first; what is left must agree with the fixes.

    Args:
        frames: The multiframes.
        made: Odometry with all points.
        register: Makes a pass.
        aiding: Fixes of a GNSS/INS, outdoors.
    """
    if aiding is not None and _contradicts(made, aiding):
        shown = _shown_by_fixes(frames, aiding)
        if shown.moving.is_crowded:
            led = _without_moving(frames, shown, made, register=register, fixes=aiding)
            if not led.moving.is_severe:
                return led
    moving = find_moving(frames, made.trajectory, made.pieces)
    if not moving.is_crowded:
        return Found(made, moving)
    shown = _Shown(made.trajectory, made.pieces, moving)
    found = _without_moving(frames, shown, made, register=register)
    if found.hidden is not None and aiding is not None and _contradicts(found.made, aiding):
        return with_fields(found, moving=replace(found.moving, outcome=MovingOutcome.CONTRADICTED))
    return found


def less_sure(found: Found) -> list[OdometryStep]:
    """The steps of a pass; where moving objects may pull it along, their covariance says so."""
    made = found.made
    if not found.moving.is_severe:
        return made.steps
    t_ns = np.array([step.t_mid_ns for step in made.steps])
    crowded = is_crowded_at(t_ns, found.moving, within_ns=_UNSEEN_NS)
    seconds = 1e-9 * float(np.median(np.diff(t_ns)))
    turn_sd = 0.0 if made.imu else _ALONG_RAD_S
    return [
        with_fields(step, motion_cov=step.motion_cov + _pulled_cov(step, seconds, turn_sd))
        if c
        else step
        for step, c in zip(made.steps, crowded, strict=True)
    ]


def _pulled_cov(step: OdometryStep, seconds: float, turn_sd_rad_s: float) -> Array:
    """Covariance of the motion by which moving objects may pull a step along, (6, 6)."""
    speed_m_s = float(np.linalg.norm(step.T_dense.t[-1] - step.T_dense.t[0])) / seconds
    # As far as from standing still to walking, or from walking to what is faster than that.
    along_m_s = max(_ALONG_M_S, speed_m_s - _ALONG_M_S)
    sd = seconds * np.array([0.0, 0.0, turn_sd_rad_s, along_m_s, along_m_s, 0.0])
    return np.diag(sd**2)


def _contradicts(made: OdometryPass, aiding: GnssAiding) -> bool:
    return aiding.rejected_ratio(made.trajectory) > _REJECTED


@dataclass(frozen=True, slots=True, eq=False)
class _Shown:
    """Moving objects as a trajectory shows them."""

    trajectory: Trajectory
    pieces: Times
    moving: MovingFigures


def _shown_by_fixes(frames: RecordedFrames, aiding: GnssAiding) -> _Shown:
    pieces = _covered(frames, aiding)
    return _Shown(aiding.trajectory, pieces, find_moving(frames, aiding.trajectory, pieces))


def _covered(frames: RecordedFrames, aiding: GnssAiding) -> NDArray[np.int64]:
    """0 for multiframes of which fixes tell the motion, else -1, (N,)."""
    if len(frames) < 2:
        return np.full(len(frames), -1)
    half_ns = int(np.median(np.diff(frames.t_mid_ns))) // 2
    covered = [aiding.covers(t - half_ns, t + half_ns) for t in frames.t_mid_ns.tolist()]
    return np.where(covered, 0, -1)


def _without_moving(
    frames: RecordedFrames,
    shown: _Shown,
    made: OdometryPass,
    *,
    register: Register,
    fixes: GnssAiding | None = None,
) -> Found:
    """Passes without moving objects, with the IMU trusted first: they may have contradicted it.

    Args:
        frames: The multiframes.
        shown: What moves.
        made: Odometry with all points.
        register: Makes a pass.
        fixes: Those that a pass must not contradict.
    """

    def fails(now: OdometryPass) -> bool:
        return now.lost > made.lost or (fixes is not None and _contradicts(now, fixes))

    found = Found(made, replace(shown.moving, outcome=MovingOutcome.NOT_HELD))
    for trusted in (True, False) if frames.imu is not None else (True,):
        settled = _settled(
            frames, shown, made, register=partial(register, trusted=trusted), fails=fails
        )
        if settled is not None:
            found = settled
        if not found.moving.is_severe:
            break
    return found


def _settled(
    frames: RecordedFrames,
    shown: _Shown,
    made: OdometryPass,
    *,
    register: Callable[[RecordedFrames], OdometryPass],
    fails: Callable[[OdometryPass], bool],
) -> Found | None:
    """Passes without moving objects until one does not move the trajectory; None if one fails.

    A trajectory that they have pulled along shows only some of them. The next one, without these,
    shows the others.
    """
    now, outcome = made, MovingOutcome.NOT_SETTLED
    for _ in range(_ROUNDS):
        hidden = hide_moving(frames, shown.trajectory, shown.pieces, found=shown.moving)
        before, now = now, register(StandingFrames(frames, hidden))
        if fails(now):
            return None
        moving = find_moving(frames, now.trajectory, now.pieces)
        shown = _Shown(now.trajectory, now.pieces, moving)
        if _moved_m(before.steps, now.steps) < _SETTLED_M:
            outcome = MovingOutcome.LEFT_OUT
            break
    left_out = replace(moving, outcome=outcome, points_left_out=hidden.count)
    return Found(now, left_out, hidden)


def _moved_m(before: list[OdometryStep], after: list[OdometryStep]) -> float:
    """Largest distance of the positions of two passes, which begin at the same place [m]."""
    a, b = (SE3.stack(step.T_odom_body for step in steps).t for steps in (before, after))
    return float(np.linalg.norm((a - a[0]) - (b - b[0]), axis=1).max())
