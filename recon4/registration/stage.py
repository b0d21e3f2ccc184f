"""The stage ``odometry``: estimate the pose of all multiframes with one `Odometry`."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np

from recon4.geometry.se3 import SE3
from recon4.model.frames import RecordedFrames
from recon4.model.hidden import MOVING_POINTS
from recon4.model.odometry_figures import MovingFigures, OdometryFigures
from recon4.model.rig import Rig
from recon4.progress import Progress
from recon4.registration.aiding import GnssAiding
from recon4.registration.felt_motion import carried, felt_motion, is_carried
from recon4.registration.moving import find_moving
from recon4.registration.moving_passes import Found, leave_out_moving, less_sure
from recon4.registration.passes import OdometryPass, register_all
from recon4.registration.step import OdometryStep
from recon4.registration.unseen_rides import HeightContradiction, UnseenRide, unseen_rides
from recon4.registration.weak_turns import weak_turns
from recon4.settings import Settings
from recon4.store.arrays import save_record, save_trajectory


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
        progress: Counts multiframes; tracking that is lost is an event.
        aiding: Fixes of a GNSS/INS, outdoors.
    """

    def register(seen: RecordedFrames, *, trusted: bool = False) -> OdometryPass:
        return register_all(seen, settings, progress=progress, aiding=aiding, trusted=trusted)

    made = register(frames)
    if settings.odometry.leave_out_moving:
        found = leave_out_moving(frames, made, register=register, aiding=aiding)
    else:
        found = Found(made, find_moving(frames, made.trajectory, made.pieces))
    if found.hidden is not None:
        save_record(out / MOVING_POINTS, found.hidden)
    found = replace(found, made=_carried(found.made, frames.rig, settings))
    made, moving = found.made, found.moving
    save_trajectory(out / "trajectory.npz", made.trajectory)
    _save_steps(out / "steps.npz", less_sure(found))
    return _figures(made, frames, moving=moving, aided=aiding is not None)


def _carried(made: OdometryPass, rig: Rig, settings: Settings) -> OdometryPass:
    """A pass with what its accelerometer says where the LiDARs hardly observe the motion."""
    if made.imu is None or not any(is_carried(step) for step in made.steps[1:]):
        return made
    felt = felt_motion(
        made.steps, made.trajectory, made.imu, rig=rig, accel_noise=settings.odometry.accel_noise
    )
    return made if felt is None else replace(made, steps=carried(made.steps, felt))


def _figures(
    made: OdometryPass, frames: RecordedFrames, *, moving: MovingFigures, aided: bool
) -> OdometryFigures:
    """Figures of a pass; ``aided`` by fixes, which show the heading."""
    return OdometryFigures(
        multiframes=len(made.steps),
        lost=made.lost,
        imu=made.imu is not None,
        imu_choice=made.imu_choice if frames.imu is not None else None,
        imu_faults=made.estimate.faults if made.estimate else (),
        heights=tuple(ride.doubt for ride in _rides(made, frames.rig)),
        gnss=aided,
        turns=() if aided else weak_turns(made.steps, with_imu=made.imu is not None),
        moving=moving,
    )


def _rides(made: OdometryPass, rig: Rig) -> list[UnseenRide | HeightContradiction]:
    """What the IMU says against the heights of the trajectory."""
    if made.imu is None:
        return []
    lost_ns = np.array([step.t_mid_ns for step in made.steps if step.lost], np.int64)
    return unseen_rides(made.trajectory, made.imu, rig, lost_ns=lost_ns)


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
