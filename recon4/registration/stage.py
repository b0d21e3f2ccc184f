"""The stage ``odometry``: estimate the pose of all multiframes with the hypothesis that holds."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from recon4.geometry.se3 import SE3
from recon4.model.hidden_points import MOVING_POINTS, HiddenPoints
from recon4.model.odometry_figures import OdometryFigures
from recon4.model.rig import Rig
from recon4.model.samples import ImuSamples
from recon4.registration.felt_motion import carried, felt_motion, is_carried
from recon4.registration.hypotheses import Choice, choose_walk
from recon4.registration.pulled_motion import less_sure
from recon4.registration.step import OdometryStep
from recon4.registration.tuning import OdometryTuning
from recon4.registration.unseen_rides import HeightContradiction, UnseenRide, unseen_rides
from recon4.registration.walk import EarlierWalks, TrackedWalk, WalkInputs
from recon4.registration.weak_turns import weak_turns
from recon4.settings.tuning import tuned
from recon4.store.arrays import load_arrays, load_record, save_record, save_trajectory
from recon4.store.tried_hypotheses import read_tried, write_tried


def run_odometry(recording: WalkInputs, out: Path) -> OdometryFigures:
    """Register all multiframes in order; again only if that shows what must be assumed.

    Args:
        recording: The multiframes with their rig, IMU and fixes, and the settings:
            registration and odometry. Its progress counts multiframes; tracking
            that is lost is an event.
        out: Receives ``trajectory.npz`` (``T_odom_body``, dense), ``steps.npz`` (a row a
            multiframe), ``hypotheses.json`` (what was tried, and why one was chosen), and
            ``moving.npz`` if points on moving objects are left out.
    """
    choice = choose_walk(recording)
    hypothesis, tracked = choice.best.hypothesis, choice.best.tracked
    if hypothesis.hidden is not None:
        save_record(out / MOVING_POINTS, hypothesis.hidden)
    write_tried(out, choice.tried)
    save_trajectory(out / "trajectory.npz", tracked.trajectory)
    used = hypothesis.imu.samples if recording.settings.odometry.use_imu else None
    steps = tracked.steps if used is None else _carried(recording, tracked, used)
    _save_steps(out / "steps.npz", less_sure(steps, choice.moving, with_imu=used is not None))
    return _figures(recording, choice, steps, with_imu=used is not None)


def _carried(recording: WalkInputs, tracked: TrackedWalk, imu: ImuSamples) -> list[OdometryStep]:
    """Steps with what the accelerometer says where the LiDARs hardly observe the motion."""
    steps = tracked.steps
    if not any(is_carried(step) for step in steps[1:]):
        return steps
    noise = tuned(OdometryTuning, recording.settings.odometry).accel_noise
    rig = recording.frames.rig
    felt = felt_motion(steps, tracked.trajectory, imu, rig=rig, accel_noise=noise)
    return steps if felt is None else carried(steps, felt)


def earlier_walks(odometry: Path) -> EarlierWalks:
    """What the odometry found before the calibration changed the rig.

    Args:
        odometry: Folder of that stage.

    Raises:
        StoreError: If a file is missing or damaged.
    """
    walks = sum(row.whole for row in read_tried(odometry))
    if not (odometry / MOVING_POINTS).exists():
        return EarlierWalks(walks)
    positions_m = load_arrays(odometry / "steps.npz", ["t_m"])["t_m"]
    return EarlierWalks(walks, load_record(odometry / MOVING_POINTS, HiddenPoints), positions_m)


def _figures(
    recording: WalkInputs, choice: Choice, steps: list[OdometryStep], *, with_imu: bool
) -> OdometryFigures:
    """Figures of the walk that was chosen; fixes show its heading."""
    tracked, aided = choice.best.tracked, recording.aiding is not None
    frames, imu = recording.frames, choice.best.hypothesis.imu
    return OdometryFigures(
        multiframes=len(tracked.steps),
        lost=tracked.score.lost,
        imu=with_imu,
        imu_choice=imu.choice if frames.imu is not None else None,
        imu_faults=tracked.estimate.faults if tracked.estimate else (),
        heights=tuple(ride.doubt for ride in _rides(choice, frames.rig)) if with_imu else (),
        gnss=aided,
        turns=() if aided else weak_turns(steps, with_imu=with_imu),
        moving=choice.moving,
        tried=choice.tried,
    )


def _rides(choice: Choice, rig: Rig) -> list[UnseenRide | HeightContradiction]:
    """What the IMU says against the heights of the trajectory."""
    imu, tracked = choice.best.hypothesis.imu.samples, choice.best.tracked
    if imu is None:
        return []
    lost_ns = np.array([step.t_mid_ns for step in tracked.steps if step.lost], np.int64)
    return unseen_rides(tracked.trajectory, imu, rig, lost_ns=lost_ns)


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
        weak_motion_sd_m=np.array([s.weak_motion_sd_m for s in steps]),
    )
