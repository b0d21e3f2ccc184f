"""A robotics hall of 20 m x 11 m with desks and laboratory equipment along its walls (L §5.1).

The middle is free, 15 m x 7 m: figures are walked there. Beams under the ceiling, windows, doors
and shelves let the profiler see more than four walls.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from recon4.geometry.mesh import MeshBuilder
from recon4.simulation.materials import MATERIAL
from recon4.simulation.world import Waypoint, World
from recon4.simulation.worlds.furniture import board, desk, lamp, radiator, shelf
from recon4.simulation.worlds.walls import Opening, WallShape, wall, window


@dataclass(frozen=True, slots=True, kw_only=True)
class HallPlan:
    """Measures of the hall."""

    length_m: float = 20.0
    width_m: float = 11.0
    height_m: float = 4.5
    free_m: tuple[float, float, float, float] = (10.0, 5.3, 7.0, 3.2)
    """Middle x, y and halves of the free floor."""
    start: float = 0.6
    """Where a round begins, as a part of the free floor's half length."""


HALL = HallPlan()


def build() -> World:
    """The hall; its furniture is drawn once and for all."""
    builder, rng = MeshBuilder(), np.random.default_rng(2015)
    _shell(builder)
    for x in np.arange(1.5, HALL.length_m, 2.6):
        if rng.random() < 0.75:
            shelf(builder, float(x), HALL.width_m - 0.45, height_m=rng.uniform(1.4, 2.4), rng=rng)
    for y in (2.2, 4.6, 7.4):
        desk(builder, 0.75, y, side=1.0, rng=rng)
        desk(builder, HALL.length_m - 0.75, y + 0.6, side=-1.0, rng=rng)
    _equipment(builder, rng)
    return World(name="hall", mesh=builder.mesh(), route=_route, stops=4, floor=HALL.free_m)


def _shell(builder: MeshBuilder) -> None:
    length_m, width_m, height_m = HALL.length_m, HALL.width_m, HALL.height_m
    builder.quad([0, 0, 0], [length_m, 0, 0], [0, width_m, 0], reflectivity=MATERIAL.linoleum)
    builder.quad([0, 0, height_m], [length_m, 0, 0], [0, width_m, 0], reflectivity=MATERIAL.ceiling)
    shape = WallShape(height_m=height_m, thickness_m=0.3)
    windows = [window(at, 2.0) for at in (3.0, 7.0, 13.0, 17.0)]
    gate = Opening(10.0, 3.0, 0.0, 3.0, glazed=True)
    wall(builder, (0, width_m), (length_m, width_m), shape=shape, openings=windows)
    wall(builder, (0, 0), (length_m, 0), shape=shape, openings=[gate])
    for x in (0.0, length_m):
        wall(builder, (x, 0), (x, width_m), shape=shape, openings=[Opening(9.3, 0.95, 0.0, 2.1)])
    # What is seen through the doors and the gate.
    builder.box([-3.0, 7.5, 0.0], [-2.9, 11.5, 3.0], 0.5)
    builder.box([length_m + 2.5, 7.5, 0.0], [length_m + 2.6, 11.5, 3.0], 0.5)
    for x in np.arange(2.5, length_m, 5.0):
        builder.box(
            [x - 0.1, 0.15, height_m - 0.45], [x + 0.1, width_m - 0.15, height_m], MATERIAL.steel
        )
        for y in (2.8, 8.2):
            lamp(builder, float(x) + 1.2, y, ceiling_m=height_m - 0.5)
    for x in (3.0, 7.0, 13.0, 17.0):
        radiator(builder, x, width_m - 0.22)
    board(builder, 0.17, 5.9, length_m=2.0)


def _equipment(builder: MeshBuilder, rng: np.random.Generator) -> None:
    """Cabinets, crates and a workbench along the south wall, and columns of cables."""
    for x in (1.2, 3.4, 5.1, 7.3, 12.6, 14.4, 16.8, 18.7):
        size = [rng.uniform(0.6, 1.3), rng.uniform(0.4, 0.7), rng.uniform(0.5, 2.0)]
        builder.block(
            [x, 0.6, 0.0],
            size,
            rng.choice([MATERIAL.wood, MATERIAL.steel, MATERIAL.dark]),
            yaw_rad=0.1 * x,
        )
    for x in (0.35, HALL.length_m - 0.35):
        builder.tube(
            [x, 0.5, 0.0], [x, 0.5, HALL.height_m], 0.1, reflectivity=MATERIAL.steel, sides=10
        )
    builder.box([6.0, HALL.width_m - 0.5, 3.0], [14.0, HALL.width_m - 0.2, 3.3], MATERIAL.steel)
    builder.ball([9.0, 0.8, 1.9], [0.4, 0.4, 0.5], 0.6)


def _route(rng: np.random.Generator, stops: int) -> list[Waypoint]:
    """Around the free floor, with a look at its corners, longer the more stops."""
    x, y, half_x, half_y = HALL.free_m
    reach = half_x * (0.4 + 0.15 * stops)
    start = (-HALL.start * half_x, -half_y)
    corners = [start, (reach, -half_y), (reach, half_y), (-reach, half_y)]
    stray = rng.uniform(-0.2, 0.2, (4, 2))
    stray[0] = 0.0  # every round begins and ends in the same place
    ways = [
        Waypoint(x + cx + float(dx), y + 0.8 * cy + float(dy), stop=k + 1 < stops, look_deg=90.0)
        for k, ((cx, cy), (dx, dy)) in enumerate(zip(corners, stray, strict=True))
    ]
    return [*ways, ways[0]]
