"""With an IMU and next to no returns, as under an open sky: fixes place the scans."""

from dataclasses import replace

import numpy as np
import pytest

from recon4.registration.odometry import Odometry
from recon4.settings import Settings
from tests.room_walks import T0_NS
from tests.scanned_room import strolling, strolling_fixes, walk, without_points

FRAMES, EMPTY = 22, range(4, 19)
BIAS_M_S2 = np.array([0.0, 0.4, 0.0])


@pytest.fixture(scope="module")
def open_sky():
    """A walk that begins in a room and sees nothing for a while; a careless accelerometer."""
    stroll = walk(strolling, FRAMES)
    for k in EMPTY:
        stroll.frames[k] = without_points(stroll.frames[k])
    stroll.imu = replace(stroll.imu, accel_m_s2=stroll.imu.accel_m_s2 + BIAS_M_S2)
    return stroll


def tracked(walked, aiding):
    odometry = Odometry(walked.rig, Settings(), walked.imu, aiding=aiding)
    steps = [odometry.push(frame) for frame in walked]
    off = [s.T_odom_body.t - t for s, t in zip(steps, walked.true_poses().t, strict=True)]
    return steps, float(np.linalg.norm(off, axis=1).max())


def test_a_body_that_sees_nothing_is_where_its_fixes_are_and_says_what_it_sees(open_sky):
    steps, worst_m = tracked(open_sky, strolling_fixes(FRAMES))

    assert {(step.lost, step.piece) for step in steps} == {(False, 0)}
    assert worst_m < 0.06
    assert max(steps[k].degeneracy for k in EMPTY) == 0.0


def test_fixes_that_begin_a_quarter_of_a_second_later_place_it_too(open_sky):
    steps, worst_m = tracked(open_sky, strolling_fixes(FRAMES, first_s=0.25))

    assert not any(step.lost for step in steps)
    assert worst_m < 0.06


def test_fixes_that_begin_later_pull_nothing_before_and_place_it_from_then_on(open_sky):
    (late, worst_m), (none, lost_m) = (
        tracked(open_sky, aiding) for aiding in (strolling_fixes(FRAMES, first_s=1.15), None)
    )

    for a, b in zip(late[:11], none[:11], strict=True):
        np.testing.assert_array_equal(a.T_odom_body.t, b.T_odom_body.t)
        np.testing.assert_array_equal(a.T_odom_body.R, b.T_odom_body.R)
    assert all(step.lost for step in none[12:14])
    assert not any(step.lost for step in late[12:])
    assert worst_m < 0.5 * lost_m


def test_without_fixes_it_is_lost(open_sky):
    steps, worst_m = tracked(open_sky, None)

    assert all(step.lost for step in steps[4:10])
    assert worst_m > 0.1


def test_fixes_to_come_or_far_from_the_prediction_place_nothing(open_sky):
    begun = replace(open_sky, frames=open_sky.frames[:8])
    aside = strolling_fixes(FRAMES)
    moved = np.where(aside.t_ns[:, None] > T0_NS + 300_000_000, 30.0, 0.0)
    for useless in (
        strolling_fixes(FRAMES, first_s=1.15),
        replace(aside, p_enu=aside.p_enu + moved),
    ):
        steps, _ = tracked(begun, useless)

        assert steps[6].lost
