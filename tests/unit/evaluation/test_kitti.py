"""Drift over pieces of the walk."""

import numpy as np
import pytest

from recon4.evaluation.ate import PosePairs
from recon4.evaluation.kitti import OFFICIAL_M, official_drift, thesis_drift
from recon4.geometry.se3 import SE3


def straight(n: int, *, step_m: float = 1.0, scale: float = 1.0, yaw_per_frame: float = 0.0) -> SE3:
    x = np.arange(n) * step_m * scale
    twists = np.zeros((n, 6))
    twists[:, 2] = np.arange(n) * yaw_per_frame
    return SE3(SE3.exp(twists).R, np.stack([x, 0 * x, 0 * x], axis=1))


def pairs_of(T_map_body: SE3, T_true_body: SE3) -> PosePairs:
    return PosePairs(np.arange(len(T_map_body)) * 100_000_000, T_map_body, T_true_body, 1.0)


def test_a_scale_error_of_two_per_cent_is_a_drift_of_two_per_cent() -> None:
    pairs = pairs_of(straight(1000, scale=1.02), straight(1000))

    assert thesis_drift(pairs).translation == pytest.approx(0.02)
    assert [row.translation for row in thesis_drift(pairs).rows] == pytest.approx([0.02] * 8)


def test_pieces_of_frames_are_counted_by_hand() -> None:
    drift = thesis_drift(pairs_of(straight(250), straight(250)), lengths=(100, 200), step=10)

    assert [row.pieces for row in drift.rows] == [15, 5]
    assert drift.pieces == 20


def test_the_official_piece_ends_at_the_first_pose_beyond_its_length() -> None:
    truth, estimate = straight(12), straight(12, scale=1.1)

    drift = official_drift(pairs_of(estimate, truth), lengths_m=(5.0,), step=100)

    # the end is pose 6 (6 m > 5 m): 0.6 m off over the nominal 5 m
    assert drift.rows[0].translation == pytest.approx(0.6 / 5.0)
    assert "not official" in drift.metric


def test_heading_drift_is_in_radians_per_metre() -> None:
    pairs = pairs_of(straight(1000, yaw_per_frame=0.001), straight(1000))

    assert thesis_drift(pairs).rotation_rad_m == pytest.approx(0.001, rel=1e-6)


def test_drift_does_not_depend_on_the_frame_of_the_estimate() -> None:
    truth, estimate = straight(400), straight(400, scale=1.01, yaw_per_frame=1e-4)
    moved = SE3.from_rpy(0.3, 0.2, 2.0, t=[5, 6, 7]) @ estimate

    before = thesis_drift(pairs_of(estimate, truth))
    after = thesis_drift(pairs_of(moved, truth))

    assert after.translation == pytest.approx(before.translation, rel=1e-9)


def test_a_walk_shorter_than_every_piece_has_no_figure() -> None:
    drift = official_drift(pairs_of(straight(50), straight(50)), lengths_m=OFFICIAL_M)

    assert drift.pieces == 0
    assert np.isnan(drift.translation)
    assert "not official" not in drift.metric


def test_standing_still_has_no_drift_per_metre() -> None:
    poses = straight(300, step_m=1e-5)

    assert thesis_drift(pairs_of(poses, poses), lengths=(100,)).pieces == 0


@pytest.mark.filterwarnings("ignore")
def test_relative_errors_agree_with_evo() -> None:
    metrics = pytest.importorskip("evo.core.metrics")
    from evo.core.trajectory import PosePath3D

    rng = np.random.default_rng(3)
    truth = straight(300, step_m=0.5, yaw_per_frame=0.01)
    estimate = truth @ SE3.exp(rng.normal(0.0, 0.01, (300, 6)))
    rpe = metrics.RPE(
        metrics.PoseRelation.translation_part,
        delta=100,
        delta_unit=metrics.Unit.frames,
        all_pairs=True,
    )
    rpe.process_data(
        (PosePath3D(poses_se3=list(truth.matrix())), PosePath3D(poses_se3=list(estimate.matrix())))
    )

    ours = thesis_drift(pairs_of(estimate, truth), lengths=(100,), step=1)

    assert ours.translation == pytest.approx(rpe.get_statistic(metrics.StatisticsType.mean) / 50.0)
