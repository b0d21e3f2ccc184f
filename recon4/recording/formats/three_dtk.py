"""Scans of 3DTK (``scan000.3d`` with ``scan000.pose``): text, in centimeters, left-handed.

Its axes are x to the right, y up, z ahead; ours x ahead, y to the left, z up. A pose file has the
position and the Euler angles about x, y and z in degrees, ``R = R_x R_y R_z`` (format ``uos``; with
a fourth column for the reflectance ``uosr``). The first line of a scan may state its resolution.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from recon4.errors import CorruptFile
from recon4.geometry.se3 import SE3, Array
from recon4.locales.coded import CodedText, at
from recon4.untrusted.bounded import parse_float, read_text_limited, text_blocks

SCAN_SUFFIX, POSE_SUFFIX, FRAMES_SUFFIX = ".3d", ".pose", ".frames"
MAX_SCAN_BYTES = 1 << 30
_MAX_POSE_BYTES = 4096
_BLOCK_BYTES = 16 << 20
_CM = 100.0
_AXES: Array = np.array([[0.0, -1.0, 0.0], [0.0, 0.0, 1.0], [1.0, 0.0, 0.0]])
"""``p_3dtk = 100 _AXES p``; a reflection."""


def read_scan(path: Path) -> dict[str, NDArray[Any]]:
    """Read a scan as named columns: x, y, z [m] in our axes, and ``intensity`` if it is there.

    Raises:
        CorruptFile: Naming the line that is not three to six finite numbers.
    """
    parts: list[Array] = []
    line, width = 1, 0
    for text in text_blocks(path, block_bytes=_BLOCK_BYTES, max_bytes=MAX_SCAN_BYTES):
        lines = text.splitlines()
        skipped = 1 if line == 1 and lines and _is_resolution(lines) else 0
        lines, line = lines[skipped:], line + skipped
        if not lines:
            continue
        if not width:
            width = _width(lines[0], f"{path.name}: line {line}")
        parts.append(_rows(lines, width, f"{path.name}: line", first=line))
        line += len(lines)
    table = np.concatenate(parts or [np.empty((0, 3))])
    xyz = table[:, :3] @ _AXES / _CM
    columns: dict[str, NDArray[Any]] = {a: xyz[:, k].copy() for k, a in enumerate("xyz")}
    if table.shape[1] == 4:
        columns["intensity"] = table[:, 3].copy()
    return columns


def scan_fields(path: Path) -> tuple[str, ...]:
    """Names of the columns, from the second line."""
    with path.open("rb") as file:
        file.readline(4096)
        words = file.readline(4096).split()
    return ("x", "y", "z", "intensity") if len(words) == 4 else ("x", "y", "z")


def read_pose(path: Path) -> SE3:
    """Read a pose ``T_map_scan`` in our axes.

    Raises:
        CorruptFile: If it is not six finite numbers.
    """
    words = read_text_limited(path, _MAX_POSE_BYTES).split()
    try:
        values = np.array([parse_float(word) for word in words])
    except ValueError as error:
        raise CorruptFile(at(path.name, str(error))) from error
    if len(values) != 6 or not np.isfinite(values).all():
        raise CorruptFile(CodedText("three-dtk-pose", file=path.name, words=str(words[:8])))
    rx, ry, rz = np.radians(values[3:])
    R = _about(0, rx) @ _about(1, ry) @ _about(2, rz)
    return SE3(_AXES.T @ R @ _AXES, _AXES.T @ values[:3] / _CM)


def write_scan(path: Path, p_scan: Array, intensity: NDArray[Any]) -> None:
    """Write points [m], (N, 3), with their intensities, (N,), as format ``uosr``."""
    np.savetxt(path, np.column_stack([_CM * p_scan @ _AXES.T, intensity]), fmt="%.2f %.2f %.2f %g")


def write_pose(path: Path, T_map_scan: SE3) -> None:
    """Write the pose of a scan, and the same as its only line of ``.frames`` for the viewer."""
    R, t = _AXES @ T_map_scan.R @ _AXES.T, _CM * _AXES @ T_map_scan.t
    ry = np.arcsin(np.clip(R[0, 2], -1.0, 1.0))
    rx, rz = np.arctan2(-R[1, 2], R[2, 2]), np.arctan2(-R[0, 1], R[0, 0])
    angles = np.degrees([rx, ry, rz])
    path.write_text(f"{_numbers(t)}\n{_numbers(angles)}\n", "ascii")
    matrix = np.eye(4)
    matrix[:3, :3], matrix[:3, 3] = R, t
    path.with_suffix(FRAMES_SUFFIX).write_text(f"{_numbers(matrix.T.ravel())} 2\n", "ascii")


def _is_resolution(lines: list[str]) -> bool:
    """Whether the first line is no point: words, or two numbers before lines of more."""
    second = lines[1].split() if len(lines) > 1 else []
    try:
        [float(word) for word in lines[0].split()]
    except ValueError:
        return True
    return len(lines[0].split()) == 2 < len(second)


def _width(line: str, where: str) -> int:
    width = len(line.split())
    if not 3 <= width <= 6:
        raise CorruptFile(CodedText("three-dtk-line", where=where, line=line[:60]))
    return width


def _rows(lines: list[str], width: int, where: str, *, first: int) -> Array:
    values = np.empty((len(lines), width))
    for row, text in enumerate(lines):
        try:
            values[row] = [float(word) for word in text.split()]
        except ValueError:
            place = f"{where} {first + row}"
            wrong = CodedText("three-dtk-row", where=place, width=width, line=text[:60])
            raise CorruptFile(wrong) from None
    return values


def _about(axis: int, angle: float) -> Array:
    a, b = (axis + 1) % 3, (axis + 2) % 3
    R = np.eye(3)
    R[a, a] = R[b, b] = np.cos(angle)
    R[a, b], R[b, a] = -np.sin(angle), np.sin(angle)
    return R


def _numbers(values: Array) -> str:
    return " ".join(f"{value:.9g}" for value in values)
