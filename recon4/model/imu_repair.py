"""What the odometry repairs of an IMU: its axes, and the sign of its forces."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from recon4.geometry.se3 import Array
from recon4.model.samples import ImuSamples

IMU_REPAIR = "imu_repair.npz"
"""In the folder of the stage ``odometry``: an `ImuRepair`, if something is repaired."""


@dataclass(frozen=True, slots=True, eq=False)
class ImuRepair:
    """Maps that make recorded samples those of an IMU as its rig states it."""

    gyro: Array
    """Of turn rates, (3, 3)."""
    accel: Array
    """Of specific forces, (3, 3)."""

    @staticmethod
    def turned(R: Array) -> ImuRepair:
        """All axes turned by a rotation."""
        return ImuRepair(R, R)

    @staticmethod
    def reversed_forces() -> ImuRepair:
        """The opposite sign of all accelerations."""
        return ImuRepair(np.eye(3), -np.eye(3))

    def after(self, first: ImuRepair) -> ImuRepair:
        """Another one, and then this one."""
        return ImuRepair(self.gyro @ first.gyro, self.accel @ first.accel)

    def of(self, imu: ImuSamples) -> ImuSamples:
        """Repaired samples."""
        return ImuSamples(imu.t_ns, imu.gyro_rad_s @ self.gyro.T, imu.accel_m_s2 @ self.accel.T)
