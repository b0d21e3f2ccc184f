"""A parking garage: equal columns on a grid of 5 m, bays painted on the floor, bare walls.

A shift by one bay along either axis gives the same view but for the outer walls and the cars.
Variant 0 is empty; the others have parked cars in some bays.

From above, columns ``o``, aisles along x between every second row::

    +---------------------+
    |  o  o  o  o  o  o   |
    |      aisle          |
    |  o  o  o  o  o  o   |
    |  o  o  o  o  o  o   |
    |      aisle          |
    |  o  o  o  o  o  o   |
    +---------------------+
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from recon4.geometry.mesh import MeshBuilder
from recon4.geometry.se3 import Array
from recon4.simulation.world import Waypoint, World
from recon4.simulation.worlds.outdoors import CONCRETE, car
from recon4.simulation.worlds.walls import PAPER, WallShape, wall

GRID_M = 5.0
COLUMN_M = 0.4
HEIGHT_M = 2.6
_COLUMNS_X = 12
_ROWS = 6
"""Of columns; aisles lie between rows 0 and 1, 2 and 3, 4 and 5."""
_MARGIN_M = 5.0
_STOPS = 8
_BESIDE_M = 0.9
"""From a column to where people cross the bays, beside the cars [m]."""


def build(variant: int = 0) -> World:
    """The garage; the variant draws how many bays are taken, and by what."""
    rng = np.random.default_rng([5005, variant])
    taken = 0.0 if variant == 0 else float(rng.uniform(0.1, 0.6))
    builder = MeshBuilder()
    size = np.array([GRID_M * (_COLUMNS_X - 1), GRID_M * (_ROWS - 1)]) + 2 * _MARGIN_M
    for z, value in ((0.0, CONCRETE), (HEIGHT_M, CONCRETE)):
        builder.quad([0, 0, z], [size[0], 0, 0], [0, size[1], 0], reflectivity=value)
    concrete = WallShape(height_m=HEIGHT_M, reflectivity=CONCRETE)
    for y in (0.0, float(size[1])):
        wall(builder, (0, y), (float(size[0]), y), shape=concrete)
    for x in (0.0, float(size[0])):
        wall(builder, (x, 0), (x, float(size[1])), shape=concrete)
    for column in range(_COLUMNS_X):
        for row in range(_ROWS):
            x, y = _column(column, row)
            builder.block([x, y, 0], [COLUMN_M, COLUMN_M, HEIGHT_M], CONCRETE)
    for x, y, inward in _bays():
        builder.block([x, y, 0.0], [0.1, 4.4, 0.003], PAPER)
        if rng.random() < taken:
            yaw = 0.5 * np.pi * inward
            car(builder, (x + 0.5 * GRID_M, y), yaw_rad=yaw, ground=_floor, rng=rng)
    return World(name="garage", mesh=builder.mesh(), route=_route, stops=_STOPS)


def _column(column: int, row: int) -> tuple[float, float]:
    return _MARGIN_M + GRID_M * column, _MARGIN_M + GRID_M * row


def _floor(x_m: ArrayLike, y_m: ArrayLike) -> Array:
    return 0.0 * (np.asarray(x_m, dtype=np.float64) + np.asarray(y_m, dtype=np.float64))


def _bays() -> list[tuple[float, float, float]]:
    """Left edge x, middle y [m] of the bays and 1 or -1: along y in or out of the aisle."""
    found = []
    for column in range(_COLUMNS_X - 1):
        for row, inward in ((1, 1.0), (3, 1.0)):  # between the rows without an aisle
            x, y = _column(column, row)
            found.append((x, y + 0.5 * GRID_M, inward))
        x, y = _column(column, 0)
        found.append((x, y - 0.5 * _MARGIN_M, -1.0))
        x, y = _column(column, _ROWS - 1)
        found.append((x, y + 0.5 * _MARGIN_M, 1.0))
    return found


def _route(rng: np.random.Generator, stops: int) -> list[Waypoint]:
    """Along one aisle and back along another one, farther the more stops."""
    out, back = sorted(rng.choice(3, size=2, replace=False))
    if stops < 4:  # a short round stays in one aisle
        back = out
    west = _MARGIN_M + _BESIDE_M
    east = west + GRID_M * round((_COLUMNS_X - 2) * stops / _STOPS)
    ys = [_MARGIN_M + GRID_M * (2.0 * aisle + 0.5) for aisle in (out, back)]
    start = Waypoint(west, ys[0])
    corners = [start, Waypoint(east, ys[0], stop=True, look_deg=90.0)]
    if back != out:
        corners += [Waypoint(east, ys[1]), Waypoint(west, ys[1], stop=True, look_deg=-90.0)]
    return [*corners, start]
