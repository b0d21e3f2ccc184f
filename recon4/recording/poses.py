"""Trajectories as text: TUM (with times) and KITTI (without)."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np

from recon4.errors import CorruptFile, EmptyRecording, UnknownFormat
from recon4.geometry.se3 import SE3, Array
from recon4.model.trajectory import Times, Trajectory

_SECONDS = re.compile(r"(-?)(\d+)(?:\.(\d*))?")
_ROTATION_TOLERANCE = 1e-2


def read_tum(path: Path) -> Trajectory:
    """Read lines of ``seconds x y z qx qy qz qw``; ``#`` starts a comment.

    Times are read as text: a float64 cannot hold nanoseconds since 1970.

    Raises:
        CorruptFile: Naming the line and what is wrong with it; also for times that do not increase.
        EmptyRecording: If there is no pose.
    """
    lines = _lines(path)
    values = _table(lines, 8, path.name)
    t_ns = np.array([_nanoseconds(words[0], n, path.name) for n, words in lines], np.int64)
    backwards = np.flatnonzero(np.diff(t_ns) <= 0)
    if len(backwards):
        raise CorruptFile(f"{path.name}: line {lines[backwards[0] + 1][0]}: times must increase")
    norms = np.linalg.norm(values[:, 4:], axis=1)
    bad = np.flatnonzero(np.abs(norms - 1.0) > _ROTATION_TOLERANCE)
    if len(bad):
        raise CorruptFile(
            f"{path.name}: line {lines[bad[0]][0]}: a quaternion has length 1, "
            f"got {norms[bad[0]]:.4g}"
        )
    return Trajectory(t_ns, SE3.from_quat(values[:, 4:], values[:, 1:4]))


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
    lines = _lines(path)
    values = _table(lines, 12, path.name)
    if len(values) != len(t_ns):
        raise CorruptFile(f"{path.name}: {len(t_ns)} poses expected, got {len(values)}")
    matrices = values.reshape(-1, 3, 4)
    R = matrices[..., :3]
    off = np.abs(R @ np.swapaxes(R, -1, -2) - np.eye(3)).max(axis=(1, 2))
    bad = np.flatnonzero((off > _ROTATION_TOLERANCE) | (np.linalg.det(R) < 0.0))
    if len(bad):
        raise CorruptFile(f"{path.name}: line {lines[bad[0]][0]}: not a rotation")
    return Trajectory(t_ns, SE3(R.copy(), matrices[..., 3].copy()))


def write_kitti(path: Path, trajectory: Trajectory) -> None:
    """Write the upper rows of the 4x4 matrices, twelve numbers a line, without times."""
    rows = trajectory.T_a_b.matrix()[:, :3].reshape(-1, 12)
    np.savetxt(path, rows, fmt="%.12g")


def pose_format(path: Path) -> str:
    """``tum`` or ``kitti`` by the number of words in the first line, or empty."""
    try:
        with path.open(encoding="ascii") as file:
            for _ in range(50):
                words = file.readline(4096).split("#")[0].split()
                if words:
                    [float(word) for word in words]
                    return {8: "tum", 12: "kitti"}.get(len(words), "")
    except (OSError, ValueError):
        return ""
    return ""


def _lines(path: Path) -> list[tuple[int, list[str]]]:
    """Words of each line with its number, without comments and blank lines."""
    try:
        text = path.read_text("ascii")
    except UnicodeDecodeError as error:
        raise UnknownFormat(f"{path.name}: expected a text file of poses: {error}") from error
    numbered = enumerate(text.splitlines(), start=1)
    lines = [(n, words) for n, line in numbered if (words := line.split("#")[0].split())]
    if not lines:
        raise EmptyRecording(f"{path.name}: no poses")
    return lines


def _table(lines: list[tuple[int, list[str]]], width: int, name: str) -> Array:
    rows = []
    for number, words in lines:
        if len(words) != width:
            raise CorruptFile(f"{name}: line {number}: {width} numbers expected, got {len(words)}")
        try:
            rows.append([float(word) for word in words])
        except ValueError as error:
            raise CorruptFile(f"{name}: line {number}: {error}") from error
    values = np.array(rows)
    bad = np.flatnonzero(~np.all(np.isfinite(values), axis=1))
    if len(bad):
        raise CorruptFile(f"{name}: line {lines[bad[0]][0]}: numbers must be finite")
    return values


def _nanoseconds(text: str, line: int, name: str) -> int:
    found = _SECONDS.fullmatch(text)
    if found is None:
        try:
            return round(float(text) * 1e9)
        except (ValueError, OverflowError) as error:
            raise CorruptFile(f"{name}: line {line}: no time: {text!r}") from error
    sign = -1 if found[1] else 1
    return sign * (int(found[2]) * 1_000_000_000 + int((found[3] or "").ljust(9, "0")[:9]))


def _seconds(t_ns: int) -> str:
    sign, size = ("-", -t_ns) if t_ns < 0 else ("", t_ns)
    return f"{sign}{size // 1_000_000_000}.{size % 1_000_000_000:09d}"
