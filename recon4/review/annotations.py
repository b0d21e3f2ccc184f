"""Notes that people pinned to a map, and measurements in the views that they saved.

The server writes these files (``recon4_app/annotations/store.py``); here they are read.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from pathlib import Path
from typing import TypeVar
from urllib.parse import parse_qs

import msgspec
import numpy as np

from recon4.errors import StoreError
from recon4.geometry.se3 import Array
from recon4.locales.coded import unreadable
from recon4.review.tuning import ANNOTATION_FILES
from recon4.store.json_files import read_object
from recon4.store.seal import check_sealed
from recon4.untrusted.typed import as_type

Point = tuple[float, float, float]


class PinnedNote(msgspec.Struct, frozen=True):
    """A note of a person at a place of the map [m]."""

    p_map: Point
    text: str
    status: str
    """``open`` or ``done``."""
    who: str
    time: str
    """UTC, ISO 8601."""


class SavedView(msgspec.Struct, frozen=True):
    """A view that a person saved, with what they measured in it."""

    name: str
    query: str
    """Of the page's address."""
    who: str
    time: str


class Measured(msgspec.Struct, frozen=True):
    """A measurement between points of the map [m]."""

    kind: str
    name: str
    points: tuple[Point, ...]
    view: SavedView

    @property
    def text(self) -> str:
        """Its figures; a profile or volume is worked out on the page."""
        return measured_text(self.kind, np.array(self.points))


Entry = TypeVar("Entry", PinnedNote, SavedView)


def pinned_notes(root: Path) -> list[PinnedNote]:
    """The notes of a project, oldest first.

    Raises:
        Altered: If their file was changed by another program.
        StoreError: If it is damaged.
    """
    return _entries(root, ANNOTATION_FILES.notes, list[PinnedNote])


def saved_measurements(root: Path) -> list[Measured]:
    """The measurements in the saved views of a project; errors as `pinned_notes`."""
    views = _entries(root, ANNOTATION_FILES.views, list[SavedView])
    return [one for view in views for one in _measurements(view)]


def _entries(root: Path, name: str, kind: type[list[Entry]]) -> list[Entry]:
    check_sealed(root, name)
    if not (root / name).exists():
        return []
    found = read_object(root / name, max_bytes=ANNOTATION_FILES.max_bytes)
    try:
        if found.get("format") != ANNOTATION_FILES.format:
            raise ValueError(f"expected format {ANNOTATION_FILES.format}")
        return as_type(found.get("items"), kind)
    except ValueError as error:
        raise StoreError(unreadable(name, error)) from error


def _measurements(view: SavedView) -> Iterator[Measured]:
    """Those of a view: ``m=kind:figure;x,y,z;…;name``; what is none of them is no measurement."""
    for text in parse_qs(view.query).get("m", []):
        head, *places, name = text.split(";")
        try:
            points = tuple(_point(place) for place in places)
        except ValueError:
            continue
        kind = head.partition(":")[0]
        if kind in _LEAST and len(points) >= _LEAST[kind]:
            yield Measured(kind, name, points, view)


_LEAST = {"point": 1, "distance": 2, "height": 2, "angle": 3, "area": 3, "profile": 2, "volume": 3}
"""Kinds of measurements, and their least points."""


def _point(text: str) -> Point:
    x, y, z = map(float, text.split(","))
    if not all(map(math.isfinite, (x, y, z))):
        raise ValueError("expected finite coordinates")
    return x, y, z


def measured_text(kind: str, p_map: Array) -> str:
    """What a measurement says, as the page *Map* does.

    Args:
        kind: Of it.
        p_map: Its points [m], (N, 3).
    """
    if kind == "point":
        return " ".join(f"{x:.3f}" for x in p_map[0])
    if kind == "angle":
        u, v = p_map[0] - p_map[1], p_map[2] - p_map[1]
        size = float(np.linalg.norm(u) * np.linalg.norm(v))
        cosine = float(u @ v) / size if size else 1.0
        return f"{math.degrees(math.acos(min(1.0, max(-1.0, cosine)))):.2f}°"
    if kind in ("area", "volume"):
        around = np.roll(p_map, -1, axis=0)
        area = 0.5 * np.cross(p_map - p_map[0], around - p_map[0]).sum(axis=0)
        return f"{np.linalg.norm(area):.3f} m², from above {abs(area[2]):.3f} m²"
    d = p_map[1] - p_map[0]
    flat = f"horizontal {math.hypot(d[0], d[1]):.3f} m, vertical {d[2]:+z.3f} m"
    return f"{np.linalg.norm(d):.3f} m, {flat}"
