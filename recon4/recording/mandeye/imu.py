"""IMU files of MANDEYE devices, ``imuNNNN.csv``.

Columns are ``timestamp gyroX gyroY gyroZ accX accY accZ imuId timestampUnix``: nanoseconds, rad/s
and g. Older files have no head line, and lack the last ones; blanks, commas, semicolons and tabs
separate.
"""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from recon4.errors import CorruptFile
from recon4.locales.coded import CodedText
from recon4.model.derived_kinds import DerivedKind
from recon4.model.samples import ImuSamples
from recon4.recording.formats.damaged_lines import DamagedLines, wrong_row
from recon4.recording.mandeye.tuning import MANDEYE
from recon4.recording.report import ImportReport
from recon4.units import STANDARD_GRAVITY_M_S2
from recon4.untrusted.bounded import lines_limited, parse_float

COLUMNS = ("timestamp", "gyrox", "gyroy", "gyroz", "accx", "accy", "accz", "imuid", "timestampunix")
"""In the order of files without a head line."""
NEEDED = COLUMNS[:7]
_SEPARATORS = re.compile(r"[\s,;]+")


@dataclass(frozen=True, slots=True)
class ImuFile:
    """The samples of a file."""

    samples: ImuSamples
    """In the order of the file; accelerations [m/s²]."""
    ids: tuple[int, ...]
    """LiDAR whose IMU measured each; empty = not stated."""

    def of(self, lidar: int) -> ImuSamples:
        """The samples of the IMU of one LiDAR; all, if the file does not say."""
        if not self.ids:
            return self.samples
        rows = np.array(self.ids) == lidar
        s = self.samples
        return ImuSamples(s.t_ns[rows], s.gyro_rad_s[rows], s.accel_m_s2[rows])


def read_imu(path: Path, report: ImportReport) -> ImuFile:
    """Read a file.

    Args:
        path: The file.
        report: Receives the count of damaged lines, and a remark if accelerations are not in g.

    Raises:
        CorruptFile: If a column is missing, or too many lines are damaged.
    """
    damaged = DamagedLines(report, "imu_lines_damaged")
    places: Mapping[str, int] = {}
    rows: list[tuple[int, float, float, float, float, float, float, int]] = []
    for number, line in enumerate(
        lines_limited(path, max_bytes=MANDEYE.most_bytes, on_damaged=damaged.add), start=1
    ):
        cells = [cell for cell in _SEPARATORS.split(line.strip()) if cell]
        if not cells:
            continue
        if not places:
            places = _places(cells, path.name)
            if cells[places["timestamp"]].lower() == "timestamp":
                continue
        try:
            rows.append(_row(cells, places))
        except (ValueError, IndexError):
            what = CodedText("cells-few", least=len(NEEDED))
            damaged.add(CorruptFile(wrong_row(path.name, number, line, why=what)))
    damaged.finish(len(rows))
    return _joined(rows, path.name, report, has_ids="imuid" in places)


def _places(cells: Sequence[str], name: str) -> Mapping[str, int]:
    """Column of each name, by a head line or by the usual order."""
    named = {cell.lower(): k for k, cell in enumerate(cells)}
    if "timestamp" in named:
        if missing := [column for column in NEEDED if column not in named]:
            raise CorruptFile(
                CodedText(
                    "mandeye-columns", name=name, needed=", ".join(NEEDED), missing=missing[0]
                )
            )
        return named
    return {column: k for k, column in enumerate(COLUMNS[: max(len(NEEDED), len(cells))])}


def _row(
    cells: Sequence[str], places: Mapping[str, int]
) -> tuple[int, float, float, float, float, float, float, int]:
    text = cells[places["timestamp"]]
    time = int(text) if text.isascii() and text.isdigit() else parse_float(text)
    if not 0 <= time < MANDEYE.latest_s * 1e9:  # infinity and NaN are no times
        raise ValueError("no time")
    t_ns = round(time)
    wx, wy, wz, ax, ay, az = (parse_float(cells[places[column]]) for column in NEEDED[1:])
    identity = int(cells[places["imuid"]]) if "imuid" in places else 0
    return t_ns, wx, wy, wz, ax, ay, az, identity


def _joined(
    rows: Sequence[tuple[int, float, float, float, float, float, float, int]],
    name: str,
    report: ImportReport,
    *,
    has_ids: bool,
) -> ImuFile:
    sound = [row for row in rows if row[0] > 0]  # 0 = the clock was not set yet
    report.count("imu_wrong_time", len(rows) - len(sound))
    numbers = np.array([row[1:7] for row in sound], np.float64).reshape(-1, 6)
    lengths = np.linalg.norm(numbers[:, 3:], axis=1)
    usual = float(np.nanmedian(lengths)) if len(lengths) and np.isfinite(lengths).any() else 0.0
    unit = STANDARD_GRAVITY_M_S2 if usual < MANDEYE.most_g else 1.0
    if unit == 1.0:
        report.derive(DerivedKind.FORCES_UNIT, usual=usual, name=name)
    t_ns = np.array([row[0] for row in sound], np.int64)
    samples = ImuSamples(t_ns, numbers[:, :3], numbers[:, 3:] * unit)
    return ImuFile(samples, tuple(row[7] for row in sound) if has_ids else ())
