"""Livox packets written: the inverse of `family`, for tests and the simulator."""

from __future__ import annotations

import math
import zlib
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from recon4.model.trajectory import Times
from recon4.recording.packets.family import Payloads
from recon4.recording.packets.livox.models import (
    CRC_FROM,
    IMU_SAMPLE,
    SDK1_HEADER,
    SDK1_IMU_TYPE,
    SDK1_VERSION,
    SDK2_HEADER,
    SDK2_IMU_TYPE,
    UTC_TIME_TYPE,
    LivoxModel,
    PointLayout,
)
from recon4.recording.packets.livox.sound import date_stamps
from recon4.recording.packets.livox.tuning import LIVOX_PACKETS
from recon4.units import STANDARD_GRAVITY_M_S2


@dataclass(frozen=True, slots=True, eq=False)
class ShotReturns:
    """Returns of P packets of one layout; the order of the shots is that of firing."""

    xyz_m: NDArray[np.floating]
    """Points; zero = no return, (P, shots, returns, 3)."""
    reflectivity: NDArray[np.integer]
    """0..255, (P, shots, returns)."""
    tag: NDArray[np.integer] | None = None
    """As in the manual, (P, shots, returns); None = 0."""


def encode_points(
    t_ns: Times, shots: ShotReturns, *, layout: PointLayout, model: LivoxModel, time_type: int = 1
) -> Payloads:
    """Data packets.

    Args:
        t_ns: Time of the first shot of each packet on the clock of the sensor [ns], (P,).
        shots: Their returns.
        layout: Data type; a point is rounded to its unit.
        model: Whose rate is stated.
        time_type: How the clock is driven; 3 (SDK1) writes dates.

    Returns:
        UDP payloads, (P, ``layout.size``).
    """
    records = np.zeros((len(t_ns), layout.shots), layout.record)
    if layout.is_spherical:
        _write_spherical(records, shots.xyz_m, layout.unit_m)
    else:
        records["returns"]["xyz"] = np.rint(shots.xyz_m / layout.unit_m)
    records["returns"]["reflectivity"] = shots.reflectivity
    if layout.is_tagged and shots.tag is not None:
        records["returns"]["tag"] = shots.tag
    interval = round(layout.shots * model.shot_s * 1e7)
    header = _header(t_ns, layout.sdk, layout.data_type, time_type=time_type)
    if layout.sdk == 2:
        header["interval"], header["points"] = interval, layout.shots
    return _joined(header, _bytes(records))


def encode_imu(
    t_ns: Times,
    gyro_rad_s: NDArray[np.floating],
    accel_m_s2: NDArray[np.floating],
    *,
    sdk: int,
    time_type: int = 1,
) -> Payloads:
    """IMU packets, one for each sample: (N, 42) of SDK1, (N, 60) of SDK2."""
    samples = np.zeros(len(t_ns), IMU_SAMPLE)
    samples["gyro"], samples["accel"] = gyro_rad_s, accel_m_s2 / STANDARD_GRAVITY_M_S2
    header = _header(t_ns, sdk, SDK1_IMU_TYPE if sdk == 1 else SDK2_IMU_TYPE, time_type=time_type)
    if sdk == 2:
        header["interval"], header["points"] = LIVOX_PACKETS.imu_interval, 1
    return _joined(header, _bytes(samples))


def _write_spherical(records: NDArray[np.void], xyz_m: NDArray[np.floating], unit_m: float) -> None:
    """Depths of all returns, and the direction of the farthest: a shot has one direction."""
    depth = np.linalg.norm(xyz_m, axis=3)
    at = np.argmax(depth, axis=2)[..., None, None]
    x, y, z = np.take_along_axis(xyz_m, at, axis=2)[:, :, 0].transpose(2, 0, 1)
    records["theta"] = np.rint(np.rad2deg(np.arctan2(np.hypot(x, y), z)) * 100)
    records["phi"] = np.rint(np.rad2deg(np.arctan2(y, x)) * 100) % 36000
    records["returns"]["depth"] = np.rint(depth / unit_m)


def _header(t_ns: Times, sdk: int, data_type: int, *, time_type: int) -> NDArray[np.void]:
    header = np.zeros(len(t_ns), SDK1_HEADER if sdk == 1 else SDK2_HEADER)
    header["data_type"], header["time_type"] = data_type, time_type
    if sdk == 1:
        header["version"], header["slot"], header["id"] = SDK1_VERSION, 1, 1
    else:
        header["counter"] = np.arange(len(t_ns)) % 65536
    dated = sdk == 1 and time_type == UTC_TIME_TYPE
    header["stamp"] = date_stamps(t_ns) if dated else _bytes(np.asarray(t_ns, "<u8"))
    return header


def _bytes(values: NDArray[np.generic]) -> NDArray[np.uint8]:
    size = values.itemsize * math.prod(values.shape[1:])  # also of no packets at all
    return np.ascontiguousarray(values).view(np.uint8).reshape(len(values), size)


def _joined(header: NDArray[np.void], body: NDArray[np.uint8]) -> Payloads:
    """Whole packets, with their length and sum if they have one."""
    size = header.dtype.itemsize + body.shape[1]
    if header.dtype != SDK2_HEADER:
        return np.concatenate([_bytes(header), body], axis=1)
    header["length"] = size
    packets = np.concatenate([_bytes(header), body], axis=1)
    header["crc"] = [zlib.crc32(packet) for packet in packets[:, CRC_FROM:].copy()]
    return np.concatenate([_bytes(header), body], axis=1)
