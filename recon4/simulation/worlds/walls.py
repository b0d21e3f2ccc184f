"""Walls with openings, doors, windows and signs: what buildings have in common."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from recon4.simulation.mesh import MeshBuilder

WALL_M = 0.12
DOOR_M = 0.95
DOOR_TOP_M = 2.1
PLASTER, CEILING, LINOLEUM, WOOD, DARK, STEEL, LAMP, PANE, PAPER = (
    0.55, 0.65, 0.3, 0.4, 0.12, 0.35, 0.95, 0.015, 0.8,
)  # fmt: skip


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


def door(at_m: float) -> Opening:
    """An open doorway."""
    return Opening(at_m, DOOR_M, 0.0, DOOR_TOP_M)


def window(at_m: float, width_m: float = 1.6) -> Opening:
    """A window above a parapet."""
    return Opening(at_m, width_m, 0.9, 2.2, glazed=True)


def wall(
    builder: MeshBuilder,
    start: tuple[float, float],
    end: tuple[float, float],
    *,
    bottom_m: float = 0.0,
    height_m: float = 2.9,
    thickness_m: float = WALL_M,
    openings: Sequence[Opening] = (),
    reflectivity: float = PLASTER,
) -> None:
    """An axis-parallel wall whose middle line runs from start to end [m]; recesses come out."""
    along = 0 if abs(end[0] - start[0]) > abs(end[1] - start[1]) else 1
    assert start[1 - along] == end[1 - along] and start[along] < end[along]

    def brick(a: float, b: float, low: float, high: float, depth: float, value: float) -> None:
        if b - a < 1e-6 or high - low < 1e-6:
            return
        corners = np.empty((2, 3))
        corners[:, along] = a, b
        corners[:, 1 - along] = start[1 - along] - depth / 2, start[1 - along] + depth / 2
        corners[:, 2] = bottom_m + low, bottom_m + high
        builder.box(corners[0], corners[1], value)

    at = start[along]
    for hole in sorted(openings, key=lambda opening: opening.at_m):
        left = start[along] + hole.at_m - hole.width_m / 2
        right = left + hole.width_m
        brick(at, left, 0.0, height_m, thickness_m, reflectivity)
        brick(left, right, 0.0, hole.bottom_m, thickness_m, reflectivity)
        brick(left, right, hole.top_m, height_m, thickness_m, reflectivity)
        if hole.glazed:
            _glaze(brick, left, right, hole)
        at = right
    brick(at, end[along], 0.0, height_m, thickness_m, reflectivity)


def _glaze(brick, left: float, right: float, hole: Opening) -> None:  # type: ignore[no-untyped-def]
    """Pane and frame with a mullion."""
    brick(left, right, hole.bottom_m, hole.top_m, 0.01, PANE)
    frame = 0.06
    middle = 0.5 * (left + right)
    for a, b in [(left, left + frame), (right - frame, right), (middle - 0.03, middle + 0.03)]:
        brick(a, b, hole.bottom_m, hole.top_m, 0.07, PAPER)
    brick(left, right, hole.bottom_m, hole.bottom_m + frame, 0.07, PAPER)
    brick(left, right, hole.top_m - frame, hole.top_m, 0.07, PAPER)
