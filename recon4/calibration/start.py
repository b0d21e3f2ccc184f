"""Where a calibration begins, and what the IMU's readings say of its own axes and units."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from recon4.calibration.gyro_alignment import GyroAlignment, align_gyro
from recon4.calibration.mount_search import without_others
from recon4.calibration.walk import RecordedWalk
from recon4.geometry.se3 import SE3, so3_log
from recon4.model.rig import Rig
from recon4.model.samples import STANDARD_GRAVITY_M_S2, ImuSamples
from recon4.settings import Settings

_MIN_EXPLAINED = 0.9
"""Part of the turning that an IMU explains if it is the right one and only its mount is wrong."""
_FAR_RAD, _FAR_S = float(np.deg2rad(5.0)), 0.05
"""Smaller errors are found by the joint calibration from the rig file."""
_SCALE_TOLERANCE, _FORCE_TOLERANCE = 0.02, 0.04
"""A usual accelerometer has a bias of 1 % of gravity along each axis."""
_UNIT_TOLERANCE = 0.1
_MIN_SECONDS = 6.0
"""In a shorter walk the accelerations do not cancel out."""
_ALONE_S = 10.0
"""Length of the window that is tracked with the reference LiDAR alone [s]."""
_DEG_PER_RAD = float(np.rad2deg(1.0))


@dataclass(frozen=True, slots=True, eq=False)
class Start:
    """Where a calibration begins."""

    rig: Rig
    imu_usable: bool
    """Whether a rotation and a clock can make the IMU fit."""
    remarks: tuple[str, ...]
    """What the IMU's axes, units or clock contradict, a sentence each."""


def find_start(walk: RecordedWalk, *, reference: int, settings: Settings) -> Start:
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
    if found is not None and (found.mirrored or found.explained < _MIN_EXPLAINED):
        found = _align_alone(walk, imu, reference, settings=settings) or found
    if found is not None and found.mirrored:
        text = "The turn rates of the IMU fit the LiDARs only with left-handed axes: an axis has "
        return Start(rig, False, (text + "the wrong sign.",))
    if found is not None and found.explained < _MIN_EXPLAINED:
        text = f"The IMU explains only {100 * found.explained:.0f} % of the turning that the "
        text += "LiDARs see: it is another recording, another clock, or not fixed to them."
        return Start(rig, False, (text,))
    if found is not None:
        rig = _turned(rig, found)
    remarks = _force_remarks(imu, walk, rig)
    remarks += _scale_remarks(found) if found is not None else ()
    return Start(rig, not remarks, remarks)


def _align_alone(
    walk: RecordedWalk, imu: ImuSamples, reference: int, *, settings: Settings
) -> GyroAlignment | None:
    """Alignment to a trajectory of the reference LiDAR alone, where all together contradict."""
    rows = walk.rows(1, _ALONE_S, with_lost=True)
    alone = without_others(walk.frames.rig, reference)
    windows = walk.tracked_windows(rows, alone, settings, imu=None)
    if not windows:
        return None
    inside = np.concatenate([walk.frames.t_mid_ns[part.start : part.stop] for part in rows])
    return align_gyro(windows[0].trajectory, inside, imu)


def _turned(rig: Rig, found: GyroAlignment) -> Rig:
    """The rig with the IMU as found, if that is far from the rig file."""
    turn = float(np.linalg.norm(so3_log(found.R_body_imu @ rig.T_body_imu.R.T)))
    R = found.R_body_imu if turn > _FAR_RAD else rig.T_body_imu.R
    clock_s = found.clock_s if abs(found.clock_s) > _FAR_S else 0.0
    return replace(
        rig,
        T_body_imu=SE3(R, rig.T_body_imu.t),
        imu_time_offset_s=rig.imu_time_offset_s + clock_s,
    )


def _force_remarks(imu: ImuSamples, walk: RecordedWalk, rig: Rig) -> tuple[str, ...]:
    """Over a walk the accelerations cancel out: the mean force has the length of gravity."""
    line = walk.trajectory
    inside = (imu.t_ns >= line.t_ns[0]) & (imu.t_ns <= line.t_ns[-1])
    force = imu.accel_m_s2[inside] @ rig.T_body_imu.R.T
    seconds = float(line.t_ns[-1] - line.t_ns[0]) * 1e-9
    if seconds < _MIN_SECONDS or not inside.any() or not np.isfinite(force).all():
        return ()
    of_odom = np.einsum("nij,nj->ni", line.at(imu.t_ns[inside]).R, force)
    mean = float(np.linalg.norm(of_odom.mean(axis=0)))
    ratio = mean / STANDARD_GRAVITY_M_S2
    if abs(ratio - 1.0) <= _FORCE_TOLERANCE:
        return ()
    if abs(mean - 1.0) < _UNIT_TOLERANCE:
        return (
            f"The accelerometer measures {mean:.2f} at rest: its unit seems to be g, expected "
            "m/s².",
        )
    return (
        f"The accelerometer measures {mean:.2f} m/s² on average, expected "
        f"{STANDARD_GRAVITY_M_S2:.2f} m/s²: its scale is {100 * (ratio - 1):+.1f} % off.",
    )


def _scale_remarks(found: GyroAlignment) -> tuple[str, ...]:
    if abs(found.scale - 1.0) <= _SCALE_TOLERANCE:
        return ()
    if abs(found.scale / _DEG_PER_RAD - 1.0) < _UNIT_TOLERANCE:
        return ("The gyroscope measures 57 times too much: its unit seems to be °/s, not rad/s.",)
    if abs(found.scale * _DEG_PER_RAD - 1.0) < _UNIT_TOLERANCE:
        return ("The gyroscope measures 57 times too little: its unit is not rad/s.",)
    return (f"The scale of the gyroscope is {100 * (found.scale - 1.0):+.1f} % off.",)
