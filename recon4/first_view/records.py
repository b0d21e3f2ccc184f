"""What the page *Map* reads of a map before it reads points."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

Xyz = tuple[float, float, float]
ColumnName = Literal["intensity", "normalized", "time", "uncertainty", "thickness"]
"""Values that are stored for each point; height and class come with the positions."""
Stored = Literal["xyz", "intensity", "normalized", "time", "uncertainty", "thickness"]
"""What a chunk is read of: positions with normals and classes, or one kind of value."""


@dataclass(frozen=True, slots=True, kw_only=True)
class MapTile:
    """A cube of the map."""

    low_m: Xyz
    """Smallest coordinates of its points [m]; positions in chunks are fractions of low to high."""
    high_m: Xyz
    points: int
    sample: int
    """Its first points that are in the sample of the whole map."""
    coarse: int
    """Its first points that are in its cube: further ones are read of the tile."""
    cube: int
    """Row of the cube that has its coarse points, with those of tiles near it."""
    spacing_m: float
    """Distance of neighboring points if all are drawn [m]."""


@dataclass(frozen=True, slots=True, kw_only=True)
class MapColumn:
    """A kind of value by which points can be colored: ``offset + scale * stored``."""

    name: ColumnName
    unit: str
    offset: float
    scale: float
    low: float
    """Usual low end of the colors."""
    high: float


@dataclass(frozen=True, slots=True, kw_only=True)
class Storey:
    """A storey that was walked through."""

    name: str
    """As in plans and exports: ``0`` is where the walk begins, ``1`` the next one above."""
    floor_m: float
    """Height of its floor [m]."""
    walk_m: float
    """Usual height of the sensors [m]."""
    ceiling: bool
    """Whether there is something above it that looks like a ceiling, and no walk."""


@dataclass(frozen=True, slots=True, kw_only=True)
class MapIndex:
    """What the page needs to know before it reads points."""

    key: str
    """The map's artifact: chunks of a key never change."""
    version: int
    """Of the layout of samples and chunks: part of their addresses."""
    points: int
    low_m: Xyz
    """Extent of nearly all points [m]: few stray ones do not decide it."""
    high_m: Xyz
    tiles: list[MapTile]
    columns: list[MapColumn]
    color: Literal["normalized", "intensity", "height"]
    """By what the points are colored at first: not by values that are the same everywhere."""
    classes: dict[int, str]
    """Names of the classes in the map, by code."""
    class_percent: dict[int, float]
    """Part of its points that have each class [%]; empty = a map of an earlier version."""
    storeys: list[Storey]
    crs: str
    frame: str
    """Caption of the coordinate frame."""
    surface: str
    """Where the points lie: on fitted surfaces, or as measured."""
    seconds: float
