"""The stage ``odometry``: estimate the pose of all multiframes with the hypothesis that holds."""

from __future__ import annotations

import dataclasses
from pathlib import Path

import numpy as np

from recon4.model.hidden_points import MOVING_POINTS, HiddenPoints
from recon4.model.imu_repair import IMU_REPAIR
from recon4.model.odometry_figures import OdometryFigures, TurnDoubt
from recon4.model.rig import Rig
from recon4.model.samples import ImuSamples
from recon4.model.tried_hypotheses import TrialVerdict, not_chosen, walks_of
from recon4.registration.felt_motion import are_carried, carried, felt_motion, moved_back
from recon4.registration.hypotheses import Choice, choose_walk, doubts_imu
from recon4.registration.imu_choice import LESS_USED
from recon4.registration.pulled_motion import less_sure
from recon4.registration.tracked_walk import EarlierWalks, WalkInputs
from recon4.registration.tuning import OdometryTuning
from recon4.registration.unseen_rides import HeightContradiction, UnseenRide, unseen_rides
from recon4.registration.walk_steps import WalkSteps
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
            multiframe), ``hypotheses.json`` (what was tried, and why one was chosen),
            ``moving.npz`` if points on moving objects are left out, and ``imu_repair.npz`` if
            something was wrong with the IMU: later stages read both.
    """
    choice = choose_walk(recording)
    if doubts_imu(choice) and (turned := recording.with_right_axes()) is not None:
        recording, choice = _with_right_axes(recording, choice, turned)
    if recording.repairs.repair is not None:
        save_record(out / IMU_REPAIR, recording.repairs.repair)
    hypothesis = choice.best.hypothesis
    if hypothesis.hidden is not None:
        save_record(out / MOVING_POINTS, hypothesis.hidden)
    write_tried(out, choice.tried)
    used = hypothesis.imu.samples if recording.settings.odometry.use_imu else None
    if used is not None:
        choice = carried_by_accelerometer(recording, choice, used)
    save_trajectory(out / "trajectory.npz", choice.best.tracked.trajectory)
    steps = choice.best.tracked.steps
    steps.update(less_sure(steps, choice.moving, with_imu=used is not None))
    _save_steps(out / "steps.npz", steps)
    return _figures(recording, choice, with_imu=used is not None)


def _with_right_axes(
    recording: WalkInputs, first: Choice, turned: WalkInputs
) -> tuple[WalkInputs, Choice]:
    """The walk with repaired axes, unless the one before fits better; the table has both.

    Forty multiframes have shown the axes, by LiDARs that may see little: all of them must agree.
    """
    again = choose_walk(turned)
    if not _agrees(again, first):
        tried = (*first.tried, *not_chosen(again.tried))
        return recording, dataclasses.replace(first, tried=tried)
    return turned, dataclasses.replace(again, tried=(*not_chosen(first.tried), *again.tried))


def _agrees(repaired: Choice, first: Choice) -> bool:
    """Whether a walk with repaired axes is as good; one that knew less must have been better."""
    after, before = repaired.best.tracked.score, first.best.tracked.score
    if first.best.hypothesis.imu.choice.outcome in LESS_USED:
        return before.clearly_better(after) is not TrialVerdict.CLEARLY_BETTER
    return after.no_worse(before).wins


def carried_by_accelerometer(recording: WalkInputs, choice: Choice, imu: ImuSamples) -> Choice:
    """The walk with what the accelerometer says where the LiDARs hardly observe the motion.

    Args:
        recording: Its rig and settings, and whether fixes aid.
        choice: The walk; its steps are changed.
        imu: As it was used.

    Returns:
        The walk with heights moved back by what false planes pulled them along, unless fixes hold
        them or they contradict the accelerometer, and with what is known of weak motions; as it is
        if all are observed. No false plane explains a ride: all that LiDARs see rides along.
    """
    best, tracked = choice.best, choice.best.tracked
    steps, poses, rig = tracked.steps, tracked.trajectory, recording.frames.rig
    if not are_carried(steps)[1:].any():
        return choice
    noise = tuned(OdometryTuning, recording.settings.odometry).accel_noise
    felt = felt_motion(steps, poses, imu, rig=rig, accel_noise=noise)
    if felt is None:
        return choice
    if best.hypothesis.aiding is None and not _rides(choice, rig):
        poses, felt = moved_back(steps, poses, felt)
    steps.update(carried(steps, felt))
    carried_by_it = dataclasses.replace(tracked, trajectory=poses)
    return dataclasses.replace(choice, best=dataclasses.replace(best, tracked=carried_by_it))


def earlier_walks(odometry: Path) -> EarlierWalks:
    """What the odometry found before the calibration changed the rig.

    Args:
        odometry: Folder of that stage.

    Raises:
        StoreError: If a file is missing or damaged.
    """
    walks = walks_of(read_tried(odometry))
    if not (odometry / MOVING_POINTS).exists():
        return EarlierWalks(walks)
    positions_m = load_arrays(odometry / "steps.npz", ["t_m"])["t_m"]
    return EarlierWalks(walks, load_record(odometry / MOVING_POINTS, HiddenPoints), positions_m)


def _figures(recording: WalkInputs, choice: Choice, *, with_imu: bool) -> OdometryFigures:
    """Figures of the walk that was chosen; fixes show its heading."""
    tracked, aided = choice.best.tracked, recording.aiding is not None
    frames, imu = recording.frames, choice.best.hypothesis.imu
    return OdometryFigures(
        multiframes=len(tracked.steps),
        lost=tracked.score.lost,
        imu=with_imu,
        imu_choice=imu.choice if frames.imu is not None else None,
        imu_turn=recording.repairs.turn,
        imu_axes=recording.repairs.axes,
        forces_reversed=recording.repairs.forces_reversed,
        imu_faults=tracked.estimate.faults if tracked.estimate else (),
        heights=tuple(ride.doubt for ride in _rides(choice, frames.rig)) if with_imu else (),
        gnss=aided,
        turns=() if aided else _turns(tracked.steps, imu.samples if with_imu else None),
        moving=choice.moving,
        tried=choice.tried,
    )


def _turns(steps: WalkSteps, imu: ImuSamples | None) -> tuple[TurnDoubt, ...]:
    """Turns that neither LiDARs nor gravity hold."""
    with_gravity = imu is not None and bool(np.isfinite(imu.accel_m_s2).all())
    return weak_turns(steps, with_imu=imu is not None, with_gravity=with_gravity)


def _rides(choice: Choice, rig: Rig) -> list[UnseenRide | HeightContradiction]:
    """What the IMU says against the heights of the trajectory."""
    imu, tracked = choice.best.hypothesis.imu.samples, choice.best.tracked
    if imu is None:
        return []
    lost_ns = tracked.steps.column("t_mid_ns")[tracked.steps.column("lost")]
    return unseen_rides(tracked.trajectory, imu, rig, lost_ns=lost_ns)


def _save_steps(path: Path, steps: WalkSteps) -> None:
    T = steps.T_odom_body
    np.savez(
        path,
        frame_id=steps.column("frame_id"),
        t_mid_ns=steps.column("t_mid_ns"),
        quat_xyzw=T.quat_xyzw(),
        t_m=T.t,
        error_m=steps.column("error_m"),
        match_ratio=steps.column("match_ratio"),
        rounds=steps.column("rounds"),
        converged=steps.column("converged"),
        degeneracy=steps.column("degeneracy"),
        prediction_offset_m=steps.column("prediction_offset_m"),
        lost=steps.column("lost"),
        piece=steps.column("piece"),
        bridged=steps.column("bridged"),
        motion_cov=steps.column("motion_cov"),
        weak_direction=steps.column("weak_direction"),
        stationary=steps.column("stationary"),
        weak_sd_m=steps.column("weak_sd_m"),
        weak_motion_sd_m=steps.column("weak_motion_sd_m"),
    )
