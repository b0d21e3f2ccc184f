"""A world with true edges, thin things and thin walls, for the benchmark of fitted surfaces.

Two rooms of 5 m x 7 m on both sides of a partition of 8 cm with a doorway, seen from above::

      y
    7 +---------+---------+
      | table   | panel   |
      |         |         |
      |            rods   |      the doorway is at y = 3.0 to 3.95
      | rods    | cabinet |
      | cabinet | table   |
    0 +---------+---------+  x
      0         5        10
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from recon4.geometry.mesh import MeshBuilder
from recon4.geometry.se3 import Array
from recon4.simulation.materials import MATERIAL
from recon4.simulation.world import Waypoint, World

LENGTH_M, WIDTH_M, HEIGHT_M = 10.0, 7.0, 2.8
DOOR_M = (3.0, 3.95)
DOOR_TOP_M = 2.1
PARTITION_M = 0.08
DIAMETERS_M = (0.01, 0.02, 0.03, 0.04)


@dataclass(frozen=True, slots=True, eq=False)
class TrueEdge:
    """A straight edge of two faces."""

    kind: str
    start_m: Array
    end_m: Array
    along: Array
    """Unit vectors from the edge into each of its faces, (2, 3); the normal of each is the other
    one, of either sign."""
    extent_m: float
    """How far the narrower face reaches [m]."""


@dataclass(frozen=True, slots=True, eq=False)
class Rod:
    """A leg, a rail or a wire."""

    start_m: Array
    end_m: Array
    diameter_m: float


@dataclass(frozen=True, slots=True, eq=False)
class Exhibition:
    """The world, and what is measured in it."""

    world: World
    edges: tuple[TrueEdge, ...]
    rods: tuple[Rod, ...]


class _Workshop:
    """Collects shapes with their edges."""

    def __init__(self) -> None:
        self.builder = MeshBuilder()
        self.edges: list[TrueEdge] = []
        self.rods: list[Rod] = []

    def rod(self, start: list[float], end: list[float], diameter_m: float) -> None:
        self.builder.tube(start, end, 0.5 * diameter_m, reflectivity=MATERIAL.steel, sides=12)
        self.rods.append(Rod(np.array(start), np.array(end), diameter_m))

    def edge(self, kind: str, start: list[float], size_m: float, axes: list[list[float]]) -> None:
        """An edge along the first axis, into the two others."""
        line, *faces = np.array(axes, dtype=np.float64)
        a = np.array(start)
        self.edges.append(TrueEdge(kind, a, a + size_m * line, np.array(faces), 1.0))

    def cabinet(self, low: list[float], high: list[float], *, kind: str, rim: bool) -> None:
        """A box standing free: its four upper edges, and the four upright ones if it is no rim."""
        self.builder.box(low, high, MATERIAL.wood)
        (x0, y0, _), (x1, y1, z1) = low, high
        for x, inward in ((x0, 1.0), (x1, -1.0)):
            self.edge(kind, [x, y0, z1], y1 - y0, [[0, 1, 0], [inward, 0, 0], [0, 0, -1]])
        for y, inward in ((y0, 1.0), (y1, -1.0)):
            self.edge(kind, [x0, y, z1], x1 - x0, [[1, 0, 0], [0, inward, 0], [0, 0, -1]])
        if rim:
            return
        for x, ix in ((x0, 1.0), (x1, -1.0)):
            for y, iy in ((y0, 1.0), (y1, -1.0)):
                self.edge(kind, [x, y, 0.1], z1 - 0.2, [[0, 0, 1], [ix, 0, 0], [0, iy, 0]])


def build() -> Exhibition:
    """The two rooms; always the same."""
    shop = _Workshop()
    _shell(shop)
    _partition(shop)
    shop.cabinet([0.6, 0.5, 0.0], [1.4, 1.0, 1.2], kind="cabinet", rim=False)
    shop.cabinet([8.6, 2.2, 0.0], [9.1, 3.0, 0.9], kind="cabinet", rim=False)
    shop.cabinet([1.0, 5.4, 0.70], [2.4, 6.1, 0.73], kind="table", rim=True)
    shop.cabinet([7.0, 0.6, 0.70], [8.4, 1.3, 0.73], kind="table", rim=True)
    shop.builder.box([6.6, 5.6, 0.0], [8.6, 5.63, 1.9], MATERIAL.wood)
    _rods(shop)
    world = World(name="exhibition", mesh=shop.builder.mesh(), route=_route, stops=4)
    return Exhibition(world, tuple(shop.edges), tuple(shop.rods))


def _shell(shop: _Workshop) -> None:
    """Floor, ceiling, outer walls; corners of the rooms are edges seen from inside."""
    b, x, y, z = shop.builder, LENGTH_M, WIDTH_M, HEIGHT_M
    b.quad([0, 0, 0], [x, 0, 0], [0, y, 0], reflectivity=MATERIAL.linoleum)
    b.quad([0, 0, z], [x, 0, 0], [0, y, 0], reflectivity=MATERIAL.plaster)
    for at in (0.0, y):
        b.quad([0, at, 0], [x, 0, 0], [0, 0, z], reflectivity=MATERIAL.plaster)
    for at in (0.0, x):
        b.quad([at, 0, 0], [0, y, 0], [0, 0, z], reflectivity=MATERIAL.plaster)
    for wx, ix in ((0.0, 1.0), (x, -1.0)):
        for wy, iy in ((0.0, 1.0), (y, -1.0)):
            shop.edge("corner", [wx, wy, 0.2], z - 0.4, [[0, 0, 1], [ix, 0, 0], [0, iy, 0]])
        shop.edge("corner", [wx, 0.3, z], y - 0.6, [[0, 1, 0], [ix, 0, 0], [0, 0, -1]])


def _partition(shop: _Workshop) -> None:
    """The wall of 8 cm between the rooms, and the reveals of its doorway."""
    west, east = (0.5 * (LENGTH_M + side * PARTITION_M) for side in (-1.0, 1.0))
    low, high = DOOR_M
    for a, b in ((0.0, low), (high, WIDTH_M)):
        shop.builder.box([west, a, 0], [east, b, HEIGHT_M], MATERIAL.plaster)
    shop.builder.box([west, low, DOOR_TOP_M], [east, high, HEIGHT_M], MATERIAL.plaster)
    for x, inward in ((west, 1.0), (east, -1.0)):
        for y, into in ((low, -1.0), (high, 1.0)):
            faces = [[0, 0, 1], [0, into, 0], [inward, 0, 0]]
            shop.edge("reveal", [x, y, 0.1], DOOR_TOP_M - 0.2, faces)
        faces = [[0, 1, 0], [0, 0, 1], [inward, 0, 0]]
        shop.edge("reveal", [x, low + 0.1, DOOR_TOP_M], high - low - 0.2, faces)


def _rods(shop: _Workshop) -> None:
    """Of each diameter a leg before a wall, a rail at a wall, a free leg and a wire."""
    for k, diameter in enumerate(DIAMETERS_M):
        along = 2.0 + 0.5 * k
        shop.rod([0.25, along, 0.05], [0.25, along, 1.6], diameter)
        shop.rod(
            [1.0 + 0.4 * k, 2.0 + 0.3 * k, 0.05], [1.0 + 0.4 * k, 2.0 + 0.3 * k, 1.4], diameter
        )
        rail = 0.7 + 0.35 * k
        shop.rod([9.94, 3.4, rail], [9.94, 6.6, rail], diameter)
        shop.rod([2.4, 6.9, rail], [4.6, 6.9, rail], diameter)
        shop.rod([5.6, 4.2 + 0.25 * k, 1.9], [9.8, 4.2 + 0.25 * k, 2.2], diameter)


def _route(rng: np.random.Generator, stops: int) -> list[Waypoint]:
    """Through the door into each room and back, with looks around."""
    way = [(3.0, 3.5), (3.6, 3.5), (6.2, 3.5), (7.4, 3.6), (7.2, 2.0), (6.0, 1.6), (6.2, 3.5)]
    way += [(3.6, 3.5), (3.2, 1.4), (2.9, 4.6)]
    shaken = [(x + rng.uniform(-0.1, 0.1), y + rng.uniform(-0.1, 0.1)) for x, y in way]
    stop = {3, 5, 8} if stops > 1 else {3}
    points = [
        Waypoint(x, y, stop=k in stop, look_deg=170.0 if k in stop else 0.0)
        for k, (x, y) in enumerate(shaken)
    ]
    return [*points, Waypoint(*shaken[0])]
