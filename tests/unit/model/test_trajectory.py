"""Interpolated poses within the covered time, and errors outside."""

import tracemalloc

import numpy as np
import pytest

from recon4.errors import OutOfRange
from recon4.geometry.se3 import SE3, matrix_from_quat, quat_from_matrix, so3_exp
from recon4.geometry.tuning import POSE_BLOCK
from recon4.model.trajectory import Trajectory
from recon4.store.arrays import load_trajectory, save_trajectory

S = 1_000_000_000


@pytest.fixture
def corner() -> Trajectory:
    """10 m ahead in 2 s, then a turn to the left by 90° on the spot in 1 s."""
    R = np.stack([np.eye(3), np.eye(3), so3_exp([0.0, 0.0, np.pi / 2])])
    t = np.array([[0.0, 0, 0], [10.0, 0, 0], [10.0, 0, 0]])
    return Trajectory(np.array([100 * S, 102 * S, 103 * S]), SE3(R, t))


def test_between_two_poses_translation_and_rotation_are_linear(corner):
    found = corner.at(np.array([100 * S, 100 * S + S // 2, 102 * S + S // 2, 103 * S]))

    assert np.allclose(found.t[:, 0], [0.0, 2.5, 10.0, 10.0])
    assert np.allclose(np.rad2deg(found.rpy()[:, 2]), [0.0, 0.0, 45.0, 90.0])


def test_times_need_not_be_sorted(corner):
    found = corner.at(np.array([102 * S, 100 * S]))

    assert np.allclose(found.t[:, 0], [10.0, 0.0])


def test_int64_nanoseconds_since_1970_keep_their_nanoseconds():
    t0 = 1_763_690_000 * S
    two = Trajectory(np.array([t0, t0 + 10]), SE3(np.stack([np.eye(3)] * 2), np.eye(2, 3) * 10.0))

    assert np.allclose(two.at(np.array([t0 + 5])).t, [[5.0, 5.0, 0.0]])


@pytest.mark.parametrize("t_ns", [99 * S, 104 * S])
def test_a_time_outside_is_rejected_with_the_covered_span(corner, t_ns):
    with pytest.raises(OutOfRange, match=r"covers 100\.000 … 103\.000 s"):
        corner.at(np.array([t_ns]))


def test_with_slack_the_last_motion_is_extrapolated(corner):
    found = corner.at(np.array([99 * S, 104 * S]), slack_ns=S)

    assert np.allclose(found.t[0], [-5.0, 0.0, 0.0])
    assert np.allclose(np.rad2deg(found[1].rpy()), [0.0, 0.0, 180.0])


def test_a_single_pose_covers_its_own_time_only():
    one = Trajectory(np.array([5 * S]), SE3(np.eye(3)[None], np.ones((1, 3))))

    assert np.allclose(one.at(np.array([5 * S, 5 * S])).t, 1.0)
    with pytest.raises(OutOfRange):
        one.at(np.array([6 * S]))


def test_an_empty_trajectory_raises_an_error():
    with pytest.raises(OutOfRange, match="empty"):
        Trajectory(np.array([], dtype=np.int64), SE3.identity(0)).at(np.array([S]))


def test_no_times_give_no_poses(corner):
    assert len(corner.at(np.array([], dtype=np.int64)).t) == 0


def test_equal_times_fail_an_assertion():
    with pytest.raises(AssertionError):
        Trajectory(np.array([S, S]), SE3.identity(2))


def test_a_part_of_a_trajectory_is_a_trajectory(corner):
    assert corner[1:].t_ns.tolist() == [102 * S, 103 * S]


def test_a_saved_trajectory_is_read_back(corner, tmp_path):
    save_trajectory(tmp_path / "trajectory.npz", corner)

    found = load_trajectory(tmp_path / "trajectory.npz")

    assert np.array_equal(found.t_ns, corner.t_ns)
    assert np.allclose(found.T_a_b.matrix(), corner.T_a_b.matrix())


def test_many_poses_are_interpolated_as_each_alone_in_little_more_memory_than_they_take():
    rng = np.random.default_rng(1)
    count = 3 * POSE_BLOCK.poses + 1
    walk = Trajectory(np.arange(count) * 10**7, SE3.exp(rng.normal(size=(count, 6))))
    t_ns = walk.t_ns[:-1] + 3_000_000

    tracemalloc.start()
    found = walk.at(t_ns)
    peak_bytes = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()

    assert peak_bytes < 2 * (found.R.nbytes + found.t.nbytes) + 1000 * POSE_BLOCK.poses
    for row in (0, POSE_BLOCK.poses - 1, POSE_BLOCK.poses, count - 2):
        alone = walk.at(t_ns[row : row + 1])
        assert np.array_equal(found.R[row], alone.R[0])
        assert np.array_equal(found.t[row], alone.t[0])


def test_a_long_saved_trajectory_is_read_back_bit_for_bit_as_it_was_computed(tmp_path):
    count = POSE_BLOCK.poses + 1
    T = SE3.exp(np.random.default_rng(2).normal(size=(count, 6)))
    save_trajectory(tmp_path / "trajectory.npz", Trajectory(np.arange(count), T))

    found = load_trajectory(tmp_path / "trajectory.npz").T_a_b

    quat = quat_from_matrix(T.R)
    R = matrix_from_quat(np.where(quat[:, 3:] < 0.0, -quat, quat))
    assert np.array_equal(found.R, R) and np.array_equal(found.t, T.t)
