"""Inertial samples of Hesai sensors: in the tails of data packets; of the JT16, in own packets.

Units and layout: Pandar128E3X manual, section 3.1.2 (the units stand in the packet), and the
published SDK for the JT16 (±4 g in 1/8192 g, ±1000°/s in 1/32.8°/s). Hesai states that the axes
are those of the point cloud: x to the right, y forward, z up.
"""

from __future__ import annotations

from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from recon4.model.samples import ImuSamples
from recon4.model.trajectory import Times
from recon4.recording.packets.family import Payloads
from recon4.recording.packets.hesai import checksums, stamps
from recon4.recording.packets.hesai.fields import Fields, sound_packets
from recon4.recording.packets.hesai.layouts import (
    JT16_IMU_SIZE,
    JT16_SIZE,
    START,
    HesaiLayout,
)
from recon4.recording.report import ImportReport
from recon4.units import STANDARD_GRAVITY_M_S2

TAIL_SAMPLE = np.dtype(
    [
        ("temperature", "<i2"),
        ("accel_unit", "<u2"),
        ("gyro_unit", "<u2"),
        ("clock", "<u4"),
        ("accel", "<i2", 3),
        ("gyro", "<i2", 3),
    ]
)
"""In the tail of a Pandar128, OT128 or JT128: units of 0.001 mg and 0.01 m°/s; clock in 25 µs."""
JT16_SAMPLE = np.dtype(
    [
        ("start", "u1", 6),
        ("date", "u1", 6),
        ("micros", "<u4"),
        ("accel", "<i2", 3),
        ("gyro", "<i2", 3),
        ("sequence", "<u2"),
        ("crc", "<u4"),
    ]
)
_JT16_START = np.frombuffer(START + bytes((1, 8)), np.uint8)


class _Units:
    """Of accelerations [g] and angular rates [°/s]: of the units in a tail, and of a JT16."""

    TAIL_G, TAIL_DEG_S = 1e-6, 1e-5
    JT16_G, JT16_DEG_S = 1 / 8192, 1 / 32.8


class Inertial(Protocol):
    """Reads the inertial samples of one sensor."""

    @property
    def size(self) -> int:
        """Bytes of the packets that hold them; 0 = there are none."""
        ...

    def samples(self, payloads: Payloads) -> tuple[ImuSamples, NDArray[np.bool_]]:
        """New samples on the clock of the sensor, and which packets they are from, (N,).

        Args:
            payloads: Packets of `size` bytes, not checked, (N, size).
        """
        ...


class TailInertial:
    """In the tails of data packets.

    A sample is repeated until the next one is measured: its time is that of the first packet with
    it, late by at most the time between two packets.
    """

    def __init__(self, layout: HesaiLayout, header: bytes) -> None:
        """Nothing is read yet."""
        self.size = layout.size if layout.imu_at >= 0 else 0
        self._layout, self._header = layout, header
        self._clock = -1

    def samples(self, payloads: Payloads) -> tuple[ImuSamples, NDArray[np.bool_]]:
        """See `Inertial`."""
        fields = Fields(payloads, self._layout)
        at = self._layout.imu_at
        tails = np.ascontiguousarray(payloads[:, at : at + TAIL_SAMPLE.itemsize])
        found: NDArray[np.void] = tails.view(TAIL_SAMPLE)[:, 0]
        sound = sound_packets(fields, self._header, 0.0, report=ImportReport())
        sound &= (found["accel_unit"] > 0) & (found["gyro_unit"] > 0)
        clock = found["clock"].astype(np.int64)
        rows = np.flatnonzero(sound)
        new = np.zeros(len(payloads), dtype=np.bool_)
        new[rows] = np.diff(clock[rows], prepend=self._clock) != 0
        if len(rows):
            self._clock = int(clock[rows[-1]])
        found = found[new]
        accel_g = found["accel"] * (_Units.TAIL_G * found["accel_unit"][:, None])
        gyro_deg_s = found["gyro"] * (_Units.TAIL_DEG_S * found["gyro_unit"][:, None])
        t_ns = stamps.time_ns(fields.date[new], fields.micros[new])
        return _samples(t_ns, accel_g, gyro_deg_s), new


class Jt16Inertial:
    """In the inertial packets of a JT16."""

    size = JT16_IMU_SIZE

    def samples(self, payloads: Payloads) -> tuple[ImuSamples, NDArray[np.bool_]]:
        """See `Inertial`."""
        found: NDArray[np.void] = np.ascontiguousarray(payloads).view(JT16_SAMPLE)[:, 0]
        sound = (found["start"][:, :4] == _JT16_START).all(axis=1) & (found["start"][:, 5] == 1)
        sound &= stamps.is_date(found["date"], found["micros"])
        sound &= jt16_sums(payloads) == found["crc"]
        found = found[sound]
        t_ns = stamps.time_ns(found["date"], found["micros"])
        return _samples(
            t_ns, found["accel"] * _Units.JT16_G, found["gyro"] * _Units.JT16_DEG_S
        ), sound


def jt16_sums(payloads: Payloads) -> NDArray[np.uint32]:
    """Checksums that the inertial packets of a JT16 ought to have, (N,)."""
    summed = np.pad(payloads[:, : JT16_IMU_SIZE - 4], ((0, 0), (0, 2)))  # to whole words
    return checksums.crc32(summed)


def inertial_of(layout: HesaiLayout, header: bytes) -> Inertial:
    """What reads the inertial samples of a sensor with such data packets."""
    return Jt16Inertial() if layout.size == JT16_SIZE else TailInertial(layout, header)


def _samples(
    t_ns: Times, accel_g: NDArray[np.floating], gyro_deg_s: NDArray[np.floating]
) -> ImuSamples:
    return ImuSamples(
        t_ns=t_ns,
        gyro_rad_s=np.deg2rad(gyro_deg_s).astype(np.float64),
        accel_m_s2=(STANDARD_GRAVITY_M_S2 * accel_g).astype(np.float64),
    )
