"""Moving objects that pull the odometry along, with and without fixes that show it."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

from recon4.geometry.se3 import SE3
from recon4.model.odometry_figures import ImuChoice, MovingFigures, MovingOutcome
from recon4.model.samples import ImuSamples
from recon4.model.tried_hypotheses import Because, TrialVerdict
from recon4.progress import Silent
from recon4.registration.aiding import GnssAiding
from recon4.registration.hypotheses import Choice, _stated, choose_walk
from recon4.registration.hypothesis import Hypothesis, ImuAssumption
from recon4.registration.imu_choice import AS_RECORDED, start_and_fastest_turn
from recon4.registration.pulled_motion import less_sure
from recon4.registration.tracked_walk import TrackedWalk, WalkInputs, track_walk
from recon4.registration.walk_steps import WalkSteps
from recon4.settings import Settings, preset
from tests.unit.registration.test_imu_choice import Walk as RecordedWalk
from tests.unit.registration.test_moving import GROUP, ROWS, Walk

SETTINGS = Settings()


class WithoutImu(Walk):
    """A hall without pillars: who walks along is all that holds an odometry without an IMU."""

    def __init__(self, seconds: float = 6.0) -> None:
        super().__init__(GROUP, seconds=seconds)
        self.imu = None


def fixes(walk: Walk, *, scale: float = 1.0) -> GnssAiding:
    """Of an antenna in the body, every tenth of a second of the walk, 2 cm."""
    t_ns = np.arange(-1, len(walk) + 1, dtype=np.int64) * 100_000_000
    places = np.stack([walk.place(max(t, 0)) for t in t_ns])
    return GnssAiding(
        t_ns=t_ns,
        p_enu=scale * (places - places[0]),
        sd_m=np.full((len(t_ns), 3), 0.1),
        R_enu_body=np.tile(np.eye(3), (len(t_ns), 1, 1)),
        attitude_sd_rad=0.01,
        p_body_antenna=np.zeros(3),
    )


def largest_error_m(walk: Walk, made: TrackedWalk) -> float:
    places = np.stack([walk.place(t) for t in walk.t_mid_ns])
    found = SE3.stack(step.T_odom_body for step in made.steps).t
    return float(np.linalg.norm((found - found[0]) - (places - places[0]), axis=1).max())


def processed(walk: Walk, aiding: GnssAiding) -> tuple[TrackedWalk, Choice]:
    """Odometry with all points, and what is chosen."""
    recording = WalkInputs(walk, SETTINGS, Silent(), aiding)
    return tracked_with_all(walk, aiding), choose_walk(recording)


def tracked_with_all(walk: Walk, aiding: GnssAiding | None = None) -> TrackedWalk:
    imu = ImuAssumption(walk.imu, AS_RECORDED)
    hypothesis = Hypothesis(because=Because.START, imu=imu, aiding=aiding)
    return track_walk(WalkInputs(walk, SETTINGS, Silent(), aiding), hypothesis)


def walks(choice: Choice) -> list[Because]:
    """Why each walk over the recording was tried."""
    return [row.because for row in choice.tried if row.whole]


@pytest.mark.slow
@pytest.mark.study
def test_fixes_show_who_pulled_the_odometry_along() -> None:
    walk = Walk(GROUP, ROWS, seconds=4.5)

    made, found = processed(walk, fixes(walk))

    assert largest_error_m(walk, made) > 1.0
    assert largest_error_m(walk, found.best.tracked) < 0.2
    assert found.best.hypothesis.hidden is not None
    assert found.moving.outcome == MovingOutcome.LEFT_OUT
    assert walks(found)[:2] == [Because.START, Because.MOVING_BY_FIXES] and len(walks(found)) <= 4


@pytest.mark.study
def test_what_contradicts_the_fixes_without_them_is_not_said_to_hold() -> None:
    walk = Walk(GROUP, ROWS, seconds=4.5)

    _, found = processed(walk, fixes(walk, scale=1.5))

    assert found.moving.outcome == MovingOutcome.CONTRADICTED and found.moving.is_severe


@pytest.mark.slow
@pytest.mark.study
def test_wrong_fixes_hide_nothing_that_stands() -> None:
    walk = Walk(standing=ROWS, seconds=6.0)

    _, found = processed(walk, fixes(walk, scale=1.5))

    assert walks(found) == [Because.START] and found.best.hypothesis.hidden is None
    assert largest_error_m(walk, found.best.tracked) < 0.05


def test_where_the_rest_does_not_hold_it_the_trajectory_is_as_unsure_as_people_walk_fast() -> None:
    made = tracked_with_all(WithoutImu(seconds=3.0)).steps
    spread = [replace(s, t_mid_ns=s.t_mid_ns + 500_000_000 * k) for k, s in enumerate(made)]
    moving = MovingFigures(t_s=(0.0,), ratio=(0.5,), outcome=MovingOutcome.NOT_HELD)

    steps = WalkSteps(spread)
    sure = steps.column("motion_cov")
    steps.update(less_sure(steps, moving, with_imu=False))
    unsure = steps.column("motion_cov")

    added = np.sqrt(np.einsum("nii->ni", unsure - sure))
    crowded = np.array([s.t_mid_ns - spread[0].t_mid_ns for s in spread]) <= 10_000_000_000
    expected = 0.6 * np.array([0.0, 0.0, 0.5, 1.5, 1.5, 0.0])
    assert added[crowded] == pytest.approx(np.tile(expected, (crowded.sum(), 1)), rel=0.02)
    assert not added[~crowded].any() and 10 < crowded.sum() < 20


def test_what_was_left_out_makes_nothing_less_sure() -> None:
    steps = tracked_with_all(WithoutImu(seconds=1.0)).steps
    moving = MovingFigures(t_s=(0.0,), ratio=(0.5,), outcome=MovingOutcome.LEFT_OUT)

    assert not list(less_sure(steps, moving, with_imu=False))


class Shaken(RecordedWalk):
    """A recording whose accelerometer is pushed where no window of the trial looks."""

    def __init__(self, frames) -> None:
        imu = frames.imu
        windows = start_and_fastest_turn(imu, frames.t_mid_ns)
        tried = {row for window in windows for row in window}
        free = [
            row for row in range(12, len(frames) - 8) if not tried & set(range(row - 2, row + 8))
        ]
        since_s = (imu.t_ns - frames.t_mid_ns[free[0]]) * 1e-9
        accel = imu.accel_m_s2.copy()
        accel[(since_s > 0.0) & (since_s < 0.5)] += [40.0, 0.0, 0.0]
        super().__init__(frames, ImuSamples(imu.t_ns, imu.gyro_rad_s, accel))


def test_forces_that_lose_the_track_outside_of_all_windows_are_not_used(frames) -> None:
    recording = WalkInputs(Shaken(frames), preset("indoor"), Silent(), None)

    found = choose_walk(recording)

    first, alone = (row for row in found.tried if row.whole)
    assert (first.because, alone.because) == (Because.START, Because.GYROSCOPE_ALONE)
    assert first.lost > alone.lost == 0
    choice = found.best.hypothesis.imu.choice
    assert choice.outcome == "accelerometer not used" and choice.with_m > choice.without_m


def test_an_accelerometer_that_only_windows_left_out_states_no_rival_walk() -> None:
    windows = ImuAssumption(None, ImuChoice(outcome="accelerometer not used"))
    hypothesis = SimpleNamespace(imu=windows)
    best = SimpleNamespace(hypothesis=hypothesis)
    row = SimpleNamespace(hypothesis=hypothesis, verdict=TrialVerdict.FIRST)

    assert _stated(SimpleNamespace(best=best, rows=[row])) is best
