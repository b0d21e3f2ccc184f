"""A walk whose recording begins in motion."""

import numpy as np
import pytest

from recon4.geometry.se3 import SE3
from recon4.recording.formats.poses import read_tum
from recon4.registration import imu_strategy as module
from recon4.registration.imu_strategy import starting_velocity
from recon4.registration.odometry import Odometry
from recon4.registration.walk_steps import dense_trajectory
from recon4.settings import Settings

FIRST = 25
"""Multiframe of the office walk at which the body walks."""


@pytest.fixture
def truth(office_walk, office_frames):
    return read_tum(office_walk / "truth.tum").at(office_frames.t_mid_ns)


def errors_m(frames, truth):
    """How far each pose is from the truth, both begun at the second pose, (N - 1,)."""
    odometry = Odometry(frames.rig, Settings(), frames.imu)
    T = SE3.stack(odometry.push(frames[k]).T_odom_body for k in range(FIRST, len(frames)))[1:]
    true = truth[FIRST + 1 :]
    off = (true[0].inverse() @ true).inverse() @ (T[0].inverse() @ T)
    return np.linalg.norm(off.t, axis=1)


def test_the_velocity_of_the_first_two_scans(office_frames, truth):
    first, second = office_frames[FIRST], office_frames[FIRST + 1]

    found = starting_velocity(first, second, rig=office_frames.rig)

    moved = truth[FIRST].inverse() @ truth[FIRST + 1]
    assert np.linalg.norm(moved.t) > 0.05
    np.testing.assert_allclose(found, moved.t / 0.1, atol=0.25)


def test_a_body_that_stands_has_no_velocity(office_frames):
    standing = office_frames[0], office_frames[1]

    assert starting_velocity(*standing, rig=office_frames.rig) is None
    late = office_frames[FIRST], office_frames[FIRST + 9]
    assert starting_velocity(*late, rig=office_frames.rig) is None


def test_a_walk_that_begins_in_motion_is_followed(office_frames, truth, monkeypatch):
    found = errors_m(office_frames, truth)
    monkeypatch.setattr(module, "starting_velocity", lambda *_, **__: None)
    as_if_standing = errors_m(office_frames, truth)

    assert found.max() < 0.06
    assert as_if_standing.max() > 3.0 * found.max()


def test_poses_inside_the_first_frame_move_too(office_frames, office_walk):
    odometry = Odometry(office_frames.rig, Settings(), office_frames.imu)
    steps = [odometry.push(office_frames[k]) for k in range(FIRST, FIRST + 4)]

    dense = dense_trajectory(steps)

    true = read_tum(office_walk / "truth.tum").at(dense.t_ns)
    middle = int(np.searchsorted(dense.t_ns, steps[1].t_mid_ns))
    T, T_true = (T[middle].inverse() @ T for T in (dense.T_a_b, true))
    off_m = np.linalg.norm(T.t - T_true.t, axis=1)
    reported_m = np.linalg.norm(steps[0].T_dense.t[0] - dense.T_a_b.t[0])
    assert reported_m > 0.03  # before the velocity was known
    assert off_m.max() < 0.02


def test_a_first_frame_that_stands_stays_as_it_was_reported(office_frames):
    odometry = Odometry(office_frames.rig, Settings(), office_frames.imu)
    steps = [odometry.push(office_frames[k]) for k in range(3)]

    dense = dense_trajectory(steps)

    np.testing.assert_array_equal(dense.T_a_b.t[0], steps[0].T_dense.t[0])
