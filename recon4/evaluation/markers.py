"""Survey markers: tables of surveyed points, and of where they were found in the map."""

from __future__ import annotations

import csv
from dataclasses import dataclass
from pathlib import Path
from typing import Literal

import numpy as np

from recon4.bounded import lines_limited, parse_float
from recon4.errors import CorruptFile
from recon4.geometry.se3 import Array

Role = Literal["control", "check"]
_MAX_BYTES = 16 << 20

NOT_MEASURED = ("", "-", "–")
"""Cells of a coordinate that was not measured."""


@dataclass(frozen=True, slots=True, eq=False)
class SurveyMarker:
    """A surveyed point."""

    name: str
    xyz_m: Array
    """East, north, up (or x, y, z of the map) [m], (3,); NaN = not measured."""
    role: Role = "check"
    """Control points were used to make the map; only check points measure its accuracy."""


def read_markers(path: Path, *, partial: bool = False) -> tuple[SurveyMarker, ...]:
    """Read a CSV of markers: columns ``name``, ``x_m``, ``y_m``, ``z_m``, optional ``role``.

    Args:
        path: The file.
        partial: Whether coordinates may be missing: an empty cell or a dash = not measured.

    Raises:
        CorruptFile: Naming the line, what was expected and what was found.
    """
    try:
        rows = csv.DictReader(lines_limited(path, max_bytes=_MAX_BYTES))
        return tuple(
            _marker(row, f"{path.name} line {rows.line_num}", partial=partial) for row in rows
        )
    except csv.Error as error:
        raise CorruptFile(f"{path.name}: cannot be read as CSV: {error}") from error


def _marker(line: dict[str, str | None], where: str, *, partial: bool) -> SurveyMarker:
    try:
        xyz_m = np.array([_coordinate(line[key], partial=partial) for key in ("x_m", "y_m", "z_m")])
        name, role = line["name"] or "", line.get("role") or "check"
    except (KeyError, ValueError) as error:
        raise CorruptFile(
            f"{where}: expected name, x_m, y_m, z_m, got {str(line)[:200]}"
        ) from error
    if not name or role not in {"control", "check"} or np.isnan(xyz_m).all():
        raise CorruptFile(
            f"{where}: expected a name, a role control or check and finite numbers, "
            f"got {str(line)[:200]}"
        )
    return SurveyMarker(name, xyz_m, "control" if role == "control" else "check")


def _coordinate(cell: str | None, *, partial: bool) -> float:
    text = (cell or "").strip()
    if partial and cell is not None and text in NOT_MEASURED:
        return float("nan")
    value = parse_float(text)
    if not np.isfinite(value):
        raise ValueError(text)
    return value
