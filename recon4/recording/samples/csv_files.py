"""IMU and GNSS samples as CSV files (``docs/reference/recordings.md`` has the headers)."""

from __future__ import annotations

import csv
import math
from array import array
from collections.abc import Iterator
from itertools import islice
from pathlib import Path

import numpy as np

from recon4.errors import CorruptFile, EmptyRecording, RecordingError, UnknownFormat
from recon4.geometry.se3 import Array
from recon4.locales.coded import CodedText
from recon4.model.samples import GnssQuality, GnssSamples, ImuSamples
from recon4.model.trajectory import Times
from recon4.recording.formats.damaged_lines import DamagedLines
from recon4.recording.limits import LIMITS
from recon4.recording.report import ImportReport
from recon4.recording.samples.heights import STATED_COLUMNS, height_above_ellipsoid
from recon4.recording.tuning import LISTED
from recon4.untrusted.bounded import lines_limited, parse_float

IMU_HEADER = ("t_ns", "gx_rad_s", "gy_rad_s", "gz_rad_s", "ax_m_s2", "ay_m_s2", "az_m_s2")
GNSS_HEADER = (
    *("t_ns", "lat_deg", "lon_deg", "height_m", "sd_e_m", "sd_n_m", "sd_u_m", "quality"),
    *("roll_deg", "pitch_deg", "heading_deg"),
)
_OPTIONAL = {*IMU_HEADER[4:], *GNSS_HEADER[3:], *STATED_COLUMNS}
_SEPARATORS = ";\t,"


def read_imu_csv(path: Path, report: ImportReport | None = None) -> ImuSamples:
    """Read IMU samples; columns in any order, ``;`` and decimal commas welcome.

    Args:
        path: The file.
        report: Gets the count of damaged lines, which are dropped; None = not wanted.

    Raises:
        CorruptFile: If too many lines are damaged, naming the first and what is no number in it.
        UnknownFormat: If a column is missing.
        EmptyRecording: If there is no line under the header.
    """
    damaged = DamagedLines(report or ImportReport(), "imu_lines_damaged")
    t_ns, columns = _read(path, IMU_HEADER, damaged)
    gyro = np.column_stack([columns[name] for name in IMU_HEADER[1:4]])
    accel = np.column_stack([columns[name] for name in IMU_HEADER[4:]])
    return ImuSamples(t_ns, gyro, accel)


def read_gnss_csv(path: Path, report: ImportReport | None = None) -> GnssSamples:
    """Read GNSS positions, and attitudes if there are; an empty cell is not measured.

    Heights come from the columns of `recon4.recording.samples.heights`.

    Args:
        path: The file.
        report: Gets the counts of damaged lines and of heights of unknown kind; None = not wanted.

    Raises:
        CorruptFile, UnknownFormat, EmptyRecording: As `read_imu_csv`.
    """
    report = report or ImportReport()
    damaged = DamagedLines(report, "gnss_lines_damaged")
    t_ns, columns = _read(path, (*GNSS_HEADER, *STATED_COLUMNS), damaged)
    lat, lon = columns["lat_deg"], columns["lon_deg"]
    quality = np.nan_to_num(columns["quality"], nan=float(GnssQuality.SINGLE))
    return GnssSamples(
        t_ns,
        np.deg2rad(lat),
        np.deg2rad(lon),
        height_above_ellipsoid(columns, report),
        np.column_stack([columns[name] for name in GNSS_HEADER[4:7]]),
        np.clip(quality, 0, 255).astype(np.uint8),
        np.deg2rad(np.column_stack([columns[name] for name in GNSS_HEADER[8:]])),
    )


def csv_header(path: Path) -> list[str]:
    """Names of the columns; empty when the first line is no text."""
    try:
        return _names(next(_lines(path, max_bytes=1 << 62), ""))
    except RecordingError:
        return []


def _names(line: str) -> list[str]:
    return [cell.strip().strip('"').lower() for cell in line.strip().split(csv_separator(line))]


def csv_separator(header: str) -> str:
    """What separates the columns of a table with this header line."""
    return next((sign for sign in _SEPARATORS if sign in header), ",")


def _lines(
    path: Path, damaged: DamagedLines | None = None, *, max_bytes: int = LIMITS.sample_file_bytes
) -> Iterator[str]:
    return lines_limited(
        path,
        max_bytes=max_bytes,
        max_line_bytes=LIMITS.line_bytes,
        on_damaged=damaged.add if damaged else None,
    )


def _read(
    path: Path, known: tuple[str, ...], damaged: DamagedLines
) -> tuple[Times, dict[str, Array]]:
    """Times and columns; a column that is not in the file is NaN."""
    first = next(_lines(path), "")
    lines = islice(_lines(path, damaged), 1, None)
    header = _checked_header(first, known, path.name)
    at = [header.index(name) if name in header else -1 for name in known]
    times, values = array("q"), array("d")
    for number, line in enumerate(lines, start=2):
        where = f"{path.name}: line {number}"
        try:
            row = _cells(line, csv_separator(first), where)
            if not any(row):
                continue
            t_ns, numbers = _sample(row, header, at, where=where)
        except CorruptFile as error:
            damaged.add(error)
            continue
        times.append(t_ns)
        values.extend(numbers)
    damaged.finish(len(times))
    if not times:
        raise EmptyRecording(CodedText("samples-none", file=path.name))
    table = np.array(values, np.float64).reshape(len(times), -1)
    return np.array(times, np.int64), {name: table[:, k] for k, name in enumerate(known[1:])}


def _checked_header(line: str, known: tuple[str, ...], name: str) -> list[str]:
    if not line.strip():
        raise UnknownFormat(CodedText("samples-header-empty", name=name, known=",".join(known)))
    header = _names(line)
    missing = [column for column in known if column not in header and column not in _OPTIONAL]
    if missing:
        raise UnknownFormat(
            CodedText(
                "samples-columns",
                name=name,
                missing=", ".join(missing),
                known=",".join(known),
                line=line.strip()[: LISTED.characters],
            )
        )
    twice = sorted({column for column in known if header.count(column) > 1})
    if twice:
        raise UnknownFormat(CodedText("column-twice", file=name, twice=str(twice)))
    return header


def _cells(line: str, separator: str, where: str) -> list[str]:
    """Cells of a line; a sample never spans lines."""
    try:
        return next(csv.reader([line.rstrip("\r\n")], delimiter=separator), [])
    except csv.Error as error:
        raise CorruptFile(CodedText("samples-csv", where=where, why=str(error))) from error


def _sample(
    row: list[str], header: list[str], at: list[int], *, where: str
) -> tuple[int, list[float]]:
    """Time and numbers of a line whose columns stand at the places ``at``; -1 = not in the file."""
    if len(row) != len(header):
        raise CorruptFile(
            CodedText("samples-cells", where=where, expected=len(header), got=len(row))
        )
    values = dict(zip(header, row, strict=True))
    if "lat_deg" in values:
        _check_place(values["lat_deg"], values["lon_deg"], where)
    t_ns = csv_time(row[at[0]], where)
    return t_ns, [csv_number(row[k], where) if k >= 0 else math.nan for k in at[1:]]


def _check_place(latitude: str, longitude: str, where: str) -> None:
    lat, lon = csv_number(latitude, where), csv_number(longitude, where)
    if abs(lat) > 90.0 or abs(lon) > 360.0:
        raise CorruptFile(CodedText("samples-degrees", where=where, lat=lat, lon=lon))


def csv_time(text: str, where: str) -> int:
    """Whole nanoseconds; read as text because a float cannot hold them.

    Raises:
        CorruptFile: If the text is something else, naming ``where``.
    """
    digits = text.strip()
    if not (digits.isascii() and digits.lstrip("-").isdigit()):
        raise CorruptFile(CodedText("samples-whole-ns", where=where, text=text[:80]))
    if len(digits) > 19 or not 0 <= int(digits) < 2**63:
        raise CorruptFile(CodedText("samples-time-range", where=where, digits=digits[:80]))
    return int(digits)


def csv_number(text: str, where: str) -> float:
    """A number with a decimal point or comma; NaN = the cell is empty.

    Raises:
        CorruptFile: If the text is something else, naming ``where``.
    """
    try:
        return parse_float(text.strip().replace(",", ".")) if text.strip() else math.nan
    except ValueError as error:
        raise CorruptFile(CodedText("samples-number", where=where, text=text[:80])) from error
