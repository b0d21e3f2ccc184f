"""Packets of RoboSense LiDARs written: the inverse of `packets`, `angles`, `solid`."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from recon4.model.samples import ImuSamples
from recon4.model.trajectory import Times
from recon4.recording.packets.family import Payloads
from recon4.recording.packets.robosense.imu_packets import IMU_ID
from recon4.recording.packets.robosense.models import (
    AIRY_VARIANT,
    ANGLE,
    ANGLES_AT,
    DEVICE_ID,
    ELEVATIONS_AT,
    IMU_FULL,
    IMU_LARGEST_RANGE,
    IMU_PACKET,
    IMU_SIZE,
    INSTALLED_AT,
    MODE_AT,
    OLD_TYPE_AT,
    OLD_TYPES,
    SIZE,
    TYPE_AT,
    RoboSenseModel,
)
from recon4.recording.packets.robosense.packets import block_bytes, stamp_bytes
from recon4.recording.packets.robosense.solid import (
    SOLID_HEADER,
    SOLID_ID,
    SOLID_STAMP_AT,
    SolidModel,
)
from recon4.recording.packets.robosense.tuning import ROBOSENSE_ANGLES
from recon4.units import SECOND_NS, STANDARD_GRAVITY_M_S2


@dataclass(frozen=True, slots=True, eq=False)
class SpinningBlocks:
    """The blocks of P data packets, as they lie on the wire."""

    azimuth_cdeg: NDArray[np.integer]
    """Azimuth at the first shot of each block [0.01°], taken modulo 360°, (P, B)."""
    distance: NDArray[np.integer]
    """Distance in units of the model, 0 = no return, (P, B, C)."""
    intensity: NDArray[np.integer]
    """0..255, (P, B, C)."""


def encode_imu(samples: ImuSamples) -> Payloads:
    """Packets of the inertial unit of an Airy, set to its largest ranges, (N, 51)."""
    packets = np.zeros(len(samples.t_ns), IMU_PACKET)
    packets["id"] = np.frombuffer(IMU_ID, np.uint8)
    seconds, rest_ns = np.divmod(samples.t_ns + 500, SECOND_NS)
    packets["stamp"][:, 2:6] = seconds.astype(">u4")[:, None].view(np.uint8)
    packets["stamp"][:, 6:10] = (rest_ns // 1000).astype(">u4")[:, None].view(np.uint8)
    packets["accel_range"] = packets["gyro_range"] = IMU_LARGEST_RANGE
    accel_full = STANDARD_GRAVITY_M_S2 * 2.0 ** (IMU_LARGEST_RANGE + 1)
    gyro_full = np.deg2rad(250.0 * 2.0**IMU_LARGEST_RANGE)
    for name, values in (
        ("accel", samples.accel_m_s2 / accel_full),
        ("gyro", samples.gyro_rad_s / gyro_full),
    ):
        packets[name] = np.rint(IMU_FULL * np.clip(values, -1.0, 1.0))
    packets["count"] = np.arange(len(packets))
    return packets.view(np.uint8).reshape(len(packets), IMU_SIZE)


def encode_spinning(t_ns: Times, blocks: SpinningBlocks, model: RoboSenseModel) -> Payloads:
    """Data packets of a model that spins.

    Args:
        t_ns: Time of the first shot of each packet [ns], (P,).
        blocks: Azimuths and returns; second returns in the blocks that the model puts them in.
        model: The sensor.

    Returns:
        UDP payloads, (P, 1248).
    """
    payloads = np.zeros((len(t_ns), SIZE), np.uint8)
    payloads[:, : len(model.data_id)] = np.frombuffer(model.data_id, np.uint8)
    if model.name == "Bpearl V4":
        payloads[:, TYPE_AT : TYPE_AT + 2] = 3, 4
    for old_type, name in OLD_TYPES.items():
        if model.name == name:
            payloads[:, OLD_TYPE_AT] = old_type
    if model.name == "Airy":
        payloads[:, TYPE_AT + 1] = AIRY_VARIANT
    payloads[:, model.stamp_at : model.stamp_at + 10] = stamp_bytes(t_ns, model.stamp)
    written = block_bytes(payloads, model)
    written[:, :, : len(model.flag)] = np.frombuffer(model.flag, np.uint8)
    written[:, :, 2:4] = _words(np.asarray(blocks.azimuth_cdeg) % 36000)
    written[:, :, 4::3], written[:, :, 5::3] = np.moveaxis(_words(blocks.distance), -1, 0)
    written[:, :, 6::3] = blocks.intensity
    return payloads


def encode_device(
    angles_cdeg: NDArray[np.integer], model: RoboSenseModel, *, mode: int = 4, installed: int = 255
) -> Payloads:
    """A device packet (DIFOP).

    Args:
        angles_cdeg: Elevation and azimuth of each laser [0.01°], (L, 2); more than L places for
            them are filled with 0xFF.
        model: How it states angles.
        mode: Return mode; 0 = dual for Helios and Bpearl.
        installed: How an Airy is installed; 255 = not stated.

    Returns:
        UDP payload, (1, 1248).
    """
    payload = np.zeros((1, SIZE), np.uint8)
    payload[0, :8] = np.frombuffer(DEVICE_ID, np.uint8)
    payload[0, MODE_AT], payload[0, INSTALLED_AT] = mode, installed
    if model.device_angles == "elevations":
        fine = 100 * np.abs(angles_cdeg[:, 0])
        digits = np.stack([fine >> 16, fine >> 8, fine], axis=1) & 255
        payload[0, ELEVATIONS_AT : ELEVATIONS_AT + digits.size] = digits.reshape(-1)
        return payload
    room = max(ROBOSENSE_ANGLES.least_room, model.lasers)
    table = np.frombuffer(b"\xff" * (6 * room), ANGLE).reshape(2, room).copy()
    scale = 10 if model.device_angles == "0.001 deg" else 1
    table["sign"][:, : len(angles_cdeg)] = (angles_cdeg < 0).T
    table["cdeg"][:, : len(angles_cdeg)] = scale * np.abs(angles_cdeg).T
    payload[0, ANGLES_AT : ANGLES_AT + 6 * room] = np.frombuffer(table.tobytes(), np.uint8)
    return payload


def encode_solid(t_ns: Times, blocks: NDArray[np.void], model: SolidModel) -> Payloads:
    """Data packets of a model that does not spin.

    Args:
        t_ns: Time of each packet [ns], (P,).
        blocks: Its records, ``SolidModel.block``, (P, B).
        model: The sensor.

    Returns:
        UDP payloads, (P, size).
    """
    payloads = np.zeros((len(t_ns), model.size), np.uint8)
    payloads[:, :4] = np.frombuffer(SOLID_ID, np.uint8)
    payloads[:, SOLID_STAMP_AT : SOLID_STAMP_AT + 10] = stamp_bytes(t_ns, "us")
    body = np.frombuffer(blocks.tobytes(), np.uint8).reshape(len(t_ns), -1)
    payloads[:, SOLID_HEADER : SOLID_HEADER + body.shape[1]] = body
    return payloads


def _words(values: NDArray[np.integer]) -> NDArray[np.uint8]:
    """Big-endian words, (…, 2)."""
    words = np.asarray(values).astype(">u2")
    return words[..., None].view(np.uint8)
