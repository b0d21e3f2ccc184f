"""Trajectories that post-processing exports as text: Inertial Explorer, GrafNav, POSPac.

People choose the columns; a line names them, the next one their units.
"""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from datetime import UTC, datetime
from itertools import pairwise
from pathlib import Path

import numpy as np

from recon4.errors import CorruptFile, EmptyRecording
from recon4.locales.coded import CodedText
from recon4.model.gps_time import utc_of_gps_ns
from recon4.model.import_notes import HEIGHTS_ORTHOMETRIC
from recon4.model.samples import GnssQuality
from recon4.model.trajectory import Times
from recon4.recording.formats.damaged_lines import DamagedLines, wrong_row
from recon4.recording.gnss.records import (
    Dating,
    FixRows,
    GnssFile,
    gnss_samples,
    seconds_ns,
    week_ns,
)
from recon4.recording.gnss.tuning import GNSS_FILES
from recon4.recording.report import ImportReport
from recon4.recording.tables.text import table_blocks
from recon4.units import SECOND_NS
from recon4.untrusted.bounded import parse_float

_ROLES = {
    "gpstime": "gps",
    "time": "gps",
    "utctime": "utc",
    "week": "week",
    "gpsweek": "week",
    "utcdate": "date",
    "gpsdate": "gps_date",
    "latitude": "lat",
    "longitude": "lon",
    "hell": "ellipsoidal",
    "ellipsoidheight": "ellipsoidal",
    "ellipsoidalheight": "ellipsoidal",
    "hmsl": "orthometric",
    "hort": "orthometric",
    "orthometricheight": "orthometric",
    "sdnorth": "sd_n",
    "sdeast": "sd_e",
    "sdheight": "sd_u",
    "northsd": "sd_n",
    "eastsd": "sd_e",
    "heightsd": "sd_u",
    "roll": "roll",
    "pitch": "pitch",
    "heading": "heading",
    "q": "quality",
}
"""Names of columns, letters only, and what they hold."""
_QUALITY = {
    1: GnssQuality.RTK_FIXED,
    2: GnssQuality.RTK_FLOAT,
    3: GnssQuality.DIFFERENTIAL,
    4: GnssQuality.DIFFERENTIAL,
    5: GnssQuality.SINGLE,
    6: GnssQuality.SINGLE,
}
"""Of ``Q``: fixed, stable float, converging float, DGPS, code only twice (manual of GrafNav)."""
_UNIT = re.compile(r"\([^()]*\)")
_SECONDS = re.compile(r"(\d{1,10})(?:\.(\d{1,12}))?")
_CLOCK = re.compile(r"(\d{1,2}):(\d{2}):(\d{2}(?:\.\d{1,12})?)")
_DATES = {"YMD": (0, 1, 2), "MDY": (2, 0, 1), "DMY": (2, 1, 0)}


@dataclass(frozen=True, slots=True)
class _Cells:
    unit: str
    first: int
    """Number of its first cell."""
    cells: int
    """3 for degrees, minutes and seconds."""


_Columns = dict[str, _Cells]


def is_exported_text(head: str) -> bool:
    """Whether a text has a line that names columns of a trajectory, and one of their units."""
    return any(_columns(*pair) for pair in pairwise(head.split("\n")))


def read_exported_text(path: Path, report: ImportReport) -> GnssFile:
    """Read positions, with attitudes and standard deviations where there are columns of them.

    Args:
        path: The file. Latitude and longitude are degrees, or degrees, minutes and seconds; times
            are seconds of the GPS week, with or without it, of 1970 in UTC, or ``h:m:s``.
        report: Gets the counts of damaged lines, and of heights above sea level.

    Raises:
        CorruptFile: If a column that is needed is missing, or too many lines are damaged.
        EmptyRecording: If there is no position in it.
    """
    damaged = DamagedLines(report, "gnss_lines_damaged")
    rows, table, before = FixRows(), None, ""
    for number, line in enumerate(_lines(path), 1):
        if table is None:
            columns = _columns(before, line)
            before = line
            table = _ExportedLines.of(columns, path.name) if columns else None
        elif line.strip():
            try:
                table.add(line, rows)
            except (ValueError, OverflowError) as error:
                damaged.add(CorruptFile(wrong_row(path.name, number, line, why=error)))
    damaged.finish(len(rows))
    if table is None or not len(rows):
        raise EmptyRecording(CodedText("gnss-no-position", file=path.name))
    if "ellipsoidal" not in table.columns:
        report.count(HEIGHTS_ORTHOMETRIC, len(rows))
    if table.dating is Dating.UTC and max(rows.t_ns) < GNSS_FILES.earliest_ns:
        raise CorruptFile(CodedText("gnss-time", file=path.name, t_ns=rows.t_ns[0] / SECOND_NS))
    samples = gnss_samples(table.utc(rows), rows.table(), rows.quality)
    return GnssFile(samples, "Inertial Explorer", table.dating)


@dataclass(frozen=True, slots=True)
class _ExportedLines:
    """How lines are read."""

    columns: _Columns
    dating: Dating
    gps: bool
    """Whether times are of GPS and count from 1970 or a week that is given."""
    time: Callable[[list[str]], int]

    @classmethod
    def of(cls, columns: _Columns, name: str) -> _ExportedLines:
        """Choose columns of time; raises CorruptFile if there is none, or no height."""
        if not columns.keys() & {"ellipsoidal", "orthometric"}:
            got = ", ".join(sorted(columns))
            raise CorruptFile(CodedText("gnss-height-column", name=name, got=got))
        for clock, date, gps in (("utc", "date", False), ("gps", "gps_date", True)):
            if columns.keys() >= {clock, date}:
                return cls(columns, Dating.UTC, gps, _dated(columns[clock], columns[date]))
        if columns.keys() >= {"gps", "week"}:
            week, second = columns["week"].first, _time(columns["gps"])
            return cls(columns, Dating.UTC, True, lambda cells: _week(cells, week, second))
        clock = "utc" if "utc" in columns else "gps"
        dating = Dating.WEEK
        if clock == "utc":
            dating = Dating.DAY if "HMS" in columns[clock].unit else Dating.UTC
        return cls(columns, dating, False, _time(columns[clock]))

    def add(self, line: str, rows: FixRows) -> None:
        """Read a position; raises ValueError with what is wrong."""
        cells = re.split(r"[,;\s]+", line.strip())
        least = max(column.first + column.cells for column in self.columns.values())
        if len(cells) < least:
            raise ValueError(f"expected {least} cells or more, got {len(cells)}")
        t_ns = self.time(cells)
        if not 0 <= t_ns < GNSS_FILES.latest_ns:
            raise ValueError("no time of our days")
        height = "ellipsoidal" if "ellipsoidal" in self.columns else "orthometric"
        lat, lon, height_m = (self._value(cells, role) for role in ("lat", "lon", height))
        if not (abs(lat) <= 90.0 and abs(lon) <= 360.0 and math.isfinite(height_m)):
            raise ValueError(f"expected a place on the earth, got {lat:g}, {lon:g}, {height_m:g}")
        sd_m = [self._value(cells, role) for role in ("sd_e", "sd_n", "sd_u")]
        sd_m = [value if value > 0.0 else math.nan for value in sd_m]
        rpy_deg = tuple(self._value(cells, role) for role in ("roll", "pitch", "heading"))
        quality = self._quality(cells, math.hypot(*sd_m[:2]))
        rows.add(t_ns, (lat, lon, height_m, *sd_m), quality, rpy_deg=rpy_deg)

    def utc(self, rows: FixRows) -> Times:
        """Times of the rows: UTC where they are absolute."""
        t_ns = np.array(rows.t_ns, np.int64)
        return utc_of_gps_ns(t_ns) if self.gps else t_ns

    def _value(self, cells: list[str], role: str) -> float:
        """Number of a column, NaN without it; degrees of degrees, minutes and seconds."""
        column = self.columns.get(role)
        if column is None:
            return math.nan
        parts = [parse_float(cell) for cell in cells[column.first : column.first + column.cells]]
        if column.cells == 1:
            return parts[0]
        sign = -1.0 if cells[column.first].startswith("-") else 1.0
        return sign * (abs(parts[0]) + parts[1] / 60.0 + parts[2] / 3600.0)

    def _quality(self, cells: list[str], flat_m: float) -> int:
        if "quality" in self.columns:
            return _QUALITY.get(round(self._value(cells, "quality")), GnssQuality.INVALID)
        if flat_m <= GNSS_FILES.fixed_m:
            return GnssQuality.RTK_FIXED
        return GnssQuality.RTK_FLOAT if flat_m <= GNSS_FILES.float_m else GnssQuality.SINGLE


def _lines(path: Path) -> Iterator[str]:
    for block in table_blocks(path, max_bytes=GNSS_FILES.text_bytes):
        yield from block.splitlines()


def _columns(names: str, units: str) -> _Columns | None:
    """Columns of a table by the line of their names and the next one; None = it is none."""
    if ("atitude" not in names and "ATITUDE" not in names) or not units.strip().startswith("("):
        return None
    titles = [(match.group(), match.end()) for match in re.finditer(r"[^\s,;]+", names)]
    found = [(match.group(), match.end()) for match in _UNIT.finditer(units)]
    columns: _Columns = {}
    cell = 0
    for place, (title, end) in enumerate(titles):
        # Right-aligned; a column without a unit has nothing below it.
        unit = next((text for text, at in found if abs(at - end) <= 2), "")
        if len(found) == len(titles):
            unit = found[place][0]
        cells = 3 if re.search(r"D\s+M\s+S", unit) else 1
        role = _ROLES.get(re.sub(r"[^a-z]", "", title.lower()), "")
        if role:
            columns.setdefault(role, _Cells(unit, cell, cells))
        cell += cells
    times = columns.keys() & {"gps", "utc"}
    return columns if times and columns.keys() >= {"lat", "lon"} else None


def _time(column: _Cells) -> Callable[[list[str]], int]:
    """Reads the time of a line [ns]."""
    first = column.first
    if "HMS" in column.unit:
        return lambda cells: _clock_ns(cells[first])
    return lambda cells: _seconds_ns(cells[first])


def _dated(clock: _Cells, date: _Cells) -> Callable[[list[str]], int]:
    order = next((order for name, order in _DATES.items() if name in date.unit), _DATES["YMD"])
    time = _time(clock)

    def read(cells: list[str]) -> int:
        parts = [int(part) for part in re.split(r"[/.-]", cells[date.first])]
        if len(parts) != len(order):
            raise ValueError(f"expected a date, got {cells[date.first]!r}")
        year, month, day_of_month = (parts[place] for place in order)
        day = datetime(year, month, day_of_month, tzinfo=UTC)
        return int(day.timestamp()) * SECOND_NS + time(cells)

    return read


def _week(cells: list[str], week: int, second: Callable[[list[str]], int]) -> int:
    if not cells[week].isdecimal() or int(cells[week]) > GNSS_FILES.most_weeks:
        raise ValueError(f"expected a GPS week, got {cells[week]!r}")
    return week_ns(int(cells[week]), second(cells))


def _seconds_ns(text: str) -> int:
    match = _SECONDS.fullmatch(text)
    if match is None:
        raise ValueError(f"expected seconds, got {text!r}")
    return seconds_ns(match)


def _clock_ns(text: str) -> int:
    match = _CLOCK.fullmatch(text)
    if match is None:
        raise ValueError(f"expected a time as h:m:s, got {text!r}")
    return (int(match[1]) * 3600 + int(match[2]) * 60) * SECOND_NS + _seconds_ns(match[3])
