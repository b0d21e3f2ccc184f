"""Where a calibration begins, and what the IMU's readings say of its own axes and units."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from recon4.calibration.mount_search import without_others
from recon4.calibration.recorded_walk import RecordedWalk
from recon4.calibration.tuning_methods import START
from recon4.geometry.se3 import SE3, so3_log
from recon4.model.odometry_figures import ImuFault
from recon4.model.rig import Rig
from recon4.model.samples import ImuSamples
from recon4.registration.gyro_alignment import GyroAlignment, align_gyro
from recon4.settings.reads import CalibrationReads
from recon4.units import STANDARD_GRAVITY_M_S2

_DEG_PER_RAD = float(np.rad2deg(1.0))


@dataclass(frozen=True, slots=True, eq=False)
class Start:
    """Where a calibration begins."""

    rig: Rig
    imu_usable: bool
    """Whether a rotation and a clock can make the IMU fit."""
    faults: tuple[ImuFault, ...]
    """What the IMU's axes, units or clock contradict."""


def find_start(walk: RecordedWalk, *, reference: int, settings: CalibrationReads) -> Start:
    """The rig to begin with: the rig file's, with the IMU turned where its axes are exchanged.

    Args:
        walk: The recording.
        reference: Row of the LiDAR whose mount stays.
        settings: Of the odometry.
    """
    rig, imu = walk.frames.rig, walk.frames.imu
    if imu is None or len(imu) < 2:
        return Start(rig, False, ())
    found = align_gyro(walk.trajectory, walk.frames.t_mid_ns, imu)
    if found is not None and (found.mirrored or found.explained < START.min_explained):
        alone = _align_alone(walk, imu, reference, settings=settings)
        if alone is None and walk.lost.mean() > START.most_lost:
            return Start(rig, False, ())  # LiDARs that lost tracking are no witnesses of turns
        found = alone or found
    if found is not None and found.mirrored:
        return Start(rig, False, (ImuFault(kind="left-handed"),))
    if found is not None and found.explained < START.min_explained:
        return Start(rig, False, (ImuFault(kind="foreign", value=float(found.explained)),))
    if found is not None:
        rig = _turned(rig, found)
    faults = _force_faults(imu, walk, rig) + (_scale_faults(found) if found is not None else ())
    return Start(rig, not faults, faults)


def _align_alone(
    walk: RecordedWalk, imu: ImuSamples, reference: int, *, settings: CalibrationReads
) -> GyroAlignment | None:
    """Alignment to a trajectory of the reference LiDAR alone, where all together contradict."""
    rows = walk.rows(1, START.alone_s, with_lost=True)
    alone = without_others(walk.frames.rig, reference)
    windows = walk.tracked_windows(rows, alone, settings, imu=None)
    if not windows:
        return None
    inside = np.concatenate([walk.frames.t_mid_ns[part.start : part.stop] for part in rows])
    return align_gyro(windows[0].trajectory, inside, imu)


def _turned(rig: Rig, found: GyroAlignment) -> Rig:
    """The rig with the IMU as found, if that is far from the rig file."""
    turn = float(np.linalg.norm(so3_log(found.R_body_imu @ rig.T_body_imu.R.T)))
    R = found.R_body_imu if turn > START.far_rad else rig.T_body_imu.R
    clock_s = found.clock_s if abs(found.clock_s) > START.far_s else 0.0
    return replace(
        rig,
        T_body_imu=SE3(R, rig.T_body_imu.t),
        imu_time_offset_s=rig.imu_time_offset_s + clock_s,
    )


def _force_faults(imu: ImuSamples, walk: RecordedWalk, rig: Rig) -> tuple[ImuFault, ...]:
    """Over a walk the accelerations cancel out: the mean force has the length of gravity.

    A trajectory whose rotations are wrong shortens the mean, but not the forces themselves.
    """
    line = walk.trajectory
    inside = (imu.t_ns >= line.t_ns[0]) & (imu.t_ns <= line.t_ns[-1])
    force = imu.accel_m_s2[inside] @ rig.T_body_imu.R.T
    seconds = float(line.t_ns[-1] - line.t_ns[0]) * 1e-9
    if seconds < START.min_seconds or not inside.any() or not np.isfinite(force).all():
        return ()
    of_odom = np.einsum("nij,nj->ni", line.at(imu.t_ns[inside]).R, force)
    mean = float(np.linalg.norm(of_odom.mean(axis=0)))
    ratio = mean / STANDARD_GRAVITY_M_S2
    longest = float(np.linalg.norm(force, axis=1).mean()) / STANDARD_GRAVITY_M_S2
    if ratio <= 1.0 + START.force_tolerance and longest >= 1.0 - START.force_tolerance:
        return ()
    if abs(mean - 1.0) < START.unit_tolerance:
        return (ImuFault(kind="accelerometer unit", value=ratio),)
    return (ImuFault(kind="accelerometer scale", value=ratio - 1.0),)


def _scale_faults(found: GyroAlignment) -> tuple[ImuFault, ...]:
    if abs(found.scale - 1.0) <= START.scale_tolerance:
        return ()
    ratios = (found.scale / _DEG_PER_RAD, found.scale * _DEG_PER_RAD)
    if any(abs(ratio - 1.0) < START.unit_tolerance for ratio in ratios):
        return (ImuFault(kind="gyroscope unit", value=float(found.scale)),)
    return (ImuFault(kind="gyroscope scale", value=float(found.scale) - 1.0),)
