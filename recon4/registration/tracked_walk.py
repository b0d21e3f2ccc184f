"""One walk over the recording: the odometry of all multiframes with one hypothesis."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from recon4.geometry.se3 import SE3, Array
from recon4.model.events import PosesAdded, TrackingLost, positions_of
from recon4.model.frames import RecordedFrames
from recon4.model.hidden_points import HiddenPoints
from recon4.model.odometry_figures import MovingFigures
from recon4.model.rig import Rig
from recon4.model.samples import ImuSamples
from recon4.model.trajectory import Trajectory
from recon4.progress import Progress, track
from recon4.registration.aiding import GnssAiding
from recon4.registration.frame_view import FrameView
from recon4.registration.hypothesis import Hypothesis
from recon4.registration.imu_estimate import ImuEstimate
from recon4.registration.imu_repairs import NO_REPAIRS, ImuRepairs
from recon4.registration.line_odometry import LineOdometry
from recon4.registration.motion import MotionState
from recon4.registration.moving import StandingFrames, find_moving
from recon4.registration.odometry import Odometry
from recon4.registration.score import Score
from recon4.registration.smoother import smooth
from recon4.registration.step import OdometryStep
from recon4.registration.tuning_motion import REPORTED_POSES
from recon4.registration.walk_steps import DensePoses, WalkSteps
from recon4.settings.reads import OdometryReads


@dataclass(frozen=True, slots=True, eq=False)
class EarlierWalks:
    """What the odometry found before the calibration changed the rig."""

    walks: int
    """How often it tracked the whole recording."""
    hidden: HiddenPoints | None = None
    """Points on moving objects that it left out; None = none."""
    positions_m: Array | None = None
    """Where the multiframes were [m], (N, 3); None = nothing was left out."""


@dataclass(frozen=True, slots=True, eq=False)
class WalkInputs:
    """What the stage ``odometry`` is given."""

    frames: RecordedFrames
    settings: OdometryReads
    progress: Progress
    aiding: GnssAiding | None = None
    """Fixes of a GNSS/INS, outdoors."""
    earlier: EarlierWalks | None = None
    """None = the rig is that of the recording."""
    repairs: ImuRepairs = NO_REPAIRS
    """What was repaired of the IMU of the multiframes."""
    with_right_axes: Callable[[], WalkInputs | None] = lambda: None
    """The same with axes of the IMU exchanged as the LiDARs show it; None = they are right. It
    takes as long as tracking a hundred multiframes."""

    def seen(self, hidden: HiddenPoints | None) -> RecordedFrames:
        """The multiframes without some points."""
        return self.frames if hidden is None else StandingFrames(self.frames, hidden)


@dataclass(frozen=True, slots=True, eq=False)
class TrackedWalk:
    """Odometry of all multiframes, and what it showed of IMU and moving objects."""

    steps: WalkSteps
    trajectory: Trajectory
    """``T_odom_body``, dense."""
    score: Score
    moving: MovingFigures
    imu_state: MotionState | None
    """The last state that knows the IMU; None without one."""

    @property
    def estimate(self) -> ImuEstimate | None:
        """What was found out about the IMU."""
        return None if self.imu_state is None else ImuEstimate.of(self.imu_state)

    @property
    def pieces(self) -> NDArray[np.int64]:
        """Number of the piece of each multiframe, -1 = lost, (N,)."""
        return _pieces(self.steps)


def track_walk(recording: WalkInputs, hypothesis: Hypothesis) -> TrackedWalk:
    """Register all multiframes in order with what a hypothesis assumes."""
    frames = recording.seen(hypothesis.hidden)
    odometry = make_odometry(
        frames.rig, recording.settings, hypothesis.imu.samples, aiding=hypothesis.aiding
    )
    if isinstance(odometry, Odometry) and hypothesis.imu.known is not None:
        odometry.remember_imu(hypothesis.imu.known)
    steps, poses = WalkSteps(), DensePoses()
    for step in smooth(_register(frames, odometry, recording.progress)):
        steps.append(step)
        poses.add(step)
    trajectory = poses.trajectory()
    return TrackedWalk(
        steps,
        trajectory,
        _score(steps, trajectory, hypothesis),
        find_moving(recording.frames, trajectory, _pieces(steps)),
        odometry.imu_state if isinstance(odometry, Odometry) else None,
    )


def _pieces(steps: WalkSteps) -> NDArray[np.int64]:
    return np.where(steps.column("lost"), -1, steps.column("piece"))


def _score(steps: WalkSteps, trajectory: Trajectory, hypothesis: Hypothesis) -> Score:
    aiding, before, after = hypothesis.aiding, hypothesis.suggested_by, steps.T_odom_body.t
    return Score(
        multiframes=len(steps),
        lost=int(np.count_nonzero(steps.column("lost"))),
        residuals_m=steps.column("error_m"),
        contradicted=None if aiding is None else aiding.rejected_ratio(trajectory),
        moved_m=None if before is None else _moved_m(before, after),
    )


def _moved_m(a: Array, b: Array) -> float:
    """Largest distance of the positions of two walks, which begin at the same place [m]."""
    return float(np.linalg.norm((a - a[0]) - (b - b[0]), axis=1).max())


def _register(
    frames: RecordedFrames, odometry: Odometry | LineOdometry, progress: Progress
) -> Iterator[OdometryStep]:
    """Register all multiframes in order, and report the growing trajectory."""
    shown: list[OdometryStep] = []
    pushed = _pushed(frames, odometry)
    tracked = track(pushed, progress, what="odometry", unit="multiframe", total=len(frames))
    for number, step in enumerate(tracked, start=1):
        if step.lost:
            progress.event(TrackingLost(frame_id=step.frame_id, t_ns=step.t_mid_ns))
        if number % REPORTED_POSES.every == 1 % REPORTED_POSES.every:
            shown.append(step)
        if number % (REPORTED_POSES.every * REPORTED_POSES.at_once) == 0:
            _report_poses(shown, progress)
            shown.clear()
        yield step


def _pushed(frames: RecordedFrames, odometry: Odometry | LineOdometry) -> Iterator[OdometryStep]:
    """Steps of all multiframes in order."""
    if isinstance(odometry, Odometry):
        yield from map(odometry.push_view, _views(frames))
    else:
        yield from map(odometry.push, frames)


def _views(frames: RecordedFrames) -> Iterator[FrameView]:
    """The multiframes in order; a thread reads and samples one while the one before is fitted."""
    rest = iter(frames)

    def view() -> FrameView | None:
        frame = next(rest, None)
        return None if frame is None else FrameView(frame, frames.rig)

    with ThreadPoolExecutor(1) as pool:
        ahead = pool.submit(view)
        while (one := ahead.result()) is not None:
            ahead = pool.submit(view)
            yield one


def _report_poses(steps: Sequence[OdometryStep], progress: Progress) -> None:
    """Report some poses as an event, for a display of the growing trajectory."""
    T = SE3.stack(step.T_odom_body for step in steps)
    quaternions = np.round(T.quat_xyzw(), 5).tolist()
    progress.event(
        PosesAdded(
            t_ns=tuple(step.t_mid_ns for step in steps),
            t_m=positions_of(T.t),
            quat_xyzw=tuple((x, y, z, w) for x, y, z, w in quaternions),
        )
    )


def make_odometry(
    rig: Rig, settings: OdometryReads, imu: ImuSamples | None, *, aiding: GnssAiding | None = None
) -> Odometry | LineOdometry:
    """Odometry by planes (this project's method) or by lines (the documents' method)."""
    if settings.registration.solver == "planes":
        return Odometry(rig, settings, imu, aiding=aiding)
    return LineOdometry(rig, settings, imu)
