"""Line scans of a profiler as tables, one row a shot, with the files that belong to them."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from recon4.errors import ConfigError, UnknownFormat
from recon4.locales.coded import CodedText
from recon4.model.derived_kinds import DerivedKind
from recon4.model.finding_kinds import FindingKind
from recon4.model.rig import Rig
from recon4.recording.assembly.shots import Shots
from recon4.recording.formats.columns import TIME, Columns, column_names, read_columns
from recon4.recording.lasers.head_angles import HeadAngles
from recon4.recording.lasers.line_recording import LineAssembly, LineItem
from recon4.recording.lasers.range_units import LaserUnit
from recon4.recording.lasers.sweeps import in_order, sweeps
from recon4.recording.lasers.tables import is_laser_table, laser_batches, returns_of
from recon4.recording.report import ImportReport
from recon4.recording.samples.csv_files import read_imu_csv
from recon4.recording.tuning import PROBE

LINE_COLUMNS = (TIME, "shot_deg", "range_m")
_LINE_OPTIONAL = ("head_deg", "intensity", "line")
_SUFFIXES = (".npz", ".csv")


def is_line_table(path: Path) -> bool:
    """Whether a file has the columns of line scans."""
    return set(LINE_COLUMNS) <= column_names(path)


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
            raise UnknownFormat(CodedText("line-tables-count", lines=len(lines), lasers=len(scans)))
        rest = [path for path in paths if path not in (*lines, *scans)]
        return LineTables(lines[0], scans[0] if scans else None, rest[0] if rest else None)


class LineTableRecording:
    """Streams tables as `recon4.recording.lasers.line_recording.LineRecording` streams bags."""

    def __init__(self, tables: LineTables, rig: Rig | None, *, report: ImportReport) -> None:
        """Check the rig.

        Raises:
            ConfigError: If the rig is missing or has no profiler, or the angles of the head are
                missing.
        """
        name = tables.lines.name
        row = None if rig is None else rig.row_of("profiler")
        if rig is None or row is None:
            raise ConfigError(CodedText("line-tables-rig", name=name))
        sensor = rig.sensors[row]
        if "head_deg" not in column_names(tables.lines) and not sensor.head_rate_rad_s:
            raise ConfigError(CodedText("head-column-missing", sensor=sensor.name, name=name))
        if rig.row_of("laser2d") is None:
            report.warn(FindingKind.LASER_NOT_IN_RIG)
        elif tables.laser2d is None:
            report.warn(FindingKind.LASER_TABLE_MISSING, name=name)
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
            yield read_imu_csv(self._tables.imu, self._report)

    def _lines(self) -> Iterator[LineItem]:
        sensor, path = self.rig.sensors[self._row], self._tables.lines
        head = HeadAngles(sensor.name, sensor.head_rate_rad_s, self._report)
        lines = LineAssembly(self._row, self.rig, head, report=self._report)
        offset_ns = round(1e9 * sensor.time_offset_s)
        first_ns = last_ns = 0
        blocks = read_columns(path, LINE_COLUMNS, _LINE_OPTIONAL, report=self._report)
        found = sweeps(blocks, "shot_deg", number="line", where=path.name)
        for line in in_order(found, path.name, late="lines_out_of_order", report=self._report):
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
        seen = returns_of(line["range_m"]) & np.isfinite(line["shot_deg"])
        angle, r = np.deg2rad(line["shot_deg"][seen]), line["range_m"][seen]
        xyz = np.stack([r * np.cos(angle), np.zeros(len(r)), r * np.sin(angle)], axis=1)
        intensity = np.clip(np.nan_to_num(line["intensity"][seen]), 0, 65535)
        if not np.isfinite(line["intensity"]).any():
            self._report.derive(DerivedKind.INTENSITY_MISSING, line_scans=True)
        none = np.zeros(len(r), np.uint8)
        return Shots(
            self._row,
            line[TIME][seen] + offset_ns,
            xyz.astype(np.float32),
            intensity.astype(np.uint16),
            none,
            none,
        )


def _push_head(head: HeadAngles, line: Columns, offset_ns: int) -> None:
    """Angles of the head: one a line if they do not change within it, else every 5 ms."""
    angle, t_ns = line["head_deg"], line[TIME]
    rows = np.zeros(1, np.intp)
    if np.ptp(angle) > 0.0:
        rows = np.unique((t_ns - t_ns[0]) // PROBE.head_step_ns, return_index=True)[1]
    for row in rows:
        head.push(int(t_ns[row]) + offset_ns, float(np.deg2rad(angle[row])))
