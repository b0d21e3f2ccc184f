"""Axes of an IMU that are not those of its rig are found by the motion of the LiDARs."""

from contextlib import nullcontext
from dataclasses import replace

import numpy as np
import pytest

from recon4.geometry.se3 import SE3, so3_exp
from recon4.model.imu_repair import IMU_REPAIR, ImuRepair
from recon4.model.multiframe import COLUMNS, Multiframe
from recon4.model.odometry_figures import ImuAxes
from recon4.model.tried_hypotheses import Because, walks_of
from recon4.progress import Silent
from recon4.registration.imu_repairs import ImuRepairs, with_right_axes
from recon4.registration.stage import run_odometry
from recon4.registration.tracked_walk import WalkInputs
from recon4.registration.turned_imu import turned_imu
from recon4.settings import preset
from recon4.settings.reads import OdometryReads, part_of
from tests.unit.registration.other_imu import Walk

SETTINGS = part_of(preset("indoor"), OdometryReads)
OVER = np.diag([1.0, -1.0, -1.0])
LEFT = np.array([[0.0, 1.0, 0.0], [-1.0, 0.0, 0.0], [0.0, 0.0, 1.0]])
MIRROR = np.diag([1.0, -1.0, 1.0])
SWAP = np.eye(3)[[1, 0, 2]]
NOISE = np.random.default_rng(5)
SKEW = so3_exp([0.3, -0.2, 0.5])


def mounted(frames, R):
    """The walk with an IMU that is rotated by R against its rig."""
    return Walk(frames, imu=ImuRepair.turned(R.T).of(frames.imu))


class _Asked(Exception):
    """The axes were compared."""


def _ask():
    raise _Asked


@pytest.mark.parametrize(
    ("R", "asked"),
    [(np.eye(3), False), (LEFT, True), (so3_exp([0.0, 0.0, 0.2]), True)],
    ids=["right", "left", "11 degrees about z, which the filter does not see"],
)
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
    assert found.axes is None


def test_the_mount_that_is_stated_is_the_right_one(frames):
    _, found = with_right_axes(mounted(frames, LEFT), SETTINGS)

    roll, pitch, yaw = np.deg2rad(found.turn.rpy_deg)
    stated = SE3.from_rpy(roll, pitch, yaw, t=[0.0] * 3).R
    np.testing.assert_allclose(stated, frames.rig.T_body_imu.R @ LEFT, atol=1e-9)


def test_a_rotation_that_is_not_of_exchanged_axes_is_found_to_a_degree_or_two(frames):
    found = turned_imu(mounted(frames, SKEW), SETTINGS)

    assert SE3(found.mount @ SKEW.T, np.zeros(3)).angle() < 0.03


@pytest.mark.parametrize(
    ("gyro", "accel", "mount", "said"),
    [
        (MIRROR, MIRROR, None, ("x, -y, z", "x, -y, z")),
        (-np.eye(3), np.eye(3), None, ("-x, -y, -z", "x, y, z")),
        (np.eye(3), -np.eye(3), None, ("x, y, z", "-x, -y, -z")),
        (np.eye(3), SWAP, None, ("x, y, z", "y, x, z")),
        (np.diag([1.0, 1.0, -1.0]), np.eye(3), None, ("x, y, -z", "x, y, z")),
        (OVER, -OVER, OVER, ("x, y, z", "-x, -y, -z")),
        (-LEFT, LEFT, LEFT, ("-x, -y, -z", "x, y, z")),
    ],
    ids=["left-handed", "gyro", "forces", "forces' axes", "gyro z", "over, forces", "left, gyro"],
)
def test_each_sensor_gets_axes_and_signs_of_its_own(frames, gyro, accel, mount, said):
    walk = Walk(frames, imu=ImuRepair(gyro.T, accel.T).of(frames.imu))

    right, found = with_right_axes(walk, SETTINGS)

    np.testing.assert_array_equal(right.imu.gyro_rad_s, frames.imu.gyro_rad_s)
    np.testing.assert_array_equal(right.imu.accel_m_s2, frames.imu.accel_m_s2)
    assert (found.axes.gyro, found.axes.accel) == said
    assert (found.turn is None) == (mount is None)
    if mount is not None:
        roll, pitch, yaw = np.deg2rad(found.turn.rpy_deg)
        stated = SE3.from_rpy(roll, pitch, yaw, t=[0.0] * 3).R
        np.testing.assert_allclose(stated, frames.rig.T_body_imu.R @ mount, atol=1e-9)


def test_left_handed_axes_of_an_imu_that_is_turned_oddly_are_found(frames):
    found = turned_imu(mounted(frames, SKEW @ MIRROR), SETTINGS)

    assert np.linalg.norm(found.repair.gyro - SKEW @ MIRROR) < 0.05
    np.testing.assert_array_equal(found.repair.accel, found.repair.gyro)
    np.testing.assert_array_equal(found.of_driver.gyro, -np.eye(3))
    np.testing.assert_allclose(found.mount, -found.repair.gyro)


@pytest.mark.parametrize("axis", np.eye(3), ids="xyz")
def test_a_rotation_of_six_degrees_is_found(frames, axis):
    R = so3_exp(0.1 * axis)

    found = turned_imu(mounted(frames, R), SETTINGS)

    assert SE3(found.repair.gyro @ R.T, np.zeros(3)).angle() < 0.03
    np.testing.assert_array_equal(found.repair.accel, found.repair.gyro)


@pytest.mark.parametrize(
    "changed",
    [
        lambda imu: imu,
        lambda imu: replace(imu, gyro_rad_s=imu.gyro_rad_s @ so3_exp([0.0, 0.0, 0.02])),
        lambda imu: replace(imu, gyro_rad_s=imu.gyro_rad_s * [1.05, 1.0, 0.97]),
        lambda imu: replace(imu, accel_m_s2=imu.accel_m_s2 / 9.8),
        lambda imu: replace(imu, accel_m_s2=0.0 * imu.accel_m_s2 + [0.0, 0.0, 9.8]),
        lambda imu: replace(imu, accel_m_s2=np.full_like(imu.accel_m_s2, np.nan)),
        lambda imu: replace(imu, accel_m_s2=NOISE.normal(0.0, 50.0, imu.accel_m_s2.shape)),
        lambda imu: replace(imu, t_ns=imu.t_ns + 200_000_000),
    ],
    ids=["none", "1 degree", "scale", "g", "constant forces", "no forces", "noise", "late clock"],
)
def test_an_imu_that_is_right_or_has_another_fault_keeps_its_axes(frames, changed):
    assert turned_imu(Walk(frames, imu=changed(frames.imu)), SETTINGS) is None


def test_turns_about_one_axis_show_no_rotation(frames):
    """Upside down by its yaw alone; how far about the axis itself nothing says."""
    yaw = frames.imu.gyro_rad_s * [0.0, 0.0, 1.0]
    noise = 0.3 * np.random.default_rng(3).standard_normal(yaw.shape)
    imu = replace(frames.imu, gyro_rad_s=(yaw + noise * [1.0, 1.0, 0.0]) @ OVER.T)

    assert turned_imu(Walk(frames, imu=imu), SETTINGS) is None


def test_a_walk_tracked_again_with_right_axes_keeps_the_table_of_the_one_before(frames, tmp_path):
    turned = mounted(frames, LEFT)
    right, repairs = with_right_axes(turned, SETTINGS)
    again = WalkInputs(right, SETTINGS, Silent(), repairs=repairs)
    walk = WalkInputs(turned, SETTINGS, Silent(), with_right_axes=lambda: again)

    tried = run_odometry(walk, tmp_path).tried

    whole = [(row.because, row.chosen) for row in tried if row.whole]
    assert whole[0] == (Because.START, False)
    assert (Because.AXES_REPAIRED, True) in whole
    assert sum(chosen for _, chosen in whole) == 1
    assert walks_of(tried) == len(whole) - whole.index((Because.AXES_REPAIRED, True))


class _Blurred(Walk):
    """A walk whose points err by 5 cm: nothing fits it well."""

    def __getitem__(self, k):
        frame = super().__getitem__(k)
        xyz = frame.xyz + NOISE.normal(0.0, 0.05, frame.xyz.shape).astype(np.float32)
        columns = {name: getattr(frame, name) for name in COLUMNS} | {"xyz": xyz}
        return Multiframe(frame.frame_id, frame.t_ns, frame.duration_ns, **columns)


def test_axes_of_a_walk_that_fits_worse_are_not_repaired(frames, tmp_path):
    found = ImuRepairs(ImuRepair.turned(LEFT), axes=ImuAxes(gyro="y", accel="y"))
    worse = WalkInputs(_Blurred(frames), SETTINGS, Silent(), repairs=found)
    walk = WalkInputs(mounted(frames, LEFT), SETTINGS, Silent(), with_right_axes=lambda: worse)

    figures = run_odometry(walk, tmp_path)

    assert figures.imu_axes is None
    assert not (tmp_path / IMU_REPAIR).exists()
    chosen = [row.because for row in figures.tried if row.chosen and row.whole]
    assert chosen and Because.AXES_REPAIRED not in chosen
    assert Because.AXES_REPAIRED in [row.because for row in figures.tried]


def test_a_small_turn_that_the_whole_walk_contradicts_is_not_repaired(frames, tmp_path):
    """Few turns by LiDARs that see little may speak for it."""
    wrong = so3_exp([0.0, 0.0, 0.07])
    scaled = Walk(frames, imu=replace(frames.imu, gyro_rad_s=1.03 * frames.imu.gyro_rad_s))
    found = ImuRepairs(ImuRepair.turned(wrong), axes=ImuAxes(gyro="x", accel="x"))
    turned = WalkInputs(mounted(scaled, wrong), SETTINGS, Silent(), repairs=found)
    walk = WalkInputs(scaled, SETTINGS, Silent(), with_right_axes=lambda: turned)

    figures = run_odometry(walk, tmp_path)

    assert Because.AXES_REPAIRED in [row.because for row in figures.tried]
    assert figures.imu_axes is None
