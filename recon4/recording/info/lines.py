"""Contents of tables of line scans, for ``recon4 info``."""

from __future__ import annotations

from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from recon4.errors import RecordingError
from recon4.locales.coded import CodedText
from recon4.locales.texts import Shown
from recon4.model.finding_kinds import FindingKind
from recon4.recording.assembly.assembler import TimeGap
from recon4.recording.formats.columns import (
    TIME,
    Columns,
    column_names,
    estimate_rows,
    read_columns,
)
from recon4.recording.info.records import RecordingInfo, SensorInfo
from recon4.recording.lasers.laser2d import read_laser2d
from recon4.recording.lasers.line_tables import LINE_COLUMNS, LineTables
from recon4.recording.lasers.sweeps import sweeps
from recon4.recording.lasers.tuning import LINES
from recon4.recording.limits import LIMITS
from recon4.recording.report import ImportReport
from recon4.recording.samples.csv_files import read_imu_csv


@dataclass(slots=True)
class _Seen:
    """What was counted in the rows that were read."""

    lines: int = 0
    rows: int = 0
    returns: int = 0
    t_first_ns: int = 0
    t_line_ns: int = 0
    """Start of the last line."""
    t_last_ns: int = 0
    head_deg: tuple[float, float] = (np.inf, -np.inf)
    gaps: tuple[TimeGap, ...] = ()

    def add(self, line: Columns, name: str) -> None:
        """Count a line."""
        t_ns = line[TIME]
        if self.lines and int(t_ns[0]) - self.t_last_ns > LINES.gap_ns:
            seconds = 1e-9 * (int(t_ns[0]) - self.t_last_ns)
            self.gaps += (TimeGap(name, self.t_last_ns, seconds),)
        self.t_first_ns = self.t_first_ns if self.lines else int(t_ns[0])
        self.t_line_ns, self.t_last_ns = int(t_ns[0]), int(t_ns[-1])
        self.lines += 1
        self.rows += len(t_ns)
        range_m = line["range_m"]
        self.returns += int(np.count_nonzero(np.isfinite(range_m) & (range_m > 0.0)))
        head = line["head_deg"][np.isfinite(line["head_deg"])]
        if len(head):
            low, high = self.head_deg
            self.head_deg = (min(low, float(head.min())), max(high, float(head.max())))


def describe_line_tables(info: RecordingInfo, path: Path) -> RecordingInfo:
    """Lines, head, 2-D laser and IMU of a folder or a file.

    Raises:
        RecordingError: If the table of lines cannot be read.
    """
    tables = LineTables.of([path])
    has_head = "head_deg" in column_names(tables.lines)
    report = ImportReport()
    seen = _read_lines(tables.lines, report)
    rows = max(seen.rows, estimate_rows(tables.lines) if seen.rows >= LIMITS.line_rows else 0)
    part = seen.rows / rows
    seconds = 1e-9 * (seen.t_last_ns - seen.t_first_ns)
    sensors: tuple[SensorInfo, ...] = (_profiler(tables.lines.name, seen, part),)
    missing, samples = _absent(tables, has_head), []
    if tables.laser2d is not None:
        try:
            sensors += (_laser2d(tables.laser2d, report),)
        except RecordingError as error:
            report.warn(FindingKind.FILE_LEFT_OUT, error=error)
    if tables.imu is not None:
        imu_ns = read_imu_csv(tables.imu, report).t_ns
        beside: dict[str, Shown] = {"file": tables.imu.name, "count": len(imu_ns), "what": "imu"}
        samples.append(CodedText("samples-beside-lines", **beside))
    return replace(
        info,
        t_first_ns=seen.t_first_ns,
        t_last_ns=seen.t_first_ns + round(1e9 * seconds / part),
        estimated=part < 1.0,
        sensors=sensors,
        samples=tuple(samples),
        gaps=seen.gaps,
        missing=missing,
        lost=tuple(report.losses()),
        repaired=tuple(report.repairs()),
        findings=tuple(report.findings),
    )


def _read_lines(path: Path, report: ImportReport) -> _Seen:
    seen = _Seen()
    blocks = read_columns(path, LINE_COLUMNS, ("head_deg", "line"), report=report)
    for line in sweeps(blocks, "shot_deg", number="line", where=path.name):
        seen.add(line, path.name)
        if seen.rows >= LIMITS.line_rows:
            break
    return seen


def _absent(tables: LineTables, has_head: bool) -> tuple[CodedText, ...]:
    absent = {
        CodedText("missing-laser-table"): tables.laser2d is None,
        CodedText("missing-imu-table", what="imu"): tables.imu is None,
        CodedText("missing-head-column"): not has_head,
    }
    found = tuple(text for text, is_absent in absent.items() if is_absent)
    return (*found, CodedText("missing-profiler-rig", what="rig"))


def _profiler(name: str, seen: _Seen, part: float) -> SensorInfo:
    seconds = 1e-9 * (seen.t_line_ns - seen.t_first_ns)
    low, high = seen.head_deg
    head = {"low": float(np.deg2rad(low)), "high": float(np.deg2rad(high))} if low <= high else {}
    shots = {"shots": seen.rows / seen.lines, "returns": seen.returns / seen.rows}
    remark = CodedText("remark-head" if head else "remark-lines", **shots, **head)
    return SensorInfo(
        label=name,
        model="profiler",
        content=CodedText("content-line-scans"),
        count=round(seen.lines / part),
        rate_hz=(seen.lines - 1) / seconds if seconds > 0 else float("nan"),
        remarks=(remark,),
    )


def _laser2d(path: Path, report: ImportReport) -> SensorInfo:
    scans = read_laser2d([path], report)
    seconds = 1e-9 * float(scans.t_ns[-1] - scans.t_ns[0])
    return SensorInfo(
        label=path.name,
        model="2-D laser",
        content=scans.layout,
        count=len(scans),
        rate_hz=(len(scans) - 1) / seconds if seconds > 0 else float("nan"),
    )
