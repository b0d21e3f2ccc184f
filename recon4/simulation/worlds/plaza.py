"""An open plaza: level pavement 160 m x 120 m, facades far away, a grid of equal lamps.

Most returns lie on the flat ground; facades are 50 to 80 m off, where a VLP-16 sees them with few
rings. Variant 0 has lamps and a fountain; other variants draw how much stands on the plaza,
down to nothing.
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
from recon4.simulation.worlds.outdoors import follow, pole
from recon4.simulation.worlds.walls import Opening, WallShape, wall


@dataclass(frozen=True, slots=True, kw_only=True)
class PlazaPlan:
    """Measures of a variant."""

    kept: float = 1.0
    """Chance that a lamp of the grid stands; with 0 there is no fountain either."""
    half_length_m: float = 80.0
    half_width_m: float = 60.0
    lamps_m: float = 24.0
    """Between two lamps."""
    facade_m: float = 14.0
    """Height of the facades."""
    stops: int = 8


def build(variant: int = 0) -> World:
    """The plaza; the variant draws how many lamps and benches there are."""
    rng = np.random.default_rng([160, variant])
    plan = PlazaPlan() if variant == 0 else PlazaPlan(kept=float(rng.choice([0.0, 0.3, 1.0])))
    builder = MeshBuilder()
    low, high = (
        [-plan.half_length_m, -plan.half_width_m, -0.3],
        [plan.half_length_m, plan.half_width_m, 0.0],
    )
    builder.box(low, high, MATERIAL.concrete)
    _facades(builder, plan)
    for x in np.arange(-2, 3) * plan.lamps_m:
        for y in np.arange(-1, 2) * plan.lamps_m:
            if rng.random() < plan.kept:
                pole(builder, float(x), float(y), ground=ground, arm=[0.8, 0.0])
    if plan.kept > 0.0:
        builder.tube([0, 12, 0], [0, 12, 0.6], 3.0, reflectivity=MATERIAL.plaster, sides=24)
        builder.tube([0, 12, 0.6], [0, 12, 2.4], 0.4, reflectivity=MATERIAL.steel, sides=12)
    return World(
        name="plaza",
        mesh=builder.mesh(),
        route=partial(_route, plan),
        stops=plan.stops,
        outdoors=True,
    )


def ground(x_m: ArrayLike, y_m: ArrayLike) -> Array:
    """Height of the level pavement [m]."""
    return 0.0 * (np.asarray(x_m, dtype=np.float64) + np.asarray(y_m, dtype=np.float64))


def _facades(builder: MeshBuilder, plan: PlazaPlan) -> None:
    """Four facades, equal windows every 4 m."""
    facade = WallShape(height_m=plan.facade_m, thickness_m=0.4)
    for length_m, along in ((2 * plan.half_length_m, 0), (2 * plan.half_width_m, 1)):
        other = plan.half_width_m if along == 0 else plan.half_length_m
        windows = [
            Opening(at, 1.6, 1.0, 3.0, glazed=False) for at in np.arange(2.0, length_m - 1.0, 4.0)
        ]
        for side in (-other, other):
            ends = [(-0.5 * length_m, side), (0.5 * length_m, side)]
            start, end = ends if along == 0 else [(b, a) for a, b in ends]
            wall(builder, start, end, shape=facade, openings=windows)


def _route(plan: PlazaPlan, rng: np.random.Generator, stops: int) -> list[Waypoint]:
    """A loop between two rows of lamps that begins near the middle, longer the more stops."""
    reach_m = (60.0 * stops / plan.stops + rng.uniform(-2.0, 2.0)) * rng.choice([-1.0, 1.0])
    near, far = (-5.0, -18.0) if rng.random() < 0.5 else (-18.0, -5.0)
    start = Waypoint(6.0, near)
    corners = [
        Waypoint(6.0 + reach_m, near),
        Waypoint(6.0 + reach_m, far, stop=True, look_deg=90.0),
        Waypoint(6.0, far),
    ]
    return follow([start, *corners, start], ground, rng, stray_m=0.3)
