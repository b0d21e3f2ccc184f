"""Control and check points: reader of survey CSV files."""

from __future__ import annotations

import csv
import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Literal

from recon4.bounded import parse_float
from recon4.errors import ConfigError, CorruptFile
from recon4.names import check_name

Role = Literal["control", "check"]
AxisOrder = Literal["EN", "NE"]
MAX_POINTS = 5000
MAX_BYTES = 4 << 20
_MAX_SKIPPED = 100
"""Largest number of skipped lines listed individually."""
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
    """Control points were used to make the map; only check points measure its accuracy."""
    radius_m: float = 0.0
    """Radius of a spherical target [m]."""


@dataclass(frozen=True, slots=True)
class ControlPreview:
    """Content of a survey file, to be confirmed before it is stored."""

    points: tuple[ControlPoint, ...]
    delimiter: str
    decimal: str
    order: AxisOrder
    """Order of the first two coordinates in the file, as used."""
    question: str
    """Question to the operator; empty = none."""
    skipped: tuple[str, ...]
    """Skipped lines, with the reason."""


def read_control(
    data: bytes, *, name: str = "file", order: AxisOrder | None = None
) -> ControlPreview:
    """Read ``ID,X,Y,Z[,Radius]``, with or without a header line.

    A byte order mark, ``;`` or tabs, and decimal commas are accepted.

    Args:
        data: The file's bytes.
        name: For messages.
        order: Which coordinate comes first; None = from the header, else a question is returned.

    Raises:
        CorruptFile: If no line has an id and three numbers.
    """
    if len(data) > MAX_BYTES:
        raise CorruptFile(f"{name}: expected at most {MAX_BYTES} bytes, got {len(data)}")
    text = _decoded(data, name)
    sample = [line for line in text.splitlines() if line.strip()][:20]
    if not sample:
        raise CorruptFile(f"{name} is empty; expected lines of ID,X,Y,Z")
    delimiter = max((";", "\t", ","), key=lambda d: min(line.count(d) for line in sample))
    decimal = "," if delimiter != "," and any("," in line for line in sample) else "."
    rows = _cells(text, delimiter, name)
    head = [cell.strip().lower() for cell in rows[0]] if rows else []
    columns, named = _columns(head)
    points, skipped = _points(rows[1:] if named else rows, columns, decimal, first=1 + int(named))
    if not points:
        raise CorruptFile(
            f"{name}: no line of ID,X,Y,Z found; {skipped[0] if skipped else 'it has no lines'}"
        )
    known: AxisOrder | None = _order_of(head, columns) if named else None
    flip = order == "NE"
    question = "" if order or known else _question(points)
    return ControlPreview(
        points=tuple(_flipped(p) for p in points) if flip else tuple(points),
        delimiter={"\t": "tab"}.get(delimiter, delimiter),
        decimal=decimal,
        order=order or "EN",
        question=question,
        skipped=tuple(skipped),
    )


def _cells(text: str, delimiter: str, name: str) -> list[list[str]]:
    """Rows of cells; any line ending is accepted."""
    lines = text.replace("\r\n", "\n").replace("\r", "\n").split("\n")
    rows: list[list[str]] = []
    try:
        rows.extend(next(csv.reader([line], delimiter=delimiter), []) for line in lines)
    except csv.Error as error:
        raise CorruptFile(f"{name}: line {len(rows) + 1}: expected CSV cells: {error}") from error
    return rows


def _decoded(data: bytes, name: str) -> str:
    if b"\0" in data:
        line = data.count(b"\n", 0, data.index(b"\0")) + 1
        raise CorruptFile(
            f"{name}: line {line}: expected text, CSV lines of ID,X,Y,Z, got a NUL byte "
            "(a file in UTF-16? save it as UTF-8)"
        )
    for encoding in ("utf-8-sig", "cp1252"):
        try:
            return data.decode(encoding)
        except UnicodeDecodeError:
            continue
    return data.decode("latin1")


def _columns(head: list[str]) -> tuple[tuple[int, ...], bool]:
    """Columns of id, first, second coordinate, height, radius and role (-1 = none)."""

    def place(names: Sequence[str]) -> int:
        return next((k for k, cell in enumerate(head) if cell in names), -1)

    east, north, up = place(_E), place(_N), place(_Z)
    if min(east, north, up) >= 0:
        return (max(place(_ID), 0), east, north, up, place(("radius", "r")), place(("role",))), True
    width_known = len(head) > 4
    return (0, 1, 2, 3, 4 if width_known else -1, -1), not _number_at(head, 1)


def _number_at(row: list[str], place: int) -> bool:
    try:
        parse_float(row[place].replace(",", "."))
    except (ValueError, IndexError):
        return False
    return True


def _order_of(head: list[str], columns: tuple[int, ...]) -> AxisOrder | None:
    """Order of the coordinates if the header names east and north; x and y are ambiguous."""
    if (
        max(columns[1:3]) < len(head)
        and head[columns[1]] in _E[1:5]
        and head[columns[2]] in _N[1:5]
    ):
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
        except ConfigError as error:
            skipped.append(f"line {line}: {error}")
            continue
        except (ValueError, IndexError):
            skipped.append(f"line {line}: expected ID,X,Y,Z, got {';'.join(row)[:60]!r}")
            continue
        if point.id in points:
            skipped.append(f"line {line}: point {point.id[:40]!r} is there already")
        elif len(points) >= MAX_POINTS:
            skipped.append(f"line {line}: more than {MAX_POINTS} points")
            break
        else:
            points[point.id] = point
    more = len(skipped) - _MAX_SKIPPED
    return list(points.values()), skipped[:_MAX_SKIPPED] + [f"{more} more lines"] * (more > 0)


def _point(row: list[str], columns: tuple[int, ...], decimal: str) -> ControlPoint:
    def number(place: int) -> float:
        text = row[place].strip().replace(" ", "").replace("\u202f", "")
        value = parse_float(text.replace(",", ".") if decimal == "," else text)
        if not math.isfinite(value) or abs(value) > 1e8:
            raise ValueError(text)
        return value

    name, a, b, c, radius, role = columns
    role_text = row[role].strip().lower() if 0 <= role < len(row) else ""
    has_radius = 0 <= radius < len(row) and row[radius].strip()
    point_id = check_name(row[name].strip(), what="the id of a point", most=64)
    if not point_id:
        raise ValueError("no id")
    return ControlPoint(
        point_id,
        (number(a), number(b), number(c)),
        "control" if role_text == "control" else "check",
        number(radius) if has_radius else 0.0,
    )


def _flipped(point: ControlPoint) -> ControlPoint:
    a, b, c = point.xyz_m
    return ControlPoint(point.id, (b, a, c), point.role, point.radius_m)


def _question(points: list[ControlPoint]) -> str:
    first = points[0]
    a, b, _ = first.xyz_m
    return f"Point {first.id}: is {a:.3f} the easting (x) and {b:.3f} the northing (y)?"
