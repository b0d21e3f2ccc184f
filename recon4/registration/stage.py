"""The stage ``odometry``: estimate the pose of all multiframes with one `Odometry`."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from dataclasses import replace as with_fields
from itertools import pairwise
from pathlib import Path

import numpy as np
from msgspec.structs import replace
from numpy.typing import NDArray

from recon4.geometry.se3 import SE3
from recon4.model.events import PosesAdded, TrackingLost, Warned, positions_of
from recon4.model.figures import MovingFigures, MovingOutcome, OdometryFigures
from recon4.model.frames import RecordedFrames
from recon4.model.hidden import MOVING_POINTS, HiddenPoints
from recon4.model.rig import Rig
from recon4.model.samples import ImuSamples
from recon4.model.trajectory import Trajectory
from recon4.progress import Progress, track
from recon4.registration.aiding import GnssAiding
from recon4.registration.bridge import bridged_text
from recon4.registration.imu_consistency import consistent_imu
from recon4.registration.imu_estimate import ImuEstimate
from recon4.registration.imu_gravity import wrong_gravity
from recon4.registration.imu_saturation import saturated_texts
from recon4.registration.line_odometry import LineOdometry
from recon4.registration.make import make_odometry
from recon4.registration.moving import StandingFrames, crowd_text, find_moving, hide_moving
from recon4.registration.moving_start import LONGEST_NS, MOVING_M_S
from recon4.registration.odometry import Odometry
from recon4.registration.step import OdometryStep
from recon4.registration.unseen_rides import HeightContradiction, UnseenRide, unseen_rides
from recon4.registration.weak_turns import turn_text, weak_turns
from recon4.settings import Settings
from recon4.store.arrays import save_record, save_trajectory

_REPORT_EVERY, _REPORT_AT_ONCE = 5, 4
"""The pose of every n-th multiframe is reported while the stage runs, some per event."""
_ROUNDS, _SETTLED_M = 4, 0.05
"""Most passes without moving objects; a trajectory is settled if the last one moved no position by
more than this [m]."""
_DENSE_NS = 9_000_000
"""Poses of the dense trajectory are at least this far apart [ns] (at most about 100 Hz)."""


def run_odometry(
    frames: RecordedFrames,
    out: Path,
    *,
    settings: Settings,
    progress: Progress,
    aiding: GnssAiding | None = None,
) -> OdometryFigures:
    """Register all multiframes in order; again without moving objects, if these fill the view.

    Args:
        frames: The multiframes with their rig and IMU.
        out: Receives ``trajectory.npz`` (``T_odom_body``, dense) and ``steps.npz``
            (a row a multiframe), ``moving.npz`` if points on moving objects are left out.
        settings: Uses segments, planes, registration and odometry.
        progress: Counts multiframes; tracking that is lost and an IMU that is wrong are events.
        aiding: Fixes of a GNSS/INS, outdoors.
    """

    def register(seen: RecordedFrames) -> _Pass:
        return _track(seen, settings, progress=progress, aiding=aiding)

    made = register(frames)
    moving = find_moving(frames, made.trajectory, made.pieces)
    if settings.odometry.leave_out_moving and moving.is_crowded:
        made, moving, hidden = _without_moving(frames, made, moving, track=register)
        if hidden is not None:
            save_record(out / MOVING_POINTS, hidden)
    save_trajectory(out / "trajectory.npz", made.trajectory)
    _save_steps(out / "steps.npz", made.steps)
    figures = _judged(made, frames, moving=moving, aided=aiding is not None)
    for text in figures.warnings:
        progress.event(Warned(text=text))
    return replace(figures, gnss=aiding is not None)


@dataclass(frozen=True, slots=True, eq=False)
class _Pass:
    """Odometry of all multiframes, and what was found out about the IMU meanwhile."""

    steps: list[OdometryStep]
    trajectory: Trajectory
    """``T_odom_body``, dense."""
    imu: ImuSamples | None
    """As it was used; None = not."""
    remark: str
    """What is wrong with it before any multiframe is registered; empty = nothing."""
    estimate: ImuEstimate | None

    @property
    def lost(self) -> int:
        """Multiframes where tracking was lost."""
        return sum(step.lost for step in self.steps)

    @property
    def pieces(self) -> NDArray[np.int64]:
        """Number of the piece of each multiframe, -1 = lost, (N,)."""
        return np.array([-1 if step.lost else step.piece for step in self.steps], np.int64)


def _track(
    frames: RecordedFrames, settings: Settings, *, progress: Progress, aiding: GnssAiding | None
) -> _Pass:
    """Register all multiframes once."""
    imu, remark = consistent_imu(frames, settings)
    odometry = make_odometry(frames.rig, settings, imu, aiding=aiding)
    steps = _register(frames, odometry, progress)
    estimate = odometry.imu_estimate if isinstance(odometry, Odometry) else None
    used = imu if settings.odometry.use_imu else None
    return _Pass(steps, dense_trajectory(steps), used, remark, estimate)


def _without_moving(
    frames: RecordedFrames,
    made: _Pass,
    moving: MovingFigures,
    *,
    track: Callable[[RecordedFrames], _Pass],
) -> tuple[_Pass, MovingFigures, HiddenPoints | None]:
    """Register again without moving objects, until that does not move the trajectory any more.

    A trajectory that they have pulled along shows only some of them. The next one, without these,
    shows the others.
    """
    now, outcome = made, MovingOutcome.NOT_SETTLED
    for _ in range(_ROUNDS):
        hidden = hide_moving(frames, now.trajectory, now.pieces, found=moving)
        before, now = now, track(StandingFrames(frames, hidden))
        if now.lost > made.lost:
            return made, replace(moving, outcome=MovingOutcome.NOT_HELD), None
        moving = find_moving(frames, now.trajectory, now.pieces)
        if _moved_m(before.steps, now.steps) < _SETTLED_M:
            outcome = MovingOutcome.LEFT_OUT
            break
    return now, replace(moving, outcome=outcome, points_left_out=hidden.count), hidden


def _moved_m(before: list[OdometryStep], after: list[OdometryStep]) -> float:
    """Largest distance of the positions of two passes, which begin at the same place [m]."""
    a, b = (SE3.stack(step.T_odom_body for step in steps).t for steps in (before, after))
    return float(np.linalg.norm((a - a[0]) - (b - b[0]), axis=1).max())


def _judged(
    made: _Pass, frames: RecordedFrames, *, moving: MovingFigures, aided: bool
) -> OdometryFigures:
    """Figures of a pass, with what contradicts it; ``aided`` by fixes, which show the heading."""
    rig = frames.rig
    rides = _rides(made.trajectory, made.imu, rig, steps=made.steps)
    crowd = crowd_text(moving)
    turns = () if aided else weak_turns(made.steps, with_imu=made.imu is not None)
    contradicted = (
        *(ride.text for ride in rides),
        *(saturated_texts(frames.imu) if frames.imu else ()),
        *(wrong_gravity(made.trajectory, made.imu, rig) if made.imu else ()),
        *(made.estimate.texts if made.estimate else ()),
        *crowd,
        *(turn_text(turn) for turn in turns),
        *_bridges(made.steps),
    )
    severe = tuple(ride.text for ride in rides if ride.is_severe)
    return OdometryFigures(
        multiframes=len(made.steps),
        lost=made.lost,
        imu=made.imu is not None,
        warnings=(made.remark, *contradicted) if made.remark else contradicted,
        severe=(*severe, *(crowd if moving.is_severe else ())),
        heights=tuple(ride.doubt for ride in rides),
        turns=turns,
        moving=moving,
    )


def _bridges(steps: list[OdometryStep]) -> tuple[str, ...]:
    """What is to be checked where single registrations joined what no scan chain joins."""
    bridged = [
        (1e-9 * (b.t_mid_ns - steps[0].t_mid_ns), a.T_odom_body, b.T_odom_body)
        for a, b in pairwise([step for step in steps if not step.lost])
        if b.bridged
    ]
    found = [(t_s, float(np.linalg.norm(b.t - a.t))) for t_s, a, b in bridged]
    return (bridged_text(found),) if found else ()


def _register(
    frames: RecordedFrames, odometry: Odometry | LineOdometry, progress: Progress
) -> list[OdometryStep]:
    """Register all multiframes in order, and report the growing trajectory."""
    steps: list[OdometryStep] = []
    for frame in track(frames, progress, what="odometry", unit="multiframe"):
        step = odometry.push(frame)
        if step.lost:
            progress.event(TrackingLost(frame_id=step.frame_id, t_ns=step.t_mid_ns))
        steps.append(step)
        if len(steps) % (_REPORT_EVERY * _REPORT_AT_ONCE) == 0:
            _report_poses(steps[-_REPORT_EVERY * _REPORT_AT_ONCE :: _REPORT_EVERY], progress)
    return steps


def _rides(
    trajectory: Trajectory, imu: ImuSamples | None, rig: Rig, *, steps: list[OdometryStep]
) -> list[UnseenRide | HeightContradiction]:
    """What the IMU says against the heights of the trajectory."""
    if imu is None:
        return []
    lost_ns = np.array([step.t_mid_ns for step in steps if step.lost], np.int64)
    return unseen_rides(trajectory, imu, rig, lost_ns=lost_ns)


def _report_poses(steps: list[OdometryStep], progress: Progress) -> None:
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


def dense_trajectory(steps: list[OdometryStep]) -> Trajectory:
    """The dense poses of all steps as one trajectory, at most about 100 Hz."""
    steps = _begun_in_motion(steps)
    t_ns = np.concatenate([step.t_ns for step in steps])
    R = np.concatenate([step.T_dense.R for step in steps])
    t_m = np.concatenate([step.T_dense.t for step in steps])
    # The first pose of a frame updates the last pose of the frame before.
    newest = len(t_ns) - 1 - np.unique(t_ns[::-1], return_index=True)[1]
    t_ns, R, t_m = t_ns[newest], R[newest], t_m[newest]
    slot = (t_ns - t_ns[0]) // _DENSE_NS
    kept = np.append(np.diff(slot) > 0, True)
    kept[0] = True
    return Trajectory(t_ns[kept], SE3(R[kept], t_m[kept]))


def _begun_in_motion(steps: list[OdometryStep]) -> list[OdometryStep]:
    """The steps with a first frame that moves as fast as the second one begins.

    The velocity at the start is known only with the second frame, when the poses inside the first
    one were already reported: half a frame of a walk puts them 6 cm beside their places.
    """
    if len(steps) < 2 or len(steps[0].t_ns) < 2 or steps[1].lost:
        return steps
    first, second = steps[:2]
    span_ns = second.t_mid_ns - first.t_mid_ns
    if second.piece != first.piece or not 0 < span_ns <= LONGEST_NS:
        return steps
    # Both at the end of the first frame; what the IMU measured inside it stays.
    there = (second.T_odom_body.t - first.T_odom_body.t) / (1e-9 * span_ns)
    reported = (first.T_dense.t[-1] - first.T_dense.t[-2]) / (1e-9 * np.diff(first.t_ns)[-1])
    missing = there - reported
    if float(np.linalg.norm(missing)) < MOVING_M_S:
        return steps
    since_s = 1e-9 * (first.t_ns - first.t_mid_ns)
    moving = SE3(first.T_dense.R, first.T_dense.t + since_s[:, None] * missing)
    return [with_fields(first, T_dense=moving), *steps[1:]]


def _save_steps(path: Path, steps: list[OdometryStep]) -> None:
    T = SE3.stack(step.T_odom_body for step in steps)
    np.savez(
        path,
        frame_id=np.array([s.frame_id for s in steps]),
        t_mid_ns=np.array([s.t_mid_ns for s in steps], np.int64),
        quat_xyzw=T.quat_xyzw(),
        t_m=T.t,
        error_m=np.array([s.error_m for s in steps]),
        match_ratio=np.array([s.match_ratio for s in steps]),
        rounds=np.array([s.rounds for s in steps]),
        converged=np.array([s.converged for s in steps]),
        degeneracy=np.array([s.degeneracy for s in steps]),
        prediction_offset_m=np.array([s.prediction_offset_m for s in steps]),
        lost=np.array([s.lost for s in steps]),
        piece=np.array([s.piece for s in steps], np.int64),
        bridged=np.array([s.bridged for s in steps]),
        motion_cov=np.array([s.motion_cov for s in steps]).reshape(-1, 6, 6),
        weak_direction=np.array([s.weak_direction for s in steps]).reshape(-1, 3),
        stationary=np.array([s.stationary for s in steps]),
        weak_sd_m=np.array([s.weak_sd_m for s in steps]),
    )
