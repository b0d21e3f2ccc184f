"""Trajectories as text: TUM (with times) and KITTI (without)."""

from __future__ import annotations

import re
from array import array
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from recon4.bounded import lines_limited
from recon4.errors import CorruptFile, EmptyRecording
from recon4.geometry.se3 import SE3, Array
from recon4.model.trajectory import Times, Trajectory

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
_TURNED, _LEVEL = 0.5, 0.2
"""Components of quaternions that a walk changes by much, and hardly at all."""
_MAX_BYTES = 1 << 30
_MAX_LINE_BYTES = 4096


def read_tum(path: Path) -> Trajectory:
    """Read lines of ``seconds x y z qx qy qz qw``; ``#`` starts a comment.

    A head line with the names of the columns, with or without ``#``, states their order. Times too
    large for seconds are milli-, micro- or nanoseconds. Times are read as text: a float64 cannot
    hold nanoseconds since 1970.

    Raises:
        CorruptFile: Naming the line and what is wrong with it; also for times that do not increase.
        EmptyRecording: If there is no pose.
    """
    table = _Table.read(path, width=8, head=True)
    values = table.values[:, _tum_order(path)]
    unit_ns = _unit_ns(values[0, 0])
    times = [_nanoseconds(text, unit_ns, table.where(row)) for row, text in enumerate(table.first)]
    t_ns = np.array(times, np.int64)
    backwards = np.flatnonzero(np.diff(t_ns) <= 0)
    if len(backwards):
        raise CorruptFile(f"{table.where(int(backwards[0]) + 1)}: times must increase")
    norms = np.linalg.norm(values[:, 4:], axis=1)
    bad = np.flatnonzero(np.abs(norms - 1.0) > _ROTATION_TOLERANCE)
    if len(bad):
        raise CorruptFile(
            f"{table.where(int(bad[0]))}: a quaternion has length 1, got {norms[bad[0]]:.4g}"
        )
    return Trajectory(t_ns, SE3.from_quat(values[:, 4:], values[:, 1:4]))


def tum_hint(trajectory: Trajectory) -> str:
    """A sentence if the quaternions of a file seem to be written with ``qw`` first; else empty.

    A walk turns about the vertical: of qx, qy, qz, qw the first two stay small. With ``qw`` first
    the middle ones do, and the body seems to roll over.
    """
    size = np.abs(trajectory.T_a_b.quat_xyzw())
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


def read_kitti(path: Path, t_ns: Times) -> Trajectory:
    """Read lines of twelve numbers, the upper rows of 4x4 matrices.

    Args:
        path: The file.
        t_ns: The times that the file does not hold [ns], as many as lines.

    Raises:
        CorruptFile: Naming the line and what is wrong with it.
        EmptyRecording: If there is no pose.
    """
    table = _Table.read(path, width=12)
    values = table.values
    if len(values) != len(t_ns):
        raise CorruptFile(f"{path.name}: {len(t_ns)} poses expected, got {len(values)}")
    matrices = values.reshape(-1, 3, 4)
    R = matrices[..., :3]
    off = np.abs(R @ np.swapaxes(R, -1, -2) - np.eye(3)).max(axis=(1, 2))
    bad = np.flatnonzero((off > _ROTATION_TOLERANCE) | (np.linalg.det(R) < 0.0))
    if len(bad):
        raise CorruptFile(f"{table.where(int(bad[0]))}: not a rotation")
    return Trajectory(t_ns, SE3(R.copy(), matrices[..., 3].copy()))


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
    """(N, width), finite."""

    @staticmethod
    def read(path: Path, *, width: int, head: bool = False) -> _Table:
        """Rows of ``width`` numbers, separated by blanks or commas; ``#`` starts a comment.

        With ``head`` the first line may be names of columns.

        Raises:
            CorruptFile: Naming the line, what was expected and what was found.
            EmptyRecording: If there is no row.
        """
        first: list[str] = []
        lines, values = array("q"), array("d")
        for number, cells in _cells(path):
            if head and not first and _order_of(cells) is not None:
                continue
            try:
                if len(cells) != width or any("_" in cell for cell in cells):
                    raise ValueError(f"{len(cells)} columns")
                row = [float(cell) for cell in cells]
            except ValueError as error:
                raise CorruptFile(
                    f"{path.name}: line {number}: expected {width} numbers, got {len(cells)}: "
                    f"{' '.join(cells)[:80]!r}"
                ) from error
            first.append(cells[0])
            lines.append(number)
            values.extend(row)
        if not first:
            raise EmptyRecording(f"{path.name}: no poses")
        table = _Table(path.name, first, lines, np.array(values).reshape(-1, width))
        bad = np.flatnonzero(~np.all(np.isfinite(table.values), axis=1))
        if len(bad):
            raise CorruptFile(
                f"{table.where(int(bad[0]))}: expected finite numbers, got one that is not"
            )
        return table

    def where(self, row: int) -> str:
        """File and line of a row, for messages."""
        return f"{self.name}: line {self.lines[row]}"


def _cells(path: Path) -> Iterator[tuple[int, list[str]]]:
    """Words of each line with its number, without comments and blank lines."""
    lines = lines_limited(path, max_bytes=_MAX_BYTES, max_line_bytes=_MAX_LINE_BYTES)
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
        raise CorruptFile(f"{where}: expected a time within 292 years of 1970, got {text[:40]} s")
    return t_ns


def _seconds(t_ns: int) -> str:
    sign, size = ("-", -t_ns) if t_ns < 0 else ("", t_ns)
    return f"{sign}{size // 1_000_000_000}.{size % 1_000_000_000:09d}"
