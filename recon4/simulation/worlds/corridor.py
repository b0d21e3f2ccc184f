"""A corridor of 110 m between two stairwell doors, with a blank stretch of 33 m.

Other variants are 80 to 150 m long, with a blank stretch of 20 to 60 m.

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

from dataclasses import dataclass

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
    SlabExtent,
    slab,
)

WIDTH_M = 1.8
HEIGHT_M = 2.7
_RECESS_M = 0.12
_SPACING_M = (2.6, 6.5)
_THICK_M = 0.3
_STOPS = 10


@dataclass(frozen=True, slots=True)
class _Plan:
    """Measures of one variant."""

    length_m: float = 110.0
    blank_m: tuple[float, float] = (40.0, 73.0)
    """Nothing but smooth walls between these distances from the start [m]."""

    @staticmethod
    def drawn(variant: int) -> _Plan:
        """That of a variant; 0 = the one in the drawing."""
        if variant == 0:
            return _Plan()
        rng = np.random.default_rng([111, variant])
        length, blank = float(rng.uniform(80.0, 150.0)), float(rng.uniform(20.0, 60.0))
        start = float(rng.uniform(8.0, length - blank - 8.0))
        return _Plan(length, (start, start + blank))


def build(variant: int = 0) -> World:
    """The corridor; the doors of a variant are always at the same places."""
    plan = _Plan.drawn(variant)
    builder = MeshBuilder()
    rng = np.random.default_rng(110 + variant)
    length_m = plan.length_m
    builder.quad([0, 0, 0], [length_m, 0, 0], [0, WIDTH_M, 0], reflectivity=LINOLEUM)
    builder.quad([0, 0, HEIGHT_M], [length_m, 0, 0], [0, WIDTH_M, 0], reflectivity=CEILING)
    for inner_m, outer_m in ((0.0, -_THICK_M), (WIDTH_M, WIDTH_M + _THICK_M)):
        _side(builder, plan, (inner_m, outer_m), rng=rng)
    for inner_m, outer_m in ((0.0, -_THICK_M), (length_m, length_m + _THICK_M)):
        _end(builder, inner_m, outer_m)

    def route(rng: np.random.Generator, stops: int) -> list[Waypoint]:
        return _route(rng, stops, length_m=length_m)

    return World(name="corridor", mesh=builder.mesh(), route=route, stops=_STOPS)


def _side(
    builder: MeshBuilder, plan: _Plan, wall: tuple[float, float], *, rng: np.random.Generator
) -> None:
    """One long wall from its inner to its outer face, its doors set back."""
    inner_m, outer_m = wall
    back_m = inner_m + np.sign(outer_m - inner_m) * _RECESS_M
    lintel = (DOOR_TOP_M, HEIGHT_M)
    at = 0.0
    for left in [*_doors(plan, rng), plan.length_m]:
        right = min(left + DOOR_M, plan.length_m)
        for span, reach, level, value in (
            ((at, left), wall, (0.0, HEIGHT_M), PLASTER),
            ((left, right), (back_m, outer_m), (0.0, DOOR_TOP_M), WOOD),
            ((left, right), wall, lintel, PLASTER),
        ):
            if span[1] > span[0]:
                slab(builder, SlabExtent(span, reach, level), along=0, reflectivity=value)
        at = right


def _doors(plan: _Plan, rng: np.random.Generator) -> list[float]:
    """Where doors begin along one wall [m]; none in the blank stretch."""
    found, at = [], float(rng.uniform(1.0, 4.0))
    while at + DOOR_M < plan.length_m - 1.0:
        if not (plan.blank_m[0] - DOOR_M < at < plan.blank_m[1]):
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
        slab(builder, SlabExtent(span, reach, level), along=1, reflectivity=value)


def _route(rng: np.random.Generator, stops: int, *, length_m: float) -> list[Waypoint]:
    """Along the corridor, farther the more stops, a turn on the spot, and back."""
    far_m = 1.5 + (length_m - 3.0) * stops / _STOPS
    xs = np.linspace(1.5, far_m, max(2, round(far_m / 5.0)))
    sway = rng.uniform(-0.15, 0.15, len(xs))
    out = [Waypoint(float(x), WIDTH_M / 2 + float(y)) for x, y in zip(xs, sway, strict=True)]
    turn = Waypoint(out[-1].x_m, out[-1].y_m, stop=True, look_deg=170.0)
    return [*out[:-1], turn, *out[-2::-1]]
