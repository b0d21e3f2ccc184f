"""Which samples of an IMU to begin with: tried on short windows, of a recording or of a live walk.

The windows are witnesses. They say which hypothesis a walk begins with; they track nothing whole.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from itertools import pairwise
from typing import Protocol

import msgspec
import numpy as np

from recon4.geometry.se3 import Array, so3_log
from recon4.model.frames import Frames
from recon4.model.odometry_figures import ImuChoice
from recon4.model.samples import ImuSamples
from recon4.model.tried_hypotheses import Because, TrialVerdict, TriedHypothesis
from recon4.registration.choose import Trials, choose
from recon4.registration.gyro_alignment import for_other_axes
from recon4.registration.hypothesis import Hypothesis, ImuAssumption, Proof
from recon4.registration.hypothesis_table import row_of
from recon4.registration.motion import ImuMotion
from recon4.registration.odometry import Odometry
from recon4.registration.score import Score
from recon4.registration.step import OdometryStep
from recon4.settings.reads import OdometryReads


@dataclass(frozen=True, slots=True, kw_only=True)
class WindowTuning:
    """Windows on which variants of an IMU are tried."""

    frames: int = 10
    """Multiframes of one window."""
    settling: int = 10
    """A window that begins within a turn knows neither the tilt nor the velocity of the body: what
    looks like a wrong accelerometer is tried again from this many multiframes before."""
    rest_ns: int = 500_000_000
    """The gyroscope bias is its mean over this time from the start, if the body is stationary."""
    zero_rad_s: float = 0.06
    """Odometry estimates a smaller bias itself (its prior is a third of this)."""
    most: int = 4
    """Most variants on the same windows."""


TUNING = WindowTuning()
AS_RECORDED = ImuChoice(outcome="as recorded")
LESS_USED = ("accelerometer not used", "not used")
"""Outcomes that leave something of the IMU out."""


class FramesWithImu(Frames, Protocol):
    """Multiframes with their IMU, of a recording or the last ones of a live walk."""

    @property
    def imu(self) -> ImuSamples | None:
        """IMU samples, if there are any."""


@dataclass(frozen=True, slots=True, eq=False)
class TriedWindow:
    """Multiframes that are registered by themselves; those that settle do not count."""

    rows: range
    settling: int = 0


@dataclass(frozen=True, slots=True, eq=False)
class TrackedWindows:
    """Windows tracked with one hypothesis."""

    score: Score
    odometry: Odometry
    """Of the last window, to go on with …"""
    last: OdometryStep
    """… and its last step."""


@dataclass(frozen=True, slots=True, eq=False)
class ImuTrials:
    """The IMU to begin with, and the table of what was tried."""

    imu: ImuAssumption
    tried: tuple[TriedHypothesis, ...] = ()
    best: TrackedWindows | None = None
    """The windows as the chosen one tracked them; None = nothing was tried."""


def choose_imu(
    frames: FramesWithImu,
    settings: OdometryReads,
    windows: Sequence[range],
    *,
    trusted: bool = False,
) -> ImuTrials:
    """Choose the samples as recorded, with the gyroscope's bias removed, without forces, or none.

    A variant that knows less must fit the LiDARs clearly better. A gyroscope may have a bias of
    tens of degrees a second (HDL-32E), its axes may be swapped, its clock may be offset. One that
    measures the turns which the LiDARs see without it is not at fault: then only the accelerometer
    can be (tried with multiframes to settle), or a LiDAR is.

    Args:
        frames: The multiframes with their rig and IMU.
        settings: Of the odometry.
        windows: Multiframes to try.
        trusted: Whether nothing but a bias is wrong with it: who walks along contradicts an IMU.
    """
    imu = frames.imu
    planes = settings.registration.solver == "planes"
    if imu is None or len(imu) < 2 or not settings.odometry.use_imu or not planes:
        return ImuTrials(ImuAssumption(imu, AS_RECORDED))
    plain = [TriedWindow(rows) for rows in windows]
    trials = choose(
        lambda table: _variants(frames, imu, table, trusted=trusted),
        lambda hypothesis: _track(frames, hypothesis, settings=settings, windows=plain),
        most=TUNING.most,
    )
    if trials.best.hypothesis.because is not Because.GYROSCOPE_ALONE:
        return _chosen([trials])
    settling = [_begun_earlier(window, len(frames)) for window in plain]
    settled = choose(
        lambda _: _both_settled(trials),
        lambda hypothesis: _track(frames, hypothesis, settings=settings, windows=settling),
        most=2,
    )
    return _chosen([trials, settled])


def without_imu(frames: FramesWithImu, settings: OdometryReads) -> ImuTrials:
    """The multiframes tracked by the LiDARs alone: of a gyroscope that does not measure."""
    imu = ImuAssumption(None, ImuChoice(outcome="not used"))
    hypothesis = Hypothesis(because=Because.LIDARS_ALONE, imu=imu)
    windows = [TriedWindow(range(len(frames)))]
    return ImuTrials(imu, (), _track(frames, hypothesis, settings=settings, windows=windows))


def start_and_fastest_turn(
    imu: ImuSamples | None, t_mid_ns: np.ndarray[tuple[int], np.dtype[np.int64]]
) -> list[range]:
    """Windows at the start of a recording, and where its IMU turns most.

    Args:
        imu: Its samples.
        t_mid_ns: Middle of each multiframe [ns], (N,).
    """
    count, length = len(t_mid_ns), TUNING.frames
    last = count - length
    if imu is None or last <= length:
        return [range(min(length, count))]
    off = imu.gyro_rad_s - np.median(imu.gyro_rad_s, axis=0)
    turned_rad = np.cumsum(np.linalg.norm(off, axis=1) * np.gradient(imu.t_ns * 1e-9))
    at = np.interp((t_mid_ns - imu.t_ns[0]) * 1e-9, (imu.t_ns - imu.t_ns[0]) * 1e-9, turned_rad)
    fastest = int(np.argmax(at[length:] - at[:-length]))
    return [range(length), range(fastest, fastest + length)]


def _variants(
    frames: FramesWithImu, imu: ImuSamples, trials: Trials[TrackedWindows], *, trusted: bool
) -> Iterator[Hypothesis]:
    """What may be wrong with an IMU, each as those before suggest it."""
    yield Hypothesis(because=Because.START, imu=ImuAssumption(imu, AS_RECORDED))
    zero_rad_s = _zero(imu, int(frames[0].t_ns))
    if np.linalg.norm(zero_rad_s) > TUNING.zero_rad_s:
        yield Hypothesis(
            because=Because.BIAS, imu=_without_bias(imu, zero_rad_s), proof=Proof.CLEARLY_BETTER
        )
    if trusted:
        return
    used = trials.best
    yield Hypothesis(
        because=Because.LIDARS_ALONE,
        imu=ImuAssumption(None, ImuChoice(outcome="not used")),
        proof=Proof.CLEARLY_BETTER,
        doubted=used.hypothesis.imu,
    )
    if trials.last.verdict is TrialVerdict.TURNS_EXPLAINED:
        assert used.hypothesis.imu.samples is not None
        yield Hypothesis(
            because=Because.GYROSCOPE_ALONE,
            imu=without_forces(used.hypothesis.imu.samples),
            proof=Proof.CLEARLY_BETTER,
        )


def _without_bias(imu: ImuSamples, zero_rad_s: Array) -> ImuAssumption:
    x, y, z = zero_rad_s.tolist()
    return ImuAssumption(
        ImuSamples(imu.t_ns, imu.gyro_rad_s - zero_rad_s, imu.accel_m_s2),
        ImuChoice(outcome="bias removed", bias_rad_s=(x, y, z)),
    )


def without_forces(imu: ImuSamples) -> ImuAssumption:
    """The gyroscope alone."""
    return ImuAssumption(
        ImuSamples(imu.t_ns, imu.gyro_rad_s, np.full_like(imu.accel_m_s2, np.nan)),
        ImuChoice(outcome="accelerometer not used"),
    )


def with_residuals(imu: ImuAssumption, rival: Score, own: Score) -> ImuAssumption:
    """The same, with the residuals of the rival that uses more of the IMU, and its own."""
    figures = {"with_m": rival.residual_m, "without_m": own.residual_m}
    return replace(imu, choice=msgspec.structs.replace(imu.choice, **figures))


def _both_settled(trials: Trials[TrackedWindows]) -> Iterator[Hypothesis]:
    """With and without forces again, on windows that begin earlier."""
    wins = [row.hypothesis for row in trials.rows if row.verdict.wins]
    for hypothesis in wins[-2:]:
        yield replace(hypothesis, because=Because.SETTLED)


def _begun_earlier(window: TriedWindow, count: int) -> TriedWindow:
    settling = min(TUNING.settling, max(count - TUNING.frames, 0))
    first = max(window.rows.start - settling, 0)
    return TriedWindow(range(first, min(first + settling + len(window.rows), count)), settling)


def _track(
    frames: FramesWithImu,
    hypothesis: Hypothesis,
    *,
    settings: OdometryReads,
    windows: Sequence[TriedWindow],
) -> TrackedWindows:
    """Register each window by itself; of the multiframes that settle nothing counts."""
    counted: list[list[OdometryStep]] = []
    for window in windows:
        odometry = Odometry(frames.rig, settings, hypothesis.imu.samples)
        steps = [odometry.push(frames[k]) for k in window.rows]
        counted.append(steps[window.settling :])
    unexplained = other_axes = None
    if hypothesis.doubted is not None and hypothesis.doubted.samples is not None:
        motion = ImuMotion(hypothesis.doubted.samples, frames.rig, settings.odometry)
        seen, measured = measured_turns(counted, motion)
        unexplained = unexplained_part(seen, measured)
        other_axes = for_other_axes(seen, measured)
    score = Score(
        multiframes=sum(len(window.rows) for window in windows),
        lost=sum(step.lost for steps in counted for step in steps),
        residuals_m=np.array([step.error_m for steps in counted for step in steps[1:]]),
        unexplained=unexplained,
        other_axes=other_axes,
    )
    return TrackedWindows(score, odometry, steps[-1])


def unexplained_part(seen: Array, measured: Array) -> float:
    """Part of some turns that a gyroscope does not measure, 0..; infinite without any turn.

    Args:
        seen: By the LiDARs [rad], (N, 3).
        measured: The same by the gyroscope.
    """
    total = float((seen**2).sum())
    left = float(((seen - measured) ** 2).sum())
    return float(np.sqrt(left / total)) if total > 0.0 else float("inf")


def measured_turns(
    windows: Sequence[Sequence[OdometryStep]], motion: ImuMotion
) -> tuple[Array, Array]:
    """Turns between tracked multiframes as seen, and as a gyroscope measures them, (N, 3) each.

    Args:
        windows: Steps in a row of an odometry without the gyroscope.
        motion: By the gyroscope.
    """
    pairs = [(a, b) for steps in windows for a, b in pairwise(steps) if not (a.lost or b.lost)]
    seen = [so3_log(a.T_odom_body.R.T @ b.T_odom_body.R) for a, b in pairs]
    measured = [so3_log(motion.turn(a.t_mid_ns, b.t_mid_ns)) for a, b in pairs]
    return np.reshape(seen, (-1, 3)), np.reshape(measured, (-1, 3))


def _chosen(stages: list[Trials[TrackedWindows]]) -> ImuTrials:
    """The IMU that the last of some choices left, with all of their tables."""
    best = stages[-1].best
    imu = best.hypothesis.imu
    if best.verdict is TrialVerdict.CLEARLY_BETTER and imu.choice.outcome in LESS_USED:
        rival = [row for row in stages[-1].rows if row.verdict.wins][-2]
        imu = with_residuals(imu, rival.score, best.tracked.score)
    tried = tuple(
        row_of(row, whole=False, chosen=row is best.row) for trials in stages for row in trials.rows
    )
    return ImuTrials(imu, tried, best.tracked)


def _zero(imu: ImuSamples, first_ns: int) -> Array:
    """Mean turn rate over the first time with samples [rad/s], (3,)."""
    start_ns = max(int(imu.t_ns[0]), first_ns)
    rows = (imu.t_ns >= start_ns) & (imu.t_ns < start_ns + TUNING.rest_ns)
    return np.asarray(imu.gyro_rad_s[rows].mean(axis=0)) if rows.any() else np.zeros(3)
