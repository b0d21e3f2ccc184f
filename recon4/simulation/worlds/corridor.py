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
from functools import partial

import numpy as np

from recon4.geometry.mesh import MeshBuilder
from recon4.simulation.materials import MATERIAL
from recon4.simulation.world import Waypoint, World
from recon4.simulation.worlds.walls import USUAL_DOOR, SlabExtent, slab


@dataclass(frozen=True, slots=True, kw_only=True)
class CorridorPlan:
    """Measures of one variant."""

    length_m: float = 110.0
    blank_m: tuple[float, float] = (40.0, 73.0)
    """Nothing but smooth walls between these distances from the start [m]."""
    width_m: float = 1.8
    height_m: float = 2.7
    thickness_m: float = 0.3
    """Of the walls."""
    recess_m: float = 0.12
    """Of the doors, behind the face of the wall."""
    spacing_m: tuple[float, float] = (2.6, 6.5)
    """Shortest and longest stretch of wall between two doors."""
    stops: int = 10

    @staticmethod
    def drawn(variant: int) -> CorridorPlan:
        """That of a variant; 0 = the one in the drawing."""
        if variant == 0:
            return CorridorPlan()
        rng = np.random.default_rng([111, variant])
        length, blank = float(rng.uniform(80.0, 150.0)), float(rng.uniform(20.0, 60.0))
        start = float(rng.uniform(8.0, length - blank - 8.0))
        return CorridorPlan(length_m=length, blank_m=(start, start + blank))


def build(variant: int = 0) -> World:
    """The corridor; the doors of a variant are always at the same places."""
    plan = CorridorPlan.drawn(variant)
    builder = MeshBuilder()
    rng = np.random.default_rng(110 + variant)
    length_m, width_m, thickness_m = plan.length_m, plan.width_m, plan.thickness_m
    for z, value in ((0.0, MATERIAL.linoleum), (plan.height_m, MATERIAL.ceiling)):
        builder.quad([0, 0, z], [length_m, 0, 0], [0, width_m, 0], reflectivity=value)
    for faces_m in ((0.0, -thickness_m), (width_m, width_m + thickness_m)):
        _side(builder, plan, faces_m, rng=rng)
    for faces_m in ((0.0, -thickness_m), (length_m, length_m + thickness_m)):
        _end(builder, plan, faces_m)
    return World(
        name="corridor", mesh=builder.mesh(), route=partial(_route, plan), stops=plan.stops
    )


def _side(
    builder: MeshBuilder, plan: CorridorPlan, wall: tuple[float, float], *, rng: np.random.Generator
) -> None:
    """One long wall from its inner to its outer face, its doors set back."""
    inner_m, outer_m = wall
    back_m = inner_m + np.sign(outer_m - inner_m) * plan.recess_m
    lintel = (USUAL_DOOR.top_m, plan.height_m)
    at = 0.0
    for left in [*_doors(plan, rng), plan.length_m]:
        right = min(left + USUAL_DOOR.width_m, plan.length_m)
        for span, reach, level, value in (
            ((at, left), wall, (0.0, plan.height_m), MATERIAL.plaster),
            ((left, right), (back_m, outer_m), (0.0, USUAL_DOOR.top_m), MATERIAL.wood),
            ((left, right), wall, lintel, MATERIAL.plaster),
        ):
            if span[1] > span[0]:
                slab(builder, SlabExtent(span, reach, level), along=0, reflectivity=value)
        at = right


def _doors(plan: CorridorPlan, rng: np.random.Generator) -> list[float]:
    """Where doors begin along one wall [m]; none in the blank stretch."""
    found, at = [], float(rng.uniform(1.0, 4.0))
    while at + USUAL_DOOR.width_m < plan.length_m - 1.0:
        if not (plan.blank_m[0] - USUAL_DOOR.width_m < at < plan.blank_m[1]):
            found.append(at)
        at += USUAL_DOOR.width_m + float(rng.uniform(*plan.spacing_m))
    return found


def _end(builder: MeshBuilder, plan: CorridorPlan, wall: tuple[float, float]) -> None:
    """The wall at one end from its inner to its outer face, with a closed door in the middle."""
    (inner_m, outer_m), width_m, height_m = wall, plan.width_m, plan.height_m
    back_m = inner_m + np.sign(outer_m - inner_m) * plan.recess_m
    left, right = 0.5 * (width_m - USUAL_DOOR.width_m), 0.5 * (width_m + USUAL_DOOR.width_m)
    for span, reach, level, value in (
        ((0.0, left), wall, (0.0, height_m), MATERIAL.plaster),
        ((right, width_m), wall, (0.0, height_m), MATERIAL.plaster),
        ((left, right), (back_m, outer_m), (0.0, USUAL_DOOR.top_m), MATERIAL.wood),
        ((left, right), wall, (USUAL_DOOR.top_m, height_m), MATERIAL.plaster),
    ):
        slab(builder, SlabExtent(span, reach, level), along=1, reflectivity=value)


def _route(plan: CorridorPlan, rng: np.random.Generator, stops: int) -> list[Waypoint]:
    """Along the corridor, farther the more stops, a turn on the spot, and back."""
    far_m = 1.5 + (plan.length_m - 3.0) * stops / plan.stops
    xs = np.linspace(1.5, far_m, max(2, round(far_m / 5.0)))
    sway = rng.uniform(-0.15, 0.15, len(xs))
    out = [Waypoint(float(x), plan.width_m / 2 + float(y)) for x, y in zip(xs, sway, strict=True)]
    turn = Waypoint(out[-1].x_m, out[-1].y_m, stop=True, look_deg=170.0)
    return [*out[:-1], turn, *out[-2::-1]]
