"""Rows that stand in one cell, and cells that hold several coordinates: ``(E;N;h)``."""

from __future__ import annotations

import re

from recon4.recording.tables.layout import NUMBER, is_content
from recon4.recording.tables.tuning import TABLES

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
