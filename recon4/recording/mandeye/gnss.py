"""Files of positions of MANDEYE devices, ``gnssNNNN.gnss`` and ``gnssNNNN.nmea``.

A ``.gnss`` file has a line for each GGA sentence, without a head line: time on the clock of the
LiDARs [ns], latitude and longitude [deg], height above sea level [m], HDOP, satellites, geoid
separation [m], age of corrections, time of day, quality of the fix, and milliseconds since 1970.
A ``.nmea`` file has the sentences: time [ns], milliseconds since 1970, sentence. Both times are
those of arrival. Source: mandeye_controller, ``gnss.cpp``.
"""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np

from recon4.errors import CorruptFile
from recon4.model.samples import GnssQuality, GnssSamples
from recon4.recording.formats.damaged_lines import DamagedLines, wrong_row
from recon4.recording.mandeye.tuning import MANDEYE
from recon4.recording.packets.velodyne.position_packets import is_on_earth, parse_fix
from recon4.recording.report import ImportReport
from recon4.recording.samples.heights import height_of_gga
from recon4.untrusted.bounded import lines_limited, parse_float

_Row = tuple[int, float, float, float, int]
"""Time [ns], latitude, longitude [deg], ellipsoidal height [m], quality."""


def read_positions(path: Path, report: ImportReport) -> GnssSamples:
    """Read a file, in its order.

    Args:
        path: A ``.gnss`` file; any other ending = sentences.
        report: Receives the counts of positions, of damaged lines and of heights of unknown kind.

    Raises:
        CorruptFile: If too many lines are damaged.
    """
    damaged = DamagedLines(report, "gnss_lines_damaged")
    of_line = _row_of_cells if path.suffix.lower() == ".gnss" else _row_of_sentence
    rows: list[_Row] = []
    sound = 0
    for number, line in enumerate(
        lines_limited(path, max_bytes=MANDEYE.most_bytes, on_damaged=damaged.add), start=1
    ):
        if not line.strip():
            continue
        try:
            row = of_line(line, report)
        except (ValueError, IndexError) as error:
            damaged.add(CorruptFile(wrong_row(path.name, number, line, why=error)))
            continue
        sound += 1
        if row is not None:
            rows.append(row)
    damaged.finish(sound)
    report.count("gnss_samples", len(rows))
    return _samples(rows)


def _row_of_cells(line: str, report: ImportReport) -> _Row | None:
    cells = line.split()
    if len(cells) < MANDEYE.position_cells:
        raise ValueError(f"{MANDEYE.position_cells} cells or more, got {len(cells)}")
    lat_deg, lon_deg, altitude_m = (parse_float(cell) for cell in cells[1:4])
    stated = cells[MANDEYE.quality_cell : MANDEYE.quality_cell + 1]
    quality = int(stated[0]) if stated else int(GnssQuality.SINGLE)
    if quality not in set(GnssQuality):
        quality = int(GnssQuality.SINGLE)
    if quality == GnssQuality.INVALID or not math.isfinite(lat_deg + lon_deg):
        report.count("gnss_no_fix")
        return None
    if not is_on_earth(lat_deg, lon_deg):
        raise ValueError("no place on earth")
    separation_m = parse_float(cells[6])
    separation = separation_m if math.isfinite(separation_m) else ""
    height_m = math.nan
    if math.isfinite(altitude_m):  # else there is no height
        height_m = height_of_gga(altitude_m, separation, report)
    return _time_ns(cells[0]), lat_deg, lon_deg, height_m, quality


def _row_of_sentence(line: str, report: ImportReport) -> _Row | None:
    time, since_1970_ms, sentence = line.split(maxsplit=2)
    if sentence[3:6] != "GGA":
        return None
    near_ns = 1_000_000 * _whole(since_1970_ms, most=1e3 * MANDEYE.latest_s)
    fix = parse_fix(sentence.strip().encode(), near_ns, report)
    if fix is None:
        return None
    return _time_ns(time), fix.lat_deg, fix.lon_deg, fix.height_m, int(fix.quality)


def _time_ns(cell: str) -> int:
    return _whole(cell, most=1e9 * MANDEYE.latest_s)


def _whole(cell: str, *, most: float) -> int:
    """A time as a whole number."""
    if not (cell.isascii() and cell.isdigit() and len(cell) <= 19) or int(cell) >= most:
        raise ValueError("no time")
    return int(cell)


def _samples(rows: list[_Row]) -> GnssSamples:
    numbers = np.array([row[1:4] for row in rows], np.float64).reshape(-1, 3)
    nothing = np.full((len(rows), 3), np.nan)
    return GnssSamples(
        t_ns=np.array([row[0] for row in rows], np.int64),
        lat_rad=np.deg2rad(numbers[:, 0]),
        lon_rad=np.deg2rad(numbers[:, 1]),
        height_m=numbers[:, 2],
        sd_enu_m=nothing,
        quality=np.array([row[4] for row in rows], np.uint8),
        rpy_ned_rad=nothing,
    )
