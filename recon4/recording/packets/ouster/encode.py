"""Ouster packets and metadata written: the inverse of `data_packets` and `metadata`."""

from __future__ import annotations

import json
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from recon4.geometry.se3 import Array
from recon4.model.trajectory import Times
from recon4.recording.packets.ouster.data_packets import checksums
from recon4.recording.packets.ouster.layouts import (
    ENCODER_TICKS,
    LEGACY,
    LEGACY_IMU,
    TYPE_DATA,
)
from recon4.recording.packets.ouster.metadata import OusterMetadata

_HEADER_BYTES = {"serial": 5, "init_id": 3}


@dataclass(frozen=True, slots=True, eq=False)
class ColumnReturns:
    """What the columns of P packets measured."""

    t_ns: Times
    """Time of each column on the clock of the sensor [ns], (P, C)."""
    number: NDArray[np.integer]
    """Its place in the revolution, (P, C)."""
    range_mm: NDArray[np.integer]
    """Range of each return of each beam, top beam first [mm]; 0 = none, (R, P, C, B)."""
    intensity: NDArray[np.integer]
    """Signal, or reflectivity where the profile has none, (R, P, C, B)."""


def encode_packets(metadata: OusterMetadata, returns: ColumnReturns) -> NDArray[np.uint8]:
    """Data packets of a sensor.

    Ranges beyond what the profile can hold are sent as none.

    Returns:
        UDP payloads, (P, size).
    """
    layout, profile = metadata.layout, metadata.layout.profile
    packets = np.zeros(len(returns.t_ns), dtype=layout.packet)
    columns = packets["columns"]
    columns["stamp_ns"] = returns.t_ns
    columns["number"] = returns.number
    pixels = columns["pixels"].reshape(*returns.number.shape, layout.beams, profile.pixel_bytes)
    for echo, range_mm, intensity in zip(
        profile.echoes, returns.range_mm, returns.intensity, strict=True
    ):
        units = np.rint(np.asarray(range_mm) / profile.unit_mm).astype(np.int64)
        units[units >> echo.range_bits > 0] = 0
        _write(pixels, units, at=echo.range_at, count=(echo.range_bits + 7) // 8)
        largest = (1 << 8 * echo.intensity_bytes) - 1
        values = np.clip(np.asarray(intensity), 0, largest).astype(np.int64)
        _write(pixels, values, at=echo.intensity_at, count=echo.intensity_bytes)
    columns["pixels"] = pixels.reshape(columns["pixels"].shape)
    again = np.diff(returns.number[:, 0], prepend=returns.number[:1, 0]) < 0
    frame = np.cumsum(again.astype(np.int64))
    if profile.name == LEGACY:
        columns["status"] = 0xFFFFFFFF
        columns["frame"] = frame[:, None] & 0xFFFF
        columns["encoder"] = returns.number * ENCODER_TICKS // metadata.columns_per_turn
    else:
        columns["status"] = 1
        _write_header(packets, metadata, frame)
    packets["columns"] = columns
    payloads = packets.view(np.uint8).reshape(len(packets), layout.size)
    if profile.name != LEGACY:
        packets["crc"] = checksums(payloads)
    return payloads


def _write_header(
    packets: NDArray[np.void], metadata: OusterMetadata, frame: NDArray[np.integer]
) -> None:
    header = packets["header"]
    header["type"] = TYPE_DATA
    header["frame"] = frame & 0xFFFF
    for name, value in (("serial", int(metadata.serial or 0)), ("init_id", metadata.init_id)):
        count = _HEADER_BYTES[name]
        header[name] = np.frombuffer(value.to_bytes(count, "little"), dtype=np.uint8)


def _write(pixels: NDArray[np.uint8], values: NDArray[np.int64], *, at: int, count: int) -> None:
    """Put the low bytes of numbers into pixels; the bits above stay those of other values."""
    for k in range(count):
        pixels[..., at + k] |= (values >> 8 * k & 0xFF).astype(np.uint8)


def encode_imu(t_ns: Times, accel_m_s2: Array, gyro_rad_s: Array) -> NDArray[np.uint8]:
    """Inertial packets of the LEGACY profile, in the axes of the chip.

    Args:
        t_ns: Times on the clock of the sensor [ns], (N,).
        accel_m_s2: Specific force [m/s²], (N, 3).
        gyro_rad_s: Angular rate [rad/s], (N, 3).

    Returns:
        UDP payloads, (N, 48).
    """
    packets = np.zeros(len(t_ns), dtype=LEGACY_IMU)
    for name in ("sent_ns", "accel_ns", "gyro_ns"):
        packets[name] = t_ns
    packets["accel_g"] = accel_m_s2 / 9.80665
    packets["gyro_deg_s"] = np.rad2deg(gyro_rad_s)
    return packets.view(np.uint8).reshape(len(t_ns), LEGACY_IMU.itemsize)


def metadata_json(metadata: OusterMetadata) -> bytes:
    """The metadata file of a sensor, nested as by firmware 3."""
    layout = metadata.layout
    T_sensor_imu, T_lidar_beam = np.eye(4), np.eye(4)
    T_sensor_imu[:3, :3] = metadata.R_sensor_imu
    T_lidar_beam[[0, 2], 3] = metadata.p_lidar_beam_m
    hz = metadata.rotation_hz if metadata.rotation_hz > 0 else 10.0
    document = {
        "sensor_info": {
            "prod_line": metadata.product,
            "prod_sn": metadata.serial,
            "initialization_id": metadata.init_id,
        },
        "beam_intrinsics": {
            "beam_altitude_angles": _rounded(np.rad2deg(metadata.elevation_rad)),
            "beam_azimuth_angles": _rounded(np.rad2deg(metadata.azimuth_rad)),
            "beam_to_lidar_transform": _in_mm(T_lidar_beam),
        },
        "lidar_intrinsics": {"lidar_to_sensor_transform": _in_mm(metadata.T_sensor_lidar)},
        "imu_intrinsics": {"imu_to_sensor_transform": _in_mm(T_sensor_imu)},
        "lidar_data_format": {
            "columns_per_frame": metadata.columns_per_turn,
            "columns_per_packet": layout.columns,
            "pixels_per_column": layout.beams,
            "udp_profile_lidar": layout.profile.name,
            "header_type": "FUSA" if layout.fusa else "STANDARD",
        },
        "config_params": {
            "lidar_mode": f"{metadata.columns_per_turn}x{round(hz)}",
            "udp_port_lidar": metadata.port,
            "udp_port_imu": metadata.imu_port,
        },
    }
    return json.dumps(document, indent=2).encode()


def _rounded(values: Array) -> list[float]:
    return [round(value, 6) for value in values.tolist()]


def _in_mm(T_a_b: Array) -> list[float]:
    scaled = T_a_b.copy()
    scaled[:3, 3] *= 1e3
    return _rounded(scaled.ravel())
