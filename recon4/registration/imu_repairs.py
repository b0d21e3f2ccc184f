"""What is wrong with the samples of an IMU before a walk is tracked with them: axes and signs."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from recon4.geometry.se3 import SE3
from recon4.model.frames import RecordedFrames
from recon4.model.imu_repair import ImuRepair
from recon4.model.odometry_figures import ImuTurn
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
    forces_reversed: float | None = None
    """Correlation of forces and motion as recorded, if the sign of all accelerations is wrong."""


NO_REPAIRS = ImuRepairs()


def repaired_imu(
    frames: RecordedFrames, settings: OdometryReads
) -> tuple[RecordedFrames, ImuRepairs]:
    """The multiframes with the right samples, and what was wrong with them.

    Args:
        frames: As recorded.
        settings: Of the odometry.
    """
    repair: ImuRepair | None = None
    turned = turned_imu(frames, settings)
    if turned is not None and frames.imu is not None:
        repair = ImuRepair.turned(turned.R)
        frames = frames.with_imu(repair.of(frames.imu))
    reversed_by = reversed_forces(frames, settings)
    if reversed_by is not None and frames.imu is not None:
        reverse = ImuRepair.reversed_forces()
        frames = frames.with_imu(reverse.of(frames.imu))
        repair = reverse if repair is None else reverse.after(repair)
    turn = _figures(turned, frames.rig) if turned else None
    return frames, ImuRepairs(repair, turn, reversed_by)


def _figures(turned: TurnedImu, rig: Rig) -> ImuTurn:
    right = SE3(rig.T_body_imu.R @ turned.R, np.zeros(3))
    roll, pitch, yaw = (np.round(np.rad2deg(right.rpy()), 1) + 0.0).tolist()
    return ImuTurn(
        angle_rad=turned.angle_rad,
        explained=turned.explained,
        explained_turned=turned.explained_turned,
        rpy_deg=(roll, pitch, yaw),
    )
