"""A straight tunnel without any structure: smooth walls, both ends out of range.

Nothing tells two places along the axis apart, neither shape nor reflectivity: the LiDAR cannot
observe how far one has walked. The route stays in the middle `walk_m`, and both end walls are
farther from there than the sensors reach.

Cross-section, seen along the axis::

       .---.        vault: half a polygon of 16 sides
      /     \
     |       |      upright walls
     +-------+
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import partial

import numpy as np

from recon4.geometry.mesh import MeshBuilder
from recon4.geometry.se3 import Array
from recon4.simulation.materials import MATERIAL
from recon4.simulation.world import Waypoint, World


@dataclass(frozen=True, slots=True, kw_only=True)
class TunnelPlan:
    """Measures of a variant."""

    width_m: float = 4.0
    wall_m: float = 1.6
    """Height of the upright walls."""
    slope: float = 0.0
    """Rise along x."""
    vault_sides: int = 16
    walk_m: float = 60.0
    """Length of the stretch that routes stay in."""
    beyond_m: float = 112.0
    """From the end of that stretch to the end wall; a VLP-16 reaches 110 m."""
    stops: int = 10

    @staticmethod
    def drawn(variant: int) -> TunnelPlan:
        """That of a variant; 0 = level, with these measures."""
        if variant == 0:
            return TunnelPlan()
        rng = np.random.default_rng([281, variant])
        width_m, wall_m = rng.uniform([2.4, 1.2], [7.0, 2.4])
        slope = float(rng.uniform(-0.03, 0.03))
        return TunnelPlan(width_m=float(width_m), wall_m=float(wall_m), slope=slope)


def build(variant: int = 0) -> World:
    """A tunnel; the variant draws width and height of the walls and the slope."""
    plan = TunnelPlan.drawn(variant)
    width_m, slope = plan.width_m, plan.slope
    builder = MeshBuilder()
    profile = _profile(plan)
    ends_m = np.array([-plan.beyond_m, plan.walk_m + plan.beyond_m])
    for k, (a, b) in enumerate(zip(profile, np.roll(profile, -1, axis=0), strict=True)):
        corner = np.array([ends_m[0], a[0], a[1] + slope * ends_m[0]])
        along = np.array([np.ptp(ends_m), 0.0, slope * np.ptp(ends_m)])
        across = np.array([0.0, *(b - a)])
        builder.quad(
            corner, along, across, reflectivity=MATERIAL.asphalt if k == 0 else MATERIAL.concrete
        )
    for x in ends_m:
        corner = np.array([x, -0.5 * width_m, slope * x])
        top = plan.wall_m + 0.5 * width_m
        builder.quad(corner, [0, width_m, 0], [0, 0, top], reflectivity=MATERIAL.concrete)
    return World(name="tunnel", mesh=builder.mesh(), route=partial(_route, plan), stops=plan.stops)


def _profile(plan: TunnelPlan) -> Array:
    """Corners of the cross-section (y, z) [m], the floor first, (N, 2)."""
    angle = np.linspace(0.0, np.pi, plan.vault_sides + 1)
    half = 0.5 * plan.width_m
    vault = np.stack([half * np.cos(angle), plan.wall_m + half * np.sin(angle)], axis=1)
    return np.vstack([[[-half, 0.0], [half, 0.0]], vault])


def _route(plan: TunnelPlan, rng: np.random.Generator, stops: int) -> list[Waypoint]:
    """Along the axis, farther the more stops, a turn on the spot, and back."""
    start_m = 0.5 * plan.walk_m * (1.0 - stops / plan.stops)
    xs = np.linspace(start_m, start_m + plan.walk_m * stops / plan.stops, stops + 2)
    sway = rng.uniform(-0.2, 0.2, len(xs))
    way = [
        Waypoint(float(x), float(y), plan.slope * float(x)) for x, y in zip(xs, sway, strict=True)
    ]
    last = way[-1]
    turn = Waypoint(last.x_m, last.y_m, last.z_m, stop=True, look_deg=170.0)
    return [*way[:-1], turn, *way[-2::-1]]
