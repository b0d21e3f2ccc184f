"""What a walk over the recording may assume, in the order in which it is tried.

A walk in order is tracked once. Each further hypothesis is suggested by what a walk has shown: an
IMU that is wrong, points that move, fixes that contradict the trajectory.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from functools import partial

import msgspec
import numpy as np
from numpy.typing import NDArray

from recon4.model.frames import RecordedFrames
from recon4.model.odometry_figures import MovingFigures, MovingOutcome
from recon4.model.trajectory import Times, Trajectory
from recon4.model.tried_hypotheses import Because, TriedHypothesis
from recon4.registration.aiding import GnssAiding
from recon4.registration.choose import Trial, Trials, choose
from recon4.registration.hypothesis import Hypothesis, ImuAssumption, Proof
from recon4.registration.hypothesis_table import row_of
from recon4.registration.imu_choice import (
    LESS_USED,
    choose_imu,
    start_and_fastest_turn,
    with_residuals,
    without_forces,
)
from recon4.registration.imu_estimate import ImuEstimate
from recon4.registration.moving import find_moving, hide_moving
from recon4.registration.tracked_walk import TrackedWalk, WalkInputs, track_walk
from recon4.registration.tuning_imu import TURNED_IMU
from recon4.registration.tuning_motion import HYPOTHESES


@dataclass(frozen=True, slots=True, eq=False)
class Choice:
    """The walk that the odometry is made of, and the table of all that were tried."""

    best: Trial[TrackedWalk]
    tried: tuple[TriedHypothesis, ...]
    moving: MovingFigures
    """Moving objects in view, and what became of their points."""


@dataclass(frozen=True, slots=True, eq=False)
class _Shown:
    """Moving objects as a trajectory shows them."""

    because: Because
    trajectory: Trajectory
    pieces: Times
    moving: MovingFigures


def doubts_imu(choice: Choice) -> bool:
    """Whether a walk contradicts its IMU.

    Tracking was lost, the IMU is wrong, less of it is used, or other axes fit the windows better.
    """
    tracked, imu = choice.best.tracked, choice.best.hypothesis.imu
    faults = tracked.estimate.faults if tracked.estimate else ()
    other_axes = max((row.other_axes or 0.0 for row in choice.tried), default=0.0)
    contradicted = bool(faults) or other_axes > TURNED_IMU.doubted_sigmas**2
    return contradicted or tracked.score.lost_in_sight > 0 or imu.choice.outcome in LESS_USED


def choose_walk(recording: WalkInputs) -> Choice:
    """Track a recording until nothing that was shown suggests another hypothesis.

    Args:
        recording: The multiframes with their IMU and fixes.
    """
    hypotheses = _WalkHypotheses(recording)
    trials = choose(hypotheses.list, partial(track_walk, recording), most=_most_walks(recording))
    whole = tuple(row_of(row, whole=True, chosen=row is trials.best.row) for row in trials.rows)
    return Choice(_stated(trials), (*hypotheses.windows, *whole), _moving(recording, trials))


def _stated(trials: Trials[TrackedWalk]) -> Trial[TrackedWalk]:
    """The best one; if a whole walk has shown that forces are wrong, with the residuals of both."""
    best = trials.best
    imu = best.hypothesis.imu
    if imu.choice.outcome != "accelerometer not used" or imu.choice.with_m is not None:
        return best
    others = [row for row in trials.rows if row.hypothesis.imu.choice != imu.choice]
    rival = next((row for row in reversed(others) if row.verdict.wins), None)
    if rival is None:  # the windows left the accelerometer out, not a walk
        return best
    stated = with_residuals(imu, rival.score, best.row.score)
    return replace(best, row=replace(best.row, hypothesis=replace(best.hypothesis, imu=stated)))


def _most_walks(recording: WalkInputs) -> int:
    kept = (recording.aiding is not None) + (recording.earlier is None)
    before = recording.earlier.walks if recording.earlier else 0
    return max(HYPOTHESES.most_walks - kept - before, 1)


class _WalkHypotheses:
    """Lists the hypotheses of a recording, and keeps the table of the windows it looked at."""

    def __init__(self, recording: WalkInputs) -> None:
        self._recording = recording
        self.windows: list[TriedHypothesis] = []

    def list(self, trials: Trials[TrackedWalk]) -> Iterator[Hypothesis]:
        """The next hypothesis, by what those before have shown."""
        first = self._first()
        yield first
        leave_out = self._recording.settings.odometry.leave_out_moving
        if not (leave_out and trials.best.tracked.moving.is_crowded):
            yield from _with_corrected_imu(trials)
            yield from _where_forces_lose(trials, first)
        if leave_out and not is_settled(trials):
            yield from self._without_moving(trials)

    def _first(self) -> Hypothesis:
        """All points, or after a calibration those that were seen before it."""
        recording, earlier = self._recording, self._recording.earlier
        hidden = earlier.hidden if earlier else None
        return Hypothesis(
            because=_because(recording),
            imu=self._imu(recording.seen(hidden), trusted=hidden is not None),
            hidden=hidden,
            aiding=recording.aiding,
            suggested_by=earlier.positions_m if earlier else None,
        )

    def _imu(self, frames: RecordedFrames, *, trusted: bool) -> ImuAssumption:
        """The IMU to begin with, tried on windows."""
        windows = start_and_fastest_turn(frames.imu, frames.t_mid_ns)
        found = choose_imu(frames, self._recording.settings, windows, trusted=trusted)
        self.windows += found.tried
        return found.imu

    def _without_moving(self, trials: Trials[TrackedWalk]) -> Iterator[Hypothesis]:
        """Without moving objects, if these fill the view.

        A trajectory that they pulled along shows them where others are, or not at all. If it
        contradicts the fixes, these show them first; what is left must agree with the fixes.
        """
        first = trials.best
        for shown in self._shown(first):
            yield from self._rounds(trials, first, shown)
            if is_settled(trials):
                return

    def _shown(self, first: Trial[TrackedWalk]) -> Iterator[_Shown]:
        """What moves, by the fixes if these contradict a walk, and by the walk itself."""
        aiding = self._recording.aiding
        if aiding is not None and first.tracked.score.contradicts_fixes:
            by_fixes = _shown_by_fixes(self._recording.frames, aiding)
            if by_fixes.moving.is_crowded:
                yield by_fixes
        by_walk = _shown_by(first.tracked)
        if by_walk.moving.is_crowded:
            yield by_walk

    def _rounds(
        self,
        trials: Trials[TrackedWalk],
        first: Trial[TrackedWalk],
        shown: _Shown,
    ) -> Iterator[Hypothesis]:
        """Walks without what moves, until one does not move the trajectory.

        A trajectory that was pulled along shows only some of the moving objects; the next one,
        without these, shows the others. Who walks along also contradicts the IMU: it is trusted
        first, and doubted again on what is left if that does not hold.
        """
        by_fixes = shown.because is Because.MOVING_BY_FIXES
        before, imu = first, None
        while True:
            hidden = hide_moving(
                self._recording.frames, shown.trajectory, shown.pieces, found=shown.moving
            )
            seen = self._recording.seen(hidden)
            imu = imu or self._imu(seen, trusted=True)
            tried = Hypothesis(
                because=shown.because,
                imu=imu,
                hidden=hidden,
                aiding=self._recording.aiding,
                proof=Proof.HOLDS_WITH_FIXES if by_fixes else Proof.HOLDS,
                rival=first.tracked.score,
                suggested_by=before.tracked.steps.T_odom_body.t,
            )
            yield tried
            if not trials.last.verdict.wins:
                doubted = self._imu(seen, trusted=False)
                if doubted.choice.outcome == imu.choice.outcome:
                    return
                yield replace(tried, imu=doubted)
                if not trials.last.verdict.wins:
                    return
            before = trials.last
            if is_settled(trials):
                yield from _with_corrected_imu(trials)
                return
            shown, imu = _shown_by(before.tracked), _as_found(before)


def _because(recording: WalkInputs) -> Because:
    """Why the first walk is tracked."""
    repairs = recording.repairs
    if repairs.turn is not None or repairs.axes is not None:
        return Because.AXES_REPAIRED
    return Because.START if recording.earlier is None else Because.CALIBRATED


def is_settled(trials: Trials[TrackedWalk]) -> bool:
    """Whether the best walk is that of all points that stand, as far as walks have shown."""
    hidden = trials.best.hypothesis.hidden
    return hidden is not None and any(
        row.hypothesis.hidden is hidden and row.score.is_settled for row in trials.rows
    )


def _with_corrected_imu(trials: Trials[TrackedWalk]) -> Iterator[Hypothesis]:
    """The best one again, with what it found wrong with the IMU corrected from the start.

    Until the scale, the axes and the clock of an IMU are known the trajectory errs by them, and
    what it finds is a part of a large error: the next walk finds the rest.
    """
    while True:
        best = trials.best
        imu = _as_found(best)
        if imu is best.hypothesis.imu:
            return
        yield best.hypothesis.with_imu(imu)
        if trials.best is best:
            return


def _where_forces_lose(trials: Trials[TrackedWalk], first: Hypothesis) -> Iterator[Hypothesis]:
    """The gyroscope alone, if tracking was lost with forces that no correction found.

    Windows of ten multiframes do not show them: a wrong lever arm pushes in turns only. What a walk
    that was lost found wrong with the IMU is forgotten.
    """
    imu = first.imu.samples
    lost = trials.best.tracked.score.lost_in_sight
    if not lost or imu is None or not np.isfinite(imu.accel_m_s2).all():
        return
    yield replace(
        first.with_imu(without_forces(imu)),
        because=Because.GYROSCOPE_ALONE,
        proof=Proof.CLEARLY_BETTER,
    )
    if trials.last is trials.best:
        yield from _with_corrected_imu(trials)


def _as_found(trial: Trial[TrackedWalk]) -> ImuAssumption:
    """The IMU of a walk, corrected by what the walk found wrong with it beyond what it knew."""
    tracked, imu = trial.tracked, trial.hypothesis.imu
    if tracked.estimate is None or not tracked.estimate.faults:
        return imu
    if imu.known is not None and tracked.estimate.confirms(ImuEstimate.of(imu.known)):
        return imu
    return replace(imu, known=tracked.imu_state)


def _shown_by(tracked: TrackedWalk) -> _Shown:
    return _Shown(Because.MOVING_BY_WALK, tracked.trajectory, tracked.pieces, tracked.moving)


def _shown_by_fixes(frames: RecordedFrames, aiding: GnssAiding) -> _Shown:
    pieces, trajectory = _covered(frames, aiding), aiding.trajectory
    moving = find_moving(frames, trajectory, pieces)
    return _Shown(Because.MOVING_BY_FIXES, trajectory, pieces, moving)


def _covered(frames: RecordedFrames, aiding: GnssAiding) -> NDArray[np.int64]:
    """0 for multiframes of which fixes tell the motion, else -1, (N,)."""
    if len(frames) < 2:
        return np.full(len(frames), -1)
    half_ns = int(np.median(np.diff(frames.t_mid_ns))) // 2
    covered = [aiding.covers(t - half_ns, t + half_ns) for t in frames.t_mid_ns.tolist()]
    return np.where(covered, 0, -1)


def _moving(recording: WalkInputs, trials: Trials[TrackedWalk]) -> MovingFigures:
    """What became of the points of moving objects, by the table."""
    best = trials.best
    moving, hidden = best.tracked.moving, best.hypothesis.hidden
    if hidden is None:
        kept = moving.is_crowded and recording.settings.odometry.leave_out_moving
        return msgspec.structs.replace(
            moving, outcome=MovingOutcome.NOT_HELD if kept else MovingOutcome.KEPT
        )
    outcome = MovingOutcome.LEFT_OUT if is_settled(trials) else MovingOutcome.NOT_SETTLED
    if best.tracked.score.contradicts_fixes:
        outcome = MovingOutcome.CONTRADICTED
    return msgspec.structs.replace(moving, outcome=outcome, points_left_out=hidden.count)
