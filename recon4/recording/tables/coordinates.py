"""Which columns of a table are the coordinates: by name, by order, or by what a person says.

A table is never read by a rule that may be wrong. Where neither its names nor its order settle
which columns the coordinates are, reading raises a question, and `preview_table` shows the first
rows, so that a person can answer with `ColumnChoice`.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from recon4.errors import ConfigError
from recon4.geometry.se3 import Array
from recon4.recording.tables.column_names import (
    UNIT_NAMES,
    UNITS_M,
    ColumnName,
    Meaning,
    Unit,
    check_meanings,
    column_name,
)
from recon4.recording.tables.layout import TableLayout, is_number

SHOWN_ROWS = 5
_MAX_SHOWN_CELL = 40
MAX_COLUMNS = 64
NEAR_M = 20_000.0
"""Coordinates this close to the map are of its place [m]."""
GEODETIC_M = 100_000.0
"""Larger coordinates are those of a national system, where x often points north [m]."""
_SJTSK_Y, _SJTSK_X = (4.0e5, 9.3e5), (9.3e5, 1.24e6)
"""Range of positive coordinates of S-JTSK, which count to the west and to the south [m]."""
_BESIDES: tuple[Meaning, ...] = ("id", "role", "radius")
_WORDS: dict[str, str] = {"x": "x (east)", "y": "y (north)", "z": "z (height)"}


@dataclass(frozen=True, slots=True)
class ColumnChoice:
    """What a person says of the columns of a table."""

    columns: tuple[Meaning, ...] = ()
    """Meaning of each column from the left; empty = as the table says."""
    unit: Unit | None = None
    """Of the coordinates; None = as the table says, else meters."""


AS_THE_TABLE_SAYS = ColumnChoice()


@dataclass(frozen=True, slots=True)
class TablePreview:
    """First rows of a table, and how it is going to be read."""

    header: tuple[str, ...]
    """Names of the columns in the file; empty = it has none."""
    rows: tuple[tuple[str, ...], ...]
    columns: tuple[Meaning, ...]
    """What each column is taken for."""
    unit: Unit
    question: str
    """What is not certain; empty = nothing."""
    description: str
    """How it is going to be read, as text."""
    delimiter: str
    decimal: str


@dataclass(frozen=True, slots=True)
class TableColumns:
    """Which columns are read."""

    at: tuple[int, int, int]
    """Of x, y, z; of longitude, latitude, height."""
    factor: tuple[float, float, float]
    """Meters (or degrees) of one unit in the file; negative where the axis is turned."""
    geographic: bool
    """Whether the first two are longitude and latitude in degrees."""
    id: int
    """Column of the names; -1 = none."""
    role: int
    radius: int
    description: str


@dataclass(frozen=True, slots=True)
class _Proposal:
    columns: tuple[Meaning, ...]
    question: str
    units: tuple[Unit, ...]
    """Of x, y, z."""


def preview_table(
    layout: TableLayout,
    choice: ColumnChoice,
    *,
    place: Array | None = None,
    of_points: bool = False,
) -> TablePreview:
    """First rows of a table and how it is going to be read; never raises a question.

    Args:
        layout: Of the table.
        choice: What a person said.
        place: Easting and northing of the map [m], (2,), if the coordinates are in its CRS.
        of_points: Whether it is a list of named points, which begin with an id if nothing is named.
    """
    found = _propose(layout, choice, place, of_points=of_points)
    shown = tuple(
        tuple(cell[:_MAX_SHOWN_CELL] for cell in row[:MAX_COLUMNS])
        for row in layout.rows[:SHOWN_ROWS]
    )
    return TablePreview(
        header=tuple(name[:_MAX_SHOWN_CELL] for name in layout.names[:MAX_COLUMNS]),
        rows=shown,
        columns=found.columns[:MAX_COLUMNS],
        unit=found.units[0],
        question=found.question,
        description=_description(layout, found),
        delimiter={"": "blanks", "\t": "tab"}.get(layout.delimiter, layout.delimiter),
        decimal=layout.decimal,
    )


def table_columns(
    layout: TableLayout,
    choice: ColumnChoice,
    name: str,
    *,
    place: Array | None = None,
    of_points: bool = False,
) -> TableColumns:
    """The columns to read.

    Raises:
        ConfigError: With the question and the answer that fits best, if they are not certain.
    """
    found = _propose(layout, choice, place, of_points=of_points)
    if found.question:
        raise ConfigError(
            f"{name}: {found.question} Say which column is what (--columns "
            f"{_suggestion(found.columns)}); the first row is "
            f"{' | '.join(layout.rows[0])[:160]}"
        )
    columns = found.columns
    geographic = "lat" in columns
    axes = ("lon", "lat", "z") if geographic else ("x", "y", "z")
    at = tuple(next(k for k, c in enumerate(columns) if c.lstrip("-") == axis) for axis in axes)
    signs = [-1.0 if columns[k].startswith("-") else 1.0 for k in at]
    sizes = [UNITS_M[unit] for unit in found.units]
    if geographic:
        sizes[:2] = [1.0, 1.0]

    def place_of(meaning: Meaning) -> int:
        return columns.index(meaning) if meaning in columns else -1

    x, y, z = (sign * size for sign, size in zip(signs, sizes, strict=True))
    return TableColumns(
        at=(at[0], at[1], at[2]),
        factor=(x, y, z),
        geographic=geographic,
        id=place_of("id"),
        role=place_of("role"),
        radius=place_of("radius"),
        description=_description(layout, found),
    )


def _suggestion(columns: tuple[Meaning, ...]) -> str:
    """Columns as a person would write them: without unused ones at the end."""
    used = max((k for k, meaning in enumerate(columns) if meaning != "-"), default=-1)
    return ",".join(columns[: used + 1]) or "id,x,y,z"


def _propose(
    layout: TableLayout, choice: ColumnChoice, place: Array | None, *, of_points: bool
) -> _Proposal:
    names = [column_name(name) for name in layout.names]
    if choice.columns:
        columns = check_meanings(choice.columns)
        units = _units(names, columns, choice.unit)
        return _Proposal(columns, _not_numbers(layout, columns), units)
    found, question = _by_name(names) if names else _by_order(layout, of_points=of_points)
    units = _units(names, found, choice.unit)
    odd = next((name.odd_unit for name in names if name.odd_unit and name.meaning != "-"), "")
    if not question and odd and choice.unit is None:
        question = f"the unit {odd[:20]!r} of a column is not known."
    question = question or _not_numbers(layout, found)
    proposal = _Proposal(found, question, units)
    if question:
        return proposal
    return _Proposal(*_at_place(layout, proposal, names, place=place, of_points=of_points), units)


def _by_name(names: list[ColumnName]) -> tuple[tuple[Meaning, ...], str]:
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
    missing = [
        _WORDS[m] for m, found in zip("xyz", (first, second, heights), strict=True) if not found
    ]
    if missing:
        return tuple(columns), f"no column is named as {' or '.join(missing)}."
    if len(pairs) > 1:
        return tuple(columns), "there are columns x, y and columns east, north."
    if any(len(found) > 1 for found in (first, second, heights)):
        return tuple(columns), "several columns have names of one coordinate."
    return tuple(columns), ""


def _by_order(layout: TableLayout, *, of_points: bool) -> tuple[tuple[Meaning, ...], str]:
    """Columns of a table without names: x, y, z first, unless the first one is an id."""
    rest = max(0, layout.width - 3)
    unused: tuple[Meaning, ...] = ("-",)
    plain: tuple[Meaning, ...] = ("x", "y", "z", *unused * rest)
    with_id: tuple[Meaning, ...] = ("id", "x", "y", "z", *unused * (rest - 1))
    if layout.stray_head:
        columns = with_id if rest and (of_points or _is_id(layout)) else plain
        return columns, f"the line {layout.stray_head[:60]!r} does not name each column."
    if of_points:
        # name, x, y, z and the radius of a target
        return (*with_id[:4], "radius") if layout.width == 5 else with_id, ""
    if rest and _is_id(layout):
        return with_id, "no column has a name, and the first one is like a point number."
    if rest and all(_is_whole(cell) for row in layout.rows for cell in row if is_number(cell)):
        return plain, "no column has a name, and all numbers are whole."
    return plain, ""


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


def _not_numbers(layout: TableLayout, columns: Sequence[Meaning]) -> str:
    """What is no number in the columns of the coordinates of the first row; empty = all are."""
    row = layout.rows[0]
    for k, meaning in enumerate(columns):
        if meaning not in ("-", "id", "role", "radius") and not (
            k < len(row) and is_number(row[k])
        ):
            cell = row[k] if k < len(row) else ""
            return f"column {k + 1} has no numbers, but {cell[:40]!r}."
    return ""


def _units(
    names: list[ColumnName], columns: Sequence[Meaning], chosen: Unit | None
) -> tuple[Unit, ...]:
    """Units of x, y, z; empty if no column is one of them."""
    found: list[Unit] = []
    for axes in (("x", "-x", "lon"), ("y", "-y", "lat"), ("z",)):
        at = next((k for k, meaning in enumerate(columns) if meaning in axes), -1)
        stated = names[at].unit if 0 <= at < len(names) else None
        found.append(chosen or stated or "m")
    return tuple(found)


def _at_place(
    layout: TableLayout,
    found: _Proposal,
    names: list[ColumnName],
    *,
    place: Array | None,
    of_points: bool,
) -> tuple[tuple[Meaning, ...], str]:
    """Check axes that national systems name otherwise: x to the north, or to the south."""
    columns = found.columns
    if "x" not in columns or "y" not in columns:
        return columns, ""
    x, y = columns.index("x"), columns.index("y")
    a = _middle(layout, x) * UNITS_M[found.units[0]]
    b = _middle(layout, y) * UNITS_M[found.units[1]]
    by_direction = bool(names) and names[x].family == "en"
    if place is not None:
        fits = [
            _renamed(columns, {x: first, y: second})
            for first, second, at in _other_axes(a, b)
            if np.all(np.abs(np.array(at) - place) < NEAR_M)
        ]
        if columns in fits:
            return columns, ""
        doubt = "the coordinates are near the map only with other axes than its names say."
        if fits:
            return fits[0], doubt if by_direction or of_points else ""
    if by_direction:
        return columns, ""
    if _SJTSK_Y[0] < min(a, b) < _SJTSK_Y[1] and _SJTSK_X[0] < max(a, b) < _SJTSK_X[1]:
        meanings: tuple[Meaning, Meaning] = ("-x", "-y") if a < b else ("-y", "-x")
        turned = _renamed(columns, dict(zip((x, y), meanings, strict=True)))
        return turned, "these are like Y and X of S-JTSK, which count to the west and south."
    if of_points:
        return columns, f"is {a:.3f} the easting (x) and {b:.3f} the northing (y)?"
    if names and y < x and min(abs(a), abs(b)) > GEODETIC_M:
        return columns, "y stands before x: x may point north, as in geodetic lists."
    return columns, ""


def _other_axes(a: float, b: float) -> list[tuple[Meaning, Meaning, tuple[float, float]]]:
    """What two columns may mean, and the easting and northing [m] that follow."""
    return [
        ("x", "y", (a, b)),
        ("y", "x", (b, a)),
        ("-x", "-y", (-a, -b)),
        ("-y", "-x", (-b, -a)),
    ]


def _renamed(columns: tuple[Meaning, ...], meanings: Mapping[int, Meaning]) -> tuple[Meaning, ...]:
    """The columns with other meanings."""
    return tuple(meanings.get(k, meaning) for k, meaning in enumerate(columns))


def _middle(layout: TableLayout, column: int) -> float:
    values = [
        float(row[column]) for row in layout.rows if column < len(row) and is_number(row[column])
    ]
    return float(np.median(values)) if values else 0.0


def _description(layout: TableLayout, found: _Proposal) -> str:
    words = []
    for axes, word in ((("x", "-x", "lon"), "x"), (("y", "-y", "lat"), "y"), (("z",), "z")):
        at = next((k for k, meaning in enumerate(found.columns) if meaning in axes), -1)
        if at < 0:
            continue
        named = layout.names[at] if at < len(layout.names) and layout.names[at] else ""
        meaning = found.columns[at]
        axis = {"lon": "longitude", "lat": "latitude"}.get(meaning, _WORDS[word])
        sign = "minus " if meaning.startswith("-") else ""
        words.append(f"{axis} = {sign}{named.strip()[:30] or f'column {at + 1}'}")
    units = dict.fromkeys(UNIT_NAMES[unit] for unit in found.units)
    return f"columns: {', '.join(words)}; {', '.join(units)}"
