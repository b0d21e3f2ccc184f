"""A winding path through a forest: trunks, bushes, uneven ground, no plane but small ones.

Under the crowns no GNSS is received.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import partial

import numpy as np
from numpy.typing import ArrayLike

from recon4.geometry.mesh import MeshBuilder, SurfaceKind
from recon4.geometry.se3 import Array
from recon4.simulation.materials import MATERIAL
from recon4.simulation.world import Waypoint, World
from recon4.simulation.worlds.outdoors import bush, follow, tree


@dataclass(frozen=True, slots=True, kw_only=True)
class ForestPlan:
    """Measures of a variant."""

    trees: int = 260
    """Places drawn for trees; there are a third as many bushes."""
    length_m: float = 70.0
    """Of the path along x."""
    half_width_m: float = 30.0
    margin_m: float = 20.0
    """Of the ground, beside the middle and beyond both ends of the path."""
    clear_m: float = 2.4
    """Nothing grows this near to the middle of the path."""
    bend_m: float = 8.0
    """Between two corners of the path."""
    stops: int = 8


def build(variant: int = 0) -> World:
    """A forest; the variant draws the trees and how dense they stand."""
    rng = np.random.default_rng([70, variant])
    plan = ForestPlan() if variant == 0 else ForestPlan(trees=int(rng.integers(80, 420)))
    builder = MeshBuilder()
    x = np.arange(-plan.margin_m, plan.length_m + plan.margin_m + 0.1, 1.25)
    y = np.arange(-plan.half_width_m, plan.half_width_m + 0.1, 1.25)
    grid_x, grid_y = np.meshgrid(x, y)
    z = ground(grid_x, grid_y) + 0.015 * rng.standard_normal(grid_x.shape)
    with builder.of(SurfaceKind.GROUND):
        builder.terrain(x, y, z, reflectivity=MATERIAL.grass)
    for grow, count in ((tree, plan.trees), (bush, plan.trees // 3)):
        for place_x, place_y in _places(plan, rng, count):
            grow(builder, place_x, place_y, ground=ground, rng=rng)
    return World(name="forest", mesh=builder.mesh(), route=partial(_route, plan), stops=plan.stops)


def ground(x_m: ArrayLike, y_m: ArrayLike) -> Array:
    """Height of the ground [m]: waves of some decimeters."""
    x, y = np.asarray(x_m, dtype=np.float64), np.asarray(y_m, dtype=np.float64)
    return np.asarray(0.35 * np.sin(x / 9.0) + 0.25 * np.sin(y / 7.0 + x / 13.0))


def _path_y(x_m: ArrayLike) -> Array:
    """Middle of the path [m]."""
    return 4.0 * np.sin(np.asarray(x_m, dtype=np.float64) / 14.0)


def _places(plan: ForestPlan, rng: np.random.Generator, count: int) -> list[tuple[float, float]]:
    """Random places beside the path."""
    low = [-plan.margin_m, -plan.half_width_m]
    high = [plan.length_m + plan.margin_m, plan.half_width_m]
    places = rng.uniform(low, high, (4 * count, 2))
    path_x = np.linspace(-plan.margin_m, plan.length_m + plan.margin_m, 500)
    path = np.stack([path_x, _path_y(path_x)], axis=1)
    off_m = np.linalg.norm(places[:, None] - path, axis=2).min(axis=1)
    free = places[off_m > plan.clear_m][:count]
    return [(float(x), float(y)) for x, y in free]


def _route(plan: ForestPlan, rng: np.random.Generator, stops: int) -> list[Waypoint]:
    """Along the path, farther the more stops, a turn on the spot, and back."""
    far_m = plan.length_m * stops / plan.stops
    xs = np.linspace(0.0, far_m, max(2, round(far_m / plan.bend_m) + 1))
    out = [Waypoint(float(x), float(y)) for x, y in zip(xs, _path_y(xs), strict=True)]
    last = Waypoint(out[-1].x_m, out[-1].y_m, stop=True, look_deg=170.0)
    return follow([*out[:-1], last, *out[-2::-1]], ground, rng, stray_m=0.3)
