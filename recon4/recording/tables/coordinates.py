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
from recon4.locales.coded import CodedText
from recon4.recording.tables.column_names import (
    COVARIANCES,
    SIGMAS,
    UNIT_NAMES,
    UNITS_M,
    ColumnName,
    Meaning,
    Unit,
    check_meanings,
    column_name,
)
from recon4.recording.tables.layout import TableLayout, is_number
from recon4.recording.tables.proposals import (
    AXIS_NAMES,
    Purpose,
    columns_by_name,
    columns_by_order,
    with_id,
    with_role,
)
from recon4.recording.tables.tuning import PLACES, SHOWN_TABLE


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
    spread: tuple[tuple[int, float], ...]
    """Column and meters of one unit of each standard deviation, or of each covariance; none."""
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
    purpose: Purpose = "cloud",
) -> TablePreview:
    """First rows of a table and how it is going to be read; never raises a question.

    Args:
        layout: Of the table.
        choice: What a person said.
        place: Easting and northing of the map [m], (2,), if the coordinates are in its CRS.
        purpose: What the table is for: lists of points begin with a name if nothing is named.
    """
    found = _propose(layout, choice, place, purpose=purpose)
    shown = tuple(
        tuple(cell[: SHOWN_TABLE.cell_characters] for cell in row[: SHOWN_TABLE.columns])
        for row in layout.rows[: SHOWN_TABLE.rows]
    )
    return TablePreview(
        header=tuple(
            name[: SHOWN_TABLE.cell_characters] for name in layout.names[: SHOWN_TABLE.columns]
        ),
        rows=shown,
        columns=found.columns[: SHOWN_TABLE.columns],
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
    purpose: Purpose = "cloud",
) -> TableColumns:
    """The columns to read.

    Raises:
        ConfigError: With the question and the answer that fits best, if they are not certain.
    """
    found = _propose(layout, choice, place, purpose=purpose)
    raise_question(preview_table(layout, choice, place=place, purpose=purpose), name)
    return _columns(layout, found)


def raise_question(preview: TablePreview, name: str, *, in_file: bool = False) -> None:
    """Raise the question of a preview, with the answer that fits best.

    Args:
        preview: Of the table.
        name: For messages.
        in_file: Whether the answer is a line of names in the file; else an option of the command.

    Raises:
        ConfigError: If there is one.
    """
    if preview.question:
        columns = _suggestion(preview.columns)
        answer = (
            f"Name the columns in a first line of the file, as {columns} (x east, y north)"
            if in_file
            else f"Say which column is what (command: --columns {columns})"
        )
        raise ConfigError(
            CodedText(
                "table-question",
                name=name,
                question=preview.question,
                answer=answer,
                rows=" | ".join(preview.rows[0])[:160],
            )
        )


def chosen_columns(
    layout: TableLayout, choice: ColumnChoice, *, purpose: Purpose = "cloud"
) -> TableColumns | None:
    """The columns as they are proposed; None if coordinates are missing among them."""
    found = _propose(layout, choice, None, purpose=purpose)
    axes = {column.lstrip("-") for column in found.columns}
    complete = axes >= {"x", "y", "z"} or axes >= {"lat", "lon", "z"}
    return _columns(layout, found) if complete else None


def _columns(layout: TableLayout, found: _Proposal) -> TableColumns:
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
        spread=spread_columns(layout, found.columns, own=sizes[2]),
        description=_description(layout, found),
    )


def spread_columns(
    layout: TableLayout, columns: Sequence[Meaning], *, own: float
) -> tuple[tuple[int, float], ...]:
    """Columns of covariances, else of standard deviations, and their units [m or m²]; none.

    Args:
        layout: Of the table.
        columns: What each column means.
        own: Meters of one unit where a name states none.
    """
    for whole, power in ((COVARIANCES, 2), (SIGMAS, 1)):
        if not {*whole} <= {*columns}:
            continue
        at = [columns.index(one) for one in whole]
        units = [column_name(layout.names[k]).unit if k < len(layout.names) else None for k in at]
        sizes = [UNITS_M[unit] if unit else own for unit in units]
        return tuple((k, size**power) for k, size in zip(at, sizes, strict=True))
    return ()


def _suggestion(columns: tuple[Meaning, ...]) -> str:
    """Columns as a person would write them: without unused ones at the end."""
    used = max((k for k, meaning in enumerate(columns) if meaning != "-"), default=-1)
    return ",".join(columns[: used + 1]) or "id,x,y,z"


def _propose(
    layout: TableLayout, choice: ColumnChoice, place: Array | None, *, purpose: Purpose
) -> _Proposal:
    names = [column_name(name) for name in layout.names]
    if choice.columns:
        columns = check_meanings(choice.columns)
        units = _units(names, columns, choice.unit)
        return _Proposal(columns, _not_numbers(layout, columns, purpose), units)
    found, question = columns_by_name(names) if names else columns_by_order(layout, purpose=purpose)
    if names and purpose != "cloud" and "id" not in found:
        found, question = with_id(found), question or "no column is named as the name of a point."
    if names and purpose == "survey":
        found = with_role(found, layout)
    if names and layout.stray_head and purpose == "cloud" and not question:
        question = f"the line {layout.stray_head[:60]!r} below the names is no row of numbers."
    units = _units(names, found, choice.unit)
    odd = next((name.odd_unit for name in names if name.odd_unit and name.meaning != "-"), "")
    if not question and odd and choice.unit is None:
        question = f"the unit {odd[:20]!r} of a column is not known."
    question = question or _not_numbers(layout, found, purpose)
    proposal = _Proposal(found, question, units)
    if question:
        return proposal
    return _Proposal(*_at_place(layout, proposal, names, place=place, purpose=purpose), units)


def _not_numbers(layout: TableLayout, columns: Sequence[Meaning], purpose: Purpose) -> str:
    """Which column of a coordinate has no number; empty = each has some.

    Rows of a list of points are judged one by one instead.
    """
    if purpose != "cloud":
        return ""
    for k, meaning in enumerate(columns):
        if meaning.lstrip("-") not in ("x", "y", "z", "lat", "lon"):
            continue
        cells = [row[k] for row in layout.rows if k < len(row)]
        if not any(map(is_number, cells)):
            return f"column {k + 1} has no numbers, but {(cells or [''])[0][:40]!r}."
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
    purpose: Purpose,
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
            if np.all(np.abs(np.array(at) - place) < PLACES.near_m)
        ]
        if columns in fits:
            return columns, ""
        doubt = "the coordinates are near the map only with other axes than its names say."
        if fits:
            return fits[0], doubt if by_direction or purpose != "cloud" else ""
    if by_direction:
        return columns, ""
    (least_y, most_y), (least_x, most_x) = PLACES.sjtsk_y, PLACES.sjtsk_x
    if least_y < min(a, b) < most_y and least_x < max(a, b) < most_x:
        meanings: tuple[Meaning, Meaning] = ("-x", "-y") if a < b else ("-y", "-x")
        turned = _renamed(columns, dict(zip((x, y), meanings, strict=True)))
        return turned, "these are like Y and X of S-JTSK, which count to the west and south."
    if purpose == "survey" or (purpose == "markers" and not names):
        first = layout.rows[0]
        return (
            columns,
            f"is {_cell(first, x)} the easting (x) and {_cell(first, y)} the northing (y)?",
        )
    if names and y < x and min(abs(a), abs(b)) > PLACES.geodetic_m:
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


def _cell(row: Sequence[str], at: int) -> str:
    return row[at][: SHOWN_TABLE.cell_characters] if at < len(row) else "–"


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
        axis = {"lon": "longitude", "lat": "latitude"}.get(meaning, AXIS_NAMES[word])
        sign = "minus " if meaning.startswith("-") else ""
        words.append(f"{axis} = {sign}{named.strip()[:30] or f'column {at + 1}'}")
    units = dict.fromkeys(UNIT_NAMES[unit] for unit in found.units)
    if {*COVARIANCES} <= {*found.columns}:
        words.append("covariances of E, N, H")
    elif {*SIGMAS} <= {*found.columns}:
        words.append("standard deviations of E, N, H")
    return f"columns: {', '.join(words)}; {', '.join(units)}"
