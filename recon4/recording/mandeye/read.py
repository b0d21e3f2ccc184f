"""A folder of a MANDEYE device as a recording: points and IMU samples, one file after the other."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np
from numpy.typing import NDArray

from recon4.errors import CorruptFile, EmptyRecording
from recon4.locales.coded import CodedText
from recon4.model.derived_kinds import DerivedKind
from recon4.model.finding_kinds import FindingKind
from recon4.model.lidars import lidar_model
from recon4.model.rig import Rig
from recon4.model.samples import GnssSamples, ImuSamples
from recon4.model.trajectory import Times
from recon4.recording.assembly.assembler import moved
from recon4.recording.assembly.shots import Shots
from recon4.recording.clouds.cloud_points import model_of_points, rings_by_elevation, say_rings
from recon4.recording.formats.las_records import las_points
from recon4.recording.mandeye.folder import MandeyeWalk, WalkPart, times_ns
from recon4.recording.mandeye.gnss import read_positions
from recon4.recording.mandeye.imu import read_imu
from recon4.recording.mandeye.tuning import MANDEYE
from recon4.recording.packets.livox.recognition import livox_of_points
from recon4.recording.report import ImportReport
from recon4.recording.rigs.choice import Stream

_LINES = {"around": 4, "ahead": 6}
"""Lasers of a Mid-360, which sees all around, and of Avia and Horizon, which look ahead."""


def walk_streams(walk: MandeyeWalk) -> list[Stream]:
    """The LiDARs of a walk, each with the model that the device states, or that of its view."""
    streams = []
    for lidar in walk.ids:
        serial = walk.serials.get(lidar, "")
        model = walk.status.model_of(serial) or _model(walk, lidar)
        streams.append(Stream(f"LiDAR {lidar}", model, serial=serial))
    return streams


def _model(walk: MandeyeWalk, lidar: int) -> str:
    """The model by the view; a Livox is what these devices carry first."""
    for part in walk.parts:
        if lidar not in part.ids:
            continue
        for points in las_points(part.path):
            xyz = _xyz(points)[np.asarray(points.user_data) == lidar]
            xyz = xyz[np.isfinite(xyz).all(axis=1) & xyz.any(axis=1)]
            return _model_of(xyz) if len(xyz) >= MANDEYE.fewest_points else "generic"
    return "generic"


def _model_of(xyz: NDArray[np.float32]) -> str:
    spinning = model_of_points(dict(zip("xyz", xyz.T, strict=True)))
    if spinning != "generic":
        return spinning
    azimuth = np.sort(np.arctan2(xyz[:, 1], xyz[:, 0]))
    widest_gap = float(np.diff(azimuth, append=azimuth[0] + 2.0 * np.pi).max())
    around = 2.0 * np.pi - widest_gap > np.deg2rad(MANDEYE.around_deg)
    return livox_of_points(xyz, _LINES["around" if around else "ahead"])


def assigned(rig: Rig, walk: MandeyeWalk, report: ImportReport) -> dict[int, int]:
    """LiDAR of the walk -> row of the rig: by serial number, then in their order.

    Raises:
        EmptyRecording: If no LiDAR of the walk is in the rig.
    """
    rows = [k for k, sensor in enumerate(rig.sensors) if sensor.kind == "lidar"]
    by_serial = {serial: lidar for lidar, serial in walk.serials.items()}
    found = {
        by_serial[rig.sensors[k].serial]: k for k in rows if rig.sensors[k].serial in by_serial
    }
    left = [k for k in rows if k not in found.values() and not rig.sensors[k].serial]
    for lidar, k in zip([one for one in walk.ids if one not in found], left, strict=False):
        found[lidar] = k
        if len(rows) > 1:
            report.derive(DerivedKind.SENSOR_NUMBER, sensor=rig.sensors[k].name, number=lidar)
    if not found:
        there = ", ".join(f"{k} ({walk.serials.get(k, '–')})" for k in walk.ids)
        raise EmptyRecording(
            CodedText("mandeye-no-lidar", folder=walk.folder.name, rig=rig.name, there=there)
        )
    return found


class MandeyeRecording:
    """Streams the points and IMU samples of a walk."""

    def __init__(self, walk: MandeyeWalk, rig: Rig, report: ImportReport) -> None:
        """Prepare.

        Args:
            walk: The parts.
            rig: Its LiDARs, by serial number or in their order.
            report: Receives counts.

        Raises:
            EmptyRecording: If no LiDAR of the walk is in the rig.
        """
        self._walk, self._rig, self._report = walk, rig, report
        self._rows = assigned(rig, walk, report)
        self._imu_of = self._imu_lidar()
        self._imu_is_free = not rig.imu_sensor
        """Whether the first samples may choose: an IMU of its own has a number of its own."""

    def _imu_lidar(self) -> int:
        """The LiDAR whose IMU is read: the one that the rig names, else the first one."""
        by_name = {self._rig.sensors[k].name: lidar for lidar, k in self._rows.items()}
        return by_name.get(self._rig.imu_sensor, min(self._rows))

    def read(self) -> Iterator[Shots | ImuSamples | GnssSamples]:
        """Positions, then one part after the other; a damaged file is left out and counted."""
        for path in self._walk.positions:
            self._report.derive(DerivedKind.POSITIONS_BY_ARRIVAL, by_device=True)
            try:
                fixes = read_positions(path, self._report)
            except CorruptFile as error:
                self._left_out(error)
                continue
            if len(fixes):
                yield fixes
        for part in self._walk.parts:
            self._report.count("files")
            try:
                if part.imu is not None:
                    yield from self._imu(part)
            except CorruptFile as error:
                self._left_out(error)
            try:
                yield from self._shots(part)
            except CorruptFile as error:
                self._left_out(error)

    def _left_out(self, error: CorruptFile) -> None:
        self._report.count("files_corrupt")
        self._report.outcome = "lossy"
        self._report.warn(FindingKind.FILE_LEFT_OUT, error=error)

    def _imu(self, part: WalkPart) -> Iterator[ImuSamples]:
        assert part.imu is not None
        rows = read_imu(part.imu, self._report)
        if rows.ids and self._imu_of not in rows.ids and self._imu_is_free:
            self._imu_of = min(rows.ids)
            self._report.derive(DerivedKind.IMU_CHOSEN, number=self._imu_of)
        self._imu_is_free &= not rows.ids
        samples = rows.of(self._imu_of)
        self._report.count("imu_samples_not_read", len(rows.samples.t_ns) - len(samples.t_ns))
        if len(samples.t_ns):
            yield samples

    def _shots(self, part: WalkPart) -> Iterator[Shots]:
        for points in las_points(part.path):
            t_ns, lidar = times_ns(points), np.asarray(points.user_data)
            timed = t_ns > 0
            self._report.count("points_without_time", len(t_ns) - int(timed.sum()))
            known = np.isin(lidar, list(self._rows))
            self._report.count("points_of_lidars_not_in_rig", int((~known & timed).sum()))
            xyz, intensity = _xyz(points), np.asarray(points.intensity, np.uint16)
            for one, row in self._rows.items():
                rows = np.flatnonzero(timed & (lidar == one))
                rows = rows[np.argsort(t_ns[rows], kind="stable")]
                if len(rows):
                    yield self._shots_of(row, t_ns[rows], xyz=xyz[rows], intensity=intensity[rows])

    def _shots_of(
        self,
        row: int,
        t_ns: Times,
        *,
        xyz: NDArray[np.float32],
        intensity: NDArray[np.uint16],
    ) -> Shots:
        sensor = self._rig.sensors[row]
        self._report.count("points", len(xyz))
        ring = np.zeros(len(xyz), np.uint8)
        if lidar_model(sensor.model).has_rings:
            elevation = np.arctan2(xyz[:, 2], np.hypot(xyz[:, 0], xyz[:, 1]))
            ring, bands = rings_by_elevation(sensor.model, elevation)
            say_rings(self._report, sensor.name, bands, in_files=True)
        shots = Shots(row, t_ns, xyz, intensity, ring, np.zeros(len(xyz), np.uint8))
        return moved(shots, round(sensor.time_offset_s * 1e9))


def _xyz(points: Any) -> NDArray[np.float32]:
    return np.column_stack([points.x, points.y, points.z]).astype(np.float32)
