"""Names in files of format 1 and their current names.

Since format 2 of ``summary.json`` names are those of ``docs/reference/glossary.md``. Files of
format 1 are never rewritten: their readers translate.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import TypeVar

SUMMARY = {"way_m": "path_length_m"}
"""Keys of ``summary.json`` and of the figures in an ``approval.json``."""
STEPS = {"share": "match_ratio", "gap_m": "prediction_offset_m"}
"""Columns of ``steps.npz``."""
TILE_FIELDS = {"returns": "surface_returns", "sigma_m": "surface_sd_m"}
"""Fields of a map's tiles, of any format: names in ``tiles.json`` and of the column files."""
PALETTES = {"grey": "gray"}
"""Palettes in the view that a browser keeps."""

Value = TypeVar("Value")


def current_names(record: Mapping[str, Value], renamed: Mapping[str, str]) -> dict[str, Value]:
    """The same values under their current names."""
    return {renamed.get(name, name): value for name, value in record.items()}
