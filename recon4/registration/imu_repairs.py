"""What is wrong with the samples of an IMU before a walk is tracked with them: axes and signs."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from recon4.geometry.se3 import SE3, Array, so3_log
from recon4.model.frames import RecordedFrames
from recon4.model.imu_repair import ImuRepair
from recon4.model.odometry_figures import ImuAxes, ImuTurn
from recon4.model.rig import Rig
from recon4.registration.reversed_forces import reversed_forces
from recon4.registration.turned_imu import TurnedImu, turned_imu
from recon4.settings.reads import OdometryReads


@dataclass(frozen=True, slots=True, eq=False)
class ImuRepairs:
    """What was found wrong, and what makes it right."""

    repair: ImuRepair | None = None
    """None = nothing is wrong."""
    turn: ImuTurn | None = None
    """Of an IMU that is mounted otherwise."""
    axes: ImuAxes | None = None
    """Axes and signs that its driver exchanges."""
    forces_reversed: float | None = None
    """Correlation of forces and motion as recorded, if the sign of all accelerations is wrong."""


NO_REPAIRS = ImuRepairs()


def with_right_forces(
    frames: RecordedFrames, settings: OdometryReads
) -> tuple[RecordedFrames, ImuRepairs]:
    """The multiframes with accelerations of the right sign, and whether it was wrong.

    Args:
        frames: As recorded.
        settings: Of the odometry.
    """
    reversed_by = reversed_forces(frames, settings)
    if reversed_by is None or frames.imu is None:
        return frames, NO_REPAIRS
    reverse = ImuRepair.reversed_forces()
    right = frames.with_imu(reverse.of(frames.imu))
    return right, ImuRepairs(reverse, forces_reversed=reversed_by)


def with_right_axes(
    frames: RecordedFrames, settings: OdometryReads
) -> tuple[RecordedFrames, ImuRepairs] | None:
    """The multiframes with the right axes and signs of the IMU; None = they are right.

    Args:
        frames: As recorded.
        settings: Of the odometry.
    """
    turned = turned_imu(frames, settings)
    if turned is None or frames.imu is None:
        return None
    right = frames.with_imu(turned.repair.of(frames.imu))
    return right, repairs_of(turned, frames.rig)


def repairs_of(turned: TurnedImu, rig: Rig) -> ImuRepairs:
    """What was found wrong with the axes of an IMU.

    Args:
        turned: Its axes.
        rig: Where it is said to be.
    """
    return ImuRepairs(turned.repair, _mount(turned, rig), _axes(turned))


def _mount(turned: TurnedImu, rig: Rig) -> ImuTurn | None:
    angle_rad = float(np.linalg.norm(so3_log(turned.mount)))
    if angle_rad == 0.0:
        return None
    right = SE3(rig.T_body_imu.R @ turned.mount, np.zeros(3))
    roll, pitch, yaw = (np.round(np.rad2deg(right.rpy()), 1) + 0.0).tolist()
    return ImuTurn(
        angle_rad=angle_rad,
        explained=turned.explained,
        explained_turned=turned.explained_turned,
        rpy_deg=(roll, pitch, yaw),
    )


def _axes(turned: TurnedImu) -> ImuAxes | None:
    gyro, accel = (_named(axes) for axes in (turned.of_driver.gyro, turned.of_driver.accel))
    return None if gyro == accel == "x, y, z" else ImuAxes(gyro=gyro, accel=accel)


def _named(axes: Array) -> str:
    """The axes of a sensor as it should state them, of those that it states: "x, -y, z"."""
    columns = np.argmax(np.abs(axes), axis=1).tolist()
    signs = ("-" if axes[row, column] < 0.0 else "" for row, column in enumerate(columns))
    return ", ".join(f"{sign}{'xyz'[column]}" for sign, column in zip(signs, columns, strict=True))
