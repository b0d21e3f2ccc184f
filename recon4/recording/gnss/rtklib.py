"""Solutions of RTKLIB and its relatives (``.pos``), in any of their positions and times."""

from __future__ import annotations

import math
import re
from dataclasses import dataclass
from datetime import UTC, datetime
from pathlib import Path

import numpy as np

from recon4.errors import CorruptFile, EmptyRecording
from recon4.geometry.se3 import Array
from recon4.locales.coded import CodedText
from recon4.model.import_notes import HEIGHTS_ORTHOMETRIC, HEIGHTS_UNSTATED
from recon4.model.samples import GnssQuality
from recon4.recording.formats.damaged_lines import DamagedLines, wrong_row
from recon4.recording.gnss.records import FixRows, GnssFile, gnss_samples, seconds_ns, week_ns
from recon4.recording.gnss.tuning import GNSS_FILES
from recon4.recording.report import ImportReport
from recon4.recording.tables.text import table_blocks
from recon4.units import HOUR_NS, SECOND_NS
from recon4.untrusted.bounded import parse_float

_QUALITY = {
    1: GnssQuality.RTK_FIXED,
    2: GnssQuality.RTK_FLOAT,
    3: GnssQuality.DIFFERENTIAL,
    4: GnssQuality.DIFFERENTIAL,
    5: GnssQuality.SINGLE,
    6: GnssQuality.RTK_FLOAT,
    7: GnssQuality.DEAD_RECKONING,
}
"""Of ``Q``: fixed, float, SBAS, DGPS, single, PPP, dead reckoning."""
_POSITIONS = {"latitude": "geodetic", "x-ecef": "ecef", "e-baseline": "enu"}
_NUMBER = re.compile(r"[-+]?\d+\.\d+")
_DATE = re.compile(r"\d{4}/\d{1,2}/\d{1,2}")
_SECONDS = re.compile(r"(\d{1,7})(?:\.(\d{1,12}))?")


def is_rtklib(head: str) -> bool:
    """Whether a text begins with the comments of such a file: they name its columns."""
    return any(_names(line) for line in head.split("\n") if line.startswith("%"))


@dataclass(slots=True)
class _Header:
    """What the comments say."""

    position: str = ""
    """``geodetic``, ``ecef`` or ``enu`` (of a baseline)."""
    sexagesimal: bool = False
    """Whether degrees, minutes and seconds stand in cells of their own."""
    time: str = "GPST"
    heights: str = HEIGHTS_UNSTATED
    """Count of the heights that are not above the ellipsoid, or of which this is not said."""
    base: tuple[float, ...] = ()
    """Position of the base: latitude, longitude, height, or earth-centered [m]."""

    def read(self, line: str) -> None:
        """Take what a comment tells."""
        if position := _names(line):
            self.position = position
            self.sexagesimal = "(d'" in line
            self.time = line.lstrip("% ").split()[0].split(",")[0]
        elif "/height=" in line:
            self.heights = HEIGHTS_ORTHOMETRIC if "geodetic" in line else ""
        elif "ref pos" in line:
            self.base = tuple(map(float, _NUMBER.findall(line.partition(":")[2])))


def read_rtklib(path: Path, report: ImportReport) -> GnssFile:
    """Read a solution: degrees, earth-centered or east, north, up of a baseline.

    Times in GPST, UTC or JST, as a date or as week and seconds, become UTC.

    Args:
        path: The file; UTF-8, UTF-16 or a code page.
        report: Gets the counts of damaged lines, and of heights above sea level or of unknown kind.

    Raises:
        CorruptFile: If too many lines are damaged, or the times are of an unknown system.
        EmptyRecording: If there is no solution in it.
    """
    damaged = DamagedLines(report, "gnss_lines_damaged")
    header, rows, number = _Header(), FixRows(), 0
    for block in table_blocks(path, max_bytes=GNSS_FILES.text_bytes):
        for line in block.split("\n")[: block.count("\n") + (not block.endswith("\n"))]:
            number += 1
            if line.startswith("%"):
                header.read(line)
            elif line.strip():
                try:
                    _add(line, header, rows)
                except (ValueError, OverflowError) as error:
                    damaged.add(CorruptFile(wrong_row(path.name, number, line, why=error)))
    damaged.finish(len(rows))
    if not len(rows):
        raise EmptyRecording(CodedText("rtklib-none", file=path.name))
    if header.heights and header.position == "geodetic":
        report.count(header.heights, len(rows))
    t_ns, table = rows.times(gps=_is_gps(header.time, path.name)), rows.table()
    if header.time == "JST":
        t_ns = t_ns - 9 * HOUR_NS
    table[:, :3] = _geodetic(table[:, :3], header, path.name)
    return GnssFile(gnss_samples(t_ns, table, rows.quality), f"RTKLIB, {header.time}")


def _names(line: str) -> str:
    """How the positions are given, if a comment names the columns; else empty."""
    return next((kind for key, kind in _POSITIONS.items() if key in line and "Q" in line), "")


def _is_gps(time: str, name: str) -> bool:
    if time not in ("GPST", "UTC", "JST"):
        raise CorruptFile(CodedText("rtklib-time-system", name=name, time=time[:20]))
    return time == "GPST"


def _add(line: str, header: _Header, rows: FixRows) -> None:
    """Read a solution; raises ValueError with what is wrong."""
    cells = line.replace(",", " ").replace(";", " ").split()
    wide = 7 if header.sexagesimal else 3
    if len(cells) < 3 + wide:
        raise ValueError(f"expected {3 + wide} cells or more, got {len(cells)}")
    t_ns = _time_ns(cells[0], cells[1])
    if not 0 <= t_ns < GNSS_FILES.latest_ns:
        raise ValueError("no time of our days")
    first, second, third = _position(cells[2 : 2 + wide], header.sexagesimal)
    if header.position == "geodetic" and (abs(first) > 90.0 or abs(second) > 360.0):
        raise ValueError(f"no latitude and longitude in degrees: {first:g}, {second:g}")
    quality = _QUALITY.get(round(parse_float(cells[2 + wide])), GnssQuality.INVALID)
    sd = [parse_float(cell) for cell in cells[4 + wide : 7 + wide]]
    # Of the axes as the position has them: north, east, up; x, y, z; or east, north, up.
    sd = sd if len(sd) == 3 and min(sd) > 0.0 else [math.nan] * 3
    if header.position == "geodetic":
        sd[:2] = sd[1::-1]
    elif header.position == "ecef":
        sd = [max(sd)] * 3
    rows.add(t_ns, (first, second, third, *sd), quality)


def _position(cells: list[str], sexagesimal: bool) -> tuple[float, float, float]:
    values = [parse_float(cell) for cell in cells]
    if not all(map(math.isfinite, values)):
        raise ValueError("expected finite coordinates")
    if not sexagesimal:
        return values[0], values[1], values[2]
    lat, lon = (
        math.copysign(abs(d) + m / 60.0 + s / 3600.0, -1.0 if cells[k].startswith("-") else 1.0)
        for k, (d, m, s) in ((0, values[:3]), (3, values[3:6]))
    )
    return lat, lon, values[6]


def _time_ns(date: str, time: str) -> int:
    """Nanoseconds since 1970 on the clock of the file, of a date and a time or a week and seconds.

    Raises:
        ValueError: If it is neither.
    """
    if not _DATE.fullmatch(date):
        match = _SECONDS.fullmatch(time)
        if match is None or not date.isdecimal() or int(date) > GNSS_FILES.most_weeks:
            raise ValueError("expected a date and a time, or a GPS week and its seconds")
        return week_ns(int(date), seconds_ns(match))
    hour, minute, second = time.split(":")
    match = _SECONDS.fullmatch(second)
    if match is None:
        raise ValueError("expected a time as hh:mm:ss")
    year, month, day_of_month = map(int, date.split("/"))
    day = datetime(year, month, day_of_month, tzinfo=UTC)
    whole = int(day.timestamp()) + int(hour) * 3600 + int(minute) * 60
    return whole * SECOND_NS + seconds_ns(match)


def _geodetic(position: Array, header: _Header, name: str) -> Array:
    """Latitude and longitude [deg] and ellipsoidal height [m] of the file's positions, (N, 3)."""
    from pyproj import Transformer

    if header.position == "geodetic":
        return position
    xyz = position
    geodetic = Transformer.from_crs("EPSG:4978", "EPSG:4979")
    if header.position == "enu":
        if len(header.base) != 3:
            raise CorruptFile(CodedText("rtklib-no-base", name=name))
        lat, lon, height = header.base
        if np.linalg.norm(header.base) > GNSS_FILES.least_radius_m:
            lat, lon, height = geodetic.transform(*header.base)
        if not (abs(lat) <= 90.0 and abs(lon) <= 360.0):
            raise CorruptFile(CodedText("rtklib-base", name=name, lat=lat, lon=lon))
        to_ecef = Transformer.from_pipeline(
            "+proj=pipeline +step +inv +proj=topocentric +ellps=WGS84 "
            f"+lat_0={lat!r} +lon_0={lon!r} +h_0={height!r}"
        )
        xyz = np.column_stack(to_ecef.transform(*position.T))
    return np.column_stack(geodetic.transform(*xyz.T))
