"""A hall with a mirror along one wall, mirrored columns and a partition of clear glass.

The mirror doubles the hall for a LiDAR: behind it stands a second one, as still as the first. The
partition is seen through, and shows the hall a second time at grazing incidence.

From above::

    y
  9.0 +-------------------------------------+
      |  shelves, desks                     |
      |        o            o        |glass |
      |                              |      |
  0.0 +====== mirror, 2.3 m high =====------+  x
      0                              11     14
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import partial

import numpy as np

from recon4.geometry.mesh import MeshBuilder
from recon4.geometry.tuning import SURFACES
from recon4.simulation.materials import MATERIAL
from recon4.simulation.world import Waypoint, World
from recon4.simulation.worlds.furniture import board, desk, lamp, shelf
from recon4.simulation.worlds.walls import WallShape, wall, window


@dataclass(frozen=True, slots=True, kw_only=True)
class MirrorHallPlan:
    """Measures of a variant, see the drawing."""

    length_m: float = 14.0
    depth_m: float = 9.0
    height_m: float = 3.4
    mirrored: float = 0.75
    """Part of the wall before the partition that the mirror takes."""
    mirror_m: tuple[float, float] = (0.2, 2.5)
    """Bottom and top of the mirror."""
    column_half_m: float = 0.22
    """Half of the width of a column."""

    @staticmethod
    def drawn(variant: int, rng: np.random.Generator) -> MirrorHallPlan:
        """That of a variant; 0 = the one in the drawing."""
        if variant == 0:
            return MirrorHallPlan()
        length_m = float(rng.uniform(12.0, 18.0))
        return MirrorHallPlan(length_m=length_m, mirrored=float(rng.uniform(0.5, 0.8)))


def build(variant: int = 0) -> World:
    """The hall; other variants are longer or shorter, and the mirror takes more or less of it."""
    rng = np.random.default_rng([140, variant])
    plan = MirrorHallPlan.drawn(variant, rng)
    length_m, depth_m, height_m = plan.length_m, plan.depth_m, plan.height_m
    builder = MeshBuilder()
    _shell(builder, plan)
    _mirror(builder, plan)
    columns = [(0.3 * length_m, 5.8), (0.6 * length_m, 5.4)]
    for x, y in columns:
        _column(builder, plan, (x, y))
    pane_x = length_m - 3.0
    builder.quad([pane_x, 3.0, 0.0], [0, 6.0, 0], [0, 0, height_m], reflectivity=SURFACES.clear)
    for y in (3.0, 5.0, 7.0, 9.0):
        builder.box([pane_x - 0.03, y - 0.06, 0], [pane_x + 0.03, y, height_m], MATERIAL.steel)
    for k, x in enumerate(np.arange(1.2, length_m - 3.6, 1.9)):
        if k % 3 == 1:
            builder.block([x, depth_m - 0.4, 0], [1.1, 0.5, rng.uniform(0.6, 2.2)], MATERIAL.wood)
        else:
            shelf(builder, float(x), depth_m - 0.6, height_m=rng.uniform(1.2, 2.4), rng=rng)
    desk(builder, length_m - 0.7, 6.0, side=-1.0, rng=rng)
    desk(builder, 0.6, 6.4, side=1.0, rng=rng)
    return World(name="mirrors", mesh=builder.mesh(), route=partial(_route, plan), stops=4)


def _shell(builder: MeshBuilder, plan: MirrorHallPlan) -> None:
    length_m, depth_m, height_m = plan.length_m, plan.depth_m, plan.height_m
    builder.quad([0, 0, 0], [length_m, 0, 0], [0, depth_m, 0], reflectivity=MATERIAL.linoleum)
    builder.quad([0, 0, height_m], [length_m, 0, 0], [0, depth_m, 0], reflectivity=MATERIAL.ceiling)
    shape = WallShape(height_m=height_m)
    wall(builder, (0, 0), (length_m, 0), shape=shape)
    wall(builder, (0, depth_m), (length_m, depth_m), shape=shape, openings=[window(3.0, 2.0)])
    for x in (0.0, length_m):
        wall(builder, (x, 0), (x, depth_m), shape=shape)
    board(builder, 0.1, 3.6, length_m=1.8)
    for x in np.arange(2.0, length_m, 3.1):
        for y in (2.2, 6.6):
            lamp(builder, float(x), y, ceiling_m=height_m)


def _mirror(builder: MeshBuilder, plan: MirrorHallPlan) -> None:
    """The mirror before the south wall, with a frame of steel."""
    left, (bottom, top) = 0.6, plan.mirror_m
    right = left + plan.mirrored * (plan.length_m - 3.5)
    width = [right - left, 0, 0]
    builder.quad([left, 0.08, bottom], width, [0, 0, top - bottom], reflectivity=SURFACES.mirror)
    for low, high in ((bottom - 0.05, bottom), (top, top + 0.05)):
        builder.box([left, 0.06, low], [right, 0.11, high], MATERIAL.steel)


def _column(builder: MeshBuilder, plan: MirrorHallPlan, at: tuple[float, float]) -> None:
    """A square column clad with mirrors, on a base and below a head of plaster."""
    (x, y), r = at, plan.column_half_m
    builder.block([x, y, 0.0], [2.2 * r, 2.2 * r, 0.2], 0.5)
    builder.block([x, y, 0.2], [2 * r, 2 * r, 2.2], SURFACES.mirror)
    builder.block([x, y, 2.4], [2.2 * r, 2.2 * r, plan.height_m - 2.4], 0.5)


def _route(plan: MirrorHallPlan, rng: np.random.Generator, stops: int) -> list[Waypoint]:
    """Along the mirror and back along the columns, farther the more stops."""
    far = 3.5 + (plan.length_m - 8.5) * stops / 4.0
    a, b = rng.uniform(-0.2, 0.2, 2)
    return [
        Waypoint(1.8, 2.2),
        Waypoint(far, 2.2 + a),
        Waypoint(far + 0.8, 3.6 + b, stop=True, look_deg=60.0),
        Waypoint(1.8, 4.0),
        Waypoint(1.8, 2.2),
    ]
