"""Absolute trajectory error (L Eq. 9-13) and how truth and estimate are paired."""

import copy

import numpy as np
import pytest

from recon4.errors import OutOfRange
from recon4.evaluation.ate import PosePairs, absolute_error, pair_poses
from recon4.geometry.se3 import SE3
from recon4.model.trajectory import Trajectory

S = 1_000_000_000


def wavy(n: int = 200, *, seed: int = 1) -> Trajectory:
    t = np.linspace(0.0, 20.0, n)
    twists = np.stack([0.1 * np.sin(t), 0.05 * np.cos(t), 0.5 * t], axis=1)
    places = np.stack([3 * np.cos(0.5 * t), 4 * np.sin(0.5 * t), 0.3 * t], axis=1)
    return Trajectory(
        (t * S).astype(np.int64), SE3(SE3.exp(np.pad(twists, ((0, 0), (0, 3)))).R, places)
    )


def noisy(truth: Trajectory, *, seed: int = 2) -> Trajectory:
    rng = np.random.default_rng(seed)
    jitter = SE3.exp(rng.normal(0.0, [0.01] * 3 + [0.03] * 3, (len(truth), 6)))
    T_other_true = SE3.from_rpy(0.2, -0.1, 1.0, t=[10.0, -5.0, 2.0])
    return Trajectory(truth.t_ns, T_other_true @ (truth.T_a_b @ jitter))


def pairs_of(T_map_body: SE3, T_true_body: SE3) -> PosePairs:
    return PosePairs(np.arange(len(T_map_body)) * S, T_map_body, T_true_body, 1.0)


def test_statistics_of_errors_worked_out_on_paper() -> None:
    places = np.array([[0.0, 0, 0], [1, 0, 0], [2, 0, 0], [3, 0, 0]])
    moved = places + np.array([[0, 0, 0], [0, 0.3, 0], [0, 0, -0.4], [0, 0, 0.5]])
    eye = np.broadcast_to(np.eye(3), (4, 3, 3))

    error = absolute_error(pairs_of(SE3(eye, moved), SE3(eye, places)), alignment="none")

    assert error.position_errors_m == pytest.approx([0.0, 0.3, 0.4, 0.5])
    assert error.position_m.rmse == pytest.approx(np.sqrt(0.5 / 4))
    assert error.position_m.mean == pytest.approx(0.3)
    assert error.position_m.median == pytest.approx(0.35)
    assert (error.position_m.minimum, error.position_m.maximum) == pytest.approx((0.0, 0.5))


def test_position_error_does_not_grow_with_the_distance_from_the_origin() -> None:
    far = np.array([[1000.0, 0, 0], [1001, 0, 0], [1001, 1, 0]])
    T_true = SE3(np.broadcast_to(np.eye(3), (3, 3, 3)), far)
    turned = SE3.from_rpy(0.0, 0.0, 0.1, t=[0, 0, 0]).R

    error = absolute_error(
        pairs_of(SE3(np.broadcast_to(turned, (3, 3, 3)), far), T_true), alignment="none"
    )

    assert error.position_m.maximum == pytest.approx(0.0, abs=1e-9)
    assert error.rotation_rad.mean == pytest.approx(0.1)


def test_yaw_alone_hides_a_tilt() -> None:
    truth = wavy().T_a_b
    tilted = SE3(SE3.from_rpy(0.2, 0.0, 0.0, t=[0, 0, 0]).R @ truth.R, truth.t)

    error = absolute_error(pairs_of(tilted, truth), alignment="none")

    assert error.rotation_rad.maximum == pytest.approx(0.2)
    assert error.yaw_rad.maximum == pytest.approx(0.0, abs=1e-9)


def test_yaw_error_beyond_half_a_turn_is_counted_the_short_way() -> None:
    truth = wavy().T_a_b
    turned = SE3(SE3.from_rpy(0.0, 0.0, np.deg2rad(190), t=[0, 0, 0]).R @ truth.R, truth.t)

    error = absolute_error(pairs_of(turned, truth), alignment="none")

    assert np.rad2deg(error.yaw_rad.maximum) == pytest.approx(170.0)


@pytest.mark.parametrize("alignment", ["svd", "first"])
def test_an_aligned_error_does_not_depend_on_the_frames(alignment: str) -> None:
    truth = wavy()
    estimate = noisy(truth)
    T_new_old = SE3.from_rpy(0.5, 0.4, -2.0, t=[100, 20, -3])
    moved = Trajectory(estimate.t_ns, T_new_old @ estimate.T_a_b)

    before = absolute_error(pair_poses(estimate, truth), alignment=alignment)
    after = absolute_error(pair_poses(moved, truth), alignment=alignment)

    assert after.position_errors_m == pytest.approx(before.position_errors_m, abs=1e-9)
    assert after.rotation_errors_rad == pytest.approx(before.rotation_errors_rad, abs=1e-7)


def test_the_svd_fit_is_the_better_one() -> None:
    pairs = pair_poses(noisy(wavy()), wavy())

    svd, first = absolute_error(pairs), absolute_error(pairs, alignment="first")

    assert svd.position_m.rmse < first.position_m.rmse
    assert first.position_errors_m[0] == pytest.approx(0.0, abs=1e-9)


def test_a_perfect_estimate_at_another_rate_has_no_error() -> None:
    truth = wavy(2001)
    estimate = Trajectory(truth.t_ns[::7] + 0, truth.T_a_b[slice(None, None, 7)])

    error = absolute_error(pair_poses(estimate, truth))

    assert error.position_m.maximum < 1e-9
    assert error.rotation_rad.maximum < 1e-6


def test_poses_outside_the_truth_are_left_out_and_counted() -> None:
    truth = wavy()
    half = truth[truth.t_ns <= 10 * S]

    pairs = pair_poses(truth, half)

    assert pairs.coverage_ratio == pytest.approx(0.5)
    assert pairs.t_ns.max() <= 10 * S


def test_poses_in_a_hole_of_the_truth_are_left_out() -> None:
    truth = wavy()
    holed = truth[(truth.t_ns < 5 * S) | (truth.t_ns > 8 * S)]

    pairs = pair_poses(truth, holed)

    assert not np.any((pairs.t_ns > 5 * S) & (pairs.t_ns < 8 * S))
    assert pairs.coverage_ratio == pytest.approx(0.85, abs=0.01)


def test_no_common_time_is_refused_naming_both_spans() -> None:
    truth = wavy()
    later = Trajectory(truth.t_ns + 1000 * S, truth.T_a_b)

    with pytest.raises(OutOfRange, match=r"0 of 200 .* 1000\.000 … 1020\.000 s, truth 0\.000"):
        pair_poses(later, truth)


def test_a_straight_walk_says_that_the_turn_is_open() -> None:
    line = np.stack([np.linspace(0, 10, 50), np.zeros(50), np.zeros(50)], axis=1)
    poses = SE3(np.broadcast_to(np.eye(3), (50, 3, 3)), line)

    assert not absolute_error(pairs_of(poses, poses)).determined
    assert absolute_error(pair_poses(wavy(), wavy())).determined


@pytest.mark.filterwarnings("ignore")
def test_agrees_with_evo() -> None:
    metrics = pytest.importorskip("evo.core.metrics")
    from evo.core.trajectory import PoseTrajectory3D

    truth, estimate = wavy(), noisy(wavy())

    def to_evo(trajectory: Trajectory) -> PoseTrajectory3D:
        return PoseTrajectory3D(
            positions_xyz=trajectory.T_a_b.t,
            orientations_quat_wxyz=trajectory.T_a_b.quat_xyzw()[:, [3, 0, 1, 2]],
            timestamps=trajectory.t_ns / 1e9,
        )

    reference, aligned = to_evo(truth), copy.deepcopy(to_evo(estimate))
    aligned.align(reference)
    position = metrics.APE(metrics.PoseRelation.translation_part)
    position.process_data((reference, aligned))
    rotation = metrics.APE(metrics.PoseRelation.rotation_angle_deg)
    rotation.process_data((reference, aligned))

    ours = absolute_error(pair_poses(estimate, truth))

    assert ours.position_m.rmse == pytest.approx(
        position.get_statistic(metrics.StatisticsType.rmse)
    )
    assert ours.position_m.maximum == pytest.approx(
        position.get_statistic(metrics.StatisticsType.max)
    )
    assert np.rad2deg(ours.rotation_rad.rmse) == pytest.approx(
        rotation.get_statistic(metrics.StatisticsType.rmse), rel=1e-6
    )
