"""How the IMU in a LiDAR is mounted."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from recon4.geometry.se3 import SE3
from recon4.model.lidars import lidar_model

if TYPE_CHECKING:  # the rig file is read with these functions
    from recon4.model.rig import Rig, Sensor


def imu_mount(holder: Sensor, stated: SE3 | None = None) -> SE3:
    """Mounting of the IMU in a LiDAR: as its data sheet says, unless another one is stated.

    Args:
        holder: The LiDAR.
        stated: ``T_body_imu`` by a person or a calibration; the identity = nobody measured it.
    """
    if stated is not None and not np.allclose(stated.matrix(), np.eye(4), atol=1e-12):
        return stated
    facts = lidar_model(holder.model)
    place = np.array(facts.p_sensor_imu_m)
    return holder.T_body_sensor @ SE3.from_rpy(*np.deg2rad(facts.rpy_sensor_imu_deg), t=place)


def with_imu_of(rig: Rig, name: str) -> Rig:
    """The rig with the IMU of one of its LiDARs, where the rig names none.

    Args:
        rig: Its mount of the IMU counts, if it states one.
        name: Of the LiDAR.
    """
    holder = next(sensor for sensor in rig.sensors if sensor.name == name)
    return replace(rig, imu_sensor=name, T_body_imu=imu_mount(holder, rig.T_body_imu))


def is_in_holder(rig: Rig) -> bool:
    """Whether the IMU is mounted as the data sheet of its LiDAR says."""
    holder = next((one for one in rig.sensors if one.name == rig.imu_sensor), None)
    if holder is None:
        return False
    by_holder = imu_mount(holder).matrix()
    return bool(np.allclose(rig.T_body_imu.matrix(), by_holder, rtol=0.0, atol=1e-9))
