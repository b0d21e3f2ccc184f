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

import numpy as np

from recon4.geometry.mesh import MeshBuilder
from recon4.geometry.tuning import SURFACES
from recon4.simulation.world import Waypoint, World
from recon4.simulation.worlds.furniture import board, desk, lamp, shelf
from recon4.simulation.worlds.walls import CEILING, LINOLEUM, STEEL, WOOD, WallShape, wall, window

_HEIGHT_M = 3.4
_DEPTH_M = 9.0
_MIRROR_M = (0.2, 2.5)
"""Bottom and top of the mirror."""
_COLUMN_M = 0.22


def build(variant: int = 0) -> World:
    """The hall; other variants are longer or shorter, and the mirror takes more or less of it."""
    rng = np.random.default_rng([140, variant])
    length_m = 14.0 if variant == 0 else float(rng.uniform(12.0, 18.0))
    part = 0.75 if variant == 0 else float(rng.uniform(0.5, 0.8))
    builder = MeshBuilder()
    _shell(builder, length_m)
    _mirror(builder, (0.6, 0.6 + part * (length_m - 3.5)))
    columns = [(0.3 * length_m, 5.8), (0.6 * length_m, 5.4)]
    for x, y in columns:
        _column(builder, x, y)
    pane_x = length_m - 3.0
    builder.quad([pane_x, 3.0, 0.0], [0, 6.0, 0], [0, 0, _HEIGHT_M], reflectivity=SURFACES.clear)
    for y in (3.0, 5.0, 7.0, 9.0):
        builder.box([pane_x - 0.03, y - 0.06, 0], [pane_x + 0.03, y, _HEIGHT_M], STEEL)
    for k, x in enumerate(np.arange(1.2, length_m - 3.6, 1.9)):
        if k % 3 == 1:
            builder.block([x, _DEPTH_M - 0.4, 0], [1.1, 0.5, rng.uniform(0.6, 2.2)], WOOD)
        else:
            shelf(builder, float(x), _DEPTH_M - 0.6, height_m=rng.uniform(1.2, 2.4), rng=rng)
    desk(builder, length_m - 0.7, 6.0, side=-1.0, rng=rng)
    desk(builder, 0.6, 6.4, side=1.0, rng=rng)

    def route(rng: np.random.Generator, stops: int) -> list[Waypoint]:
        return _route(rng, stops, length_m=length_m)

    return World(name="mirrors", mesh=builder.mesh(), route=route, stops=4)


def _shell(builder: MeshBuilder, length_m: float) -> None:
    builder.quad([0, 0, 0], [length_m, 0, 0], [0, _DEPTH_M, 0], reflectivity=LINOLEUM)
    builder.quad([0, 0, _HEIGHT_M], [length_m, 0, 0], [0, _DEPTH_M, 0], reflectivity=CEILING)
    shape = WallShape(height_m=_HEIGHT_M)
    wall(builder, (0, 0), (length_m, 0), shape=shape)
    wall(builder, (0, _DEPTH_M), (length_m, _DEPTH_M), shape=shape, openings=[window(3.0, 2.0)])
    for x in (0.0, length_m):
        wall(builder, (x, 0), (x, _DEPTH_M), shape=shape)
    board(builder, 0.1, 3.6, length_m=1.8)
    for x in np.arange(2.0, length_m, 3.1):
        for y in (2.2, 6.6):
            lamp(builder, float(x), y, ceiling_m=_HEIGHT_M)


def _mirror(builder: MeshBuilder, span_m: tuple[float, float]) -> None:
    """The mirror before the south wall, with a frame of steel."""
    (left, right), (bottom, top) = span_m, _MIRROR_M
    width = [right - left, 0, 0]
    builder.quad([left, 0.08, bottom], width, [0, 0, top - bottom], reflectivity=SURFACES.mirror)
    for low, high in ((bottom - 0.05, bottom), (top, top + 0.05)):
        builder.box([left, 0.06, low], [right, 0.11, high], STEEL)


def _column(builder: MeshBuilder, x: float, y: float) -> None:
    """A square column clad with mirrors, on a base and below a head of plaster."""
    r = _COLUMN_M
    builder.block([x, y, 0.0], [2.2 * r, 2.2 * r, 0.2], 0.5)
    builder.block([x, y, 0.2], [2 * r, 2 * r, 2.2], SURFACES.mirror)
    builder.block([x, y, 2.4], [2.2 * r, 2.2 * r, _HEIGHT_M - 2.4], 0.5)


def _route(rng: np.random.Generator, stops: int, *, length_m: float) -> list[Waypoint]:
    """Along the mirror and back along the columns, farther the more stops."""
    far = 3.5 + (length_m - 8.5) * stops / 4.0
    a, b = rng.uniform(-0.2, 0.2, 2)
    return [
        Waypoint(1.8, 2.2),
        Waypoint(far, 2.2 + a),
        Waypoint(far + 0.8, 3.6 + b, stop=True, look_deg=60.0),
        Waypoint(1.8, 4.0),
        Waypoint(1.8, 2.2),
    ]
