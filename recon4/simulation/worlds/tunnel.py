"""A straight tunnel without any structure: smooth walls, both ends out of range.

Nothing tells two places along the axis apart, neither shape nor reflectivity: the LiDAR cannot
observe how far one has walked. The route stays in the middle `WALK_M`, and both end walls are
farther from there than the sensors reach.

Cross-section, seen along the axis::

       .---.        vault: half a polygon of 16 sides
      /     \
     |       |      upright walls
     +-------+
"""

from __future__ import annotations

import numpy as np

from recon4.geometry.mesh import MeshBuilder
from recon4.geometry.se3 import Array
from recon4.simulation.world import Waypoint, World
from recon4.simulation.worlds.outdoors import ASPHALT, CONCRETE

WALK_M = 60.0
"""Length of the stretch that routes stay in [m]."""
_BEYOND_M = 112.0
"""From the end of that stretch to the end wall; a VLP-16 reaches 110 m [m]."""
_STOPS = 10
_VAULT_SIDES = 16


def build(variant: int = 0) -> World:
    """A tunnel; the variant draws width and height of the walls and the slope."""
    rng = np.random.default_rng([281, variant])
    width_m, wall_m = (4.0, 1.6) if variant == 0 else rng.uniform([2.4, 1.2], [7.0, 2.4])
    slope = 0.0 if variant == 0 else float(rng.uniform(-0.03, 0.03))
    builder = MeshBuilder()
    profile = _profile(float(width_m), float(wall_m))
    ends_m = np.array([-_BEYOND_M, WALK_M + _BEYOND_M])
    for k, (a, b) in enumerate(zip(profile, np.roll(profile, -1, axis=0), strict=True)):
        corner = np.array([ends_m[0], a[0], a[1] + slope * ends_m[0]])
        along = np.array([np.ptp(ends_m), 0.0, slope * np.ptp(ends_m)])
        across = np.array([0.0, *(b - a)])
        builder.quad(corner, along, across, reflectivity=ASPHALT if k == 0 else CONCRETE)
    for x in ends_m:
        corner = np.array([x, -0.5 * width_m, slope * x])
        top = wall_m + 0.5 * width_m
        builder.quad(corner, [0, width_m, 0], [0, 0, top], reflectivity=CONCRETE)

    def route(rng: np.random.Generator, stops: int) -> list[Waypoint]:
        return _route(rng, stops, slope=slope)

    return World(name="tunnel", mesh=builder.mesh(), route=route, stops=_STOPS)


def _profile(width_m: float, wall_m: float) -> Array:
    """Corners of the cross-section (y, z) [m], the floor first, (N, 2)."""
    angle = np.linspace(0.0, np.pi, _VAULT_SIDES + 1)
    half = 0.5 * width_m
    vault = np.stack([half * np.cos(angle), wall_m + half * np.sin(angle)], axis=1)
    return np.vstack([[[-half, 0.0], [half, 0.0]], vault])


def _route(rng: np.random.Generator, stops: int, *, slope: float) -> list[Waypoint]:
    """Along the axis, farther the more stops, a turn on the spot, and back."""
    start_m = 0.5 * WALK_M * (1.0 - stops / _STOPS)
    xs = np.linspace(start_m, start_m + WALK_M * stops / _STOPS, stops + 2)
    sway = rng.uniform(-0.2, 0.2, len(xs))
    way = [Waypoint(float(x), float(y), slope * float(x)) for x, y in zip(xs, sway, strict=True)]
    last = way[-1]
    turn = Waypoint(last.x_m, last.y_m, last.z_m, stop=True, look_deg=170.0)
    return [*way[:-1], turn, *way[-2::-1]]
