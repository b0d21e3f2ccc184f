"""Mount and clock of a LiDAR from its trajectory and that of another one."""

from dataclasses import replace

import numpy as np
import pytest

from recon4.calibration.trajectory_pair import align_trajectories
from recon4.errors import CalibrationError
from recon4.geometry.se3 import SE3, so3_exp
from recon4.model.trajectory import Trajectory
from recon4.recording.formats.poses import read_tum

T_A_B = SE3(so3_exp([0.3, -1.2, 2.0]), np.array([-0.12, 0.2, -0.3]))
OFFSET_S, RATE = 3.37, 4e-4
START_NS = 1_700_000_000_000_000_000


def walk(t_s):
    """Pose of sensor a: a walk with turns about all axes."""
    turns = np.stack(
        [0.15 * np.sin(1.3 * t_s), 0.2 * np.sin(0.9 * t_s + 1.0), 1.5 * np.sin(0.31 * t_s)], axis=1
    )
    place = np.stack([np.sin(0.2 * t_s) * 8, 1.2 * t_s, 0.05 * np.sin(11 * t_s)], axis=1)
    return SE3(so3_exp(turns), place)


def trajectories(*, noise=0.0, seconds=60.0, flat=False, seed=1):
    """Of sensor a, and of b in another world, on another clock and with poses of its own times."""
    rng = np.random.default_rng(seed)

    def noisy(T):
        step = noise * rng.standard_normal((len(T), 6))
        step[:, :3] *= 0.5
        return T @ SE3.exp(step)

    def at(t_s):
        T = walk(t_s)
        if not flat:
            return T
        yaw = np.zeros((len(t_s), 3))
        yaw[:, 2] = 1.5 * np.sin(0.31 * t_s)
        return SE3(so3_exp(yaw), T.t)

    t_a = np.arange(0.0, seconds, 0.1)
    t_b = np.arange(2.0, seconds - 1.0, 0.05)
    stamp_b = t_b - OFFSET_S - RATE * (t_b - seconds / 2)
    other_world = SE3(so3_exp([0.0, 0.0, 1.0]), np.array([5.0, 6.0, 7.0]))
    a = Trajectory(START_NS + np.rint(1e9 * t_a).astype(np.int64), noisy(at(t_a)))
    b_poses = noisy(other_world @ at(t_b) @ T_A_B)
    return a, Trajectory(START_NS + np.rint(1e9 * stamp_b).astype(np.int64), b_poses)


def test_mount_offset_and_rate_of_a_clock_are_found():
    found = align_trajectories(*trajectories())

    turn, shift = (found.T_a_b.inverse() @ T_A_B).angle(), found.T_a_b.t - T_A_B.t
    assert np.rad2deg(turn) < 0.1
    assert np.linalg.norm(shift) < 0.005
    assert found.offset_s == pytest.approx(OFFSET_S, abs=2e-3)
    assert found.rate == pytest.approx(RATE, abs=5e-5)


def test_the_clock_of_a_rig_file_begins_with_the_first_pose():
    a, b = trajectories()
    found = align_trajectories(a, b)
    offset_s, rate = found.clock

    since_s = (b.t_ns - b.t_ns[0]) / 1e9
    put_right_s = (b.t_ns - START_NS) / 1e9 + offset_s + rate * since_s
    np.testing.assert_allclose(put_right_s, np.arange(2.0, 59.0, 0.05), atol=3e-3)
    assert replace(found, sd_rate=abs(found.rate)).clock == (found.offset_s, 0.0)


def test_the_stated_errors_are_those_that_are_made():
    errors, stated = [], []
    for seed in range(3):
        found = align_trajectories(*trajectories(noise=0.01, seed=seed))
        errors.append([*(found.T_a_b.t - T_A_B.t), found.offset_s - OFFSET_S])
        stated.append([*found.sd_m, found.sd_offset_s])

    ratio = np.abs(errors) / np.array(stated)
    assert np.sqrt(np.mean(ratio**2)) < 2.5
    assert np.median(ratio) > 0.05


def test_a_walk_that_turns_about_one_axis_is_refused_with_the_reason():
    with pytest.raises(CalibrationError, match="turns about one axis only"):
        align_trajectories(*trajectories(flat=True))


def test_trajectories_of_two_walks_are_refused():
    a, _ = trajectories()
    rng = np.random.default_rng(3)
    wandering = np.cumsum(0.03 * rng.standard_normal((500, 6)), axis=0)

    with pytest.raises(CalibrationError, match="do not show the same motion"):
        other = Trajectory(a.t_ns[0] + 50_000_000 * np.arange(500), SE3.exp(wandering))
        align_trajectories(a, other)


def test_a_short_walk_is_refused():
    with pytest.raises(CalibrationError, match="at least 20 s, got 9"):
        align_trajectories(*trajectories(seconds=10.0))


def test_a_real_backpack_is_mounted_as_its_makers_found(data):
    folder = data("calibration/backpack-jt128-avia")
    hesai, livox = (read_tum(folder / name) for name in ("hesai_tum.txt", "livox_tum.txt"))
    T_base_hesai = SE3(np.eye(3), np.array([0.008253, -0.096516, 0.050717]))
    T_base_livox = SE3.from_quat(
        [-0.705785506805, -0.000401950293, 0.708425365747, -0.000397475555],
        [-0.109151776691, -0.286584491313, 0.02305933384],
    )

    found = align_trajectories(hesai, livox[livox.t_ns < livox.t_ns[0] + 145_000_000_000])

    difference = (T_base_hesai.inverse() @ T_base_livox).inverse() @ found.T_a_b
    assert np.rad2deg(difference.angle()) < 0.5  # stated: 2.0° and 7.8 cm
    assert np.linalg.norm(difference.t) < 0.06
    assert abs(found.offset_s) < 0.03  # the stamps were shifted by their median already
    assert abs(found.rate) < 3 * found.sd_rate
