"""An IMU that is mounted otherwise than its rig says is found by the turns of the LiDARs."""

from contextlib import nullcontext
from dataclasses import replace

import numpy as np
import pytest

from recon4.geometry.se3 import SE3, so3_exp
from recon4.model.imu_repair import ImuRepair
from recon4.progress import Silent
from recon4.registration.imu_repairs import with_right_axes
from recon4.registration.stage import run_odometry
from recon4.registration.tracked_walk import WalkInputs
from recon4.registration.turned_imu import turned_imu
from recon4.settings import preset
from recon4.settings.reads import OdometryReads, part_of
from tests.unit.registration.other_imu import Walk

SETTINGS = part_of(preset("indoor"), OdometryReads)
OVER = np.diag([1.0, -1.0, -1.0])
LEFT = np.array([[0.0, 1.0, 0.0], [-1.0, 0.0, 0.0], [0.0, 0.0, 1.0]])
SKEW = so3_exp([0.3, -0.2, 0.5])


def mounted(frames, R):
    """The walk with an IMU that is rotated by R against its rig."""
    return Walk(frames, imu=ImuRepair.turned(R.T).of(frames.imu))


class _Asked(Exception):
    """The axes were compared."""


def _ask():
    raise _Asked


@pytest.mark.parametrize(("R", "asked"), [(np.eye(3), False), (LEFT, True)], ids=["right", "left"])
def test_axes_are_compared_only_where_a_walk_contradicts_the_imu(frames, R, asked, tmp_path):
    walk = WalkInputs(mounted(frames, R), SETTINGS, Silent(), with_right_axes=_ask)

    with pytest.raises(_Asked) if asked else nullcontext():
        assert run_odometry(walk, tmp_path).lost == 0


@pytest.mark.parametrize("R", [OVER, LEFT], ids=["upside down", "x to the left"])
def test_exchanged_axes_are_exchanged_back_exactly(frames, R):
    right, found = with_right_axes(mounted(frames, R), SETTINGS)

    np.testing.assert_array_equal(found.repair.gyro, R)
    np.testing.assert_array_equal(right.imu.gyro_rad_s, frames.imu.gyro_rad_s)
    np.testing.assert_array_equal(right.imu.accel_m_s2, frames.imu.accel_m_s2)
    assert found.turn.explained < 0.85 < 0.95 < found.turn.explained_turned
    assert found.forces_reversed is None


def test_the_mount_that_is_stated_is_the_right_one(frames):
    _, found = with_right_axes(mounted(frames, LEFT), SETTINGS)

    roll, pitch, yaw = np.deg2rad(found.turn.rpy_deg)
    stated = SE3.from_rpy(roll, pitch, yaw, t=[0.0] * 3).R
    np.testing.assert_allclose(stated, frames.rig.T_body_imu.R @ LEFT, atol=1e-9)


def test_a_rotation_that_is_not_of_exchanged_axes_is_found_to_a_degree_or_two(frames):
    found = turned_imu(mounted(frames, SKEW), SETTINGS)

    assert found.angle_rad == pytest.approx(np.linalg.norm([0.3, -0.2, 0.5]), abs=0.03)
    assert SE3(found.R @ SKEW.T, np.zeros(3)).angle() < 0.03


def test_reversed_forces_are_found_on_an_imu_that_was_turned(frames):
    walk = mounted(frames, OVER)
    walk.imu = replace(walk.imu, accel_m_s2=-walk.imu.accel_m_s2)

    right, found = with_right_axes(walk, SETTINGS)

    assert found.forces_reversed < -0.8
    np.testing.assert_array_equal(right.imu.accel_m_s2, frames.imu.accel_m_s2)


@pytest.mark.parametrize(
    "gyro", [np.eye(3), np.diag([1.0, -1.0, 1.0]), so3_exp([0.0, 0.0, 0.1])],
    ids=["right", "left-handed", "6 degrees"],
)  # fmt: skip
def test_an_imu_that_is_right_or_has_another_fault_is_not_turned(frames, gyro):
    imu = replace(frames.imu, gyro_rad_s=frames.imu.gyro_rad_s @ gyro.T)

    assert turned_imu(Walk(frames, imu=imu), SETTINGS) is None


def test_a_late_clock_is_no_rotation(frames):
    late = replace(frames.imu, t_ns=frames.imu.t_ns + 200_000_000)

    assert turned_imu(Walk(frames, imu=late), SETTINGS) is None


def test_turns_about_one_axis_show_no_rotation(frames):
    """Upside down by its yaw alone; how far about the axis itself nothing says."""
    yaw = frames.imu.gyro_rad_s * [0.0, 0.0, 1.0]
    noise = 0.3 * np.random.default_rng(3).standard_normal(yaw.shape)
    imu = replace(frames.imu, gyro_rad_s=(yaw + noise * [1.0, 1.0, 0.0]) @ OVER.T)

    assert turned_imu(Walk(frames, imu=imu), SETTINGS) is None
