"""Control and check points: a survey's CSV, residuals, and whether they are within the limits."""

from __future__ import annotations

import csv
import io
import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Literal

import numpy as np

from recon4.errors import CorruptFile
from recon4.evaluation.markers import (
    MAX_HORIZONTAL_LIMIT_M,
    MAX_VERTICAL_LIMIT_M,
    MEAN_HORIZONTAL_LIMIT_M,
    MEAN_VERTICAL_LIMIT_M,
)
from recon4.geometry.se3 import Array

Role = Literal["control", "check"]
Order = Literal["EN", "NE"]
RELATIVE_LIMIT_M = 0.05
"""Distances between points of the map are off by no more than this (requirements, relative)."""
MOST_POINTS = 5000
_E = ("x", "e", "east", "easting", "x_m")
_N = ("y", "n", "north", "northing", "y_m")
_Z = ("z", "h", "u", "height", "elevation", "up", "z_m")
_ID = ("id", "name", "point", "nr", "no")


@dataclass(frozen=True, slots=True)
class ControlPoint:
    """A surveyed point."""

    id: str
    xyz_m: tuple[float, float, float]
    """Easting (or x), northing (or y), height [m]."""
    role: Role = "check"
    """Control points made the map; only check points say how good it is."""
    radius_m: float = 0.0
    """Of a spherical target [m]."""


@dataclass(frozen=True, slots=True)
class Preview:
    """What a file seems to hold, to be looked at before it counts."""

    points: tuple[ControlPoint, ...]
    delimiter: str
    decimal: str
    order: Order
    """Order of the first two coordinates in the file, as used."""
    question: str
    """What has to be decided by a person; empty = nothing."""
    skipped: tuple[str, ...]
    """Lines left out, with the reason."""


@dataclass(frozen=True, slots=True)
class Residual:
    """Map minus survey at one point."""

    id: str
    role: Role
    east_m: float
    north_m: float
    up_m: float
    d2_m: float
    d3_m: float


@dataclass(frozen=True, slots=True)
class Figures:
    """Residuals of one role taken together."""

    role: Role
    points: int
    rmse_m: tuple[float, float, float]
    """East, north, up."""
    mean_2d_m: float
    mean_up_m: float
    """Of ``|dU|``."""
    max_2d_m: float
    max_up_m: float
    rmse_3d_m: float
    relative_m: float
    """Largest error of the distance between two of the points; NaN with one point."""
    passed: dict[str, bool]
    """Limit in words -> whether it holds."""


@dataclass(frozen=True, slots=True)
class ControlReport:
    """The residual table."""

    rows: tuple[Residual, ...]
    missing: tuple[str, ...]
    """Points without a place in the map yet."""
    figures: tuple[Figures, ...]
    """Of check points, then of control points; a role without points is left out."""
    judged_by: Role | None
    """Whose limits decide; None = no point was measured."""


def read_control(data: bytes, *, name: str = "file", order: Order | None = None) -> Preview:
    """Read ``ID,X,Y,Z[,Radius]``, with or without a head line.

    A byte order mark, ``;`` or tabs, and decimal commas are understood.

    Args:
        data: The file's bytes.
        name: For messages.
        order: Which coordinate comes first; None = as the head says, else a question is asked.

    Raises:
        CorruptFile: If no line has an id and three numbers.
    """
    text = _decoded(data, name)
    sample = [line for line in text.splitlines() if line.strip()][:20]
    if not sample:
        raise CorruptFile(f"{name} is empty; expected lines of ID,X,Y,Z")
    delimiter = max((";", "\t", ","), key=lambda d: min(line.count(d) for line in sample))
    decimal = "," if delimiter != "," and any("," in line for line in sample) else "."
    rows = [row for row in csv.reader(io.StringIO(text), delimiter=delimiter)]
    head = [cell.strip().lower() for cell in rows[0]] if rows else []
    columns, named = _columns(head)
    points, skipped = _points(rows[1:] if named else rows, columns, decimal, first=1 + int(named))
    if not points:
        raise CorruptFile(
            f"{name}: no line of ID,X,Y,Z found; {skipped[0] if skipped else 'it has no lines'}"
        )
    known: Order | None = _order_of(head, columns) if named else None
    flip = order == "NE"
    question = "" if order or known else _question(points)
    return Preview(
        points=tuple(_flipped(p) for p in points) if flip else tuple(points),
        delimiter={"\t": "tab"}.get(delimiter, delimiter),
        decimal=decimal,
        order=order or "EN",
        question=question,
        skipped=tuple(skipped),
    )


def residuals(points: Sequence[ControlPoint], measured: Mapping[str, Array]) -> ControlReport:
    """The residual table, control and check points apart.

    Args:
        points: As surveyed.
        measured: Id -> place in the map, in the coordinates of the survey [m], (3,).
    """
    rows = tuple(_residual(p, measured[p.id]) for p in points if p.id in measured)
    figures = []
    for role in ("check", "control"):
        mine = [row for row in rows if row.role == role]
        if mine:
            figures.append(
                _figures(mine, [p for p in points if p.id in measured and p.role == role])
            )
    return ControlReport(
        rows=rows,
        missing=tuple(p.id for p in points if p.id not in measured),
        figures=tuple(figures),
        judged_by=figures[0].role if figures else None,
    )


def residual_csv(report: ControlReport) -> str:
    """The table in metres, with a line of RMSE and of the largest a role."""
    out = io.StringIO()
    rows = csv.writer(out, lineterminator="\n")
    rows.writerow(["id", "role", "dE_m", "dN_m", "dU_m", "d2D_m", "d3D_m"])
    for row in report.rows:
        values = (row.east_m, row.north_m, row.up_m, row.d2_m, row.d3_m)
        rows.writerow([safe_cell(row.id), row.role, *(f"{value:.4f}" for value in values)])
    for f in report.figures:
        rows.writerow(["RMSE", f.role, *(f"{v:.4f}" for v in f.rmse_m), "", f"{f.rmse_3d_m:.4f}"])
        rows.writerow(["max", f.role, "", "", f"{f.max_up_m:.4f}", f"{f.max_2d_m:.4f}", ""])
    return out.getvalue()


def safe_cell(text: str) -> str:
    """A cell no spreadsheet takes for a formula."""
    return f"'{text}" if text[:1] in ("=", "+", "-", "@", "\t", "\r") else text


def _decoded(data: bytes, name: str) -> str:
    if b"\0" in data[:4096]:
        raise CorruptFile(f"{name} is not text; expected CSV lines of ID,X,Y,Z")
    for encoding in ("utf-8-sig", "cp1252"):
        try:
            return data.decode(encoding)
        except UnicodeDecodeError:
            continue
    return data.decode("latin1")


def _columns(head: list[str]) -> tuple[tuple[int, ...], bool]:
    """Places of id, first, second coordinate, height, radius and role (-1 = none)."""

    def place(names: Sequence[str]) -> int:
        return next((k for k, cell in enumerate(head) if cell in names), -1)

    east, north, up = place(_E), place(_N), place(_Z)
    if min(east, north, up) >= 0:
        return (max(place(_ID), 0), east, north, up, place(("radius", "r")), place(("role",))), True
    width_known = len(head) > 4
    return (0, 1, 2, 3, 4 if width_known else -1, -1), not _number_at(head, 1)


def _number_at(row: list[str], place: int) -> bool:
    try:
        float(row[place].replace(",", "."))
    except (ValueError, IndexError):
        return False
    return True


def _order_of(head: list[str], columns: tuple[int, ...]) -> Order | None:
    """Known when the head names east and north; x and y mean either in surveys."""
    if head[columns[1]] in _E[1:5] and head[columns[2]] in _N[1:5]:
        return "EN"
    return None


def _points(
    rows: list[list[str]], columns: tuple[int, ...], decimal: str, *, first: int
) -> tuple[list[ControlPoint], list[str]]:
    points: dict[str, ControlPoint] = {}
    skipped: list[str] = []
    for line, row in enumerate(rows, start=first):
        if not any(cell.strip() for cell in row):
            continue
        try:
            point = _point(row, columns, decimal)
        except (ValueError, IndexError):
            skipped.append(f"line {line}: expected ID,X,Y,Z, got {';'.join(row)[:60]!r}")
            continue
        if point.id in points:
            skipped.append(f"line {line}: point {point.id[:40]!r} is there already")
        elif len(points) >= MOST_POINTS:
            skipped.append(f"line {line}: more than {MOST_POINTS} points")
            break
        else:
            points[point.id] = point
    return list(points.values()), skipped


def _point(row: list[str], columns: tuple[int, ...], decimal: str) -> ControlPoint:
    def number(place: int) -> float:
        text = row[place].strip().replace(" ", "").replace("\u202f", "")
        value = float(text.replace(",", ".") if decimal == "," else text)
        if not math.isfinite(value) or abs(value) > 1e8:
            raise ValueError(text)
        return value

    name, a, b, c, radius, role = columns
    words = row[role].strip().lower() if 0 <= role < len(row) else ""
    has_radius = 0 <= radius < len(row) and row[radius].strip()
    point_id = row[name].strip()[:64]
    if not point_id:
        raise ValueError("no id")
    return ControlPoint(
        point_id,
        (number(a), number(b), number(c)),
        "control" if words == "control" else "check",
        number(radius) if has_radius else 0.0,
    )


def _flipped(point: ControlPoint) -> ControlPoint:
    a, b, c = point.xyz_m
    return ControlPoint(point.id, (b, a, c), point.role, point.radius_m)


def _question(points: list[ControlPoint]) -> str:
    first = points[0]
    a, b, _ = first.xyz_m
    return f"Point {first.id}: is {a:.3f} the easting (x) and {b:.3f} the northing (y)?"


def _residual(point: ControlPoint, found_m: Array) -> Residual:
    east, north, up = (float(d) for d in np.asarray(found_m, dtype=np.float64) - point.xyz_m)
    d2 = math.hypot(east, north)
    return Residual(point.id, point.role, east, north, up, d2, math.hypot(d2, up))


def _figures(rows: list[Residual], points: list[ControlPoint]) -> Figures:
    d = np.array([(row.east_m, row.north_m, row.up_m) for row in rows])
    flat, up = np.hypot(d[:, 0], d[:, 1]), np.abs(d[:, 2])
    relative = _relative(np.array([p.xyz_m for p in points]), d)
    rmse = np.sqrt((d**2).mean(axis=0))
    passed = {
        "mean horizontal ≤ 14 cm": bool(flat.mean() <= MEAN_HORIZONTAL_LIMIT_M),
        "mean height ≤ 12 cm": bool(up.mean() <= MEAN_VERTICAL_LIMIT_M),
        "largest horizontal ≤ 28 cm": bool(flat.max() <= MAX_HORIZONTAL_LIMIT_M),
        "largest height ≤ 24 cm": bool(up.max() <= MAX_VERTICAL_LIMIT_M),
    }
    if math.isfinite(relative):
        passed["distances between points ≤ 5 cm"] = relative <= RELATIVE_LIMIT_M
    return Figures(
        role=rows[0].role,
        points=len(rows),
        rmse_m=(float(rmse[0]), float(rmse[1]), float(rmse[2])),
        mean_2d_m=float(flat.mean()),
        mean_up_m=float(up.mean()),
        max_2d_m=float(flat.max()),
        max_up_m=float(up.max()),
        rmse_3d_m=float(np.sqrt((d**2).sum(axis=1).mean())),
        relative_m=relative,
        passed=passed,
    )


def _relative(true_m: Array, d: Array) -> float:
    """Largest ``| |p_i - p_j| measured - surveyed |`` [m]; of at most 500 points."""
    true_m, d = true_m[:500], d[:500]
    if len(true_m) < 2:
        return float("nan")
    i, j = np.triu_indices(len(true_m), k=1)
    surveyed = np.linalg.norm(true_m[i] - true_m[j], axis=1)
    measured = np.linalg.norm((true_m + d)[i] - (true_m + d)[j], axis=1)
    return float(np.abs(measured - surveyed).max())
