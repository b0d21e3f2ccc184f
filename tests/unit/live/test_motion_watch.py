"""What the motion of a walk shows of the axes of a rig."""

import numpy as np
import pytest

from recon4.geometry.se3 import SE3, so3_exp
from recon4.live.mapper.live_map import MotionWatch
from recon4.registration.step import OdometryStep

FRAME_S = 0.1


def step(k, T, *, lost=False):
    return OdometryStep(
        frame_id=k, t_mid_ns=round(k * FRAME_S * 1e9), T_odom_body=T,
        t_ns=np.zeros(0, np.int64), T_dense=SE3.identity(1), error_m=0.01, match_ratio=1.0,
        rounds=1, converged=True, degeneracy=0.1, prediction_offset_m=0.0, lost=lost,
        motion_cov=np.zeros((6, 6)),
    )  # fmt: skip


def watched(turn_deg, *, seconds=20.0, lost=False):
    """The message after a motion; ``turn_deg(t_s)`` is the rotation vector of the body."""
    watch = MotionWatch()
    for k in range(round(seconds / FRAME_S)):
        R = so3_exp(np.deg2rad(np.array(turn_deg(k * FRAME_S), float)))
        watch.push(step(k, SE3(R, np.zeros(3)), lost=lost and k % 2 == 1))
    return watch.message()


def shown(message):
    return {(one.quantity, one.axis): one.shown for one in message.axes}


def test_who_stands_still_shows_nothing_but_rest():
    found = watched(lambda t: (0, 0, 0))

    assert found.still_s == pytest.approx(19.9)
    assert set(shown(found).values()) == {0.0}
    assert found.tilt_deg == [0.0, 0.0]
    assert found.turned_deg == [0, 0]


def test_turns_about_the_vertical_leave_its_axis_unknown():
    found = watched(lambda t: (0, 0, 90 * np.sin(t)))

    part = shown(found)
    assert part["rotation", "x"] == part["rotation", "y"] == 1.0
    assert part["rotation", "z"] == 0.0
    assert part["position", "z"] == 0.0
    assert part["position", "x"] > 0.1
    assert part["clock", ""] == 1.0
    assert found.turned_deg[0] > 300
    assert found.turned_deg[1] > 300
    assert found.still_s < 1.0


def test_a_dance_with_tilts_shows_every_axis():
    found = watched(
        lambda t: (25 * np.sin(3 * t), 25 * np.sin(2.3 * t), 90 * np.sin(t)), seconds=40.0
    )

    assert min(shown(found).values()) == 1.0
    assert min(found.tilt_deg) > 30


def test_multiframes_that_are_lost_say_nothing():
    found = watched(lambda t: (25 * np.sin(3 * t), 0, 90 * np.sin(t)), lost=True)

    assert set(shown(found).values()) == {0.0}


def test_the_time_of_a_pause_is_no_motion():
    watch = MotionWatch()
    for k, angle in ((0, 0.0), (1, 0.0), (60, 1.0), (61, 1.0)):
        watch.push(step(k, SE3(so3_exp(np.array([0, 0, angle])), np.zeros(3))))

    assert watch.message().turned_deg == [0, 0]
