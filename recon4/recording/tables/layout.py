"""How the lines of a table of coordinates are written: separator, decimal sign, names, rows."""

from __future__ import annotations

import csv
import re
from collections.abc import Iterable
from dataclasses import dataclass

from recon4.errors import CorruptFile
from recon4.locales.coded import CodedText
from recon4.recording.tables.column_names import is_unit
from recon4.recording.tables.tuning import TABLES

_COMMENTS = ("#", "//", "%", "!")
NUMBER = re.compile(
    r"[-+]?(?:[0-9]+[.]?[0-9]*|[.][0-9]+)(?:[eE][-+]?[0-9]+)?|[-+]?(?:nan|inf)", re.I
)
_COUNT = re.compile(r"[0-9]{1,12}")
_COMMA_NUMBER = re.compile(r"[-+]?[0-9]+,[0-9]+(?:[eE][-+]?[0-9]+)?")
_QUOTED_COMMA = re.compile(r'"([-+]?[0-9]+),([0-9]+)"')
_GROUPED = re.compile(r"[-+]?[0-9]{1,3}(?:[.'’ ,][0-9]{3})+(?:[.,][0-9]+)?")
"""Digits in groups of three, as 1.234,5 or 1'234.5: nobody can tell a group from a decimal."""
_CERTAIN = re.compile(
    r"[-+]?[0-9]{1,3}(?:(?:['’ ][0-9]{3})+(?:[.,][0-9]+)?|(?:\.[0-9]{3})+,[0-9]+"
    r"|(?:,[0-9]{3})+\.[0-9]+|(?:\.[0-9]{3}){2,}|(?:,[0-9]{3}){2,})"
)
"""Digits in groups that cannot be read otherwise: two signs, one sign twice, or blanks between."""
NOT_MEASURED = ("", "-", "–")
"""Cells of a coordinate that was not measured."""


@dataclass(frozen=True, slots=True)
class TableLayout:
    """How a table is written, as its first lines show."""

    delimiter: str
    """Between cells; empty = blanks."""
    decimal: str
    """``.`` or ``,``."""
    head_lines: int
    """Lines before the first row of numbers."""
    names: tuple[str, ...]
    """Names of the columns; empty = the file has none."""
    names_line: int
    """Line of the names, from 0; -1 = there are none."""
    stray_head: str
    """A line above the numbers with text that does not name each column; empty = there is none."""
    promised: int | None
    """Count of points above the first of them, as PTS files have it."""
    rows: tuple[tuple[str, ...], ...]
    """The first rows, as text; decimal commas are points."""

    @property
    def width(self) -> int:
        """Cells of the first row, without empty ones at its end."""
        return len(_without_end(self.rows[0]))

    @staticmethod
    def of(text: str, name: str, *, fewest: int = TABLES.fewest_columns) -> TableLayout:
        r"""Detect the layout from the first lines.

        Args:
            text: The lines, each ending with ``\n``.
            name: Of the file, for messages.
            fewest: Numbers that make a line a row.

        Raises:
            CorruptFile: If no line has that many numbers.
        """
        lines = text.split("\n")
        delimiter = _delimiter([line for line in lines[: TABLES.sample] if is_content(line)])
        decimal = _decimal(lines[: TABLES.sample], delimiter)
        for first, line in enumerate(lines):
            if is_content(line) and _numbers(split_row(line, delimiter, decimal)) >= fewest:
                break
        else:
            seen = next((line for line in lines if is_content(line)), "")
            raise CorruptFile(CodedText("table-rows", name=name, seen=seen.strip()[:80]))
        rows = [split_row(line, delimiter, decimal) for line in lines[first:] if is_content(line)]
        head = lines[:first]
        width = len(_without_end(rows[0]))
        names_line, names = _names(head, delimiter, width, exact=fewest == TABLES.fewest_columns)
        return TableLayout(
            delimiter=delimiter,
            decimal=decimal,
            head_lines=first,
            names=names,
            names_line=names_line,
            stray_head=_stray(head, names_line),
            promised=_promised(head),
            rows=tuple(tuple(row) for row in rows[: TABLES.sample]),
        )


def split_row(line: str, delimiter: str, decimal: str) -> list[str]:
    """Cells of a line; decimal commas become points.

    Raises:
        csv.Error: If quotes do not match.
    """
    text = line.replace("\t", " ").strip() if not delimiter else line.strip("\r\n")
    reader = csv.reader([text], delimiter=delimiter or " ", skipinitialspace=True)
    cells = [cell.strip() for cell in next(reader, [])]
    return with_decimal_points(cells) if decimal == "," else cells


def with_decimal_points(cells: list[str]) -> list[str]:
    """Cells whose decimal commas are points."""
    return [c.replace(",", ".") if _COMMA_NUMBER.fullmatch(c) else c for c in cells]


def with_points(text: str, delimiter: str) -> str:
    """A block whose decimal commas are points."""
    if delimiter == ",":
        return _QUOTED_COMMA.sub(r"\1.\2", text)
    return text.replace(",", ".")


def is_number(cell: str) -> bool:
    """Whether a cell is a number with a decimal point."""
    return NUMBER.fullmatch(cell) is not None


def is_grouped(cell: str) -> bool:
    """Whether a cell is a number in groups of three digits that has one reading only."""
    return _CERTAIN.fullmatch(cell) is not None


def group_sign(cell: str) -> str:
    """The thousands separator of a number `is_grouped`, or that a cell as 1.234 may have."""
    signs = [sign for sign in cell.lstrip("-+") if not sign.isdigit()]
    return signs[0] if _GROUPED.fullmatch(cell) else ""


def without_groups(cell: str) -> str:
    """A number `is_grouped` with a decimal point and without thousands separators."""
    signs = [sign for sign in cell.lstrip("-+") if not sign.isdigit()]
    last = signs[-1]
    if signs.count(last) > 1 or len({*signs}) == 1:
        return cell.replace(last, "")
    whole, _, part = cell.rpartition(last)
    return f"{whole.replace(signs[0], '')}.{part}"


def wrong_number(cell: str) -> CodedText:
    """What is wrong with a cell that is expected to be a number."""
    if "°" in cell:
        return CodedText("cell-degrees", cell=cell[:40])
    if _GROUPED.fullmatch(cell):
        return CodedText("cell-grouped", cell=cell[:40])
    return CodedText("cell-number", cell=cell[:40])


def is_content(line: str) -> bool:
    """Whether a line is neither blank nor a comment nor the rule of a printed table."""
    text = line.strip()
    return bool(text) and not text.startswith(_COMMENTS) and bool(text.strip("|-:=+ "))


def _delimiter(lines: list[str]) -> str:
    body = lines[1:] or lines
    columns = TABLES.fewest_columns
    signs = columns - 1
    for sign in ";\t|":
        if _most(line.count(sign) >= signs for line in body):
            return sign
    by_blanks = [line.split() for line in body]
    if _most(sum(map(_loosely, cells)) >= columns for cells in by_blanks):
        return ""
    return "," if _most(line.count(",") >= signs for line in body) else ""


def _most(found: Iterable[bool]) -> bool:
    """Whether more than half are: a line of text between or below the rows decides nothing."""
    answers = list(found)
    return 2 * sum(answers) > len(answers)


def _loosely(cell: str) -> bool:
    """Whether a cell is a number with a decimal point or comma."""
    return is_number(cell) or _COMMA_NUMBER.fullmatch(cell) is not None


def _decimal(lines: list[str], delimiter: str) -> str:
    for line in filter(is_content, lines):
        if any(_COMMA_NUMBER.fullmatch(cell) for cell in split_row(line, delimiter, ".")):
            return ","
    return "."


def _numbers(cells: list[str]) -> int:
    """Numbers of a row, also those not measured; a row of units may begin with a hyphen."""
    found = sum(map(is_number, cells))
    return found + sum(cell in NOT_MEASURED[1:] for cell in cells) if found else 0


def _names(
    head: list[str], delimiter: str, width: int, *, exact: bool
) -> tuple[int, tuple[str, ...]]:
    """The last line above the numbers that has a name for each column, and its place.

    A line of units below the names, as ``[m];[m];[m]``, is joined to them.
    """
    units: tuple[str, ...] = ()
    for at in range(len(head) - 1, -1, -1):
        cells = _name_cells(head[at].strip().lstrip("#/%! "), delimiter, width, exact=exact)
        if cells and not units and _all_units(cells):
            units = tuple("" if cell in NOT_MEASURED else cell for cell in cells)
        elif cells:
            units += ("",) * (len(cells) - len(units))
            joined = (
                f"{c} [{u.strip('[]()')}]" if u else c for c, u in zip(cells, units, strict=False)
            )
            return at, tuple(joined)
    return -1, ()


def _name_cells(text: str, delimiter: str, width: int, *, exact: bool) -> tuple[str, ...]:
    """The cells of a line that names columns; empty if it does not.

    ``exact`` = a name for each cell of a row; else rows may be shorter.
    """
    if not text or _COUNT.fullmatch(text):
        return ()
    for sign in dict.fromkeys((delimiter, ",", "", "\t", ";")):
        cells = [cell.strip('"') for cell in split_row(text, sign, ".")]
        named = _without_end(cells)
        fits = len(cells) >= width and named and (not exact or width >= len(named))
        if fits and not any(map(is_number, named)):
            return tuple(cells[: max(width, len(named))])
    return ()


def _stray(head: list[str], names_line: int) -> str:
    """A line between the names (or the begin) and the numbers that is neither."""
    below = [line for line in head[names_line + 1 :] if _is_text(line)]
    others = [
        line for line in below if names_line < 0 or not _all_units(re.split(r"[;,|\s]+", line))
    ]
    return others[-1].strip() if others else ""


def _all_units(cells: Iterable[str]) -> bool:
    return all(is_unit(cell) for cell in cells if cell not in NOT_MEASURED)


def _is_text(line: str) -> bool:
    return is_content(line) and not _COUNT.fullmatch(line.strip()) and line.strip()[:4] != "sep="


def _promised(head: list[str]) -> int | None:
    counts = [line.strip() for line in head if _COUNT.fullmatch(line.strip())]
    return int(counts[-1]) if counts else None


def _without_end(cells: list[str] | tuple[str, ...]) -> list[str]:
    """Without the empty cells at the end."""
    count = next((k for k in range(len(cells), 0, -1) if cells[k - 1]), 0)
    return list(cells[:count])
