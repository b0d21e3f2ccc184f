"""Writes any recording of LiDARs as a folder of a MANDEYE device, which HDMapping reads."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import laspy
import numpy as np

from recon4.errors import ConfigError
from recon4.locales.coded import CodedText
from recon4.model.rig import Rig
from recon4.model.samples import ImuSamples
from recon4.recording.assembly.shots import Shots
from recon4.recording.mandeye.tuning import MANDEYE
from recon4.store.atomic import write_json, write_text
from recon4.units import STANDARD_GRAVITY_M_S2

_HEAD = "timestamp gyroX gyroY gyroZ accX accY accZ imuId timestampUnix"


class MandeyeWriter:
    """Writes parts as their points come, and the samples of the IMU at the end, by `close`."""

    def __init__(self, folder: Path, rig: Rig) -> None:
        """Prepare.

        Args:
            folder: An empty folder.
            rig: The LiDARs; their rows are the numbers in the files.
        """
        self._folder, self._rig = folder, rig
        self._parts: dict[int, list[Shots]] = {}
        self._numbers: list[int] = []
        """Of the parts that were written."""
        self._start_ns: int | None = None
        self._written = 0
        self.points = self.samples = 0
        """Written so far."""

    def push(self, shots: Shots) -> None:
        """Add points of one LiDAR.

        Raises:
            ConfigError: If coordinates are beyond those of the format.
            StoreError: If a file cannot be written.
        """
        if not len(shots):
            return
        newest_ns = int(shots.t_ns.max())
        if self._start_ns is None:
            self._start_ns = int(shots.t_ns.min())
        part_ns = round(MANDEYE.part_s * 1e9)
        numbers = np.maximum((shots.t_ns - self._start_ns) // part_ns, self._written)
        for number in np.unique(numbers).tolist():
            rows = _rows_of_shots(shots, numbers == number)
            self._parts.setdefault(number, []).append(rows)
        self._write((newest_ns - self._start_ns - round(MANDEYE.wait_s * 1e9)) // part_ns)

    def close(self, imu: ImuSamples | None) -> None:
        """Write the rest, and the samples of the IMU to the parts of their times.

        Args:
            imu: On the clock of the points, in order of time; None = there are none.

        Raises:
            ConfigError, StoreError: As `push`.
        """
        self._write(max(self._parts, default=-1) + 1)
        if not self._numbers:
            return
        holder = [s.name for s in self._rig.sensors].index(self._rig.imu_sensor or self._first)
        part_ns = round(MANDEYE.part_s * 1e9)
        starts = [(self._start_ns or 0) + number * part_ns for number in self._numbers]
        t_ns = imu.t_ns if imu is not None else np.zeros(0, np.int64)
        ends = [0, *np.searchsorted(t_ns, starts[1:]).tolist(), len(t_ns)]
        for number, first, last in zip(self._numbers, ends[:-1], ends[1:], strict=True):
            text, samples = _imu_text(imu, range(first, last), holder)
            write_text(self._folder / f"imu{number:04d}.csv", text)
            self.samples += samples

    def _write(self, end: int) -> None:
        """The parts before one."""
        for number in sorted(k for k in self._parts if k < end):
            self._write_part(number, self._parts.pop(number))
        self._written = max(self._written, end)

    def _write_part(self, number: int, shots: Sequence[Shots]) -> None:
        name = f"lidar{number:04d}"
        path = self._folder / f"{name}.laz"
        points = _write_points(path, shots)
        self._numbers.append(number)
        sensors = self._rig.sensors
        serials = [sensor.serial or sensor.name.replace(" ", "_") for sensor in sensors]
        text = "".join(f"{row} {serial}\n" for row, serial in enumerate(serials))
        write_text(self._folder / f"{name}.sn", text)
        lidars = [
            {"sn": serial, "lidar_ip": sensor.address, "model": sensor.model}
            for serial, sensor in zip(serials, sensors, strict=True)
        ]
        state = {"points_count": points, "multi": {"LivoxLidarInfo": lidars}}
        status = {"name": "recon4", "state": "SCANNING", "lidar": state}
        write_json(self._folder / f"status{number:04d}.json", status)
        self.points += points

    @property
    def _first(self) -> str:
        return self._rig.sensors[0].name


def _write_points(path: Path, shots: Sequence[Shots]) -> int:
    t_ns = np.concatenate([one.t_ns for one in shots])
    order = np.argsort(t_ns, kind="stable")
    xyz = np.concatenate([one.xyz for one in shots])[order].astype(np.float64)
    if len(xyz) and np.abs(xyz).max() > np.iinfo(np.int32).max * MANDEYE.scale_m:
        raise ConfigError(
            CodedText(
                "convert-far",
                file=path.name,
                limit_m=np.iinfo(np.int32).max * MANDEYE.scale_m,
                farthest_m=float(np.abs(xyz).max()),
            )
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


def _imu_text(imu: ImuSamples | None, rows: range, holder: int) -> tuple[str, int]:
    """The lines of some samples, and their number."""
    lines = [_HEAD]
    if imu is None:
        return f"{_HEAD}\n", 0
    for k in rows:
        values = [*imu.gyro_rad_s[k], *(imu.accel_m_s2[k] / STANDARD_GRAVITY_M_S2)]
        numbers = " ".join(f"{value:.9g}" for value in values)
        lines.append(f"{imu.t_ns[k]} {numbers} {holder} {imu.t_ns[k]}")
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
