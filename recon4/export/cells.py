"""Cells of tables for spreadsheets."""

from __future__ import annotations


def safe_cell(text: str) -> str:
    """A cell that spreadsheets do not evaluate as a formula."""
    return f"'{text}" if text[:1] in ("=", "+", "-", "@", "\t", "\r") else text
