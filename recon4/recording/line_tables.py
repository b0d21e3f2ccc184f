"""Line scans and scans of a 2-D laser as tables: one row a shot, CSV or NPZ."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import chain, islice
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from recon4.errors import ConfigError, EmptyRecording, UnknownFormat
from recon4.geometry.se3 import Array
from recon4.model.laser_scans import LaserScans
from recon4.model.rig import Rig
from recon4.recording.assembly.shots import Shots
from recon4.recording.formats.columns import TIME, Columns, column_names, read_columns
from recon4.recording.head_angles import HeadAngles
from recon4.recording.line_recording import LineAssembly, LineItem
from recon4.recording.range_units import LaserUnit
from recon4.recording.report import ImportReport
from recon4.recording.samples.csv_files import read_imu_csv
from recon4.recording.sweeps import sweeps

LINE_COLUMNS = (TIME, "shot_deg", "range_m")
_LINE_OPTIONAL = ("head_deg", "intensity", "line")
LASER_COLUMNS = (TIME, "beam_deg", "range_m")
_LASER_OPTIONAL = ("scan", "x_m", "y_m", "yaw_deg")
_SUFFIXES = (".npz", ".csv")
_LONGEST_M, _SHORTEST_M = 1e4, 1e-3
_HEAD_STEP_NS = 5_000_000
_SCANS_AT_ONCE = 250
_LAYOUT_SCANS = 50
"""Scans from which the angles of the beams are found."""
_MAX_BEAMS = 100_000
_OFF_GRID = 0.3
"""Part of the angle between two beams by which one may be off its place."""
_USUAL_REACH_M = 30.0


def is_line_table(path: Path) -> bool:
    """Whether a file has the columns of line scans."""
    return set(LINE_COLUMNS) <= column_names(path)


def is_laser_table(path: Path) -> bool:
    """Whether a file has the columns of a 2-D laser."""
    return set(LASER_COLUMNS) <= column_names(path)


def table_in(folder: Path, name: str) -> Path | None:
    """``name.npz`` or ``name.csv`` of a folder."""
    return next((p for s in _SUFFIXES if (p := folder / f"{name}{s}").is_file()), None)


@dataclass(frozen=True, slots=True)
class LineTables:
    """Files of a walk with a profiler."""

    lines: Path
    laser2d: Path | None = None
    imu: Path | None = None

    @staticmethod
    def of(paths: Sequence[Path]) -> LineTables:
        """Those of a folder, or of several files.

        Raises:
            UnknownFormat: If there is no table of lines, or more than one.
        """
        if len(paths) == 1 and paths[0].is_dir():
            folder = paths[0]
            imu = folder / "imu.csv"
            found = [p for name in ("lines", "laser2d") if (p := table_in(folder, name))]
            paths = found + ([imu] if imu.is_file() else [])
        lines = [path for path in paths if is_line_table(path)]
        scans = [path for path in paths if is_laser_table(path)]
        if len(lines) != 1 or len(scans) > 1:
            raise UnknownFormat(
                f"expected one table of line scans and at most one of a 2-D laser, got "
                f"{len(lines)} and {len(scans)}"
            )
        rest = [path for path in paths if path not in (*lines, *scans)]
        return LineTables(lines[0], scans[0] if scans else None, rest[0] if rest else None)


class LineTableRecording:
    """Streams tables as `recon4.recording.line_recording.LineRecording` streams bags."""

    def __init__(self, tables: LineTables, rig: Rig | None, *, report: ImportReport) -> None:
        """Check the rig.

        Raises:
            ConfigError: If the rig is missing or has no profiler, or the angles of the head are
                missing.
        """
        name = tables.lines.name
        row = None if rig is None else rig.row_of("profiler")
        if rig is None or row is None:
            raise ConfigError(
                f"{name}: line scans need a rig file with a sensor of kind profiler (--rig): "
                "tables do not say where the sensors are mounted"
            )
        sensor = rig.sensors[row]
        if "head_deg" not in column_names(tables.lines) and not sensor.head_rate_rad_s:
            raise ConfigError(
                f"{sensor.name}: the angles of its head are missing: expected a column head_deg in "
                f"{name}; with a head of constant rate, head_rate_deg_s in the rig file"
            )
        if rig.row_of("laser2d") is None:
            report.warn("the rig has no 2-D laser: the first motion is from the IMU alone")
        elif tables.laser2d is None:
            report.warn(f"no table of the 2-D laser beside {name}: expected laser2d.csv or .npz")
        self.rig, self._row, self._tables, self._report = rig, row, tables, report

    def read(self) -> Iterator[LineItem]:
        """Lines first, then scans of the 2-D laser, then IMU samples."""
        yield from self._lines()
        row = self.rig.row_of("laser2d")
        if row is not None and self._tables.laser2d is not None:
            offset_ns = round(1e9 * self.rig.sensors[row].time_offset_s)
            batches = laser_batches(self._tables.laser2d, self._report, offset_ns=offset_ns)
            yield from map(LaserUnit(self._report).in_meters, batches)
        if self._tables.imu is not None:
            yield read_imu_csv(self._tables.imu)

    def _lines(self) -> Iterator[LineItem]:
        sensor, path = self.rig.sensors[self._row], self._tables.lines
        head = HeadAngles(sensor.name, sensor.head_rate_rad_s, self._report)
        lines = LineAssembly(self._row, self.rig, head, report=self._report)
        offset_ns = round(1e9 * sensor.time_offset_s)
        first_ns = last_ns = 0
        blocks = read_columns(path, LINE_COLUMNS, _LINE_OPTIONAL)
        for line in sweeps(blocks, "shot_deg", number="line", where=path.name):
            t_ns = line[TIME] + offset_ns
            if np.any(np.diff(t_ns) < 0):
                self._report.count("lines_out_of_order")
                continue
            first_ns, last_ns = first_ns or int(t_ns[0]), int(t_ns[-1])
            if not sensor.head_rate_rad_s:
                _push_head(head, line, offset_ns)
            yield from lines.push_shots(self._shots(line, offset_ns))
        yield from lines.flush()
        head.finish(1e-9 * (last_ns - first_ns))

    def _shots(self, line: Columns, offset_ns: int) -> Shots:
        """The returns of a line, in the x-z plane of the head."""
        seen = _returns(line["range_m"]) & np.isfinite(line["shot_deg"])
        angle, r = np.deg2rad(line["shot_deg"][seen]), line["range_m"][seen]
        xyz = np.stack([r * np.cos(angle), np.zeros(len(r)), r * np.sin(angle)], axis=1)
        intensity = np.clip(np.nan_to_num(line["intensity"][seen]), 0, 65535)
        if not np.isfinite(line["intensity"]).any():
            self._report.derive("line scans without intensities: 0 is stored")
        none = np.zeros(len(r), np.uint8)
        return Shots(
            self._row,
            line[TIME][seen] + offset_ns,
            xyz.astype(np.float32),
            intensity.astype(np.uint16),
            none,
            none,
        )


def _returns(range_m: Array) -> NDArray[np.bool_]:
    with np.errstate(invalid="ignore"):
        return np.asarray((range_m >= _SHORTEST_M) & (range_m <= _LONGEST_M), dtype=np.bool_)


def _push_head(head: HeadAngles, line: Columns, offset_ns: int) -> None:
    """Angles of the head: one a line if they do not change within it, else every 5 ms."""
    angle, t_ns = line["head_deg"], line[TIME]
    rows = np.zeros(1, np.intp)
    if np.ptp(angle) > 0.0:
        rows = np.unique((t_ns - t_ns[0]) // _HEAD_STEP_NS, return_index=True)[1]
    for row in rows:
        head.push(int(t_ns[row]) + offset_ns, float(np.deg2rad(angle[row])))


# -- 2-D laser


@dataclass(frozen=True, slots=True)
class _BeamLayout:
    """Angles and times of the beams of a scan, found in the data."""

    first_deg: float
    step_deg: float
    beams: int
    step_ns: float
    """Time between two beams [ns]."""

    @staticmethod
    def of(scans: Sequence[Columns], where: str) -> _BeamLayout:
        """That of most scans.

        Raises:
            UnknownFormat: If the beams have no common step.
        """
        angles = np.concatenate([scan["beam_deg"] for scan in scans])
        steps = np.concatenate([np.diff(scan["beam_deg"]) for scan in scans])
        times = np.concatenate([np.diff(scan[TIME]) for scan in scans])
        used = np.isfinite(steps) & (steps != 0.0)
        if not used.any():
            raise UnknownFormat(f"{where}: expected angles that change from beam to beam, got none")
        step = float(np.median(steps[used]))
        finite = angles[np.isfinite(angles)]
        low, high = float(finite.min()), float(finite.max())
        beams = round((high - low) / abs(step)) + 1
        if beams > _MAX_BEAMS:
            raise UnknownFormat(f"{where}: expected at most {_MAX_BEAMS} beams, got {beams}")
        per_beam = times[used] / np.maximum(np.rint(steps[used] / step), 1.0)
        return _BeamLayout(low if step > 0 else high, step, beams, float(np.median(per_beam)))


def read_laser_table(path: Path, report: ImportReport) -> LaserScans:
    """Read a table of a 2-D laser alone.

    Raises:
        RecordingError: If it cannot be read.
        EmptyRecording: If it has no scan.
    """
    parts = list(laser_batches(path, report))
    if not parts:
        raise EmptyRecording(f"{path.name}: no scan of a 2-D laser can be read")
    odometry = [part.odometry for part in parts if part.odometry is not None]
    joined = np.concatenate(odometry) if len(odometry) == len(parts) else None
    if joined is None:
        report.derive("no odometry: motion is predicted from the scans before")
    return LaserScans(
        t_ns=np.concatenate([part.t_ns for part in parts]),
        range_m=np.concatenate([part.range_m for part in parts]),
        angle_min_rad=parts[0].angle_min_rad,
        angle_step_rad=parts[0].angle_step_rad,
        range_max_m=max(part.range_max_m for part in parts),
        time_step_s=parts[0].time_step_s,
        odometry=joined,
    )


def laser_batches(path: Path, report: ImportReport, *, offset_ns: int = 0) -> Iterator[LaserScans]:
    """Stream the scans of a 2-D laser in batches.

    Args:
        path: The table.
        report: Counts scans and beams that are left out.
        offset_ns: Added to all times.

    Raises:
        RecordingError: If the table cannot be read.
    """
    blocks = read_columns(path, LASER_COLUMNS, _LASER_OPTIONAL)
    scans = sweeps(blocks, "beam_deg", number="scan", where=path.name)
    head = list(islice(scans, _LAYOUT_SCANS))
    collector = _ScanRows(_BeamLayout.of(head, path.name), report)
    for scan in chain(head, scans):
        collector.push(scan, offset_ns)
        if len(collector) >= _SCANS_AT_ONCE:
            yield collector.take()
    if len(collector):
        yield collector.take()


class _ScanRows:
    """Scans placed on the beams of a layout."""

    def __init__(self, layout: _BeamLayout, report: ImportReport) -> None:
        self._layout, self._report = layout, report
        self._ranges: list[NDArray[np.float32]] = []
        self._t_ns: list[int] = []
        self._odometry: list[Array] = []
        self._last_ns = -1

    def __len__(self) -> int:
        return len(self._t_ns)

    def push(self, scan: Columns, offset_ns: int) -> None:
        """Add a scan; one that is not later than the one before is counted and left out."""
        layout = self._layout
        place = (scan["beam_deg"] - layout.first_deg) / layout.step_deg
        beam = np.rint(np.nan_to_num(place, nan=-1.0))
        used = (np.abs(place - beam) < _OFF_GRID) & (beam >= 0) & (beam < layout.beams)
        self._report.count("beams", len(used))
        self._report.count("beams_off_grid", int(np.count_nonzero(~used)))
        if not used.any():
            self._report.count("scans_of_another_layout")
            return
        first = int(np.flatnonzero(used)[0])
        t_ns = int(scan[TIME][first]) - round(layout.step_ns * beam[first]) + offset_ns
        if t_ns <= self._last_ns:
            self._report.count("scans_out_of_order")
            return
        ranges = np.full(layout.beams, np.nan, np.float32)
        seen = used & _returns(scan["range_m"])
        ranges[beam[seen].astype(np.intp)] = scan["range_m"][seen]
        self._last_ns = t_ns
        self._t_ns.append(t_ns)
        self._ranges.append(ranges)
        pose = np.array([scan[name][first] for name in _LASER_OPTIONAL[1:]])
        self._odometry.append(pose * [1.0, 1.0, np.pi / 180.0])
        self._report.count("scans")

    def take(self) -> LaserScans:
        """The scans so far."""
        layout, ranges = self._layout, np.stack(self._ranges)
        poses = np.stack(self._odometry)
        scans = LaserScans(
            t_ns=np.array(self._t_ns, np.int64),
            range_m=ranges,
            angle_min_rad=float(np.deg2rad(layout.first_deg)),
            angle_step_rad=float(np.deg2rad(layout.step_deg)),
            range_max_m=max(_USUAL_REACH_M, float(np.nanmax(ranges, initial=0.0))),
            time_step_s=max(layout.step_ns * 1e-9, 0.0),
            odometry=poses if np.isfinite(poses).all() else None,
        )
        self._t_ns, self._ranges, self._odometry = [], [], []
        return scans
