"""Trajectories as text: TUM (with times) and KITTI (without)."""

from __future__ import annotations

import math
import re
from array import array
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from recon4.errors import CorruptFile, EmptyRecording
from recon4.geometry.se3 import SE3, Array
from recon4.locales.coded import CodedText
from recon4.model.trajectory import Times, Trajectory
from recon4.recording.clocks.stamps import strays
from recon4.recording.formats.damaged_lines import DamagedLines
from recon4.recording.report import ImportReport
from recon4.untrusted.bounded import lines_limited

_SECONDS = re.compile(r"([-+]?)([0-9]{1,19})(?:\.([0-9]*))?")
_ROTATION_TOLERANCE = 1e-2
_UNITS = ((1e17, 1), (1e14, 1_000), (1e11, 1_000_000))
"""From this value on a time is no number of seconds, which would be after the year 5000; ns in one
unit."""
_POSITION_NAMES = ("{}", "t{}", "p{}", "p_{}", "t_{}", "pos_{}", "position_{}", "p_rs_r_{}")
_TURN_NAMES = ("q{}", "q_{}", "orientation_{}", "rotation_{}", "q_rs_{}")
"""Forms of the names of an axis; the last ones are those of EuRoC."""
_TUM_NAMES = (
    ("timestamp", "time", "t", "stamp", "timestamp_s", "timestamp_ns", "time_ns", "t_ns"),
    *(tuple(form.format(a) for form in _POSITION_NAMES) for a in "xyz"),
    *(tuple(form.format(a) for form in _TURN_NAMES) for a in "xyzw"),
)
"""Names of the columns in a head line, in the order of the format."""
_TURNED, _LEVEL, _NOT_TURNED = 0.5, 0.2, 0.9999
"""Components of quaternions that a walk changes by much, and hardly at all."""
_MAX_BYTES = 1 << 30
_MAX_LINE_BYTES = 4096


def read_tum(path: Path, report: ImportReport | None = None) -> Trajectory:
    """Read lines of ``seconds x y z qx qy qz qw``; ``#`` starts a comment.

    A head line with the names of the columns, with or without ``#``, states their order. Times too
    large for seconds are milli-, micro- or nanoseconds. Times are read as text: a float64 cannot
    hold nanoseconds since 1970.

    Args:
        path: The file.
        report: Gets the counts of poses and of damaged lines, which are dropped; None = not wanted.

    Raises:
        CorruptFile: If too many lines are damaged, naming the first and what is wrong with it; a
            time that is not later than the one before is damage, too.
        EmptyRecording: If there is no pose.
    """
    report = report or ImportReport()
    damaged = DamagedLines(report, "poses_damaged")
    table = _Table.read(path, damaged)
    order = _tum_order(path)
    unit_ns = _unit_ns(float(np.median(table.values[:, order[0]]))) if len(table.values) else 1
    rows, times = [], []
    for row, values in enumerate(table.values[:, order]):
        where = table.where(row)
        try:
            _check_length(values[4:], where)
            times.append(_nanoseconds(table.first[row], unit_ns, where))
            rows.append(row)
        except CorruptFile as error:
            damaged.add(error)
    t_ns = np.array(times, np.int64)
    kept = _in_order(t_ns)
    for k in np.flatnonzero(~kept):
        damaged.add(CorruptFile(CodedText("pose-times", where=table.where(rows[k]))))
    damaged.finish(int(np.count_nonzero(kept)))
    report.count("poses", int(np.count_nonzero(kept)))
    values = table.values[np.array(rows, np.intp)[kept]][:, order]
    if not len(values):
        raise EmptyRecording(CodedText("poses-none", file=path.name))
    return Trajectory(t_ns[kept], SE3.from_quat(values[:, 4:], values[:, 1:4]))


def tum_hint(trajectory: Trajectory) -> str:
    """A sentence if the quaternions of a file seem to be written with ``qw`` first; else empty.

    A walk turns about the vertical: of qx, qy, qz, qw the first two stay small. With ``qw`` first
    the middle ones do, and the body seems to roll over. A LiDAR on its side really turns about its
    x axis; its odometry starts at the identity, which it would not with ``qw`` first.
    """
    size = np.abs(trajectory.T_a_b.quat_xyzw())
    if size[0, 3] > _NOT_TURNED:
        return ""
    spread = np.ptp(size, axis=0)
    usual = np.median(size, axis=0)
    middle_small = max(usual[1], usual[2]) < _LEVEL
    if middle_small and usual[0] > _LEVEL and spread[0] > _TURNED and spread[3] > _TURNED:
        return (
            "the body rolls over and never turns: is qw the first number of the quaternion? "
            "Expected qx qy qz qw; a head line '# timestamp tx ty tz qw qx qy qz' states the order"
        )
    return ""


def write_tum(path: Path, trajectory: Trajectory) -> None:
    """Write lines of ``seconds x y z qx qy qz qw``, 9 decimals each (12 for the quaternion)."""
    quat = trajectory.T_a_b.quat_xyzw()
    with path.open("w", encoding="ascii") as file:
        for t, p, q in zip(trajectory.t_ns.tolist(), trajectory.T_a_b.t, quat, strict=True):
            place = " ".join(f"{v:.9f}" for v in p)
            turn = " ".join(f"{v:.12f}" for v in q)
            file.write(f"{_seconds(t)} {place} {turn}\n")


def _check_length(quaternion: Array, where: str) -> None:
    norm = float(np.linalg.norm(quaternion))
    if not abs(norm - 1.0) <= _ROTATION_TOLERANCE:
        raise CorruptFile(CodedText("pose-quaternion", where=where, norm=norm))


def _in_order(t_ns: Times) -> NDArray[np.bool_]:
    """Which times are later than all before them, without single ones far from their neighbors."""
    kept = ~strays(t_ns)
    before = np.concatenate([[np.iinfo(np.int64).min], np.where(kept, t_ns, -(2**63))[:-1]])
    return np.asarray(kept & (t_ns > np.maximum.accumulate(before)))


def write_kitti(path: Path, trajectory: Trajectory) -> None:
    """Write the upper rows of the 4x4 matrices, twelve numbers a line, without times."""
    rows = trajectory.T_a_b.matrix()[:, :3].reshape(-1, 12)
    np.savetxt(path, rows, fmt="%.12g")


def pose_format(path: Path) -> str:
    """``tum`` or ``kitti`` by the number of columns in the first line, or empty."""
    try:
        with path.open(encoding="ascii") as file:
            for _ in range(50):
                cells = file.readline(4096).split("#")[0].replace(",", " ").split()
                if cells and _order_of(cells) is None:
                    [float(cell) for cell in cells]
                    return {8: "tum", 12: "kitti"}.get(len(cells), "")
    except (OSError, ValueError):
        return ""
    return ""


@dataclass(frozen=True, slots=True, eq=False)
class _Table:
    """The numbers of a text file of poses."""

    name: str
    first: list[str]
    """First word of each row, as text: a float64 cannot hold nanoseconds since 1970."""
    lines: array[int]
    """Line number of each row."""
    values: Array
    """(N, 8), finite."""

    @staticmethod
    def read(path: Path, damaged: DamagedLines) -> _Table:
        """Rows of eight numbers, separated by blanks or commas; ``#`` starts a comment.

        The first line may be names of columns.

        Raises:
            EmptyRecording: If there is no row.
        """
        first: list[str] = []
        lines, values = array("q"), array("d")
        for number, cells in _cells(path, damaged):
            if not first and _order_of(cells) is not None:
                continue
            try:
                values.extend(_numbers(cells, f"{path.name}: line {number}"))
            except CorruptFile as error:
                damaged.add(error)
                continue
            first.append(cells[0])
            lines.append(number)
        if not first:
            damaged.check(0)
            raise EmptyRecording(CodedText("poses-none", file=path.name))
        return _Table(path.name, first, lines, np.array(values).reshape(-1, 8))

    def where(self, row: int) -> str:
        """File and line of a row, for messages."""
        return f"{self.name}: line {self.lines[row]}"


def _numbers(cells: list[str], where: str) -> list[float]:
    try:
        if len(cells) != 8 or any("_" in cell for cell in cells):
            raise ValueError(f"{len(cells)} columns")
        row = [float(cell) for cell in cells]
    except ValueError as error:
        raise CorruptFile(
            CodedText("pose-numbers", where=where, count=len(cells), cells=" ".join(cells)[:80])
        ) from error
    if not all(map(math.isfinite, row)):
        raise CorruptFile(CodedText("pose-not-finite", where=where))
    return row


def _cells(path: Path, damaged: DamagedLines) -> Iterator[tuple[int, list[str]]]:
    """Words of each line with its number, without comments and blank lines."""
    lines = lines_limited(
        path, max_bytes=_MAX_BYTES, max_line_bytes=_MAX_LINE_BYTES, on_damaged=damaged.add
    )
    for number, line in enumerate(lines, start=1):
        cells = line.partition("#")[0].replace(",", " ").split()
        if cells:
            yield number, cells


def _tum_order(path: Path) -> list[int]:
    """Where time, x, y, z, qx, qy, qz, qw stand in a line, by the names above the first pose."""
    usual = list(range(8))
    for line in lines_limited(path, max_bytes=_MAX_BYTES, max_line_bytes=_MAX_LINE_BYTES):
        words = line.replace("#", " ").replace(",", " ").split()
        order = _order_of(words)
        if order is not None:
            return order
        if line.partition("#")[0].strip():
            break
    return usual


def _order_of(words: list[str]) -> list[int] | None:
    """Columns in the order of the format by their names; None = these are no names of columns."""
    names = [word.lower() for word in words if not word.startswith(("[", "("))]
    if len(names) != len(_TUM_NAMES):
        return None
    found = [[k for k, name in enumerate(names) if name in known] for known in _TUM_NAMES]
    order = [rows[0] for rows in found if len(rows) == 1]
    return order if len(order) == len(_TUM_NAMES) and order[0] == 0 else None


def _unit_ns(time: float) -> int:
    """Nanoseconds in the unit of a time."""
    return next((unit for least, unit in _UNITS if abs(time) >= least), 1_000_000_000)


def _nanoseconds(text: str, unit_ns: int, where: str) -> int:
    found = _SECONDS.fullmatch(text)
    digits = len(str(unit_ns)) - 1
    if found is None:
        t_ns = round(float(text) * unit_ns)
    else:
        sign = -1 if found[1] == "-" else 1
        part = int((found[3] or "").ljust(digits, "0")[:digits] or "0")
        t_ns = sign * (int(found[2]) * unit_ns + part)
    if not -(2**63) <= t_ns < 2**63:
        raise CorruptFile(CodedText("pose-time", where=where, text=text[:40]))
    return t_ns


def _seconds(t_ns: int) -> str:
    sign, size = ("-", -t_ns) if t_ns < 0 else ("", t_ns)
    return f"{sign}{size // 1_000_000_000}.{size % 1_000_000_000:09d}"
