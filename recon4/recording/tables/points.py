"""Lists of named points: control and check points, markers, read line by line."""

from __future__ import annotations

import csv
import math
from dataclasses import dataclass

from recon4.errors import ConfigError, CorruptFile
from recon4.model.survey_covariance import Covariance, check_covariance, covariance_of
from recon4.recording.limits import LIMITS
from recon4.recording.tables.coordinates import (
    AS_THE_TABLE_SAYS,
    ColumnChoice,
    TableColumns,
    TablePreview,
    chosen_columns,
    preview_table,
)
from recon4.recording.tables.dxf_points import dxf_table, is_dxf
from recon4.recording.tables.layout import (
    NOT_MEASURED,
    TableLayout,
    is_content,
    is_number,
    split_row,
    wrong_number,
)
from recon4.recording.tables.packed import unpacked
from recon4.recording.tables.proposals import Purpose
from recon4.recording.tables.text import decode_table, universal
from recon4.untrusted.names import check_name


@dataclass(frozen=True, slots=True)
class TablePoint:
    """A row of a list of points."""

    line: int
    name: str
    xyz_m: tuple[float, float, float]
    """NaN = not measured."""
    role: str
    """As written; empty = none."""
    radius_m: float
    covariance_m2: Covariance | None = None
    """None = the row states none."""


@dataclass(frozen=True, slots=True)
class PointTable:
    """A list of points, and how it was read."""

    preview: TablePreview
    """With a question, if its columns are not certain; the points are then what they would be."""
    points: tuple[TablePoint, ...]
    skipped: tuple[str, ...]
    """Lines that are no points, with the reason."""


def read_point_table(
    data: bytes,
    name: str,
    *,
    choice: ColumnChoice = AS_THE_TABLE_SAYS,
    purpose: Purpose = "survey",
    partial: bool = False,
) -> PointTable:
    """Read a list of points; columns by their names, or name, x, y, z and a radius; or a DXF.

    Args:
        data: The file's bytes.
        name: For messages.
        choice: What a person says of the columns.
        purpose: Which columns need a confirmation.
        partial: Whether coordinates may be missing: `NOT_MEASURED`.

    Raises:
        CorruptFile: If no line has a number, or a cell cannot be read.
        ConfigError: If the chosen columns name no place.
    """
    text = dxf_table(data, name) if is_dxf(data) else unpacked(universal(decode_table(data, name)))
    try:
        layout = TableLayout.of(text, name, fewest=1)
        preview = preview_table(layout, choice, purpose=purpose)
        columns = chosen_columns(layout, choice, purpose=purpose)
        if columns is None:
            return PointTable(preview, (), ())
        return _read(text, layout, columns, preview=preview, partial=partial)
    except csv.Error as error:
        raise CorruptFile(f"{name}: cannot be read as CSV: {error}") from error


def _read(
    text: str, layout: TableLayout, columns: TableColumns, *, preview: TablePreview, partial: bool
) -> PointTable:
    points: list[TablePoint] = []
    skipped: list[str] = []
    first = layout.names_line + 1  # a row that is no point may stand before the first that is one
    for line, row in enumerate(text.split("\n")[first:], start=first + 1):
        cells = split_row(row, layout.delimiter, layout.decimal) if is_content(row) else []
        if not any(cells) or (line <= layout.head_lines and not _is_row(cells, columns)):
            continue
        try:
            points.append(_point(line, cells, columns, partial=partial))
        except (ConfigError, ValueError) as error:
            skipped.append(f"line {line}: {error}")
    return PointTable(preview, tuple(points), tuple(skipped))


def _is_row(cells: list[str], columns: TableColumns) -> bool:
    """Whether a line above the first row was meant as one: it has a number in a coordinate."""
    return any(k < len(cells) and is_number(cells[k]) for k in columns.at)


def _point(line: int, cells: list[str], columns: TableColumns, *, partial: bool) -> TablePoint:
    def cell(at: int) -> str:
        return cells[at] if 0 <= at < len(cells) else ""

    if max(columns.at) >= len(cells):
        raise ValueError(f"expected {max(columns.at) + 1} cells, got {';'.join(cells)[:60]!r}")
    numbers = [_number(cell(at), partial=partial) for at in columns.at]
    x, y, z = (n * factor for n, factor in zip(numbers, columns.factor, strict=True))
    name = check_name(
        cell(columns.id) or str(line), what="the id of a point", most=LIMITS.id_characters
    )
    radius = _number(cell(columns.radius), partial=False) if cell(columns.radius) else 0.0
    return TablePoint(
        line,
        name,
        (x, y, z),
        cell(columns.role),
        radius * abs(columns.factor[0]),
        spread_of([(cell(at), size) for at, size in columns.spread]),
    )


def spread_of(cells: list[tuple[str, float]]) -> Covariance | None:
    """Of six covariances, or of three standard deviations, with their units; None = all are empty.

    Raises:
        ConfigError: If it is none.
        ValueError: If a cell is no number.
    """
    if not any(text for text, _ in cells):
        return None
    values = [_number(text, partial=False) * size for text, size in cells]
    if len(values) == 3:
        return covariance_of((values[0], values[1], values[2]))
    ee, en, eh, nn, nh, hh = values
    return check_covariance((ee, en, eh, nn, nh, hh))


def _number(text: str, *, partial: bool) -> float:
    """A finite number; NaN if it was not measured.

    Raises:
        ValueError: If it is something else.
    """
    if partial and text in NOT_MEASURED:
        return math.nan
    if not is_number(text):
        raise ValueError(wrong_number(text))
    value = float(text)
    if not math.isfinite(value) or abs(value) > LIMITS.coordinate_m:
        raise ValueError(f"expected a finite coordinate, got {text[:40]!r}")
    return value
