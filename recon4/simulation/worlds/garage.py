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

from dataclasses import dataclass
from functools import partial

import numpy as np
from numpy.typing import ArrayLike

from recon4.geometry.mesh import MeshBuilder
from recon4.geometry.se3 import Array
from recon4.simulation.materials import MATERIAL
from recon4.simulation.world import Waypoint, World
from recon4.simulation.worlds.outdoors import car
from recon4.simulation.worlds.walls import WallShape, wall


@dataclass(frozen=True, slots=True, kw_only=True)
class GaragePlan:
    """Measures of a variant, see the drawing."""

    taken: float = 0.0
    """Chance that a car is parked in a bay."""
    columns: int = 12
    """Along x."""
    rows: int = 6
    """Of columns; aisles lie between rows 0 and 1, 2 and 3, 4 and 5."""
    grid_m: float = 5.0
    """From column to column."""
    margin_m: float = 5.0
    """From the outer columns to the walls."""
    column_m: float = 0.4
    """Width of a column."""
    height_m: float = 2.6
    beside_m: float = 0.9
    """From a column to where people cross the bays, beside the cars."""
    stops: int = 8


def build(variant: int = 0) -> World:
    """The garage; the variant draws how many bays are taken, and by what."""
    rng = np.random.default_rng([5005, variant])
    plan = GaragePlan() if variant == 0 else GaragePlan(taken=float(rng.uniform(0.1, 0.6)))
    builder = MeshBuilder()
    size = plan.grid_m * np.array([plan.columns - 1, plan.rows - 1]) + 2 * plan.margin_m
    for z, value in ((0.0, MATERIAL.concrete), (plan.height_m, MATERIAL.concrete)):
        builder.quad([0, 0, z], [size[0], 0, 0], [0, size[1], 0], reflectivity=value)
    concrete = WallShape(height_m=plan.height_m, reflectivity=MATERIAL.concrete)
    for y in (0.0, float(size[1])):
        wall(builder, (0, y), (float(size[0]), y), shape=concrete)
    for x in (0.0, float(size[0])):
        wall(builder, (x, 0), (x, float(size[1])), shape=concrete)
    pillar = [plan.column_m, plan.column_m, plan.height_m]
    for column in range(plan.columns):
        for row in range(plan.rows):
            x, y = _column(plan, column, row)
            builder.block([x, y, 0], pillar, MATERIAL.concrete)
    for x, y, inward in _bays(plan):
        builder.block([x, y, 0.0], [0.1, 4.4, 0.003], MATERIAL.paper)
        if rng.random() < plan.taken:
            yaw = 0.5 * np.pi * inward
            car(builder, (x + 0.5 * plan.grid_m, y), yaw_rad=yaw, ground=_floor, rng=rng)
    return World(name="garage", mesh=builder.mesh(), route=partial(_route, plan), stops=plan.stops)


def _column(plan: GaragePlan, column: int, row: int) -> tuple[float, float]:
    return plan.margin_m + plan.grid_m * column, plan.margin_m + plan.grid_m * row


def _floor(x_m: ArrayLike, y_m: ArrayLike) -> Array:
    return 0.0 * (np.asarray(x_m, dtype=np.float64) + np.asarray(y_m, dtype=np.float64))


def _bays(plan: GaragePlan) -> list[tuple[float, float, float]]:
    """Left edge x, middle y [m] of the bays and 1 or -1: along y in or out of the aisle."""
    found = []
    for column in range(plan.columns - 1):
        for row, inward in ((1, 1.0), (3, 1.0)):  # between the rows without an aisle
            x, y = _column(plan, column, row)
            found.append((x, y + 0.5 * plan.grid_m, inward))
        x, y = _column(plan, column, 0)
        found.append((x, y - 0.5 * plan.margin_m, -1.0))
        x, y = _column(plan, column, plan.rows - 1)
        found.append((x, y + 0.5 * plan.margin_m, 1.0))
    return found


def _route(plan: GaragePlan, rng: np.random.Generator, stops: int) -> list[Waypoint]:
    """Along one aisle and back along another one, farther the more stops."""
    out, back = sorted(rng.choice(3, size=2, replace=False))
    if stops < 4:  # a short round stays in one aisle
        back = out
    west = plan.margin_m + plan.beside_m
    east = west + plan.grid_m * round((plan.columns - 2) * stops / plan.stops)
    ys = [plan.margin_m + plan.grid_m * (2.0 * aisle + 0.5) for aisle in (out, back)]
    start = Waypoint(west, ys[0])
    corners = [start, Waypoint(east, ys[0], stop=True, look_deg=90.0)]
    if back != out:
        corners += [Waypoint(east, ys[1]), Waypoint(west, ys[1], stop=True, look_deg=-90.0)]
    return [*corners, start]
