"""Accelerations with the wrong sign are distinguished from a LiDAR that hangs upside down."""

from dataclasses import replace

import numpy as np
import pytest

from recon4.geometry.se3 import SE3
from recon4.model.imu_repair import ImuRepair
from recon4.registration.reversed_forces import reversed_forces
from recon4.settings import preset
from recon4.settings.reads import OdometryReads, part_of
from tests.unit.registration.other_imu import Walk

SETTINGS = part_of(preset("indoor"), OdometryReads)
OVER = SE3.from_rpy(np.pi, 0.0, 0.0, t=[0.0] * 3)
"""From a body that stands to one that hangs."""


def hanging(rig):
    """The rig whose body is turned over with all of its sensors."""
    sensors = [replace(s, T_body_sensor=OVER @ s.T_body_sensor) for s in rig.sensors]
    return replace(rig, sensors=tuple(sensors), T_body_imu=OVER @ rig.T_body_imu)


def test_forces_against_the_motion_of_the_lidars_are_reversed(frames):
    wrong = ImuRepair.reversed_forces().of(frames.imu)

    assert reversed_forces(Walk(frames, imu=wrong), SETTINGS) < -0.8
    assert reversed_forces(frames, SETTINGS) is None


def test_an_imu_that_is_turned_over_in_its_rig_has_no_reversed_forces(frames):
    """By the rig file it is upright: its gyroscope contradicts the LiDARs, too."""
    imu, over = frames.imu, np.diag([-1.0, 1.0, -1.0])
    turned = replace(imu, gyro_rad_s=imu.gyro_rad_s @ over, accel_m_s2=imu.accel_m_s2 @ over)

    assert reversed_forces(Walk(frames, imu=turned), SETTINGS) is None


@pytest.mark.study
def test_a_lidar_that_hangs_has_no_reversed_forces(frames):
    assert reversed_forces(Walk(frames, rig=hanging(frames.rig)), SETTINGS) is None


def test_an_imu_without_accelerometer_is_not_looked_at(frames):
    nan = replace(frames.imu, accel_m_s2=np.full_like(frames.imu.accel_m_s2, np.nan))
    assert reversed_forces(Walk(frames, imu=nan), SETTINGS) is None
