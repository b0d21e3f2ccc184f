"""Tuning of the tables of people."""

from __future__ import annotations

from msgspec import Struct


class TableTuning(Struct, frozen=True, kw_only=True):
    """How a table is read and recognized."""

    head_bytes: int = 64 * 1024
    """Of a file, which tell its encoding."""
    block_characters: int = 16 << 20
    """Read at a time."""
    sample: int = 60
    """Lines from which the layout is detected."""
    fewest_columns: int = 3
    """A table of coordinates has this many numbers in a row."""
    fewest_packed: int = 2
    """Numbers that make a cell in parentheses a group."""


TABLES = TableTuning()


class DxfPointTuning(Struct, frozen=True, kw_only=True):
    """Points of drawings (`dxf_points.py`)."""

    most_pairs: int = 4_000_000
    """Points times texts: in a larger drawing points are numbered."""


DXF_POINTS = DxfPointTuning()


class ShownTableTuning(Struct, frozen=True, kw_only=True):
    """What of a table is shown to who is asked what its columns mean."""

    rows: int = 5
    cell_characters: int = 40
    columns: int = 64


SHOWN_TABLE = ShownTableTuning()


class CoordinateTuning(Struct, frozen=True, kw_only=True):
    """What the size of coordinates says of them (`coordinates.py`)."""

    near_m: float = 20_000.0
    """Coordinates this close to the map are of its place [m]."""
    geodetic_m: float = 100_000.0
    """Larger coordinates are those of a national system, where x often points north [m]."""
    sjtsk_y: tuple[float, float] = (4.0e5, 9.3e5)
    sjtsk_x: tuple[float, float] = (9.3e5, 1.24e6)
    """Range of positive coordinates of S-JTSK, which count to the west and to the south [m]."""


PLACES = CoordinateTuning()
