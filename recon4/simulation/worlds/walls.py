"""Walls with openings, doors, windows and signs: what buildings have in common."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from recon4.geometry.mesh import MeshBuilder, SurfaceKind
from recon4.simulation.materials import MATERIAL


@dataclass(frozen=True, slots=True)
class Opening:
    """A hole in a wall."""

    at_m: float
    """Middle, measured from the wall's start [m]."""
    width_m: float
    bottom_m: float
    top_m: float
    glazed: bool = False
    """A pane in the middle of the wall's thickness."""


@dataclass(frozen=True, slots=True, kw_only=True)
class WallShape:
    """What walls differ in besides their place and openings."""

    bottom_m: float = 0.0
    height_m: float = 2.9
    thickness_m: float = 0.12
    reflectivity: float = MATERIAL.plaster


USUAL_WALL = WallShape()


@dataclass(frozen=True, slots=True, kw_only=True)
class DoorSize:
    """Size of a doorway, which begins at the floor."""

    width_m: float = 0.95
    top_m: float = 2.1


USUAL_DOOR = DoorSize()


def door(at_m: float) -> Opening:
    """An open doorway."""
    return Opening(at_m, USUAL_DOOR.width_m, 0.0, USUAL_DOOR.top_m)


def window(at_m: float, width_m: float = 1.6) -> Opening:
    """A window above a parapet."""
    return Opening(at_m, width_m, 0.9, 2.2, glazed=True)


def wall(
    builder: MeshBuilder,
    start: tuple[float, float],
    end: tuple[float, float],
    *,
    shape: WallShape = USUAL_WALL,
    openings: Sequence[Opening] = (),
) -> None:
    """An axis-parallel wall whose middle line runs from start to end [m]; recesses come out."""
    height_m, thickness_m, reflectivity = shape.height_m, shape.thickness_m, shape.reflectivity
    along = 0 if abs(end[0] - start[0]) > abs(end[1] - start[1]) else 1
    assert start[1 - along] == end[1 - along] and start[along] < end[along]
    bricks = _Bricks(builder, along, start[1 - along], shape.bottom_m)
    full, at = (0.0, height_m), start[along]
    for hole in sorted(openings, key=lambda opening: opening.at_m):
        left = start[along] + hole.at_m - hole.width_m / 2
        right = left + hole.width_m
        bricks.lay((at, left), full, thickness_m, value=reflectivity)
        bricks.lay((left, right), (0.0, hole.bottom_m), thickness_m, value=reflectivity)
        bricks.lay((left, right), (hole.top_m, height_m), thickness_m, value=reflectivity)
        if hole.glazed:
            _glaze(bricks, left, right, hole=hole)
        at = right
    bricks.lay((at, end[along]), full, thickness_m, value=reflectivity)


@dataclass(frozen=True, slots=True, eq=False)
class _Bricks:
    """Boxes centered on the middle line of one wall."""

    builder: MeshBuilder
    along: int
    middle_m: float
    bottom_m: float

    def lay(
        self, span: tuple[float, float], level: tuple[float, float], depth: float, *, value: float
    ) -> None:
        """One box, unless there is nothing of it."""
        if span[1] - span[0] < 1e-6 or level[1] - level[0] < 1e-6:
            return
        reach = (self.middle_m - depth / 2, self.middle_m + depth / 2)
        levels = (self.bottom_m + level[0], self.bottom_m + level[1])
        extent = SlabExtent(span, reach, levels)
        slab(self.builder, extent, along=self.along, reflectivity=value)


@dataclass(frozen=True, slots=True)
class SlabExtent:
    """Extent of a box of a facade, from and to [m]."""

    span: tuple[float, float]
    """Along the facade."""
    reach: tuple[float, float]
    """Across it, in any order."""
    level: tuple[float, float]
    """In height."""


def slab(builder: MeshBuilder, extent: SlabExtent, *, along: int, reflectivity: float) -> None:
    """A box of a facade along axis 0 or 1."""
    corners = np.empty((2, 3))
    corners[:, along] = extent.span
    corners[:, 1 - along] = sorted(extent.reach)
    corners[:, 2] = extent.level
    with builder.of(SurfaceKind.BUILDING):
        builder.box(corners[0], corners[1], reflectivity)


def _glaze(bricks: _Bricks, left: float, right: float, *, hole: Opening) -> None:
    """Pane and frame with a mullion."""
    full, frame, middle = (hole.bottom_m, hole.top_m), 0.06, 0.5 * (left + right)
    bricks.lay((left, right), full, 0.01, value=MATERIAL.pane)
    for a, b in [(left, left + frame), (right - frame, right), (middle - 0.03, middle + 0.03)]:
        bricks.lay((a, b), full, 0.07, value=MATERIAL.paper)
    bricks.lay((left, right), (hole.bottom_m, hole.bottom_m + frame), 0.07, value=MATERIAL.paper)
    bricks.lay((left, right), (hole.top_m - frame, hole.top_m), 0.07, value=MATERIAL.paper)
