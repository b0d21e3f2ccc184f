"""Without an IMU, with a few returns of bare ground: fixes place the scans that the last do not."""

import numpy as np
import pytest

from recon4.geometry.se3 import SE3
from recon4.registration.odometry import Odometry
from recon4.settings import Settings
from tests.room_walks import T0_NS
from tests.scanned_room import LOW_M, strolling, strolling_fixes, walk

FRAMES, BARE, RETURNS = 28, range(4, 28), 60


def ground_only(frame, rig, rng):
    """The frame with a few returns of the floor."""
    T = strolling((frame.t_ns - T0_NS + frame.dt_ns.astype(np.int64)) * 1e-9)
    p_map = (T @ rig.T_body_sensor[frame.sensor]) @ frame.xyz.astype(np.float64)
    ground = np.flatnonzero(p_map[:, 2] < LOW_M[2] + 0.03)
    return frame.take(np.sort(rng.choice(ground, RETURNS, replace=False)))


@pytest.fixture(scope="module")
def bare():
    stroll, rng = walk(strolling, FRAMES, with_imu=False), np.random.default_rng(1)
    for k in BARE:
        stroll.frames[k] = ground_only(stroll.frames[k], stroll.rig, rng)
    return stroll


def followed(bare, aiding):
    odometry = Odometry(bare.rig, Settings(), None, aiding=aiding)
    steps = [odometry.push(frame) for frame in bare]
    T, true = SE3.stack(step.T_odom_body for step in steps), bare.true_poses()
    off = (true[0].inverse() @ true).inverse() @ (T[0].inverse() @ T)
    return sum(step.lost for step in steps), float(np.linalg.norm(off.t, axis=1).max())


def test_fixes_hold_a_body_that_its_scans_do_not(bare):
    lost, worst_m = followed(bare, strolling_fixes(FRAMES))

    assert lost == 0
    assert worst_m < 0.1


@pytest.mark.study
def test_fixes_that_begin_later_hold_the_body_from_where_they_meet_it(bare):
    first = 12  # multiframe that they cover

    lost, worst_m = followed(bare, strolling_fixes(FRAMES, first_s=1.15))

    assert lost == first - BARE[0]
    assert worst_m < 0.6  # it strolls 0.41 m while nothing places it
