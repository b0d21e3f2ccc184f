from dataclasses import replace

import numpy as np
import pytest

from recon4.geometry.se3 import SE3, align_points
from recon4.model.events import TrackingLost
from recon4.model.samples import ImuSamples
from recon4.progress import Silent
from recon4.recording.formats.poses import read_tum
from recon4.registration.line_odometry import LineOdometry, averaged
from recon4.registration.odometry import Odometry
from recon4.registration.result import Registration, StopReason
from recon4.registration.stage import run_odometry
from recon4.registration.tracked_walk import WalkInputs, make_odometry
from recon4.registration.walk_steps import dense_trajectory
from recon4.settings import Settings, preset
from recon4.store.arrays import load_arrays, load_trajectory
from tests.room_walks import FRAME_NS, T0_NS
from tests.scanned_room import RIG, noise_frame, scan, standing, strolling, walk, without_points
from tests.tuned import with_tuning

STEPS = (
    "frame_id", "t_mid_ns", "quat_xyzw", "t_m", "error_m", "match_ratio", "rounds", "converged",
    "degeneracy", "prediction_offset_m", "lost",
)  # fmt: skip


def push_all(odometry, frames):
    return [odometry.push(frame) for frame in frames]


def poses(steps):
    return SE3.stack(step.T_odom_body for step in steps)


def ate_m(T, T_true):
    aligned = align_points(T_true.t, T.t) @ T.t
    return float(np.sqrt(np.mean(np.sum((aligned - T_true.t) ** 2, axis=1))))


def worst_from_start(T, T_true):
    """Largest distance from the truth, both begun at the first pose [m]."""
    delta = (T_true[0].inverse() @ T_true).inverse() @ (T[0].inverse() @ T)
    return float(np.linalg.norm(delta.t, axis=1).max())


@pytest.fixture(scope="module")
def stroll():
    return walk(strolling, 14)


# -- a person's walk, simulated


@pytest.fixture(scope="module")
def office_odometry(office_walk, tmp_path_factory):
    from recon4.store.frames import FrameStore

    out, watch = tmp_path_factory.mktemp("odometry"), Silent()
    figures = run_odometry(WalkInputs(FrameStore.open(office_walk), Settings(), watch), out)
    return out, figures, watch


def test_a_walk_through_the_office_is_followed_within_two_centimeters(office_odometry, office_walk):
    out, figures, watch = office_odometry
    steps = load_arrays(out / "steps.npz", list(STEPS))
    truth = read_tum(office_walk / "truth.tum").at(steps["t_mid_ns"])
    T = SE3.from_quat(steps["quat_xyzw"], steps["t_m"])

    assert (figures.multiframes, figures.lost, figures.imu) == (60, 0, True)
    assert not steps["lost"].any()
    assert not any(isinstance(event, TrackingLost) for event in watch.events)
    assert ate_m(T, truth) < 0.02
    turned = (T[:-1].inverse() @ T[1:]).inverse() @ (truth[:-1].inverse() @ truth[1:])
    assert np.rad2deg(turned.angle()).max() < 0.3


def test_the_stage_leaves_a_row_a_multiframe_and_a_dense_trajectory(office_odometry, office_frames):
    out, _, _ = office_odometry
    steps = load_arrays(out / "steps.npz", list(STEPS))
    dense = load_trajectory(out / "trajectory.npz")

    np.testing.assert_array_equal(steps["frame_id"], np.arange(60))
    np.testing.assert_array_equal(steps["t_mid_ns"], office_frames.t_mid_ns)
    assert dense.t_ns[0] == office_frames[0].t_ns
    assert dense.t_ns[-1] == office_frames[59].t_ns + FRAME_NS
    assert np.diff(dense.t_ns).max() <= 20_000_000
    assert 60 * 9 < len(dense) < 60 * 13
    middle = dense.at(steps["t_mid_ns"])
    np.testing.assert_allclose(middle.t, steps["t_m"], atol=2e-3)


def test_without_an_imu_the_same_walk_is_followed_within_a_centimeter(office_walk, office_frames):
    """It turns by up to 150°/s and passes a thin partition, where a fit cut short slides."""
    steps = push_all(Odometry(office_frames.rig, Settings(), None), office_frames)

    truth = read_tum(office_walk / "truth.tum").at(office_frames.t_mid_ns)
    assert not any(step.lost for step in steps)
    assert sum(step.converged for step in steps) >= 55
    assert ate_m(poses(steps), truth) < 0.01


# -- in a room made by arithmetic


def test_odom_begins_level_at_the_body(stroll):
    step = Odometry(stroll.rig, Settings(), stroll.imu).push(stroll[0])

    assert not step.lost
    np.testing.assert_allclose(step.T_dense.t[0], 0.0, atol=1e-12)
    np.testing.assert_allclose(step.T_dense.R[0] @ [0, 0, 1], [0, 0, 1], atol=1e-3)


@pytest.mark.parametrize("with_imu", [True, False])
def test_a_stroll_is_followed(stroll, with_imu):
    odometry = Odometry(stroll.rig, Settings(), stroll.imu if with_imu else None)

    steps = push_all(odometry, stroll)

    assert not any(step.lost for step in steps)
    # Without an IMU the initial velocity is not known.
    skipped = 0 if with_imu else 3
    assert worst_from_start(poses(steps)[skipped:], stroll.true_poses()[skipped:]) < 0.03


def test_the_same_frames_give_the_same_bits(stroll):
    one, other = (push_all(Odometry(stroll.rig, Settings(), stroll.imu), stroll) for _ in "ab")

    np.testing.assert_array_equal(poses(one).t, poses(other).t)
    np.testing.assert_array_equal(poses(one).R, poses(other).R)


def test_with_an_imu_a_new_map_is_begun_in_an_unknown_place(stroll):
    settings = with_tuning(Settings(), "odometry.restart_after=3")
    frames = list(stroll)
    for k in (4, 5, 6):
        frames[k] = without_points(frames[k])

    steps = push_all(Odometry(stroll.rig, settings, stroll.imu), frames)

    assert [k for k, step in enumerate(steps) if step.lost] == [4, 5, 6]
    assert steps[7].match_ratio == 0.0  # matched against an empty map
    assert steps[8].match_ratio > 0.4


def test_single_frames_and_the_stage_give_the_same_result(stroll, tmp_path):
    steps = push_all(Odometry(stroll.rig, Settings(), stroll.imu), stroll)
    run_odometry(WalkInputs(stroll, Settings(), Silent()), tmp_path)

    # The stage also knows where the next multiframe begins.
    of_stage = load_arrays(tmp_path / "steps.npz", ["t_m"])["t_m"]
    np.testing.assert_allclose(of_stage, poses(steps).t, atol=5e-4)
    np.testing.assert_array_equal(of_stage[[0, -1]], poses(steps).t[[0, -1]])


def test_a_frame_of_noise_is_lost_and_tracking_continues(stroll):
    frames = list(stroll)
    frames[7] = noise_frame(frames[7])

    steps = push_all(Odometry(stroll.rig, Settings(), stroll.imu), frames)

    assert [k for k, step in enumerate(steps) if step.lost] == [7]
    assert worst_from_start(poses(steps), stroll.true_poses()) < 0.03


def test_the_stage_reports_a_lost_frame(stroll, tmp_path):
    frames = list(stroll)
    frames[7] = without_points(frames[7])
    watch = Silent()

    figures = run_odometry(WalkInputs(replace(stroll, frames=frames), Settings(), watch), tmp_path)

    assert watch.events == [TrackingLost(frame_id=7, t_ns=frames[7].t_mid_ns)]
    assert figures.lost == 1
    lost = load_arrays(tmp_path / "steps.npz", ["lost"])["lost"]
    assert np.flatnonzero(lost).tolist() == [7]


def test_an_empty_frame_is_lost_and_tracking_continues(stroll):
    frames = list(stroll)
    frames[7] = without_points(frames[7])

    steps = push_all(Odometry(stroll.rig, Settings(), stroll.imu), frames)

    assert [k for k, step in enumerate(steps) if step.lost] == [7]
    assert np.isnan(steps[7].error_m)
    assert steps[7].match_ratio == 0.0
    assert worst_from_start(poses(steps), stroll.true_poses()) < 0.03


@pytest.mark.parametrize(("row", "held"), [(0, [0, 1]), (1, [0, 2])])
def test_a_single_sensor_observes_its_plane_and_has_a_degenerate_direction(stroll, row, held):
    # V §3.4: the horizontal one is degenerate vertically, the vertical one sideways.
    frames = [frame.of_sensor(row) for frame in stroll]

    alone = push_all(Odometry(stroll.rig, Settings(), stroll.imu), frames)
    both = push_all(Odometry(stroll.rig, Settings(), stroll.imu), stroll)

    assert not any(step.lost for step in alone)
    off = poses(alone).t - stroll.true_poses().t
    assert np.abs(off - off[0])[:, held].max() < 0.05
    usual = [np.median([step.degeneracy for step in steps[1:]]) for steps in (alone, both)]
    assert usual[0] < 0.01 < 0.05 < usual[1]


def test_another_start_of_the_clock_gives_the_same_motion(stroll):
    later_ns = 86_400_000_000_000
    frames = [replace(frame, t_ns=frame.t_ns + later_ns) for frame in stroll]
    imu = replace(stroll.imu, t_ns=stroll.imu.t_ns + later_ns)

    steps = push_all(Odometry(stroll.rig, Settings(), stroll.imu), stroll)
    moved = push_all(Odometry(stroll.rig, Settings(), imu), frames)

    np.testing.assert_allclose(poses(moved).t, poses(steps).t, atol=1e-9)


def test_a_step_has_the_prediction_offset(stroll):
    biased = replace(stroll.imu, gyro_rad_s=stroll.imu.gyro_rad_s + np.array([0.0, 0.0, 0.02]))

    good = push_all(Odometry(stroll.rig, Settings(), stroll.imu), stroll)
    bad = push_all(Odometry(stroll.rig, Settings(), biased), stroll)

    assert bad[2].prediction_offset_m >= 0.0
    assert worst_from_start(poses(bad), stroll.true_poses()) < 0.03
    assert all(step.degeneracy > 0.05 for step in good[1:])


# -- the documents' odometry


THESIS = preset("thesis")


def test_the_thesis_preset_uses_line_odometry(stroll):
    assert isinstance(make_odometry(stroll.rig, THESIS, None), LineOdometry)
    assert isinstance(make_odometry(stroll.rig, Settings(), None), Odometry)


@pytest.mark.parametrize("mode", ["joined", "averaged"])
@pytest.mark.study
def test_lines_follow_a_slow_motion(mode):
    def slow(t_s):
        return SE3.exp(np.asarray(t_s)[:, None] * [0, 0, 0.05, 0.15, 0.05, 0.0])

    recording = walk(slow, 8, with_imu=False)
    settings = with_tuning(
        THESIS,
        "registration.max_iterations=60",
        "odometry.history=3",
        f"odometry.history_mode={mode}",
    )

    steps = push_all(LineOdometry(recording.rig, settings), recording)

    T, truth = poses(steps), recording.true_poses()
    # The path is 11 cm long: near surfaces alone would suppress most of the motion of the lines.
    assert worst_from_start(T, truth) < 0.01
    assert all(step.converged for step in steps)
    np.testing.assert_array_equal(steps[3].t_ns, T0_NS + np.array([30, 35, 40]) * FRAME_NS // 10)


def test_lines_bridge_a_gap_at_the_speed_they_had():
    def steady(t_s):
        return SE3.exp(np.asarray(t_s)[:, None] * [0, 0, 0.05, 0.15, 0.05, 0.0])

    recording = walk(steady, 11, with_imu=False)
    settings = with_tuning(THESIS, "registration.max_iterations=60")

    steps = push_all(LineOdometry(recording.rig, settings), [*recording[:5], *recording[7:]])

    # Three times as far as in a frame before, and no farther than that in the next one.
    assert max(step.prediction_offset_m for step in steps[4:]) < 0.01
    assert not any(step.lost for step in steps)


def test_lines_keep_the_matches_that_overlap_and_not_a_fixed_half():
    frames = [scan(standing, T0_NS + k * FRAME_NS, frame_id=k, columns=1800) for k in range(2)]
    settings = with_tuning(THESIS, "registration.max_iterations=20")

    steps = push_all(LineOdometry(RIG, settings), frames)

    # What is left out of the view volume lies in bins with fewer than five points.
    assert 0.6 < steps[1].match_ratio < 1.0


def test_the_poses_against_a_history_are_averaged_over_those_that_converged():
    def found(x_m, stop):
        T = SE3.from_rpy(0.0, 0.0, x_m, t=[x_m, 0.0, 0.0])
        return Registration(T, stop, 30, 0.02, 0.5, np.eye(6), 0.1)

    good, bad = StopReason.STEADY_ERROR, StopReason.LIMIT
    mean = averaged([found(0.1, good), found(9.0, bad), found(0.3, good)])
    none = averaged([found(0.1, bad), found(0.3, bad)])

    np.testing.assert_allclose(mean.T_target_source.t, [0.2, 0.0, 0.0], atol=1e-12)
    np.testing.assert_allclose(mean.T_target_source.rpy(), [0.0, 0.0, 0.2], atol=1e-9)
    assert mean.converged
    assert not none.converged


def test_line_odometry_uses_the_gyroscope_if_allowed(stroll):
    settings = with_tuning(THESIS, "odometry.use_imu=true", "registration.max_iterations=30")

    steps = push_all(LineOdometry(stroll.rig, settings, stroll.imu), stroll.frames[:5])

    turned = (poses(steps)[0].inverse() @ poses(steps)[4]).angle()
    assert np.rad2deg(turned) == pytest.approx(8.0, abs=0.7)


def test_line_odometry_works_after_an_empty_first_frame():
    frames = [scan(standing, T0_NS + k * FRAME_NS, frame_id=k) for k in range(4)]
    frames[0] = without_points(frames[0])
    settings = with_tuning(THESIS, "registration.max_iterations=40")

    steps = push_all(LineOdometry(RIG, settings), frames)

    assert not any(step.lost for step in steps)
    assert steps[3].match_ratio > 0.3


def test_line_odometry_loses_an_empty_frame():
    frames = [scan(standing, T0_NS + k * FRAME_NS, frame_id=k) for k in range(4)]
    frames[2] = without_points(frames[2])
    settings = with_tuning(THESIS, "registration.max_iterations=40")

    steps = push_all(LineOdometry(RIG, settings), frames)

    assert [step.lost for step in steps] == [False, False, True, False]


# -- faults of the recording


def test_dense_poses_are_thinned_but_ends_stay(stroll):
    steps = push_all(Odometry(stroll.rig, Settings(), stroll.imu), stroll.frames[:3])

    dense = dense_trajectory(steps)

    assert dense.t_ns[0] == T0_NS
    assert dense.t_ns[-1] == T0_NS + 3 * FRAME_NS
    assert (np.diff(dense.t_ns) > 0).all()
    single = dense_trajectory(steps[:1])
    assert len(single) >= 2


def test_odometry_works_after_an_empty_first_frame(stroll):
    frames = list(stroll)
    frames[0] = without_points(frames[0])

    steps = push_all(Odometry(stroll.rig, Settings(), stroll.imu), frames)

    assert not any(step.lost for step in steps[2:])


def test_an_imu_that_begins_late_leaves_no_nan(stroll):
    late = stroll.imu.t_ns > T0_NS + 700_000_000
    imu = ImuSamples(
        stroll.imu.t_ns[late], stroll.imu.gyro_rad_s[late], stroll.imu.accel_m_s2[late]
    )

    steps = push_all(Odometry(stroll.rig, Settings(), imu), stroll)

    assert np.isfinite(poses(steps).t).all()
    assert worst_from_start(poses(steps)[3:], stroll.true_poses()[3:]) < 0.05


def test_a_gap_of_the_imu_is_not_free_fall(stroll):
    t = stroll.imu.t_ns - T0_NS
    there = (t < 400_000_000) | (t > 900_000_000)
    imu = ImuSamples(
        stroll.imu.t_ns[there], stroll.imu.gyro_rad_s[there], stroll.imu.accel_m_s2[there]
    )

    steps = push_all(Odometry(stroll.rig, Settings(), imu), stroll)

    # How fast the body moves at first is not known with or without a hole.
    assert max(step.prediction_offset_m for step in steps[2:]) < 0.03
    assert worst_from_start(poses(steps), stroll.true_poses()) < 0.03


def test_a_gap_in_the_recording_is_bridged(stroll):
    frames = stroll.frames[:5] + stroll.frames[8:]

    steps = push_all(Odometry(stroll.rig, Settings(), stroll.imu), frames)

    dense = dense_trajectory(steps)
    assert steps[5].t_ns[0] <= frames[5].t_ns
    assert steps[5].t_ns[-1] == frames[5].t_ns + FRAME_NS
    assert not any(step.lost for step in steps)
    T_true = stroll.truth.at(np.array([f.t_mid_ns for f in frames]))
    assert worst_from_start(poses(steps), T_true) < 0.03
    middle = dense.at(np.array([frames[5].t_mid_ns])).t[0]
    np.testing.assert_allclose(middle, poses(steps).t[5], atol=1e-3)
