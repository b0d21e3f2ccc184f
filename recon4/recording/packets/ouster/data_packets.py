"""Ouster data packets to points."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from recon4.kernels import ouster as kernel
from recon4.model.finding_kinds import FindingKind
from recon4.model.trajectory import Times
from recon4.recording.assembly.shots import Shots
from recon4.recording.formats.datagrams import Datagrams
from recon4.recording.packets.family import PacketSamples, PacketSensor, Payloads
from recon4.recording.packets.ouster.columns import (
    column_step_ns,
    columns_in_turn,
    columns_of,
    wrong_numbers,
    wrong_times,
    wrong_type,
)
from recon4.recording.packets.ouster.imu_packets import SAMPLE_SIZES, ImuPackets
from recon4.recording.packets.ouster.layouts import CHECKSUM_BYTES, WORD, PacketLayout
from recon4.recording.packets.ouster.metadata import OusterMetadata
from recon4.recording.packets.ouster.metadata_choice import serials, sound_head, usual_serial
from recon4.recording.packets.ouster.tuning import OUSTER_COLUMNS
from recon4.recording.packets.sensor_clock import SensorClock
from recon4.recording.packets.tuning import HEAD

_WITHOUT_COLUMNS = "packets_without_columns"


@dataclass(frozen=True, slots=True)
class Turning:
    """How a sensor turns."""

    columns: int
    """Columns in a revolution; 0 = not known."""
    column_s: float
    """From one column to the next [s]."""

    @property
    def rotation_hz(self) -> float:
        """Revolutions a second."""
        return 1.0 / (self.columns * self.column_s) if self.columns else float("nan")


def turning_of(metadata: OusterMetadata, head: Datagrams) -> Turning:
    """How a sensor turns, by its first packets, else by its metadata."""
    columns = columns_of(metadata.layout, sound_head(head, metadata.layout))
    number = columns_in_turn(columns) or metadata.columns_per_turn
    step_s = 1e-9 * column_step_ns(columns)
    if not step_s > 0:
        hz = metadata.rotation_hz if metadata.rotation_hz > 0 else OUSTER_COLUMNS.usual_hz
        step_s = 1.0 / (hz * max(number, 1))
    return Turning(number, step_s)


class OusterPackets:
    """The data packets of one sensor, and its inertial samples.

    Points are in the *sensor frame* of the maker: origin in the middle of the base, x forward (away
    from the connector), y left, z up. Its drivers call it ``os_sensor``.
    """

    stamps_past_hour = False

    def __init__(self, sensor: PacketSensor, metadata: OusterMetadata, turning: Turning) -> None:
        """Prepare the tables.

        Args:
            sensor: Whose packets they are.
            metadata: Of the very sensor.
            turning: Its columns in a revolution are known.
        """
        assert turning.columns > 0
        self.size = metadata.layout.size
        self.sample_sizes = SAMPLE_SIZES - {self.size}
        self.packet_s = metadata.layout.columns * turning.column_s
        self._layout, self._turn = metadata.layout, turning.columns
        self._sensor, self._metadata = sensor.without_head(), metadata
        self._report = sensor.report
        self._tables = _tables(metadata, turning.columns)
        self._imu = ImuPackets(metadata, sensor)
        self._serial: int | None = None
        self._checks = False
        self._judge(sound_head(sensor.head, metadata.layout))

    def sound(self, payloads: Payloads) -> NDArray[np.bool_]:
        """Which payloads are data packets of this sensor, (N,).

        Counts ``packets`` and those that are dropped: ``packets_wrong_header``,
        ``packets_of_another_sensor``, ``packets_wrong_crc``, ``packets_wrong_columns`` (do not
        follow each other, or are beyond a revolution), ``packets_wrong_stamp``, and
        ``packets_without_columns``, whose columns are all marked as not measured.
        """
        if self._serial is None:
            self._judge(payloads[~wrong_type(self._layout, payloads)])
        columns = columns_of(self._layout, payloads)
        foreign = wrong_type(self._layout, payloads)
        other = self._is_other(payloads) & ~foreign
        faults = {
            "packets_wrong_header": foreign,
            "packets_of_another_sensor": other,
            "packets_wrong_crc": self._is_damaged(payloads),
            "packets_wrong_columns": wrong_numbers(columns, self._turn),
            "packets_wrong_stamp": wrong_times(columns),
            _WITHOUT_COLUMNS: ~columns.valid.any(axis=1),
        }
        self._report.count("packets", int((~other).sum()))
        sound = np.ones(len(payloads), dtype=np.bool_)
        for name, fault in faults.items():
            self._report.count(name, int((sound & fault).sum()))
            sound &= ~fault
        return sound

    def stamps_ns(self, payloads: Payloads) -> Times:
        """Time of the first valid column of each packet on the clock of the sensor [ns], (N,)."""
        columns = columns_of(self._layout, payloads)
        return columns.at_first(columns.stamp_ns)

    def azimuth_cdeg(self, payloads: Payloads) -> NDArray[np.int64]:
        """Direction of the first valid column, clockwise from x of the sensor [0.01°], (N,)."""
        columns = columns_of(self._layout, payloads)
        turned = 36000 * columns.at_first(columns.number) // self._turn
        R_sensor_lidar = self._metadata.T_sensor_lidar[:3, :3]
        yaw_deg = np.rad2deg(np.arctan2(R_sensor_lidar[1, 0], R_sensor_lidar[0, 0]))
        return np.asarray((turned - round(100 * yaw_deg)) % 36000)

    def decode(self, t_ns: Times, payloads: Payloads) -> Shots:
        """Points of sound packets; all beams of a column are fired at once.

        Counts ``points``, ``points_no_return``, ``points_near`` and ``points_far``.

        Args:
            t_ns: Time of the first valid column of each packet on the clock of the rig [ns], (P,).
            payloads: The packets, (P, size).
        """
        columns = columns_of(self._layout, payloads)
        rows = np.where(columns.valid, columns.number, -1)
        assert payloads.shape[1] == self.size
        assert rows.max(initial=-1) < self._turn
        turns, beams = self._tables
        words = np.ascontiguousarray(payloads).view("<u4")
        found = kernel.decode(
            words,
            (t_ns[:, None] + columns.since_ns, rows, self._layout.pixels_at // WORD),
            *_pixel_arguments(self._layout),
            self._limits(),
            turns,
            beams,
        )
        shots = Shots(self._sensor.row, *found[:5])
        names = ("points_no_return", "points_near", "points_far")
        for name, count in zip(names, found[5].tolist(), strict=True):
            self._report.count(name, count)
        self._report.count("points", len(shots))
        return shots

    def likely_models(self, usual_s: float) -> tuple[str, ...]:
        """The interval of packets depends on the mode, not on the model."""
        return ()

    def samples(self, datagrams: Datagrams, clock: SensorClock) -> PacketSamples | None:
        """Inertial samples in the frame of the points; None if there are none."""
        imu = self._imu.read(datagrams, clock)
        return PacketSamples(imu=imu) if imu is not None else None

    def _judge(self, payloads: Payloads) -> None:
        """Find out by the first packets whose they are, and whether checksums are sent."""
        if not len(payloads) or not self._layout.profile.has_header:
            return
        payloads = payloads[: HEAD.packets]
        wanted = self._sensor.sensor.serial
        sent = serials(self._layout, payloads)
        named = wanted.isdigit() and (sent == int(wanted)).any()
        self._serial = int(wanted if named else usual_serial(self._layout, payloads) or 0)
        others = sorted(set(sent.tolist()) - {self._serial})
        if others:
            self._report.warn(
                FindingKind.PACKETS_MIXED,
                sensor=self._sensor.sensor.name,
                others=", ".join(map(str, others[:4])),
                read=str(self._serial),
            )
        self._checks = 2 * int(self._checksum_fits(payloads).sum()) > len(payloads)

    def _is_other(self, payloads: Payloads) -> NDArray[np.bool_]:
        if not self._serial:
            return np.zeros(len(payloads), dtype=np.bool_)
        return serials(self._layout, payloads) != self._serial

    def _is_damaged(self, payloads: Payloads) -> NDArray[np.bool_]:
        if not self._checks:
            return np.zeros(len(payloads), dtype=np.bool_)
        return ~self._checksum_fits(payloads)

    def _checksum_fits(self, payloads: Payloads) -> NDArray[np.bool_]:
        stated = self._layout.records(payloads)["crc"]
        return np.asarray(checksums(payloads) == stated)

    def _limits(self) -> tuple[int, int]:
        """Smallest and largest range that is kept [units]."""
        settings, unit_m = self._sensor.settings, 1e-3 * self._layout.profile.unit_mm
        limits = np.array([settings.min_range_m, settings.max_range_m]) / unit_m
        return int(np.ceil(limits[0] - 1e-6)), int(np.floor(min(limits[1] + 1e-6, 1e9)))


def checksums(payloads: Payloads) -> NDArray[np.uint64]:
    """CRC-64 of all but the last 8 bytes of each row, where firmware 3.1 and later has it, (N,)."""
    size = payloads.shape[1] - CHECKSUM_BYTES
    if payloads.shape[1] % 8 == 0:
        words = np.ascontiguousarray(payloads).view("<u8")[:, :-1]
    else:
        words = np.ascontiguousarray(payloads[:, : size // 8 * 8]).view("<u8")
    rest = np.ascontiguousarray(payloads[:, size // 8 * 8 : size])
    return kernel.checksums(words, rest, kernel.CHECKSUM_TABLES)


def _pixel_arguments(
    layout: PacketLayout,
) -> tuple[tuple[kernel.EchoWords, ...], tuple[int, bool, np.float32]]:
    """Arguments ``layout`` and ``pixel`` of the kernel."""
    profile = layout.profile
    echoes = []
    for echo in profile.echoes:
        assert echo.range_at % WORD == 0 and echo.range_bits < 31
        assert echo.intensity_at % WORD + echo.intensity_bytes <= WORD
        echoes.append(
            kernel.EchoWords(
                range_word=echo.range_at // WORD,
                range_mask=(1 << echo.range_bits) - 1,
                intensity_word=echo.intensity_at // WORD,
                intensity_shift=8 * (echo.intensity_at % WORD),
                intensity_mask=(1 << 8 * echo.intensity_bytes) - 1,
            )
        )
    unit_m = np.float32(1e-3 * profile.unit_mm)
    return tuple(echoes), (profile.pixel_bytes // WORD, profile.has_signal, unit_m)


def _tables(
    metadata: OusterMetadata, columns: int
) -> tuple[NDArray[np.float32], tuple[NDArray[np.float32], NDArray[np.uint8]]]:
    """Arguments ``turns`` and ``beams`` of the kernel.

    Firmware User Manual 3.1, Lidar Range to XYZ, with n the distance from the axis to where the
    beams leave: a range counts from the axis, so that a point lies at ``range - n`` from there.
    """
    encoder = -2.0 * np.pi / columns * np.arange(columns)
    cos, sin = np.cos(encoder), np.sin(encoder)
    R_lidar_turn = np.zeros((columns, 3, 3))
    R_lidar_turn[:, 0, 0] = R_lidar_turn[:, 1, 1] = cos
    R_lidar_turn[:, 1, 0], R_lidar_turn[:, 0, 1] = sin, -sin
    R_lidar_turn[:, 2, 2] = 1.0
    turns = np.empty((columns, 3, 4))
    turns[:, :, :3] = metadata.T_sensor_lidar[:3, :3] @ R_lidar_turn
    turns[:, :, 3] = metadata.T_sensor_lidar[:3, 3]
    elevation, azimuth = metadata.elevation_rad, -metadata.azimuth_rad
    direction = np.column_stack(
        [
            np.cos(elevation) * np.cos(azimuth),
            np.cos(elevation) * np.sin(azimuth),
            np.sin(elevation),
        ]
    )
    x_m, z_m = metadata.p_lidar_beam_m.tolist()
    origin = np.array([x_m, 0.0, z_m]) - np.hypot(x_m, z_m) * direction
    beams = np.ascontiguousarray(np.column_stack([origin, direction]).T, dtype=np.float32)
    return turns.astype(np.float32), (beams, ring_of_beams(metadata))


def ring_of_beams(metadata: OusterMetadata) -> NDArray[np.uint8]:
    """Ring of each beam, 0 = lowest; the silent beams of an OS1-16 share one, (B,)."""
    angles = np.column_stack([metadata.elevation_rad, metadata.azimuth_rad])
    return np.unique(angles, axis=0, return_inverse=True)[1].reshape(-1).astype(np.uint8)
