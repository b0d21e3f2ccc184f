"""Hesai packets written: the inverse of `data_packets` and `inertial`, for tests and simulation.

`recon4.recording.packets.hesai.firing.shot_times_us` tells when each channel fires, so that a
simulator can place the beams.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from recon4.recording.packets.family import Payloads
from recon4.recording.packets.hesai import checksums, stamps
from recon4.recording.packets.hesai.inertial import JT16_SAMPLE, TAIL_SAMPLE, jt16_sums
from recon4.recording.packets.hesai.layouts import (
    JT16_IMU_SIZE,
    PANDAR40P_BLOCK,
    START,
    HesaiLayout,
)
from recon4.recording.packets.hesai.models import HesaiModel
from recon4.units import SECOND_US


@dataclass(frozen=True, slots=True, eq=False)
class HesaiBlocks:
    """The blocks of P data packets."""

    azimuth: NDArray[np.integer]
    """Azimuth of each block [0.01°; 1/25600° for an AT128], taken modulo 360°, (P, B)."""
    distance: NDArray[np.integer]
    """Distance in units of the layout (usually 4 mm), 0 = no return, (P, B, C)."""
    intensity: NDArray[np.integer]
    """Reflectivity 0..255, (P, B, C)."""


@dataclass(frozen=True, slots=True, kw_only=True)
class HesaiMode:
    """What the tails of some packets say."""

    return_mode: int = 0x37
    """Dual mode: blocks 2k and 2k + 1 belong together."""
    rpm: float = 600.0
    """Revolutions a minute."""
    state: int = 2
    """Operational state of a Pandar128 or OT128: 0 = high resolution, 2 = standard."""
    azimuth_flag: int = 0
    """Firing sequences of its blocks: block 1 in the highest two of 16 bits."""
    sequence: int = 1
    """QT128: 1 = the packet starts with the first firing sequence."""


class InertialUnits(NamedTuple):
    """Of the numbers in inertial samples."""

    accel_g: float
    gyro_deg_s: float
    clock_ns: int
    """A tick of their clock."""


TAIL_UNITS = InertialUnits(488e-6, 0.14, 25_000)
"""That `write_inertial` states."""
JT16_UNITS = InertialUnits(1 / 8192, 1 / 32.8, 1000)


def encode_packets(
    stamp_us: NDArray[np.integer],
    blocks: HesaiBlocks,
    *,
    model: HesaiModel,
    mode: HesaiMode = HesaiMode(),
) -> Payloads:
    """Data packets of the usual layout of a model.

    Args:
        stamp_us: Stamp of each packet [µs since 1970], (P,).
        blocks: Their azimuths and returns.
        model: The sensor.
        mode: What the tails say.

    Returns:
        UDP payloads, (P, size).
    """
    layout = model.layout
    packets = np.zeros((len(stamp_us), layout.size), dtype=np.uint8)
    packets[:, : len(model.header)] = np.frombuffer(model.header, np.uint8)
    _write_blocks(packets, layout, blocks)
    _write_tail(packets, model, mode)
    seconds, micros = np.divmod(np.asarray(stamp_us, dtype=np.int64), SECOND_US)
    date = stamps.date_of(seconds)
    if layout.tail.date == 16:  # Pandar40P and Pandar64 count years from 2000
        date[:, 0] -= 100
    at = layout.tail_at
    packets[:, at + layout.tail.date : at + layout.tail.date + 6] = date
    _write(packets, at + layout.tail.micros, micros, kind="<u4")
    checksums.write(packets, layout)
    return packets


def _write_blocks(packets: Payloads, layout: HesaiLayout, blocks: HesaiBlocks) -> None:
    fine = layout.returns_at - layout.azimuth_at == 3
    azimuth = np.asarray(blocks.azimuth, dtype=np.int64) % (36000 * 256 if fine else 36000)
    for block in range(layout.blocks):
        start = layout.blocks_at + block * layout.block_bytes
        if layout.azimuth_at == 2:
            packets[:, start : start + 2] = np.frombuffer(PANDAR40P_BLOCK, np.uint8)
        coarse = azimuth[:, block] // 256 if fine else azimuth[:, block]
        _write(packets, start + layout.azimuth_at, coarse, kind="<u2")
        if fine:
            packets[:, start + 2] = azimuth[:, block] % 256
        at = start + layout.returns_at + layout.return_bytes * np.arange(layout.channels)
        distance = np.asarray(blocks.distance)[:, block].astype(np.uint16)
        packets[:, at], packets[:, at + 1] = distance & 0xFF, distance >> 8
        packets[:, at + 2] = np.asarray(blocks.intensity)[:, block]


def _write_tail(packets: Payloads, model: HesaiModel, mode: HesaiMode) -> None:
    layout = model.layout
    at, tail, ones = layout.tail_at, layout.tail, np.ones(len(packets), dtype=np.int64)
    if tail.mode >= 0:
        packets[:, at + tail.mode] = mode.return_mode
        _write(packets, at + tail.speed, ones * round(mode.rpm / model.speed_rpm), kind="<u2")
    if tail.azimuth_flag >= 0:
        packets[:, at + tail.state] = mode.state
        _write(packets, at + tail.azimuth_flag, ones * mode.azimuth_flag, kind="<u2")
    if tail.sequence >= 0:
        packets[:, at + tail.sequence] = mode.sequence


def write_inertial(
    packets: Payloads,
    layout: HesaiLayout,
    *,
    clock: NDArray[np.integer],
    values: NDArray[np.integer],
) -> None:
    """Put inertial samples into the tails of data packets, and set their checksums.

    Args:
        packets: The packets, (P, size).
        layout: Theirs.
        clock: Time of each sample since power-on [25 µs], (P,).
        values: Accelerations [0.488 mg] and angular rates [0.14°/s], (P, 6).
    """
    samples = np.zeros(len(packets), dtype=TAIL_SAMPLE)
    samples["accel_unit"] = round(1e6 * TAIL_UNITS.accel_g)
    samples["gyro_unit"] = round(1e5 * TAIL_UNITS.gyro_deg_s)
    samples["clock"] = clock
    samples["accel"], samples["gyro"] = values[:, :3], values[:, 3:]
    at = layout.imu_at
    packets[:, at : at + TAIL_SAMPLE.itemsize] = samples.view(np.uint8).reshape(
        len(packets), TAIL_SAMPLE.itemsize
    )
    checksums.write(packets, layout)


def encode_jt16_inertial(stamp_us: NDArray[np.integer], values: NDArray[np.integer]) -> Payloads:
    """Inertial packets of a JT16.

    Args:
        stamp_us: Time of each sample [µs since 1970], (N,).
        values: Accelerations [1/8192 g] and angular rates [1/32.8°/s], (N, 6).
    """
    packets = np.zeros(len(stamp_us), dtype=JT16_SAMPLE)
    packets["start"] = np.frombuffer(START + bytes((1, 8, 0, 1)), np.uint8)
    seconds, packets["micros"] = np.divmod(np.asarray(stamp_us, dtype=np.int64), SECOND_US)
    packets["date"] = stamps.date_of(seconds)
    packets["accel"], packets["gyro"] = values[:, :3], values[:, 3:]
    payloads = packets.view(np.uint8).reshape(-1, JT16_IMU_SIZE)
    packets["crc"] = jt16_sums(payloads)
    return payloads


def _write(packets: Payloads, at: int, values: NDArray[np.integer], *, kind: str) -> None:
    """Numbers of one field, one a packet."""
    numbers = np.asarray(values).astype(kind)
    size = numbers.itemsize * math.prod(numbers.shape[1:])  # also of no packets at all
    packets[:, at : at + size] = numbers.view(np.uint8).reshape(len(packets), size)
