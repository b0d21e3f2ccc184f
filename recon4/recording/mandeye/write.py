"""Writes any recording of LiDARs as a folder of a MANDEYE device, which HDMapping reads."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path

import laspy
import numpy as np

from recon4.errors import ConfigError
from recon4.model.rig import Rig
from recon4.model.samples import ImuSamples
from recon4.model.trajectory import Times
from recon4.recording.assembly.shots import Shots
from recon4.recording.mandeye.tuning import MANDEYE
from recon4.store.atomic import write_json, write_text
from recon4.units import STANDARD_GRAVITY_M_S2

_HEAD = "timestamp gyroX gyroY gyroZ accX accY accZ imuId timestampUnix"


@dataclass(slots=True)
class _WaitingPart:
    """What has come for a part."""

    shots: list[Shots] = field(default_factory=list)
    imu: list[ImuSamples] = field(default_factory=list)


class MandeyeWriter:
    """Writes parts as their points come; call `close` at the end."""

    def __init__(self, folder: Path, rig: Rig) -> None:
        """Prepare.

        Args:
            folder: An empty folder.
            rig: The LiDARs; their rows are the numbers in the files.
        """
        self._folder, self._rig = folder, rig
        self._parts: dict[int, _WaitingPart] = {}
        self._start_ns: int | None = None
        self._written = 0
        self.points = self.samples = 0
        """Written so far."""

    def push(self, item: Shots | ImuSamples) -> None:
        """Add points of one LiDAR, or samples of the IMU.

        Raises:
            ConfigError: If coordinates are beyond those of the format.
            StoreError: If a file cannot be written.
        """
        if not len(item.t_ns):
            return
        newest_ns = int(item.t_ns.max())
        if self._start_ns is None:
            self._start_ns = int(item.t_ns.min())
        part_ns = round(MANDEYE.part_s * 1e9)
        numbers = np.maximum((item.t_ns - self._start_ns) // part_ns, self._written)
        for number in np.unique(numbers).tolist():
            part = self._parts.setdefault(number, _WaitingPart())
            if isinstance(item, Shots):
                part.shots.append(_rows_of_shots(item, numbers == number))
            else:
                part.imu.append(_rows_of_imu(item, numbers == number))
        done = (newest_ns - self._start_ns - round(MANDEYE.wait_s * 1e9)) // part_ns
        if isinstance(item, Shots):
            self._write(done)

    def close(self) -> None:
        """Write the rest.

        Raises:
            ConfigError, StoreError: As `push`.
        """
        self._write(max(self._parts, default=-1) + 1)

    def _write(self, end: int) -> None:
        """The parts before one."""
        for number in sorted(k for k in self._parts if k < end):
            part = self._parts.pop(number)
            if part.shots:
                self._write_part(number, part)
        self._written = max(self._written, end)

    def _write_part(self, number: int, part: _WaitingPart) -> None:
        name = f"lidar{number:04d}"
        path = self._folder / f"{name}.laz"
        points = _write_points(path, part.shots)
        serials = "".join(
            f"{row} {sensor.serial or sensor.name.replace(' ', '_')}\n"
            for row, sensor in enumerate(self._rig.sensors)
        )
        write_text(self._folder / f"{name}.sn", serials)
        holder = [s.name for s in self._rig.sensors].index(self._rig.imu_sensor or self._first)
        text, samples = _imu_text(part.imu, holder)
        write_text(self._folder / f"imu{number:04d}.csv", text)
        status = {"name": "recon4", "state": "SCANNING", "lidar": {"points_count": points}}
        write_json(self._folder / f"status{number:04d}.json", status)
        self.points += points
        self.samples += samples

    @property
    def _first(self) -> str:
        return self._rig.sensors[0].name


def _write_points(path: Path, shots: Sequence[Shots]) -> int:
    t_ns = np.concatenate([one.t_ns for one in shots])
    order = np.argsort(t_ns, kind="stable")
    xyz = np.concatenate([one.xyz for one in shots])[order].astype(np.float64)
    if len(xyz) and np.abs(xyz).max() > np.iinfo(np.int32).max * MANDEYE.scale_m:
        raise ConfigError(
            f"{path.name}: expected points within {np.iinfo(np.int32).max * MANDEYE.scale_m:.0f} "
            f"m, got {np.abs(xyz).max():.4g} m"
        )
    header = laspy.LasHeader(version="1.2", point_format=1)
    header.scales, header.offsets = np.full(3, MANDEYE.scale_m), np.zeros(3)
    header.generating_software = "recon4"
    header.global_encoding.gps_time_type = laspy.header.GpsTimeType.STANDARD
    points = laspy.ScaleAwarePointRecord.zeros(len(xyz), header=header)
    points.x, points.y, points.z = xyz.T
    points.intensity = np.concatenate([one.intensity for one in shots])[order]
    seconds, rest_ns = np.divmod(t_ns[order], 1_000_000_000)
    points.gps_time = seconds + rest_ns * 1e-9
    points.user_data = np.concatenate([np.full(len(s), s.sensor, np.uint8) for s in shots])[order]
    points.return_number = np.ones(len(xyz), np.uint8)
    points.number_of_returns = np.ones(len(xyz), np.uint8)
    with laspy.open(path, mode="w", header=header, laz_backend=laspy.LazBackend.Lazrs) as file:
        file.write_points(points)
    return len(xyz)


def _imu_text(parts: Sequence[ImuSamples], holder: int) -> tuple[str, int]:
    """The lines of the samples in the order of their times, and their number."""
    lines = [_HEAD]
    if parts:
        t_ns = np.concatenate([one.t_ns for one in parts])
        rows = np.concatenate(
            [
                np.column_stack([one.gyro_rad_s, one.accel_m_s2 / STANDARD_GRAVITY_M_S2])
                for one in parts
            ]
        )
        for k in np.argsort(t_ns, kind="stable").tolist():
            numbers = " ".join(f"{value:.9g}" for value in rows[k].tolist())
            lines.append(f"{t_ns[k]} {numbers} {holder} {t_ns[k]}")
    return "\n".join([*lines, ""]), len(lines) - 1


def _rows_of_shots(shots: Shots, rows: np.ndarray[tuple[int], np.dtype[np.bool_]]) -> Shots:
    return Shots(
        shots.sensor,
        shots.t_ns[rows],
        shots.xyz[rows],
        shots.intensity[rows],
        shots.ring[rows],
        shots.echo[rows],
    )


def _rows_of_imu(imu: ImuSamples, rows: np.ndarray[tuple[int], np.dtype[np.bool_]]) -> ImuSamples:
    times: Times = imu.t_ns[rows]
    return ImuSamples(times, imu.gyro_rad_s[rows], imu.accel_m_s2[rows])
