"""Survey markers: errors of the map at control and check points (V §3.3, Table 3.3)."""

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

MEAN_HORIZONTAL_LIMIT_M = 0.14
MEAN_VERTICAL_LIMIT_M = 0.12
MAX_HORIZONTAL_LIMIT_M = 0.28
MAX_VERTICAL_LIMIT_M = 0.24


@dataclass(frozen=True, slots=True, eq=False)
class SurveyMarker:
    """A surveyed point."""

    name: str
    xyz_m: Array
    """East, north, up (or x, y, z of the map) [m], (3,)."""
    role: Role = "check"
    """Control points were used to make the map; only check points measure its accuracy."""


@dataclass(frozen=True, slots=True)
class MarkerRow:
    """One row of V Table 3.3, map minus reference."""

    name: str
    role: Role
    dx_m: float
    dy_m: float
    horizontal_m: float
    dz_m: float
    total_m: float


@dataclass(frozen=True, slots=True)
class MarkerTable:
    """Errors at the markers, compared with V's limits."""

    rows: tuple[MarkerRow, ...]
    missing: tuple[str, ...]
    """Markers of the reference that were not found in the map."""
    judged_by: Role
    """Role behind the figures below: check points if there are any."""
    mean_horizontal_m: float
    mean_vertical_m: float
    """Mean of ``|dz|`` [m]."""
    max_horizontal_m: float
    max_vertical_m: float

    @property
    def within_limits(self) -> bool:
        """Mean at most 14 cm horizontally and 12 cm in height, largest at most twice that."""
        return (
            self.mean_horizontal_m <= MEAN_HORIZONTAL_LIMIT_M
            and self.mean_vertical_m <= MEAN_VERTICAL_LIMIT_M
            and self.max_horizontal_m <= MAX_HORIZONTAL_LIMIT_M
            and self.max_vertical_m <= MAX_VERTICAL_LIMIT_M
        )


def compare_markers(measured: dict[str, Array], reference: tuple[SurveyMarker, ...]) -> MarkerTable:
    """Compare coordinates picked in the map with surveyed ones.

    Args:
        measured: Name -> coordinates in the frame of the reference [m], (3,).
        reference: The surveyed points.
    """
    rows = tuple(_row(m, measured[m.name]) for m in reference if m.name in measured)
    judged_by: Role = "check" if any(row.role == "check" for row in rows) else "control"
    judged = [row for row in rows if row.role == judged_by]
    horizontal = np.array([row.horizontal_m for row in judged] or [np.nan])
    vertical = np.abs([row.dz_m for row in judged] or [np.nan])
    return MarkerTable(
        rows=rows,
        missing=tuple(m.name for m in reference if m.name not in measured),
        judged_by=judged_by,
        mean_horizontal_m=float(horizontal.mean()),
        mean_vertical_m=float(vertical.mean()),
        max_horizontal_m=float(horizontal.max()),
        max_vertical_m=float(vertical.max()),
    )


def read_markers(path: Path) -> tuple[SurveyMarker, ...]:
    """Read a CSV of markers: columns ``name``, ``x_m``, ``y_m``, ``z_m``, optional ``role``.

    Raises:
        CorruptFile: Naming the line, what was expected and what was found.
    """
    try:
        rows = csv.DictReader(lines_limited(path, max_bytes=_MAX_BYTES))
        return tuple(_marker(row, f"{path.name} line {rows.line_num}") for row in rows)
    except csv.Error as error:
        raise CorruptFile(f"{path.name}: cannot be read as CSV: {error}") from error


def _marker(line: dict[str, str | None], where: str) -> SurveyMarker:
    try:
        xyz_m = np.array([parse_float(line[key] or "") for key in ("x_m", "y_m", "z_m")])
        name, role = line["name"] or "", line.get("role") or "check"
    except (KeyError, ValueError) as error:
        raise CorruptFile(
            f"{where}: expected name, x_m, y_m, z_m, got {str(line)[:200]}"
        ) from error
    if not name or role not in {"control", "check"} or not np.all(np.isfinite(xyz_m)):
        raise CorruptFile(
            f"{where}: expected a name, a role control or check and finite numbers, "
            f"got {str(line)[:200]}"
        )
    return SurveyMarker(name, xyz_m, "control" if role == "control" else "check")


def _row(marker: SurveyMarker, found_m: Array) -> MarkerRow:
    dx, dy, dz = (float(d) for d in np.asarray(found_m, dtype=np.float64) - marker.xyz_m)
    horizontal = float(np.hypot(dx, dy))
    return MarkerRow(
        marker.name, marker.role, dx, dy, horizontal, dz, float(np.hypot(horizontal, dz))
    )
