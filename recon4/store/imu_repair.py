"""What the odometry repaired of an IMU, as a project has it."""

from __future__ import annotations

from pathlib import Path

from recon4.model.imu_repair import IMU_REPAIR, ImuRepair
from recon4.store.arrays import load_record

FORCES_REVERSED = "forces_reversed.npz"
"""What the odometry left up to version 60 where the sign of all accelerations is wrong."""


def read_imu_repair(odometry: Path) -> ImuRepair | None:
    """The repair that the stage ``odometry`` found; None = nothing is wrong.

    Raises:
        StoreError: If its file is damaged.
    """
    if (odometry / FORCES_REVERSED).is_file():
        return ImuRepair.reversed_forces()
    path = odometry / IMU_REPAIR
    return load_record(path, ImuRepair) if path.is_file() else None
