"""A corridor of 110 m between two stairwell doors, with a blank stretch of 33 m.

Doors are recessed by 12 cm. Along the blank stretch only the two ends of the corridor, up to 73 m
away, say how far one has walked: a test of what an estimator knows about what it cannot observe.

From above::

    y
  1.8 +--U--U-U---U--+------------------+-U---U--U--U-U--+
      |              |  blank, 33 m     |                |
  0.0 +-U---U--U--U--+------------------+--U--U---U---U--+  x
      0             40                 73               110
"""

from __future__ import annotations

import numpy as np

from recon4.geometry.mesh import MeshBuilder
from recon4.simulation.world import Waypoint, World
from recon4.simulation.worlds.walls import (
    CEILING,
    DOOR_M,
    DOOR_TOP_M,
    LINOLEUM,
    PLASTER,
    WOOD,
    slab,
)

LENGTH_M = 110.0
WIDTH_M = 1.8
HEIGHT_M = 2.7
BLANK_M = (40.0, 73.0)
"""Nothing but smooth walls between these distances from the start [m]."""
_RECESS_M = 0.12
_SPACING_M = (2.6, 6.5)
_THICK_M = 0.3
_STOPS = 10


def build() -> World:
    """The corridor; its doors are always at the same places."""
    builder = MeshBuilder()
    rng = np.random.default_rng(110)
    builder.quad([0, 0, 0], [LENGTH_M, 0, 0], [0, WIDTH_M, 0], reflectivity=LINOLEUM)
    builder.quad([0, 0, HEIGHT_M], [LENGTH_M, 0, 0], [0, WIDTH_M, 0], reflectivity=CEILING)
    for inner_m, outer_m in ((0.0, -_THICK_M), (WIDTH_M, WIDTH_M + _THICK_M)):
        _side(builder, inner_m, outer_m, rng=rng)
    for inner_m, outer_m in ((0.0, -_THICK_M), (LENGTH_M, LENGTH_M + _THICK_M)):
        _end(builder, inner_m, outer_m)
    return World(name="corridor", mesh=builder.mesh(), route=_route, stops=_STOPS)


def _side(
    builder: MeshBuilder, inner_m: float, outer_m: float, *, rng: np.random.Generator
) -> None:
    """One long wall, its doors set back."""
    back_m = inner_m + np.sign(outer_m - inner_m) * _RECESS_M
    wall, lintel = (inner_m, outer_m), (DOOR_TOP_M, HEIGHT_M)
    at = 0.0
    for left in [*_doors(rng), LENGTH_M]:
        right = min(left + DOOR_M, LENGTH_M)
        for span, reach, level, value in (
            ((at, left), wall, (0.0, HEIGHT_M), PLASTER),
            ((left, right), (back_m, outer_m), (0.0, DOOR_TOP_M), WOOD),
            ((left, right), wall, lintel, PLASTER),
        ):
            if span[1] > span[0]:
                slab(builder, span, reach, level, along=0, reflectivity=value)
        at = right


def _doors(rng: np.random.Generator) -> list[float]:
    """Where doors begin along one wall [m]; none in the blank stretch."""
    found, at = [], float(rng.uniform(1.0, 4.0))
    while at + DOOR_M < LENGTH_M - 1.0:
        if not (BLANK_M[0] - DOOR_M < at < BLANK_M[1]):
            found.append(at)
        at += DOOR_M + float(rng.uniform(*_SPACING_M))
    return found


def _end(builder: MeshBuilder, inner_m: float, outer_m: float) -> None:
    """The wall at one end, with a closed door in the middle."""
    back_m = inner_m + np.sign(outer_m - inner_m) * _RECESS_M
    left, right = 0.5 * (WIDTH_M - DOOR_M), 0.5 * (WIDTH_M + DOOR_M)
    for span, reach, level, value in (
        ((0.0, left), (inner_m, outer_m), (0.0, HEIGHT_M), PLASTER),
        ((right, WIDTH_M), (inner_m, outer_m), (0.0, HEIGHT_M), PLASTER),
        ((left, right), (back_m, outer_m), (0.0, DOOR_TOP_M), WOOD),
        ((left, right), (inner_m, outer_m), (DOOR_TOP_M, HEIGHT_M), PLASTER),
    ):
        slab(builder, span, reach, level, along=1, reflectivity=value)


def _route(rng: np.random.Generator, stops: int) -> list[Waypoint]:
    """Along the corridor, farther the more stops, a turn on the spot, and back."""
    far_m = 1.5 + (LENGTH_M - 3.0) * stops / _STOPS
    xs = np.linspace(1.5, far_m, max(2, round(far_m / 5.0)))
    sway = rng.uniform(-0.15, 0.15, len(xs))
    out = [Waypoint(float(x), WIDTH_M / 2 + float(y)) for x, y in zip(xs, sway, strict=True)]
    turn = Waypoint(out[-1].x_m, out[-1].y_m, stop=True, look_deg=170.0)
    return [*out[:-1], turn, *out[-2::-1]]
