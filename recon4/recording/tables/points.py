"""Lists of named points: control and check points, markers, read line by line."""

from __future__ import annotations

import csv
import math
import re
from collections.abc import Iterator
from dataclasses import dataclass

from recon4.errors import ConfigError, CorruptFile
from recon4.locales.coded import CodedText
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
    NUMBER,
    TableLayout,
    group_sign,
    is_content,
    is_grouped,
    is_number,
    split_row,
    with_decimal_points,
    without_groups,
    wrong_number,
)
from recon4.recording.tables.proposals import Purpose
from recon4.recording.tables.text import decode_table, universal
from recon4.recording.tables.tuning import TABLES
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
        raise CorruptFile(CodedText("table-csv", file=name, why=str(error))) from error


def _read(
    text: str, layout: TableLayout, columns: TableColumns, *, preview: TablePreview, partial: bool
) -> PointTable:
    points: list[TablePoint] = []
    skipped: list[str] = []
    rows = list(_rows(text, layout, columns))
    places = [[cells[k] for k in columns.at if k < len(cells)] for _, cells in rows]
    signs = {group_sign(cell) for cells in places for cell in cells if is_grouped(cell)}
    for (line, cells), place in zip(rows, places, strict=True):
        try:
            # Beside 1.234,5 nobody can tell whether 1.234 is a thousand.
            doubt = [cell for cell in place if group_sign(cell) in signs and not is_grouped(cell)]
            if doubt:
                raise ValueError(f"{wrong_number(doubt[0])}, which other rows have")
            cells = with_decimal_points(cells) if layout.decimal == "," else cells
            points.append(_point(line, cells, columns, partial=partial))
        except (ConfigError, ValueError) as error:
            skipped.append(f"line {line}: {error}")
    return PointTable(preview, tuple(points), tuple(skipped))


def _rows(text: str, layout: TableLayout, columns: TableColumns) -> Iterator[tuple[int, list[str]]]:
    """Lines with their number and cells as written: rows, and what was meant as one."""
    first = layout.names_line + 1  # a row that is no point may stand before the first that is one
    for line, row in enumerate(text.split("\n")[first:], start=first + 1):
        cells = split_row(row, layout.delimiter, ".") if is_content(row) else []
        if any(cells) and (line > layout.head_lines or _is_row(cells, columns)):
            yield line, cells


def _is_row(cells: list[str], columns: TableColumns) -> bool:
    """Whether a line above the first row was meant as one: it has a number in a coordinate."""
    found = with_decimal_points([cells[k] for k in columns.at if k < len(cells)])
    return any(is_number(cell) or is_grouped(cell) for cell in found)


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
    text = without_groups(text) if is_grouped(text) else text
    if not is_number(text):
        raise ValueError(wrong_number(text))
    value = float(text)
    if not math.isfinite(value) or abs(value) > LIMITS.coordinate_m:
        raise ValueError(f"expected a finite coordinate, got {text[:40]!r}")
    return value


_QUOTED_LINE = re.compile(r'\s*"([^"]*)"[\s;,]*')
_SEPARATORS = ";,\t|"
_GROUP = re.compile(r"[^()]*\(([^()]*)\)\s*")


def unpacked(text: str) -> str:
    r"""A table with one value a cell; other tables come back as they are.

    Programs put quotes around whole rows, and people write three coordinates into one cell, as
    ``A1,(678411.560;1527288.550;-29.360)``. A name above such a cell that does not name its values
    itself, as ``(E;N;h)`` does, is repeated with numbers.

    Args:
        text: The lines, each ending with ``\n``; their number stays.
    """
    lines = _without_outer_quotes(text.split("\n"))
    rows = [line for line in lines if is_content(line)]
    grouped = [row for row in rows if _groups(row)]
    if not grouped or len(grouped) < (len(rows) - 1) / 2:
        return "\n".join(lines)
    outer = max(_SEPARATORS, key=lambda sign: re.sub(r"\([^()]*\)", "", grouped[0]).count(sign))
    widths = [len(_values(cell)) or 1 for cell in _cells(grouped[0], outer)]
    return "\n".join(_row(line, outer, widths) if is_content(line) else line for line in lines)


def _without_outer_quotes(lines: list[str]) -> list[str]:
    """The lines without quotes around each whole row, if all rows have them."""
    found = [_QUOTED_LINE.fullmatch(line) if is_content(line) else None for line in lines]
    rows = [match for match, line in zip(found, lines, strict=True) if is_content(line)]
    if not rows or not all(m and any(sign in m[1] for sign in _SEPARATORS) for m in rows):
        return lines
    return [match[1] if match else line for match, line in zip(found, lines, strict=True)]


def _groups(line: str) -> bool:
    """Whether a line has several numbers in parentheses."""
    parts = re.findall(r"\(([^()]*)\)", line)
    return any(sum(map(_is_number, _split(part))) >= TABLES.fewest_packed for part in parts)


def _values(cell: str) -> list[str]:
    """The values of a cell in parentheses; none = it is not in parentheses."""
    match = _GROUP.fullmatch(cell)
    return _split(match[1]) if match else []


def _split(group: str) -> list[str]:
    sign = next((sign for sign in ";|\t" if sign in group), "")
    if not sign and "," in group:
        sign = ","
    return [part.strip() for part in (group.split(sign) if sign else group.split())]


def _is_number(text: str) -> bool:
    return NUMBER.fullmatch(text.replace(",", ".")) is not None


def _cells(line: str, outer: str) -> list[str]:
    """Cells of a line; separators in parentheses separate none."""
    return re.split(rf"{re.escape(outer)}(?![^()]*\))", line.strip("\r"))


def _row(line: str, outer: str, widths: list[int]) -> str:
    out: list[str] = []
    for k, cell in enumerate(_cells(line, outer)):
        width = widths[k] if k < len(widths) else 1
        values = _values(cell)
        if width == 1 or len(values) == width:
            out += values if len(values) == width > 1 else [cell]
        else:
            name = cell.strip().strip('"')
            out += [f"{name} {number}" if name else "" for number in range(1, width + 1)]
    # A decimal comma of a value is no separator.
    return outer.join(f'"{one}"' if outer in one and '"' not in one else one for one in out)
