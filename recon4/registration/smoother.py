"""What is known of the poses inside a multiframe only when the next one came.

The filter reports each multiframe at once. Afterwards the next one says how fast the first began,
and where each one really ended; both bend poses that were reported already. Equations:
``docs/explanation/odometry.md``.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import replace
from itertools import islice

import numpy as np

from recon4.geometry.se3 import SE3
from recon4.kernels.imu import led_to
from recon4.registration.motion import middle_of
from recon4.registration.step import OdometryStep
from recon4.registration.tuning_motion import DENSE, MOVING_START


def smooth(steps: Iterable[OdometryStep]) -> Iterator[OdometryStep]:
    """The steps of an odometry with all that is known of the poses inside them.

    Each is given when the next one is known.
    """
    return _without_jumps(_begun_in_motion(iter(steps)))


def _begun_in_motion(steps: Iterator[OdometryStep]) -> Iterator[OdometryStep]:
    """The steps with a first frame that moves as fast as the second one begins.

    The velocity at the start is known only with the second frame, when the poses inside the first
    one were already reported: half a frame of a walk puts them 6 cm beside their places.
    """
    begin = list(islice(steps, 2))
    if len(begin) == 2:
        yield _moving_first(*begin)
    yield from begin[-1:]
    yield from steps


def _moving_first(first: OdometryStep, second: OdometryStep) -> OdometryStep:
    """The first step, which moves as fast as the second one begins."""
    if len(first.t_ns) < 2 or second.lost:
        return first
    span_ns = second.t_mid_ns - first.t_mid_ns
    if second.piece != first.piece or not 0 < span_ns <= MOVING_START.longest_ns:
        return first
    # Both at the end of the first frame; what the IMU measured inside it stays.
    there = (second.T_odom_body.t - first.T_odom_body.t) / (1e-9 * span_ns)
    reported = (first.T_dense.t[-1] - first.T_dense.t[-2]) / (1e-9 * np.diff(first.t_ns)[-1])
    missing = there - reported
    if float(np.linalg.norm(missing)) < MOVING_START.moving_m_s:
        return first
    since_s = 1e-9 * (first.t_ns - first.t_mid_ns)
    moving = SE3(first.T_dense.R, first.T_dense.t + since_s[:, None] * missing)
    return replace(first, T_dense=moving)


def _without_jumps(steps: Iterator[OdometryStep]) -> Iterator[OdometryStep]:
    """The steps with inner poses that lead to where the next one begins.

    The next multiframe corrects the pose between both, by up to a millimeter. What it says of the
    end is true of the motion that led there, in proportion to the time: a jump in the last 10 ms
    of every revolution would always meet the same azimuths. How the first multiframe began is not
    known better than by itself.
    """
    yield from islice(steps, 1)
    for step in islice(steps, 1):
        for after in steps:
            yield _led_to(step, after)
            step = after
        yield step


def _led_to(step: OdometryStep, after: OdometryStep) -> OdometryStep:
    if step.lost or after.lost or step.piece != after.piece or step.t_ns[-1] != after.t_ns[0]:
        return step
    T, begin = step.T_dense, after.T_dense[0]
    part = (step.t_ns - step.t_ns[0]) / max(1, int(step.t_ns[-1] - step.t_ns[0]))
    R, p, turn, shift = led_to(part, T.R, T.t, begin.R, begin.t)
    if np.linalg.norm(turn) > DENSE.most_turn_rad or np.linalg.norm(shift) > DENSE.most_shift_m:
        return step
    led, t_s = SE3(R, p), 1e-9 * (step.t_ns - step.t_ns[0])
    return replace(step, T_dense=led, T_odom_body=middle_of(t_s, led))
