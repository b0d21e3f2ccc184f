"""A 2-D laser mounted upside down is found by the gyroscope; one mounted well is left alone."""

import pytest

from recon4.model.laser_upright import turned_round
from recon4.model.trajectory import Trajectory
from recon4.profiler.mirrored import is_mirrored
from recon4.store.line_store import load_laser_scans
from tests.laser_rows import rows_of, with_rows


@pytest.fixture(scope="module")
def scans(frames):
    return load_laser_scans(frames.folder)


@pytest.fixture(scope="module")
def attitude(frames, truth):
    return Trajectory(truth.t_ns, truth.T_a_b @ frames.rig.sensors[0].T_body_sensor)


def test_a_laser_that_turns_with_the_gyroscope_is_upright(scans, attitude):
    assert not is_mirrored(scans, attitude)


def test_ranges_in_reverse_order_are_found(scans, attitude):
    reverse = with_rows(scans, rows_of(scans)[:, ::-1])

    assert is_mirrored(reverse, attitude)
    assert not is_mirrored(turned_round(reverse), attitude)


def test_angles_of_the_wrong_sign_are_found(scans, attitude):
    assert is_mirrored(turned_round(scans), attitude)


def test_a_laser_that_hardly_turns_is_left_alone(scans, attitude):
    still = with_rows(scans[:20], rows_of(scans)[:20, ::-1])

    assert not is_mirrored(still, attitude)
