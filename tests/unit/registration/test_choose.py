"""The table of hypotheses: who wins, and how often a recording is tracked."""

import weakref
from dataclasses import replace
from itertools import islice, pairwise

import numpy as np
import pytest

from recon4.evaluation.ate import pair_poses
from recon4.model.hidden_points import HiddenPoints
from recon4.model.odometry_figures import ImuChoice, MovingFigures
from recon4.model.samples import ImuSamples
from recon4.model.tried_hypotheses import Because, TrialVerdict
from recon4.progress import Silent
from recon4.recording.formats.poses import read_tum
from recon4.registration import hypotheses as module
from recon4.registration.choose import choose
from recon4.registration.hypotheses import choose_walk
from recon4.registration.hypothesis import Hypothesis, ImuAssumption, Proof
from recon4.registration.odometry import Odometry
from recon4.registration.score import Score
from recon4.registration.stage import earlier_walks, run_odometry
from recon4.registration.tracked_walk import EarlierWalks, TrackedWalk, WalkInputs, track_walk
from recon4.registration.tuning_motion import HYPOTHESES
from recon4.settings import preset

SETTINGS = preset("indoor")
SCALE = 1.1


def with_scale(frames, scale):
    imu = ImuSamples(frames.imu.t_ns, scale * frames.imu.gyro_rad_s, frames.imu.accel_m_s2)
    return replace(frames, imu=imu)


class Read:
    """Multiframes that count how often each was read in a walk over all of them, or the first."""

    def __init__(self, frames, most=None):
        self._frames, self.walks, self.single = frames, 0, 0
        self.rig, self.imu, self.t_mid_ns = frames.rig, frames.imu, frames.t_mid_ns[:most]

    def __len__(self):
        return len(self.t_mid_ns)

    def __getitem__(self, k):
        self.single += 1
        return self._frames[k]

    def __iter__(self):
        self.walks += 1
        return islice(self._frames, len(self))


def tracked_once(frames, known=None):
    imu = ImuAssumption(frames.imu, ImuChoice(outcome="as recorded"), known)
    return track_walk(
        WalkInputs(frames, SETTINGS, Silent()), Hypothesis(because=Because.START, imu=imu)
    )


def turn_error_rad(made: TrackedWalk, office_recording) -> float:
    """Largest error of the orientation against that of the first multiframe."""
    pairs = pair_poses(made.trajectory, read_tum(office_recording / "truth.tum"))
    found, true = pairs.T_map_body, pairs.T_true_body
    left = (true[0].inverse() @ true).inverse() @ (found[0].inverse() @ found)
    return float(np.max(left.angle()))


@pytest.mark.slow
@pytest.mark.study
def test_a_wrong_scale_is_corrected_from_the_start(frames, office_recording):
    walk = Read(with_scale(frames, SCALE))

    choice = choose_walk(WalkInputs(walk, SETTINGS, Silent()))
    first = tracked_once(with_scale(frames, SCALE))

    assert walk.walks == sum(row.whole for row in choice.tried) == 2
    assert [row.because for row in choice.tried if row.chosen and row.whole] == [Because.IMU_FAULTS]
    assert "scale" in first.estimate.faults[0].kind
    errors = [turn_error_rad(made, office_recording) for made in (first, choice.best.tracked)]
    assert errors[1] < 0.6 * errors[0]


def test_a_walk_in_order_is_tracked_once_and_the_table_says_so(frames, tmp_path):
    walk = Read(frames)

    figures = run_odometry(WalkInputs(walk, SETTINGS, Silent()), tmp_path)

    assert walk.walks == 1
    assert figures.imu_faults == ()
    assert [(row.because, row.verdict) for row in figures.tried if row.whole] == [
        (Because.START, TrialVerdict.FIRST)
    ]
    assert earlier_walks(tmp_path).walks == 1
    # Windows of ten multiframes, and one scan a second that is searched for moving objects.
    assert walk.single < 60 + 2 * len(frames) / 10


@pytest.mark.parametrize(
    ("factor", "lost", "verdict"),
    [
        (1.01, 0, TrialVerdict.NO_WORSE),
        (1.05, 0, TrialVerdict.LARGER_RESIDUALS),
        (1.0, 1, TrialVerdict.LOSES_MORE),
    ],
)
def test_a_correction_wins_if_it_loses_nothing_and_lies_as_near(factor, lost, verdict):
    rival = score(0, 0.01)

    assert score(lost, factor * 0.01).no_worse(rival) is verdict


def score(lost, residual_m, **more):
    return Score(multiframes=9, lost=lost, residuals_m=np.full(9, residual_m), **more)


@pytest.mark.parametrize(
    ("tried", "verdict"),
    [
        (score(0, 0.014), TrialVerdict.CLEARLY_BETTER),
        (score(0, 0.016), TrialVerdict.NOT_CLEARLY_BETTER),
        (score(1, 0.001), TrialVerdict.LOSES_MORE),
        (score(0, 0.014, unexplained=0.2), TrialVerdict.TURNS_EXPLAINED),
    ],
)
def test_what_knows_less_must_fit_clearly_better(tried, verdict):
    assert tried.clearly_better(score(0, 0.02)) is verdict


def test_lidars_that_lose_most_multiframes_are_no_witnesses_against_an_imu():
    assert score(4, 0.004).clearly_better(score(6, 0.02)) is TrialVerdict.CLEARLY_BETTER
    assert score(5, 0.004).clearly_better(score(6, 0.02)) is TrialVerdict.SEES_TOO_LITTLE


def test_fewer_points_must_agree_with_the_fixes_that_showed_them():
    wrong, right = (score(0, 0.02, contradicted=ratio) for ratio in (0.2, 0.05))

    assert wrong.holds(score(0, 0.01), with_fixes=True) is TrialVerdict.CONTRADICTS_FIXES
    assert wrong.holds(score(0, 0.01), with_fixes=False).wins
    assert right.holds(score(0, 0.01), with_fixes=True).wins
    assert not score(1, 0.02).holds(score(0, 0.01), with_fixes=True).wins


class Worth:
    """What a hypothesis is worth, without a walk."""

    def __init__(self, found):
        self.score = found


def test_hypotheses_are_listed_lazily_and_a_loser_stays_in_the_table():
    rows_before, lost = [], iter([0, 1, 0, 0])

    def hypotheses(trials):
        while True:
            rows_before.append(len(trials.rows))
            imu = ImuAssumption(None, ImuChoice(outcome="not used"))
            yield Hypothesis(because=Because.START, imu=imu, proof=Proof.NO_WORSE)

    trials = choose(hypotheses, lambda _: Worth(score(next(lost), 0.01)), most=3)

    assert rows_before == [0, 1, 2]
    assert [row.verdict for row in trials.rows] == ["first", "loses more multiframes", "no worse"]
    assert trials.best.row is trials.rows[2]


def test_of_all_walks_that_were_tried_the_best_and_the_last_stay_in_memory():
    made, alive = weakref.WeakSet(), []

    class Walk:
        def __init__(self, score):
            self.score = score

    def track(hypothesis):
        made.add(walk := Walk(score(0, 0.02)))
        alive.append(len(made))
        return walk

    first = Hypothesis(
        because=Because.START, imu=ImuAssumption(None, ImuChoice(outcome="not used"))
    )
    loser = replace(first, proof=Proof.CLEARLY_BETTER)
    trials = choose(lambda _: iter([first, *[loser] * 5]), track, most=6)

    assert alive == [1, 2, 3, 3, 3, 3]
    assert len(trials.rows) == 6
    assert [row.score.residual_m for row in trials.rows] == [0.02] * 6
    assert trials.best.row is trials.rows[0]
    assert trials.last.row is trials.rows[5]


@pytest.mark.parametrize(
    ("earlier", "walks"), [(None, 5), (EarlierWalks(1), 5), (EarlierWalks(5), 1)]
)
@pytest.mark.study
def test_however_much_is_wrong_a_recording_is_tracked_six_times_at_most(
    monkeypatch, frames, earlier, walks
):
    """A crowd that never settles, and an IMU that is doubted each time."""
    walk = Read(with_scale(frames, SCALE), most=25)
    crowded = MovingFigures(t_s=(0.0,), ratio=(0.5,))
    monkeypatch.setattr("recon4.registration.tracked_walk.find_moving", lambda *_: crowded)
    monkeypatch.setattr("recon4.registration.tracked_walk._moved_m", lambda *_: 1.0)
    monkeypatch.setattr(module, "hide_moving", lambda *_, **__: HiddenPoints.of([None] * len(walk)))
    recording = WalkInputs(walk, SETTINGS, Silent(), earlier=earlier)

    choice = choose_walk(recording)

    tracked = sum(row.whole for row in choice.tried)
    assert tracked == walks
    assert tracked + (earlier.walks if earlier else 0) <= HYPOTHESES.most_walks
    assert choice.moving.is_severe


def largest_jump_m(steps) -> float:
    """Of the end of a multiframe from where the next one begins, but for the first [m]."""
    return max(
        float(np.linalg.norm(step.T_dense.t[-1] - after.T_dense.t[0]))
        for step, after in pairwise(list(steps)[1:])
    )


def test_poses_lead_to_where_the_next_multiframe_begins(frames):
    odometry = Odometry(frames.rig, SETTINGS, frames.imu)
    steps = [odometry.push(frame) for frame in frames]

    made = tracked_once(frames)

    assert largest_jump_m(steps) > 1e-4
    assert largest_jump_m(made.steps) < 1e-9
    middles = made.trajectory.at(np.array([step.t_mid_ns for step in made.steps])).t
    stated = np.stack([step.T_odom_body.t for step in made.steps])
    np.testing.assert_allclose(middles, stated, atol=2e-4)
