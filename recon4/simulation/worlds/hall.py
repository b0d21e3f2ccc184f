"""A robotics hall of 20 m x 11 m with desks and laboratory equipment along its walls (L §5.1).

The middle is free, 15 m x 7 m: figures are walked there. Beams under the ceiling, windows, doors
and shelves let the profiler see more than four walls.
"""

from __future__ import annotations

import numpy as np

from recon4.geometry.mesh import MeshBuilder
from recon4.simulation.world import Waypoint, World
from recon4.simulation.worlds.furniture import board, desk, lamp, radiator, shelf
from recon4.simulation.worlds.walls import (
    CEILING,
    DARK,
    LINOLEUM,
    STEEL,
    WOOD,
    Opening,
    WallShape,
    wall,
    window,
)

LENGTH_M, WIDTH_M, HEIGHT_M = 20.0, 11.0, 4.5
_FREE = (10.0, 5.3, 7.0, 3.2)
"""Middle x, y and halves of the free floor [m]."""


def build() -> World:
    """The hall; its furniture is drawn once and for all."""
    builder, rng = MeshBuilder(), np.random.default_rng(2015)
    _shell(builder)
    for x in np.arange(1.5, LENGTH_M, 2.6):
        if rng.random() < 0.75:
            shelf(builder, float(x), WIDTH_M - 0.45, height_m=rng.uniform(1.4, 2.4), rng=rng)
    for y in (2.2, 4.6, 7.4):
        desk(builder, 0.75, y, side=1.0, rng=rng)
        desk(builder, LENGTH_M - 0.75, y + 0.6, side=-1.0, rng=rng)
    _equipment(builder, rng)
    return World(name="hall", mesh=builder.mesh(), route=_route, stops=4, floor=_FREE)


def _shell(builder: MeshBuilder) -> None:
    builder.quad([0, 0, 0], [LENGTH_M, 0, 0], [0, WIDTH_M, 0], reflectivity=LINOLEUM)
    builder.quad([0, 0, HEIGHT_M], [LENGTH_M, 0, 0], [0, WIDTH_M, 0], reflectivity=CEILING)
    shape = WallShape(height_m=HEIGHT_M, thickness_m=0.3)
    windows = [window(at, 2.0) for at in (3.0, 7.0, 13.0, 17.0)]
    gate = Opening(10.0, 3.0, 0.0, 3.0, glazed=True)
    wall(builder, (0, WIDTH_M), (LENGTH_M, WIDTH_M), shape=shape, openings=windows)
    wall(builder, (0, 0), (LENGTH_M, 0), shape=shape, openings=[gate])
    for x in (0.0, LENGTH_M):
        wall(builder, (x, 0), (x, WIDTH_M), shape=shape, openings=[Opening(9.3, 0.95, 0.0, 2.1)])
    # What is seen through the doors and the gate.
    builder.box([-3.0, 7.5, 0.0], [-2.9, 11.5, 3.0], 0.5)
    builder.box([LENGTH_M + 2.5, 7.5, 0.0], [LENGTH_M + 2.6, 11.5, 3.0], 0.5)
    for x in np.arange(2.5, LENGTH_M, 5.0):
        builder.box([x - 0.1, 0.15, HEIGHT_M - 0.45], [x + 0.1, WIDTH_M - 0.15, HEIGHT_M], STEEL)
        for y in (2.8, 8.2):
            lamp(builder, float(x) + 1.2, y, ceiling_m=HEIGHT_M - 0.5)
    for x in (3.0, 7.0, 13.0, 17.0):
        radiator(builder, x, WIDTH_M - 0.22)
    board(builder, 0.17, 5.9, length_m=2.0)


def _equipment(builder: MeshBuilder, rng: np.random.Generator) -> None:
    """Cabinets, crates and a workbench along the south wall, and columns of cables."""
    for x in (1.2, 3.4, 5.1, 7.3, 12.6, 14.4, 16.8, 18.7):
        size = [rng.uniform(0.6, 1.3), rng.uniform(0.4, 0.7), rng.uniform(0.5, 2.0)]
        builder.block([x, 0.6, 0.0], size, rng.choice([WOOD, STEEL, DARK]), yaw_rad=0.1 * x)
    for x in (0.35, LENGTH_M - 0.35):
        builder.tube([x, 0.5, 0.0], [x, 0.5, HEIGHT_M], 0.1, reflectivity=STEEL, sides=10)
    builder.box([6.0, WIDTH_M - 0.5, 3.0], [14.0, WIDTH_M - 0.2, 3.3], STEEL)
    builder.ball([9.0, 0.8, 1.9], [0.4, 0.4, 0.5], 0.6)


_START = 0.6
"""Where a round begins, as a part of the free floor's half length."""


def _route(rng: np.random.Generator, stops: int) -> list[Waypoint]:
    """Around the free floor, with a look at its corners, longer the more stops."""
    x, y, half_x, half_y = _FREE
    reach = half_x * (0.4 + 0.15 * stops)
    start = (-_START * half_x, -half_y)
    corners = [start, (reach, -half_y), (reach, half_y), (-reach, half_y)]
    stray = rng.uniform(-0.2, 0.2, (4, 2))
    stray[0] = 0.0  # every round begins and ends in the same place
    ways = [
        Waypoint(x + cx + float(dx), y + 0.8 * cy + float(dy), stop=k + 1 < stops, look_deg=90.0)
        for k, ((cx, cy), (dx, dy)) in enumerate(zip(corners, stray, strict=True))
    ]
    return [*ways, ways[0]]
