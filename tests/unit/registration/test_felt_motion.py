"""The accelerometer carries a motion that no LiDAR observes, and contradicts a wrong one."""

from dataclasses import replace
from unittest.mock import Mock

import numpy as np
import pytest
from msgspec import structs

from recon4.geometry.se3 import SE3, Array
from recon4.model.odometry_figures import MovingFigures
from recon4.model.samples import ImuSamples
from recon4.model.trajectory import Trajectory
from recon4.model.tried_hypotheses import Because, TrialVerdict
from recon4.progress import Silent
from recon4.registration import felt_motion as module
from recon4.registration.aiding import GnssAiding
from recon4.registration.choose import Trial, TrialRow
from recon4.registration.felt_motion import FeltMotion, carried, felt_motion, moved_back
from recon4.registration.hypotheses import Choice
from recon4.registration.hypothesis import Hypothesis, ImuAssumption
from recon4.registration.imu_choice import AS_RECORDED
from recon4.registration.score import Score
from recon4.registration.stage import carried_by_accelerometer
from recon4.registration.step import OdometryStep
from recon4.registration.tracked_walk import TrackedWalk, WalkInputs
from recon4.registration.walk_steps import WalkSteps
from recon4.settings import Settings
from tests.unit.registration.test_unseen_rides import RIG, walked

ALONG_X, UP = np.array([1.0, 0.0, 0.0]), np.array([0.0, 0.0, 1.0])
WEAK = slice(60, 110)
"""Five seconds in the middle of the walk."""
ACCEL_NOISE = 0.01
STATED = 0.06**2 * np.eye(6)


def steps_of(trajectory: Trajectory, direction: Array, *, weak: slice = WEAK) -> WalkSteps:
    """Multiframes at 10 Hz whose points hardly observe a direction for a while."""
    t_ns = np.arange(trajectory.t_ns[0], trajectory.t_ns[-1], 100_000_000)
    sd_m = np.full(len(t_ns), 0.005)
    sd_m[weak] = 0.3
    return WalkSteps(
        OdometryStep(
            frame_id=k, t_mid_ns=int(t_ns[k]), T_odom_body=T,
            t_ns=t_ns[k : k + 1], T_dense=SE3.stack([T]),
            error_m=0.01, match_ratio=0.9, rounds=3, converged=True, degeneracy=0.1,
            prediction_offset_m=0.0, lost=False, motion_cov=STATED,
            weak_direction=direction, weak_sd_m=float(sd_m[k]),
        )
        for k, T in enumerate(trajectory.at(t_ns))
    )  # fmt: skip


def after(
    trajectory: Trajectory, imu: ImuSamples, direction: Array, *, seen: Trajectory | None = None
) -> WalkSteps:
    """The steps of an odometry that made ``seen`` of the walk, with what the IMU says of them."""
    made = trajectory if seen is None else seen
    steps = steps_of(made, direction)
    felt = felt_motion(steps, made, imu, rig=RIG, accel_noise=ACCEL_NOISE)
    assert felt is not None
    steps.update(carried(steps, felt))
    return steps


def stated_m(steps: WalkSteps) -> float:
    """Standard deviation of the motion over the weak stretch, all errors being the same."""
    return sum(step.weak_motion_sd_m for step in list(steps)[WEAK])


def test_a_walk_in_parts_is_felt_as_the_whole(monkeypatch: pytest.MonkeyPatch) -> None:
    trajectory, imu = walked("office", seconds=15.0, seed=1)
    whole = [step.motion_cov for step in after(trajectory, imu, UP)]

    monkeypatch.setattr(module, "FELT", structs.replace(module.FELT, at_once=7))
    parts = [step.motion_cov for step in after(trajectory, imu, UP)]

    assert np.allclose(parts, whole, rtol=1e-9, atol=1e-15)


@pytest.mark.parametrize("direction", [ALONG_X, UP], ids=["along", "up"])
@pytest.mark.parametrize("seed", [1, 2, 3])
def test_five_unobserved_seconds_are_known_to_centimeters(direction: Array, seed: int) -> None:
    trajectory, imu = walked("office", seconds=15.0, seed=seed)

    steps = after(trajectory, imu, direction)

    assert 0.005 < stated_m(steps) < 0.12
    listed = list(steps)
    assert all(step.weak_motion_sd_m > 0.0 for step in listed[WEAK])
    others = [*listed[1 : WEAK.start], *listed[WEAK.stop + 1 :]]
    assert all(0.0 < step.weak_motion_sd_m < 3e-4 for step in others)
    assert all((step.motion_cov == STATED).all() for step in others)


def dragged(trajectory: Trajectory, m_s: float, along: Array = ALONG_X) -> Trajectory:
    """The walk as an odometry makes of it that slides back while nothing observes it."""
    start_ns = trajectory.t_ns[0] + 100_000_000 * WEAK.start
    since_s = np.clip((trajectory.t_ns - start_ns) / 1e9, 0.0, 5.0)
    slid = trajectory.T_a_b.t - m_s * since_s[:, None] * along
    return Trajectory(trajectory.t_ns, SE3(trajectory.T_a_b.R, slid))


@pytest.mark.parametrize("m_s", [0.1, 0.3])
def test_a_motion_that_the_accelerometer_contradicts_stays_unknown(m_s: float) -> None:
    trajectory, imu = walked("office", seconds=15.0)

    steps = after(trajectory, imu, ALONG_X, seen=dragged(trajectory, m_s))

    assert stated_m(steps) > 0.8 * 5.0 * m_s


def as_weak_as(sd_m: float, slide_m_s: float = 0.0) -> tuple[FeltMotion, Array]:
    """What is felt of a walk that slides along x while this weak; its true shifts, (N - 1, 3)."""
    trajectory, imu = walked("office", seconds=15.0)
    true_m = steps_of(trajectory, ALONG_X).T_odom_body.t
    seen = dragged(trajectory, slide_m_s)
    steps = steps_of(seen, ALONG_X)
    steps.update([(k, replace(steps[k], weak_sd_m=sd_m)) for k in range(WEAK.start, WEAK.stop)])
    felt = felt_motion(steps, seen, imu, rig=RIG, accel_noise=ACCEL_NOISE)
    assert felt is not None
    return felt, np.diff(true_m, axis=0)


def test_no_threshold_parts_observed_from_weak_steps() -> None:
    below, above = (as_weak_as(sd_m)[0] for sd_m in (0.0199, 0.0201))

    np.testing.assert_allclose(below.cov, above.cov, rtol=0.05, atol=1e-9)
    assert np.all(below.pull_sd_m[WEAK] > 5.0 * as_weak_as(0.005)[0].pull_sd_m[WEAK])


def test_steps_that_are_nearly_weak_and_slide_do_not_pull_the_accelerometer_along() -> None:
    felt, true_m = as_weak_as(0.019, slide_m_s=0.05)

    wrong_m = abs((felt.shift_m - true_m)[WEAK, 0].sum())
    stated_m = np.sqrt(felt.cov[WEAK, 0, 0]).sum()
    assert wrong_m < min(2.0 * stated_m, 0.4 * 5.0 * 0.05)


def test_a_step_that_undoes_a_slide_is_known_to_be_wrong() -> None:
    """It is stated with its own covariance only: the weak steps before it state the slide."""
    trajectory, imu = walked("office", seconds=15.0)
    seen = dragged(trajectory, 0.03)
    back = seen.t_ns >= trajectory.t_ns[0] + 100_000_000 * WEAK.stop
    undone = Trajectory(
        seen.t_ns, SE3(seen.T_a_b.R, np.where(back[:, None], trajectory.T_a_b.t, seen.T_a_b.t))
    )
    steps = steps_of(undone, ALONG_X)

    felt = felt_motion(steps, undone, imu, rig=RIG, accel_noise=ACCEL_NOISE)

    assert felt is not None
    jump = WEAK.stop - 1
    assert steps[jump + 1].weak_sd_m < 0.01
    assert felt.pull_m[jump] == pytest.approx([0.15, 0.0, 0.0], rel=0.5, abs=1e-9)
    assert felt.pull_sd_m[jump + 1 :].max() < 3e-4
    stated = dict(carried(steps, felt))[jump + 1]
    assert stated.weak_motion_sd_m == pytest.approx(0.06)
    np.testing.assert_array_equal(stated.motion_cov, STATED)


def test_heights_are_moved_back_by_what_false_planes_pulled_them_along() -> None:
    trajectory, imu = walked("office", seconds=15.0)
    seen = dragged(trajectory, 0.1, UP)
    steps = steps_of(seen, UP)
    felt = felt_motion(steps, seen, imu, rig=RIG, accel_noise=ACCEL_NOISE)
    assert felt is not None

    poses, left = moved_back(steps, seen, felt)

    wrong_m = poses.T_a_b.t - trajectory.T_a_b.t
    assert abs(wrong_m[:, 2]).max() < 0.1 * 5.0 * 0.1
    np.testing.assert_array_equal(poses.T_a_b.t[:, :2], seen.T_a_b.t[:, :2])
    np.testing.assert_array_equal(poses.T_a_b.R, seen.T_a_b.R)
    at_mid = poses.at(steps.column("t_mid_ns")).t
    np.testing.assert_allclose(steps.T_odom_body.t, at_mid, atol=1e-3)
    np.testing.assert_allclose(steps.column("t_ends_m")[:, 0], at_mid, atol=1e-3)
    assert not left.pull_m.any()


def test_sideways_a_contradiction_is_stated_and_nothing_is_moved() -> None:
    """A tilt of 1 mrad pushes a body sideways by 1.6 m in 18 s."""
    trajectory, imu = walked("office", seconds=15.0)
    seen = dragged(trajectory, 0.1)
    steps = steps_of(seen, ALONG_X)
    felt = felt_motion(steps, seen, imu, rig=RIG, accel_noise=ACCEL_NOISE)
    assert felt is not None

    poses, left = moved_back(steps, seen, felt)

    np.testing.assert_allclose(poses.T_a_b.t, seen.T_a_b.t, atol=1e-12)
    np.testing.assert_array_equal(left.pull_m[:, 0], felt.pull_m[:, 0])


def test_nothing_is_less_sure_than_before_and_other_directions_stay() -> None:
    trajectory, imu = walked("office", seconds=15.0)

    steps = after(trajectory, imu, ALONG_X, seen=dragged(trajectory, 3.0))

    assert 0.9 * 50 * 0.06 < stated_m(steps) < 1.0001 * 50 * 0.06
    surer = after(trajectory, imu, ALONG_X)[WEAK.start].motion_cov
    assert surer[3, 3] < 0.1 * STATED[3, 3]
    np.testing.assert_allclose(surer[4:, 4:], STATED[4:, 4:])
    np.testing.assert_allclose(surer[:3, :3], STATED[:3, :3])


def test_across_missing_samples_nothing_is_carried() -> None:
    trajectory, imu = walked("office", seconds=15.0)
    at_s = (imu.t_ns - trajectory.t_ns[0]) / 1e9
    kept = (at_s < 8.0) | (at_s > 8.5)
    holey = ImuSamples(imu.t_ns[kept], imu.gyro_rad_s[kept], imu.accel_m_s2[kept])

    assert stated_m(after(trajectory, holey, ALONG_X)) > 3.0 * stated_m(
        after(trajectory, imu, ALONG_X)
    )


def carried_walk(trajectory: Trajectory, imu: ImuSamples, *, fixes: bool = False) -> TrackedWalk:
    """What the stage makes of a walk whose height is hardly observed for a while."""
    steps, aiding = steps_of(trajectory, UP), Mock(GnssAiding) if fixes else None
    assumed = ImuAssumption(imu, AS_RECORDED)
    start = Hypothesis(because=Because.START, imu=assumed, aiding=aiding)
    nothing = MovingFigures(t_s=(), ratio=())
    score = Score(multiframes=len(steps), lost=0, residuals_m=np.zeros(len(steps)))
    tracked = TrackedWalk(steps, trajectory, score, nothing, None)
    row = TrialRow(start, score, TrialVerdict.FIRST)
    choice = Choice(Trial(row, tracked), (), nothing)
    recording = WalkInputs(Mock(rig=RIG), Settings(), Silent(), aiding)
    return carried_by_accelerometer(recording, choice, imu).best.tracked


@pytest.mark.parametrize("fixes", [False, True], ids=["without fixes", "with fixes"])
def test_fixes_hold_heights_better_than_the_accelerometer(fixes: bool) -> None:
    trajectory, imu = walked("office", seconds=15.0)
    seen = dragged(trajectory, 0.1, UP)

    made = carried_walk(seen, imu, fixes=fixes)

    assert np.array_equal(made.trajectory.T_a_b.t, seen.T_a_b.t) is fixes
    assert (stated_m(made.steps) > 0.8 * 5.0 * 0.1) is fixes


def test_no_false_plane_explains_a_ride() -> None:
    trajectory, imu = walked("elevator:1", seconds=30.0)

    made = carried_walk(trajectory, imu)

    np.testing.assert_array_equal(made.trajectory.T_a_b.t, trajectory.T_a_b.t)


def test_without_an_accelerometer_nothing_is_felt() -> None:
    trajectory, imu = walked("office", seconds=15.0)
    blind = ImuSamples(imu.t_ns, imu.gyro_rad_s, np.full_like(imu.accel_m_s2, np.nan))

    assert (
        felt_motion(steps_of(trajectory, UP), trajectory, blind, rig=RIG, accel_noise=ACCEL_NOISE)
        is None
    )


@pytest.mark.parametrize(
    "how",
    [
        {"lost": True},
        {"stationary": True},
        {"bridged": True},
        {"weak_direction": np.full(3, np.nan)},
    ],
    ids=["lost", "stands", "bridged", "unknown"],
)
def test_other_multiframes_keep_their_covariance(how: dict[str, object]) -> None:
    trajectory, imu = walked("office", seconds=15.0)
    steps = steps_of(trajectory, UP)
    steps.update([(80, replace(steps[80], **how))])
    felt = felt_motion(steps, trajectory, imu, rig=RIG, accel_noise=ACCEL_NOISE)
    assert felt is not None

    after = dict(carried(steps, felt))

    assert 80 not in after
    assert after[90].weak_motion_sd_m > 0.0
