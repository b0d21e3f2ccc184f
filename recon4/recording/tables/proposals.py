"""What the columns of a table are taken for: by their names, or by their order."""

from __future__ import annotations

from typing import Literal

from recon4.recording.tables.column_names import (
    COVARIANCES,
    ROLES,
    SIGMAS,
    ColumnName,
    Meaning,
    plain_word,
)
from recon4.recording.tables.layout import TableLayout, is_number

Purpose = Literal["cloud", "survey", "markers"]
"""Of a table: points alone; named points, whose x and y a person confirms; named points of two
tables alike, whose names x and y are enough."""
AXIS_NAMES: dict[str, str] = {"x": "x (east)", "y": "y (north)", "z": "z (height)"}
_BESIDES: tuple[Meaning, ...] = ("id", "role", "radius", *SIGMAS, *COVARIANCES)


def columns_by_name(names: list[ColumnName]) -> tuple[tuple[Meaning, ...], str]:
    """Columns by their names, and what remains open."""

    def rows(meaning: Meaning, family: str | None = None) -> list[int]:
        return [
            k
            for k, name in enumerate(names)
            if name.meaning == meaning and family in (None, name.family)
        ]

    xy, en = (rows("x", "xy"), rows("y", "xy")), (rows("x", "en"), rows("y", "en"))
    degrees = (rows("lon"), rows("lat"))
    pairs = [pair for pair in (xy, en) if all(pair)] or [pair for pair in (degrees,) if all(pair)]
    heights = rows("z", "xy") if all(xy) and rows("z", "xy") else rows("z")
    first, second = pairs[0] if pairs else ([], [])
    axes: tuple[Meaning, Meaning] = ("lon", "lat") if (first, second) == degrees else ("x", "y")
    columns: list[Meaning] = ["-"] * len(names)
    taken: tuple[tuple[Meaning, list[int]], ...] = (
        *((meaning, rows(meaning)) for meaning in _BESIDES),
        (axes[0], first),
        (axes[1], second),
        ("z", heights),
    )
    for meaning, found in taken:
        if found:
            columns[found[0]] = meaning
    for whole in (SIGMAS, COVARIANCES):
        if not {*whole} <= {*columns}:  # "SN" alone is a serial number
            columns = ["-" if one in whole else one for one in columns]
    missing = [
        AXIS_NAMES[m] for m, found in zip("xyz", (first, second, heights), strict=True) if not found
    ]
    if missing:
        return tuple(columns), f"no column is named as {' or '.join(missing)}."
    if len(pairs) > 1:
        return tuple(columns), "there are columns x, y and columns east, north."
    if any(len(found) > 1 for found in (first, second, heights)):
        return tuple(columns), "several columns have names of one coordinate."
    return tuple(columns), ""


def columns_by_order(layout: TableLayout, *, purpose: Purpose) -> tuple[tuple[Meaning, ...], str]:
    """Columns of a table without names: x, y, z first, unless the first one is an id."""
    rest = max(0, layout.width - 3)
    unused: tuple[Meaning, ...] = ("-",)
    plain: tuple[Meaning, ...] = ("x", "y", "z", *unused * rest)
    named: tuple[Meaning, ...] = ("id", "x", "y", "z", *unused * (rest - 1))
    if purpose != "cloud" and all(_has_decimals(row[0]) for row in layout.rows):
        named = _with_later_id(plain, layout)
    if layout.stray_head:
        columns = named if rest and (purpose != "cloud" or _is_id(layout)) else plain
        return columns, f"the line {layout.stray_head[:60]!r} does not name each column."
    if purpose != "cloud":
        # name, x, y, z, and the radius of a target or its role
        if layout.width != 5 or named[0] != "id":
            return named, ""
        return (*named[:4], "radius" if is_number(layout.rows[0][4]) else "role"), ""
    if rest and _is_id(layout):
        return named, "no column has a name, and the first one is like a point number."
    if rest and all(_is_whole(cell) for row in layout.rows for cell in row if is_number(cell)):
        return plain, "no column has a name, and all numbers are whole."
    return plain, ""


def with_id(columns: tuple[Meaning, ...]) -> tuple[Meaning, ...]:
    """The columns with the first unused one as the names of the points."""
    at = columns.index("-") if "-" in columns else -1
    return tuple("id" if k == at else meaning for k, meaning in enumerate(columns))


def _with_later_id(columns: tuple[Meaning, ...], layout: TableLayout) -> tuple[Meaning, ...]:
    """x, y, z with the last column whose texts each stand for one place as names, if there is one.

    So are lists of points in images, as of OpenDroneMap: x, y, z, pixel, image, name.
    """
    places = [row[:3] for row in layout.rows]
    for at in range(layout.width - 1, 2, -1):
        names = [row[at] if at < len(row) else "" for row in layout.rows]
        one_to_one = len({*names}) == len({*places}) == len({*zip(names, places, strict=True)})
        if one_to_one and all(names) and not any(map(is_number, names)):
            return (*columns[:at], "id", *columns[at + 1 :])
    return columns


def with_role(columns: tuple[Meaning, ...], layout: TableLayout) -> tuple[Meaning, ...]:
    """The columns with one of another name as the roles, if its cells are nothing else."""
    if "role" in columns:
        return columns
    for k, meaning in enumerate(columns):
        cells = [plain_word(row[k]) for row in layout.rows if k < len(row)]
        if meaning == "-" and any(cells) and all(cell in ROLES for cell in cells):
            return (*columns[:k], "role", *columns[k + 1 :])
    return columns


def _is_id(layout: TableLayout) -> bool:
    """Whether the first column is text, or whole numbers beside numbers that are not."""
    first = [row[0] for row in layout.rows]
    others = [cell for row in layout.rows for cell in row[1:4]]
    return (all(map(_is_whole, first)) and any(map(_has_decimals, others))) or not all(
        map(is_number, first)
    )


def _is_whole(cell: str) -> bool:
    return cell.lstrip("+-").isdigit()


def _has_decimals(cell: str) -> bool:
    return is_number(cell) and not _is_whole(cell)
