"""Inertial samples of Ouster sensors.

LEGACY: 48 bytes, a hundred times a second; acceleration [g] and angular rate [°/s] are measured at
two times, 0.2 ms apart. ACCEL32_GYRO32_NMEA (firmware 3.2 and later): a packet with header, an NMEA
sentence and a number of samples in SI units.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from recon4.geometry.distinct import distinct
from recon4.geometry.se3 import Array
from recon4.model.samples import ImuSamples
from recon4.model.trajectory import Times
from recon4.recording.formats.datagrams import Datagrams
from recon4.recording.limits import LIMITS
from recon4.recording.packets.family import PacketSensor, Payloads
from recon4.recording.packets.ouster.layouts import (
    AROUND_SAMPLES_BYTES,
    HEADER_BYTES,
    IMU_SAMPLE,
    LEGACY_IMU,
    MAX_SAMPLES,
    NMEA_BYTES,
    STANDARD_HEADER,
    TYPE_IMU,
    TYPE_ZONES,
    ZONE_BYTES,
    numbers,
)
from recon4.recording.packets.ouster.metadata import OusterMetadata
from recon4.recording.packets.ouster.tuning import OUSTER_IMU
from recon4.recording.packets.sensor_clock import SensorClock
from recon4.units import STANDARD_GRAVITY_M_S2

SAMPLE_SIZES = frozenset(
    {
        LEGACY_IMU.itemsize,
        *(AROUND_SAMPLES_BYTES + IMU_SAMPLE.itemsize * n for n in range(1, 1 + MAX_SAMPLES)),
    }
)
"""Bytes of all inertial packets."""


def imu_samples_in(size: int) -> int:
    """Samples in an inertial packet of a size [bytes]; 0 = it is none."""
    if size == LEGACY_IMU.itemsize:
        return 1
    samples, rest = divmod(size - AROUND_SAMPLES_BYTES, IMU_SAMPLE.itemsize)
    return samples if rest == 0 and 1 <= samples <= MAX_SAMPLES else 0


def sound_imu(payloads: Payloads) -> NDArray[np.bool_]:
    """Which payloads of a size of inertial packets are such, (N,)."""
    if payloads.shape[1] == LEGACY_IMU.itemsize:
        return _sound_legacy(payloads)
    sample = _samples(payloads)
    used = (sample["status"] & 1).astype(np.bool_)
    sound = _sound(sample["t_ns"], sample["accel_m_s2"], sample["gyro_rad_s"])
    return np.asarray(_is_type(payloads, TYPE_IMU) & (sound | ~used).all(axis=1))


def is_known_packet(payloads: Payloads) -> NDArray[np.bool_]:
    """Which payloads of one size are packets of an Ouster other than data, (N,)."""
    if imu_samples_in(payloads.shape[1]):
        return sound_imu(payloads)
    if payloads.shape[1] == ZONE_BYTES:
        return _is_type(payloads, TYPE_ZONES)
    return np.zeros(len(payloads), dtype=np.bool_)


class ImuPackets:
    """Turns the inertial packets of one sensor into samples."""

    def __init__(self, metadata: OusterMetadata, sensor: PacketSensor) -> None:
        """Start with nothing seen.

        Args:
            metadata: How the chip is turned, and the port of its packets.
            sensor: Its report takes the counts.
        """
        self._R_sensor_imu, self._report = metadata.R_sensor_imu, sensor.report
        self._stated_port, self._serial = metadata.imu_port, metadata.serial
        self._port: int | None = None
        self._last_ns = np.iinfo(np.int64).min

    def read(self, datagrams: Datagrams, clock: SensorClock) -> ImuSamples | None:
        """Samples in order; None if there are none.

        The time is that of the gyroscope; the acceleration is interpolated to it.
        Counts ``sample_datagrams``, ``samples_damaged``, ``samples_out_of_order``,
        ``imu_copies`` and ``imu_samples``.
        """
        datagrams = self._own(datagrams)
        parts = [
            self._of_size(datagrams, size, clock)
            for size in distinct(datagrams.length).tolist()
            if imu_samples_in(size)
        ]
        if not parts:
            return None
        t_ns, accel, gyro = (np.concatenate(column) for column in zip(*parts, strict=True))
        newest_ns = np.maximum.accumulate(np.concatenate([[self._last_ns], t_ns[:-1]]))
        later = t_ns > newest_ns
        self._report.count("samples_out_of_order", int((t_ns < newest_ns).sum()))
        self._report.count("imu_copies", int((t_ns == newest_ns).sum()))
        self._report.count("imu_samples", int(later.sum()))
        if not later.any():
            return None
        self._last_ns = int(t_ns[later][-1])
        return ImuSamples(
            t_ns[later],
            gyro[later] @ self._R_sensor_imu.T,
            accel[later] @ self._R_sensor_imu.T,
        )

    def _own(self, datagrams: Datagrams) -> Datagrams:
        """Those to the port that the metadata states, if the first ones go there; else all.

        Several sensors that a relay sends from one address have ports of their own.
        """
        if self._port is None and len(datagrams):
            there = (datagrams.port == self._stated_port).any()
            self._port = self._stated_port if there else 0
        return datagrams.take(datagrams.port == self._port) if self._port else datagrams

    def _of_size(
        self, datagrams: Datagrams, size: int, clock: SensorClock
    ) -> tuple[Times, Array, Array]:
        """Times of the rig [ns], accelerations [m/s²] and rates [rad/s] of packets of one size."""
        rows = np.flatnonzero(datagrams.length == size)
        payloads = datagrams.payloads(rows, size)
        if size != LEGACY_IMU.itemsize and self._serial:
            mine = numbers(_header(payloads)["serial"]) == int(self._serial)
            rows, payloads = (rows[mine], payloads[mine]) if mine.any() else (rows, payloads)
        sound = sound_imu(payloads)
        self._report.count("sample_datagrams", len(payloads))
        self._report.count("samples_damaged", int((~sound).sum()))
        read = _legacy if size == LEGACY_IMU.itemsize else _new
        row, stamp_ns, accel, gyro = read(payloads[sound])
        t_ns, valid = clock.at_ns(datagrams.t_ns[rows[sound]][row], stamp_ns)
        self._report.count("samples_damaged", int((~valid).sum()))
        return t_ns[valid], accel[valid], gyro[valid]


_RawSamples = tuple[NDArray[np.intp], Times, Array, Array]
"""Row of the packet, stamp of the sensor [ns], acceleration [m/s²] and rate [rad/s]."""


def _legacy(payloads: Payloads) -> _RawSamples:
    packets = np.ascontiguousarray(payloads).view(LEGACY_IMU)[:, 0]
    t_ns = packets["gyro_ns"].astype(np.int64)
    accel_m_s2 = STANDARD_GRAVITY_M_S2 * packets["accel_g"].astype(np.float64)
    if len(t_ns) > 1:
        order = np.argsort(packets["accel_ns"], kind="stable")
        start = int(t_ns[0])
        known = packets["accel_ns"].astype(np.int64)[order] - start
        accel_m_s2 = np.column_stack(
            [np.interp(t_ns - start, known, axis[order]) for axis in accel_m_s2.T]
        )
    gyro_rad_s = np.deg2rad(packets["gyro_deg_s"].astype(np.float64))
    return np.arange(len(t_ns)), t_ns, accel_m_s2, gyro_rad_s


def _new(payloads: Payloads) -> _RawSamples:
    sample = _samples(payloads)
    used = (sample["status"] & 1).astype(np.bool_)
    return (
        np.nonzero(used)[0],
        sample["t_ns"][used].astype(np.int64),
        sample["accel_m_s2"][used].astype(np.float64),
        sample["gyro_rad_s"][used].astype(np.float64),
    )


def _samples(payloads: Payloads) -> NDArray[np.void]:
    """The samples in packets of the new profile, (N, K)."""
    inner = payloads[:, HEADER_BYTES + NMEA_BYTES : -HEADER_BYTES]
    return np.ascontiguousarray(inner).view(IMU_SAMPLE)


def _sound_legacy(payloads: Payloads) -> NDArray[np.bool_]:
    packets = np.ascontiguousarray(payloads).view(LEGACY_IMU)[:, 0]
    gyro_ns = packets["gyro_ns"].astype(np.int64)
    near = [
        np.abs(packets[name].astype(np.int64) // 2 - gyro_ns // 2) < OUSTER_IMU.apart_ns
        for name in ("sent_ns", "accel_ns")
    ]
    with np.errstate(invalid="ignore"):  # bytes that are no numbers
        accel = STANDARD_GRAVITY_M_S2 * packets["accel_g"].astype(np.float64)
        gyro = np.deg2rad(packets["gyro_deg_s"].astype(np.float64))
    values = _sound(packets["gyro_ns"], accel, gyro)
    return np.asarray(near[0] & near[1] & values)


def _sound(t_ns: NDArray[np.uint64], accel_m_s2: Array, gyro_rad_s: Array) -> NDArray[np.bool_]:
    """Which samples can have been measured, (...)."""
    with np.errstate(invalid="ignore"):
        moved = np.abs(accel_m_s2) < OUSTER_IMU.max_accel_m_s2
        moved &= np.abs(gyro_rad_s) < OUSTER_IMU.max_gyro_rad_s
    return np.asarray((t_ns > 0) & (t_ns < LIMITS.latest_ns) & moved.all(axis=-1))


def _is_type(payloads: Payloads, kind: int) -> NDArray[np.bool_]:
    return np.asarray(_header(payloads)["type"] == kind)


def _header(payloads: Payloads) -> NDArray[np.void]:
    return np.ascontiguousarray(payloads[:, :HEADER_BYTES]).view(STANDARD_HEADER)[:, 0]
