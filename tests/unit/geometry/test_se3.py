"""SE(3): worked cases, the laws of a group, degenerate inputs."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from recon4.geometry.se3 import (
    SE3,
    align_points,
    interpolate,
    matrix_from_quat,
    mean_rotation,
    quat_from_matrix,
    skew,
    so3_exp,
    so3_log,
)

BELOW_PI = 3.1 / np.sqrt(3.0)


def vectors(bound: float):
    numbers = st.floats(-bound, bound, allow_nan=False, width=64)
    return arrays(np.float64, 3, elements=numbers)


def motions():
    return st.builds(lambda omega, t: SE3(so3_exp(omega), t), vectors(BELOW_PI), vectors(1000.0))


def same(a: SE3, b: SE3, atol: float = 1e-9) -> bool:
    return np.allclose(a.R, b.R, atol=atol) and np.allclose(a.t, b.t, rtol=1e-12, atol=atol * 1e3)


# -- on paper


def test_a_quarter_turn_about_z_takes_x_to_y():
    T_a_b = SE3(so3_exp([0.0, 0.0, np.pi / 2]), np.array([10.0, 0.0, 0.0]))

    moved = T_a_b @ np.array([1.0, 0.0, 0.0])

    assert np.allclose(moved, [10.0, 1.0, 0.0])


def test_the_exponential_of_a_turning_walk_is_a_quarter_circle():
    # One meter per radian ahead while turning left by 90°: a circle of radius 1.
    T = SE3.exp([0.0, 0.0, np.pi / 2, np.pi / 2, 0.0, 0.0])

    assert np.allclose(T.t, [1.0, 1.0, 0.0])


def test_roll_pitch_yaw_turn_about_the_fixed_axes_x_y_z_in_this_order():
    T = SE3.from_rpy(np.pi / 2, 0.0, np.pi / 2, t=[0.0, 0.0, 0.0])

    assert np.allclose(T @ np.array([0.0, 1.0, 0.0]), [0.0, 0.0, 1.0])
    assert np.allclose(T @ np.array([1.0, 0.0, 0.0]), [0.0, 1.0, 0.0])


def test_the_quaternion_of_a_half_turn_about_x():
    assert np.allclose(quat_from_matrix(np.diag([1.0, -1.0, -1.0])), [1.0, 0.0, 0.0, 0.0])


def test_halfway_between_two_poses_is_half_the_way_and_half_the_turn():
    start = SE3.identity()
    end = SE3(so3_exp([0.0, 0.0, 2.0]), np.array([4.0, 2.0, 0.0]))

    half = interpolate(start, end, 0.5)

    assert np.allclose(half.R, so3_exp([0.0, 0.0, 1.0]))
    assert np.allclose(half.t, [2.0, 1.0, 0.0])


def test_the_mean_of_two_turns_lies_between_them_and_weights_pull_it():
    R = np.stack([so3_exp([0.0, 0.0, 0.1]), so3_exp([0.0, 0.0, 0.3])])

    assert np.allclose(so3_log(mean_rotation(R)), [0.0, 0.0, 0.2])
    assert np.allclose(so3_log(mean_rotation(R, np.array([1.0, 0.0]))), [0.0, 0.0, 0.1])


# -- laws


@given(motions(), motions(), motions())
def test_composition_is_associative(a, b, c):
    assert same((a @ b) @ c, a @ (b @ c))


@given(motions())
def test_a_motion_and_its_inverse_cancel(a):
    assert same(a @ a.inverse(), SE3.identity())
    assert same(a.inverse() @ a, SE3.identity())


@given(motions(), motions(), vectors(100.0))
def test_moving_twice_is_moving_by_the_composition(a, b, point):
    assert np.allclose((a @ b) @ point, a @ (b @ point), atol=1e-8)


@given(vectors(BELOW_PI), vectors(50.0))
def test_the_logarithm_undoes_the_exponential(omega, v):
    xi = np.concatenate([omega, v])

    assert np.allclose(SE3.exp(xi).log(), xi, atol=1e-6)


@given(vectors(BELOW_PI), vectors(50.0))
def test_two_half_exponentials_make_a_whole(omega, v):
    # Catches a wrong series that exp and log share, which their round trip cannot.
    half = SE3.exp(np.concatenate([omega, v]) / 2.0)

    assert same(half @ half, SE3.exp(np.concatenate([omega, v])), atol=1e-8)


@given(vectors(1e-3), vectors(1.0))
def test_tiny_turns_agree_with_the_series(omega, v):
    xi = np.concatenate([omega, v])
    M = np.zeros((4, 4))
    M[:3, :3], M[:3, 3] = skew(omega), v
    series = np.eye(4) + M + M @ M / 2.0 + M @ M @ M / 6.0

    assert np.allclose(SE3.exp(xi).matrix(), series, atol=1e-11)


@pytest.mark.parametrize("angle", [1e-9, 5e-5, 0.99e-4, 1.01e-4, 1e-3])
def test_on_both_sides_of_the_switch_to_the_series_the_result_is_the_same(angle):
    omega, v = np.array([0.0, 0.0, angle]), np.array([1.0, 2.0, 3.0])

    # A turn about z by a on paper: x = sin(a)/a vx - (1 - cos(a))/a vy, and so on.
    s, c = np.sin(angle) / angle, 2.0 * np.sin(angle / 2.0) ** 2 / angle
    expected = [s * v[0] - c * v[1], c * v[0] + s * v[1], v[2]]
    assert np.allclose(SE3.exp(np.concatenate([omega, v])).t, expected, rtol=0, atol=1e-12)


@given(motions())
def test_every_rotation_is_proper_and_survives_quaternion_and_matrix(a):
    assert np.allclose(a.R @ a.R.T, np.eye(3), atol=1e-12)
    assert np.linalg.det(a.R) == pytest.approx(1.0)
    assert same(SE3.from_quat(a.quat_xyzw(), a.t), a)
    assert same(SE3.from_matrix(a.matrix()), a)
    assert a.quat_xyzw()[3] >= 0.0


@given(st.floats(-3.1, 3.1), st.floats(-1.5, 1.5), st.floats(-3.1, 3.1))
def test_roll_pitch_yaw_come_back(roll, pitch, yaw):
    assert np.allclose(SE3.from_rpy(roll, pitch, yaw, t=np.zeros(3)).rpy(), [roll, pitch, yaw])


@settings(max_examples=30)
@given(st.lists(motions(), min_size=2, max_size=5))
def test_a_batch_does_what_its_members_do(members):
    batch = SE3.stack(members)
    point = np.array([1.0, 2.0, 3.0])

    assert len(batch) == len(members)
    assert np.allclose(batch.log(), [one.log() for one in members])
    assert np.allclose(batch.inverse().t, [one.inverse().t for one in members])
    assert np.allclose(batch @ point, [one @ point for one in members])
    assert same(batch[1], members[1])


@given(motions())
def test_aligning_moved_points_finds_the_motion(T_a_b):
    p_b = np.random.default_rng(5).normal(size=(20, 3))

    assert same(align_points(T_a_b @ p_b, p_b), T_a_b, atol=1e-7)


@given(motions(), motions(), st.floats(-0.5, 1.5))
def test_interpolation_does_not_depend_on_the_frame_it_is_seen_from(a, step, fraction):
    there = a @ step

    assert same(
        interpolate(a, there, fraction), a @ interpolate(SE3.identity(), step, fraction), atol=1e-7
    )


# -- degenerate


@pytest.mark.parametrize("axis", np.eye(3).tolist())
def test_half_turns_have_a_logarithm_of_length_pi(axis):
    omega = so3_log(so3_exp(np.pi * np.array(axis)))

    assert np.linalg.norm(omega) == pytest.approx(np.pi)
    assert np.allclose(so3_exp(omega), so3_exp(np.pi * np.array(axis)))


def test_nothing_is_the_identity():
    assert same(SE3.exp(np.zeros(6)), SE3.identity())
    assert np.allclose(SE3.identity().log(), 0.0)
    assert len(SE3.stack([])) == 0


def test_points_in_a_plane_are_aligned_without_a_mirror():
    p_b = np.random.default_rng(6).normal(size=(10, 3)) * [1.0, 1.0, 0.0]
    T_a_b = SE3.exp([0.3, -0.2, 1.0, 1.0, 2.0, 3.0])

    found = align_points(T_a_b @ p_b, p_b)

    assert same(found, T_a_b)
    assert np.linalg.det(found.R) == pytest.approx(1.0)


def test_a_mirrored_set_is_answered_with_a_rotation_not_a_mirror():
    p_b = np.random.default_rng(7).normal(size=(10, 3))

    assert np.linalg.det(align_points(p_b * [1.0, 1.0, -1.0], p_b).R) == pytest.approx(1.0)


def test_points_without_weight_do_not_matter():
    p_b = np.random.default_rng(8).normal(size=(10, 3))
    T_a_b = SE3.exp([0.1, 0.2, 0.3, 1.0, 2.0, 3.0])
    p_a = T_a_b @ p_b
    p_a[0] += 100.0

    found = align_points(p_a, p_b, np.r_[0.0, np.ones(9)])

    assert same(found, T_a_b)


def test_a_quaternion_of_any_length_is_the_same_turn():
    assert np.allclose(matrix_from_quat([0.0, 0.0, 2.0, 2.0]), so3_exp([0.0, 0.0, np.pi / 2]))


@pytest.mark.parametrize("angle", [0.0, 1e-9, 0.1, 3.0, np.pi])
def test_a_motion_is_larger_than_a_limit_when_its_size_is(angle):
    T = SE3.exp(np.array([0.6 * angle, 0.0, -0.8 * angle, 0.1, 0.2, 0.3]))
    size_m = T.size_m()

    limits = [0.0, 0.5 * size_m, size_m - 1e-9, size_m, size_m + 1e-9, 1.4 * size_m, 9.0 * size_m]

    assert [T.moves_more_than(limit) for limit in limits] == [size_m > limit for limit in limits]
