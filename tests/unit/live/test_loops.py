"""A recognized place moves the map only when that makes it better."""

import numpy as np
import pytest

from recon4.geometry.se3 import SE3, so3_exp
from recon4.live.mapper.loops import LoopGate
from recon4.registration.result import Registration, StopReason

HERE = SE3(so3_exp([0.0, 0.0, 2.0]), np.array([30.0, -20.0, 1.0]))


def found(x_m=0.0, yaw_rad=0.0, *, match_ratio=0.8, degeneracy=0.1):
    """Registration to an old place: the body is off by that much, seen from itself."""
    off = SE3(so3_exp([0.0, 0.0, yaw_rad]), np.array([x_m, 0.0, 0.0]))
    return Registration(
        T_target_source=HERE @ off,
        stop=StopReason.SMALL_STEP,
        iterations=3,
        error_m=0.01,
        match_ratio=match_ratio,
        information=np.eye(6),
        degeneracy=degeneracy,
    )


def test_a_drift_found_twice_moves_the_map_once():
    gate = LoopGate()

    moves = [gate.judge(found(0.30), HERE), gate.judge(found(0.31), HERE)]

    assert moves == [False, True]
    assert (gate.closed, round(gate.drift_m, 2)) == (True, 0.31)


@pytest.mark.parametrize(("x_m", "yaw_rad"), [(0.03, 0.0), (0.03, 0.012), (0.09, 0.0)])
def test_the_noise_of_a_registration_is_left_alone_but_the_loop_is_closed(x_m, yaw_rad):
    gate = LoopGate()

    assert not any(gate.judge(found(x_m, yaw_rad), HERE) for _ in range(5))
    assert gate.closed


@pytest.mark.parametrize(
    "other",
    [
        found(-0.30),
        found(0.30, 0.05),
        None,
        found(0.3, match_ratio=0.4),
        found(0.3, degeneracy=0.001),
    ],
)
def test_two_that_contradict_each_other_are_not_believed(other):
    gate = LoopGate()

    assert not any(gate.judge(one, HERE) for one in (found(0.30), other, found(0.30)))


def test_nothing_is_closed_by_a_view_that_does_not_fit():
    gate = LoopGate()

    gate.judge(found(match_ratio=0.3), HERE)

    assert not gate.closed
