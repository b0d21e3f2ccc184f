"""Aligned text tables."""

from __future__ import annotations

from collections.abc import Sequence

_MISSING = "–"


def text_table(header: Sequence[str], rows: Sequence[Sequence[str]]) -> str:
    """Format a table: the first column left-aligned, the others right-aligned.

    Args:
        header: Title of each column, with the unit.
        rows: Cells; every row as long as the header.
    """
    lines = [list(header), *[list(row) for row in rows]]
    widths = [max(len(line[k]) for line in lines) for k in range(len(header))]
    out = []
    for line in lines:
        cells = [
            c.ljust(w) if k == 0 else c.rjust(w)
            for k, (c, w) in enumerate(zip(line, widths, strict=True))
        ]
        out.append("  ".join(cells).rstrip())
    out.insert(1, "  ".join("-" * w for w in widths))
    return "\n".join(out)


def number(value: float, digits: int = 2, scale: float = 1.0) -> str:
    """A number for a cell, never -0.0; a dash where it is not finite."""
    scaled = value * scale
    return f"{scaled:z.{digits}f}" if scaled - scaled == 0 else _MISSING


def percentage(value: float, digits: int = 1) -> str:
    """A ratio 0..1 as percent."""
    return f"{number(value, digits, 100.0)} %" if value == value else _MISSING
