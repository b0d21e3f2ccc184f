"""An open plaza: level pavement 160 m x 120 m, facades far away, a grid of equal lamps.

Most returns lie on the flat ground; facades are 50 to 80 m off, where a VLP-16 sees them with few
rings. Variant 0 has lamps and a fountain; other variants draw how much stands on the plaza,
down to nothing.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from recon4.geometry.mesh import MeshBuilder
from recon4.geometry.se3 import Array
from recon4.simulation.world import Waypoint, World
from recon4.simulation.worlds.outdoors import CONCRETE, follow, pole
from recon4.simulation.worlds.walls import PLASTER, STEEL, Opening, WallShape, wall

HALF_LENGTH_M, HALF_WIDTH_M = 80.0, 60.0
_LAMPS_M = 24.0
"""Between two lamps [m]."""
_FACADE_M = 14.0
_STOPS = 8


def build(variant: int = 0) -> World:
    """The plaza; the variant draws how many lamps and benches there are."""
    rng = np.random.default_rng([160, variant])
    kept = 1.0 if variant == 0 else float(rng.choice([0.0, 0.3, 1.0]))
    builder = MeshBuilder()
    low, high = [-HALF_LENGTH_M, -HALF_WIDTH_M, -0.3], [HALF_LENGTH_M, HALF_WIDTH_M, 0.0]
    builder.box(low, high, CONCRETE)
    _facades(builder)
    for x in np.arange(-2, 3) * _LAMPS_M:
        for y in np.arange(-1, 2) * _LAMPS_M:
            if rng.random() < kept:
                pole(builder, float(x), float(y), ground=ground, arm=[0.8, 0.0])
    if kept > 0.0:
        builder.tube([0, 12, 0], [0, 12, 0.6], 3.0, reflectivity=PLASTER, sides=24)
        builder.tube([0, 12, 0.6], [0, 12, 2.4], 0.4, reflectivity=STEEL, sides=12)
    return World(name="plaza", mesh=builder.mesh(), route=_route, stops=_STOPS, outdoors=True)


def ground(x_m: ArrayLike, y_m: ArrayLike) -> Array:
    """Height of the level pavement [m]."""
    return 0.0 * (np.asarray(x_m, dtype=np.float64) + np.asarray(y_m, dtype=np.float64))


def _facades(builder: MeshBuilder) -> None:
    """Four facades, equal windows every 4 m."""
    facade = WallShape(height_m=_FACADE_M, thickness_m=0.4)
    for length_m, along in ((2 * HALF_LENGTH_M, 0), (2 * HALF_WIDTH_M, 1)):
        other = HALF_WIDTH_M if along == 0 else HALF_LENGTH_M
        windows = [
            Opening(at, 1.6, 1.0, 3.0, glazed=False) for at in np.arange(2.0, length_m - 1.0, 4.0)
        ]
        for side in (-other, other):
            ends = [(-0.5 * length_m, side), (0.5 * length_m, side)]
            start, end = ends if along == 0 else [(b, a) for a, b in ends]
            wall(builder, start, end, shape=facade, openings=windows)


def _route(rng: np.random.Generator, stops: int) -> list[Waypoint]:
    """A loop between two rows of lamps that begins near the middle, longer the more stops."""
    reach_m = (60.0 * stops / _STOPS + rng.uniform(-2.0, 2.0)) * rng.choice([-1.0, 1.0])
    near, far = (-5.0, -18.0) if rng.random() < 0.5 else (-18.0, -5.0)
    start = Waypoint(6.0, near)
    corners = [
        Waypoint(6.0 + reach_m, near),
        Waypoint(6.0 + reach_m, far, stop=True, look_deg=90.0),
        Waypoint(6.0, far),
    ]
    return follow([start, *corners, start], ground, rng, stray_m=0.3)
