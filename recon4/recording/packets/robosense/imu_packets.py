"""Packets of the inertial unit of a RoboSense Airy."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from recon4.model.samples import ImuSamples
from recon4.model.trajectory import Times
from recon4.recording.packets.family import Payloads
from recon4.recording.packets.robosense.models import (
    IMU_FULL,
    IMU_LARGEST_RANGE,
    IMU_PACKET,
)
from recon4.recording.packets.robosense.packets import stamps_of
from recon4.recording.packets.sensor_clock import SensorClock
from recon4.recording.report import ImportReport
from recon4.units import STANDARD_GRAVITY_M_S2

IMU_ID = bytes.fromhex("aa555a05")
"""First bytes of a packet."""


def is_imu(payloads: Payloads) -> NDArray[np.bool_]:
    """Which payloads of 51 bytes are packets of an inertial unit, (N,)."""
    packets = np.ascontiguousarray(payloads).view(IMU_PACKET)[:, 0]
    begins = (packets["id"] == np.frombuffer(IMU_ID, np.uint8)).all(axis=1)
    ranges = np.maximum(packets["accel_range"], packets["gyro_range"])
    return np.asarray(
        begins
        & (ranges <= IMU_LARGEST_RANGE)
        & (np.abs(packets["accel"].astype(np.int64)) <= IMU_FULL).all(axis=1)
        & (np.abs(packets["gyro"].astype(np.int64)) <= IMU_FULL).all(axis=1)
        & stamps_of(packets["stamp"].copy(), ns=False)[1]
    )


def imu_samples(
    payloads: Payloads, t_arrival_ns: Times, *, clock: SensorClock, report: ImportReport
) -> ImuSamples | None:
    """Samples of sound packets, in the axes of the inertial unit; None = there are none.

    Counts ``imu_samples``.

    Args:
        payloads: Packets of 51 bytes, (N, 51).
        t_arrival_ns: When they arrived [ns], (N,).
        clock: Turns their stamps into times of the rig.
        report: Takes the counts.
    """
    sound = is_imu(payloads)
    packets = np.ascontiguousarray(payloads[sound]).view(IMU_PACKET)[:, 0]
    t_ns, timed = clock.at_ns(t_arrival_ns[sound], stamps_of(packets["stamp"].copy(), ns=False)[0])
    packets, t_ns = packets[timed], t_ns[timed]
    report.count("imu_samples", len(packets))
    if not len(packets):
        return None
    g = 2.0 ** (packets["accel_range"] + 1.0) / IMU_FULL
    deg_s = 250.0 * 2.0 ** packets["gyro_range"].astype(np.float64) / IMU_FULL
    return ImuSamples(
        t_ns=t_ns,
        gyro_rad_s=np.deg2rad(packets["gyro"] * deg_s[:, None]),
        accel_m_s2=packets["accel"] * (STANDARD_GRAVITY_M_S2 * g)[:, None],
    )
