"""Walks whose rig is known, stored with rig files that are wrong."""

from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
import pytest

from recon4.calibration.tuning import CalibrationTuning
from recon4.geometry.se3 import SE3, so3_exp
from recon4.model.rig import Rig
from recon4.model.samples import ImuSamples
from recon4.progress import Silent
from recon4.registration.stage import run_odometry
from recon4.registration.tracked_walk import WalkInputs
from recon4.settings import OdometrySettings, Settings
from recon4.store.frames import FrameStore, FrameWriter
from tests import scanned_room

SECONDS = 12.0
COLUMNS = 200
"""Half as dense as a VLP-16 at 10 Hz; nothing here needs more."""
CALIBRATION = CalibrationTuning(
    audit_windows=3, audit_window_s=2.0, windows=3, window_s=2.0, points=300_000, mode="audit"
)
SETTINGS = Settings(calibration=CALIBRATION, odometry=OdometrySettings(leave_out_moving=False))
"""Nothing moves in the room; a rig file that is far off only looks so, which costs a minute."""
AUTO = replace(SETTINGS, calibration=replace(CALIBRATION, mode="auto"))


def dancing(t_s):
    """Turns about all three axes while going back and forth."""
    t = np.asarray(t_s)
    turn = np.stack(
        [
            0.30 * np.sin(2.1 * t),
            0.25 * np.sin(2.9 * t + 0.7),
            0.9 * np.sin(0.8 * t) + 0.2 * np.sin(3.3 * t),
        ],
        axis=1,
    )
    place = np.stack([1.0 * np.sin(0.7 * t), 0.8 * np.sin(0.5 * t + 1.0), 0.1 * np.sin(4.0 * t)], 1)
    return SE3(so3_exp(turn), place)


def planar(t_s):
    """Turns about the vertical only."""
    t = np.asarray(t_s)
    zero = np.zeros_like(t)
    place = np.stack([1.0 * np.sin(0.7 * t), 0.8 * np.sin(0.5 * t + 1.0), zero], 1)
    return SE3(so3_exp(np.stack([zero, zero, 0.9 * np.sin(0.8 * t)], axis=1)), place)


def circle(t_s):
    """Turns about the vertical at a constant rate."""
    t = np.asarray(t_s)
    zero = np.zeros_like(t)
    place = np.stack([np.sin(0.5 * t), 1.0 - np.cos(0.5 * t), zero], 1)
    return SE3(so3_exp(np.stack([zero, zero, 0.5 * t], axis=1)), place)


def straight(t_s):
    """Without any turn."""
    t = np.asarray(t_s)
    zero = np.zeros_like(t)
    place = np.stack([0.2 * t - 1.0, zero, zero], 1)
    return SE3(so3_exp(np.zeros((len(t), 3))), place)


def mounted(rig: Rig, row: int, *, turn_deg=(0.0, 0.0, 0.0), shift_m=(0.0, 0.0, 0.0), late_s=0.0):
    """The rig with another mount and clock offset of one LiDAR."""
    sensors = list(rig.sensors)
    T = sensors[row].T_body_sensor
    sensors[row] = replace(
        sensors[row],
        T_body_sensor=SE3(so3_exp(np.deg2rad(turn_deg)) @ T.R, T.t + shift_m),
        time_offset_s=sensors[row].time_offset_s + late_s,
    )
    return replace(rig, sensors=tuple(sensors))


def imu_mounted(rig: Rig, *, turn_deg=(0.0, 0.0, 0.0), late_s=0.0):
    """The rig with another mount and clock offset of the IMU."""
    T = rig.T_body_imu
    return replace(
        rig,
        T_body_imu=SE3(so3_exp(np.deg2rad(turn_deg)) @ T.R, T.t),
        imu_time_offset_s=rig.imu_time_offset_s + late_s,
    )


@dataclass
class Recorded:
    """A recording whose rig file may be wrong, with its odometry."""

    frames: FrameStore
    odometry: Path
    true: Rig


def store(folder: Path, walk, rig: Rig, imu: ImuSamples | None) -> Recorded:
    """Write a walk with a rig file, whose clock offsets its times have, and run the odometry."""
    pairs = zip(rig.sensors, walk.rig.sensors, strict=True)
    late_s = [wrong.time_offset_s - right.time_offset_s for wrong, right in pairs]
    late_ns = np.rint(1e9 * np.array(late_s)).astype(np.int32)
    with FrameWriter(folder / "frames", rig) as writer:
        for frame in walk:
            writer.append(replace(frame, dt_ns=frame.dt_ns + late_ns[frame.sensor]))
        if imu is not None:
            change_s = rig.imu_time_offset_s - walk.rig.imu_time_offset_s
            imu = replace(imu, t_ns=imu.t_ns + round(1e9 * change_s))
        writer.add(imu=imu)
    return tracked(folder, FrameStore.open(folder / "frames"), walk.rig)


def tracked(folder: Path, frames: FrameStore, true: Rig) -> Recorded:
    """Run the odometry of a recording."""
    odometry = folder / "odometry"
    odometry.mkdir(parents=True, exist_ok=True)
    run_odometry(WalkInputs(frames, SETTINGS, Silent()), odometry)
    return Recorded(frames, odometry, true)


@pytest.fixture(scope="package")
def dance():
    """12 s with turns about all axes; the sensors are where the rig says."""
    return scanned_room.walk(dancing, round(SECONDS * 10), noise_m=0.01, columns=COLUMNS)


@pytest.fixture(scope="package")
def right(dance, tmp_path_factory):
    """That walk with a rig file that is right."""
    return store(tmp_path_factory.mktemp("right"), dance, dance.rig, dance.imu)
