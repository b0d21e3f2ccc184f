"""IMU and GNSS samples as CSV files (``docs/recordings.md`` has the headers)."""

from __future__ import annotations

import csv
import math
from array import array
from collections.abc import Iterator
from pathlib import Path

import numpy as np

from recon4.bounded import lines_limited, parse_float
from recon4.errors import CorruptFile, EmptyRecording, RecordingError, UnknownFormat
from recon4.geometry.se3 import Array
from recon4.model.samples import GnssQuality, GnssSamples, ImuSamples
from recon4.model.trajectory import Times
from recon4.recording.report import ImportReport
from recon4.recording.samples.heights import STATED_COLUMNS, height_above_ellipsoid

IMU_HEADER = ("t_ns", "gx_rad_s", "gy_rad_s", "gz_rad_s", "ax_m_s2", "ay_m_s2", "az_m_s2")
GNSS_HEADER = (
    *("t_ns", "lat_deg", "lon_deg", "height_m", "sd_e_m", "sd_n_m", "sd_u_m", "quality"),
    *("roll_deg", "pitch_deg", "heading_deg"),
)
_OPTIONAL = {*IMU_HEADER[4:], *GNSS_HEADER[3:], *STATED_COLUMNS}
_SEPARATORS = ";\t,"
MAX_BYTES = 1 << 30
"""About ten million samples: an IMU of 400 Hz for seven hours."""
_MAX_LINE_BYTES = 16 * 1024


def read_imu_csv(path: Path) -> ImuSamples:
    """Read IMU samples; columns in any order, ``;`` and decimal commas welcome.

    Raises:
        CorruptFile: Naming the line and column of what is no number.
        UnknownFormat: If a column is missing.
        EmptyRecording: If there is no line under the header.
    """
    t_ns, columns = _read(path, IMU_HEADER)
    gyro = np.column_stack([columns[name] for name in IMU_HEADER[1:4]])
    accel = np.column_stack([columns[name] for name in IMU_HEADER[4:]])
    return ImuSamples(t_ns, gyro, accel)


def read_gnss_csv(path: Path, report: ImportReport | None = None) -> GnssSamples:
    """Read GNSS positions, and attitudes if there are; an empty cell is not measured.

    Heights come from the columns of `recon4.recording.samples.heights`.

    Args:
        path: The file.
        report: Gets the counts of heights of unknown kind; None = not wanted.

    Raises:
        CorruptFile, UnknownFormat, EmptyRecording: As `read_imu_csv`.
    """
    t_ns, columns = _read(path, (*GNSS_HEADER, *STATED_COLUMNS))
    lat, lon = columns["lat_deg"], columns["lon_deg"]
    outside = np.flatnonzero((np.abs(lat) > 90.0) | (np.abs(lon) > 360.0))
    if len(outside):
        row = int(outside[0])
        raise CorruptFile(
            f"{path.name}: sample {row + 1}: latitude and longitude must be in degrees, "
            f"got {lat[row]:g}, {lon[row]:g}"
        )
    quality = np.nan_to_num(columns["quality"], nan=float(GnssQuality.SINGLE))
    return GnssSamples(
        t_ns,
        np.deg2rad(lat),
        np.deg2rad(lon),
        height_above_ellipsoid(columns, report or ImportReport()),
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


def _lines(path: Path, *, max_bytes: int = MAX_BYTES) -> Iterator[str]:
    return lines_limited(path, max_bytes=max_bytes, max_line_bytes=_MAX_LINE_BYTES)


def _read(path: Path, known: tuple[str, ...]) -> tuple[Times, dict[str, Array]]:
    """Times and columns; a column that is not in the file is NaN."""
    lines = _lines(path)
    first = next(lines, "")
    header = _checked_header(first, known, path.name)
    at = [header.index(name) if name in header else -1 for name in known]
    times, values = array("q"), array("d")
    for number, row in _rows(lines, csv_separator(first), path.name):
        where = f"{path.name}: line {number}"
        if len(row) != len(header):
            raise CorruptFile(f"{where}: expected {len(header)} cells, got {len(row)}")
        times.append(csv_time(row[at[0]], where))
        values.extend(csv_number(row[k], where) if k >= 0 else math.nan for k in at[1:])
    if not times:
        raise EmptyRecording(f"{path.name}: no samples under the header")
    table = np.array(values, np.float64).reshape(len(times), -1)
    return np.array(times, np.int64), {name: table[:, k] for k, name in enumerate(known[1:])}


def _checked_header(line: str, known: tuple[str, ...], name: str) -> list[str]:
    if not line.strip():
        raise UnknownFormat(f"{name}: line 1 is empty; expected header: {','.join(known)}")
    header = _names(line)
    missing = [column for column in known if column not in header and column not in _OPTIONAL]
    if missing:
        raise UnknownFormat(
            f"{name}: missing columns {', '.join(missing)}; expected header: {','.join(known)}"
        )
    twice = sorted({column for column in known if header.count(column) > 1})
    if twice:
        raise UnknownFormat(f"{name}: line 1: expected each column once, got {twice} twice")
    return header


def _rows(lines: Iterator[str], separator: str, name: str) -> Iterator[tuple[int, list[str]]]:
    """Cells of each line that is not blank, with its number; a sample never spans lines."""
    for number, line in enumerate(lines, start=2):
        try:
            row = next(csv.reader([line.rstrip("\r\n")], delimiter=separator), [])
        except csv.Error as error:
            raise CorruptFile(f"{name}: line {number}: expected cells of a CSV: {error}") from error
        if any(row):
            yield number, row


def csv_time(text: str, where: str) -> int:
    """Whole nanoseconds; read as text because a float cannot hold them.

    Raises:
        CorruptFile: If the text is something else, naming ``where``.
    """
    digits = text.strip()
    if not (digits.isascii() and digits.lstrip("-").isdigit()):
        raise CorruptFile(f"{where}: t_ns must be whole nanoseconds, got {text[:80]!r}")
    if len(digits) > 19 or not 0 <= int(digits) < 2**63:
        raise CorruptFile(f"{where}: t_ns must be 0 to 2^63, got {digits[:80]}")
    return int(digits)


def csv_number(text: str, where: str) -> float:
    """A number with a decimal point or comma; NaN = the cell is empty.

    Raises:
        CorruptFile: If the text is something else, naming ``where``.
    """
    try:
        return parse_float(text.strip().replace(",", ".")) if text.strip() else math.nan
    except ValueError as error:
        raise CorruptFile(f"{where}: expected a number, got {text[:80]!r}") from error
