"""Open fields with a power line: few features, but GNSS is received.

A path of some 500 m leads around under the wires; survey markers lie beside it.
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from numpy.typing import ArrayLike

from recon4.geometry.mesh import MeshBuilder, SurfaceKind
from recon4.geometry.se3 import Array
from recon4.simulation.materials import MATERIAL
from recon4.simulation.world import Waypoint, World, WorldMarker, distance_to_leg
from recon4.simulation.worlds.outdoors import bush, follow, ground_marker, tree, wire


@dataclass(frozen=True, slots=True, kw_only=True)
class FieldPlan:
    """Measures of the field."""

    corners: int = 10
    """Of the path around, which is an oval with these halves."""
    half_length_m: float = 95.0
    half_width_m: float = 62.0
    clear_m: float = 3.0
    """Nothing grows this near to a path, crown aside."""
    short_stops: int = 4
    """Number of possible rounds that do not reach the first corner."""
    pylons_m: tuple[tuple[float, float], ...] = ((-110.0, 18.0), (-8.0, 10.0), (105.0, 2.0))
    """x, y of the pylons."""
    arms_m: tuple[tuple[float, float], ...] = ((15.0, 4.5), (19.0, 3.2))
    """Height and half length of the cross-arms of a pylon."""
    barn_m: tuple[float, float] = (-30.0, -40.0)
    """x, y of the barn."""


FIELD = FieldPlan()


def build() -> World:
    """The field; trees and bushes are drawn once and for all."""
    builder = MeshBuilder()
    rng = np.random.default_rng(1907)
    _ground(builder, rng)
    _power_line(builder)
    _village_line(builder)
    _barn(builder, *FIELD.barn_m)
    for grow, count in ((tree, 45), (bush, 60)):
        for x, y in _free_places(rng, count):
            grow(builder, x, y, ground=height, rng=rng)
    markers = _markers(builder)
    return World(
        name="field",
        mesh=builder.mesh(),
        route=_route,
        stops=FIELD.short_stops + FIELD.corners - 1,
        markers=markers,
        outdoors=True,
    )


def height(x_m: ArrayLike, y_m: ArrayLike) -> Array:
    """Height of the ground [m]: gentle undulation and a ditch."""
    x, y = np.asarray(x_m, dtype=np.float64), np.asarray(y_m, dtype=np.float64)
    waves = 1.2 * np.sin(x / 37.0 + 0.4) + 0.9 * np.sin(y / 29.0 - x / 61.0)
    small = 0.12 * np.sin(x / 5.3 + 1.0) * np.sin(y / 4.7) + 0.01 * x
    ditch = -0.5 * np.exp(-(((y + 0.15 * x - 34.0) / 1.2) ** 2))
    return np.asarray(waves + small + ditch)


def _ground(builder: MeshBuilder, rng: np.random.Generator) -> None:
    x, y = np.arange(-170.0, 170.1, 1.25), np.arange(-130.0, 130.1, 1.25)
    grid_x, grid_y = np.meshgrid(x, y)
    # Tufts: far corners of the mesh are a little off the smooth ground.
    z = height(grid_x, grid_y) + 0.012 * rng.standard_normal(grid_x.shape)
    strips = np.where((grid_y[1:, 1:] // 16) % 2 == 0, MATERIAL.grass, 0.7 * MATERIAL.grass)
    with builder.of(SurfaceKind.GROUND):
        builder.terrain(x, y, z, reflectivity=strips)


def _power_line(builder: MeshBuilder) -> None:
    """Lattice pylons and six wires."""
    for x, y in FIELD.pylons_m:
        _pylon(builder, x, y)
    for (x0, y0), (x1, y1) in pairwise(FIELD.pylons_m):
        z0, z1 = float(height(x0, y0)), float(height(x1, y1))
        for level, half in FIELD.arms_m:
            for side in (-half, 0.55 * -half, half):
                start = [x0, y0 + side, z0 + level - 0.6]
                end = [x1, y1 + side, z1 + level - 0.6]
                wire(builder, start, end, sag_m=3.5, radius_m=0.02)


def _pylon(builder: MeshBuilder, x: float, y: float) -> None:
    z = float(height(x, y))
    levels = np.array([-0.5, 4.0, 8.0, 11.5, 15.0, 19.0, 22.0])
    halves = np.interp(levels, [0.0, 15.0, 22.0], [1.8, 0.6, 0.15])
    signs = [(-1, -1), (1, -1), (1, 1), (-1, 1)]
    corner = [
        [np.array([x + sx * h, y + sy * h, z + level]) for sx, sy in signs]
        for level, h in zip(levels, halves, strict=True)
    ]
    for low, high in pairwise(corner):
        for k in range(4):
            builder.tube(low[k], high[k], 0.06, reflectivity=MATERIAL.steel, sides=4)
            builder.tube(low[k], high[(k + 1) % 4], 0.03, reflectivity=MATERIAL.steel, sides=4)
            builder.tube(high[k], high[(k + 1) % 4], 0.03, reflectivity=MATERIAL.steel, sides=4)
    for level, half in FIELD.arms_m:
        a, b = [x, y - half, z + level], [x, y + half, z + level]
        builder.tube(a, b, 0.08, reflectivity=MATERIAL.steel, sides=4)
        builder.tube([x, y, z + level + 1.2], a, 0.04, reflectivity=MATERIAL.steel, sides=4)
        builder.tube([x, y, z + level + 1.2], b, 0.04, reflectivity=MATERIAL.steel, sides=4)
        for side in (-half, 0.55 * -half, half):
            top = [x, y + side, z + level]
            builder.tube(top, [x, y + side, z + level - 0.6], 0.07, reflectivity=0.5, sides=6)


def _village_line(builder: MeshBuilder) -> None:
    """Wooden poles with two wires along the southern edge."""
    places = [(-120.0 + 34.0 * k, -80.0 - 3.0 * np.sin(k)) for k in range(8)]
    for x, y in places:
        z = float(height(x, y))
        builder.tube(
            [x, y, z - 0.5], [x, y, z + 8.0], (0.13, 0.09), reflectivity=MATERIAL.wood, sides=8
        )
        builder.tube(
            [x, y - 0.8, z + 7.6], [x, y + 0.8, z + 7.6], 0.05, reflectivity=MATERIAL.wood, sides=4
        )
    for (x0, y0), (x1, y1) in pairwise(places):
        for side in (-0.7, 0.7):
            start = [x0, y0 + side, float(height(x0, y0)) + 7.7]
            end = [x1, y1 + side, float(height(x1, y1)) + 7.7]
            wire(builder, start, end, sag_m=0.7, radius_m=0.012)


def _barn(builder: MeshBuilder, x: float, y: float) -> None:
    z = float(height(x, y))
    with builder.of(SurfaceKind.BUILDING):
        builder.block([x, y, z - 0.6], [11.0, 7.0, 4.0], MATERIAL.wood, yaw_rad=0.35)
        builder.block([x, y, z + 3.4], [12.0, 8.0, 0.25], MATERIAL.steel, yaw_rad=0.35)
    builder.block([x + 9.0, y + 4.0, z - 0.2], [1.5, 1.5, 1.4], MATERIAL.concrete, yaw_rad=0.7)


def _corner(k: int) -> Array:
    """A corner of the path around; number 0 is where the walk starts."""
    angle = 2.0 * np.pi * k / FIELD.corners - 0.5 * np.pi
    squash = 1.0 + 0.12 * np.sin(3.0 * angle)
    return np.array(
        [FIELD.half_length_m * squash * np.cos(angle), FIELD.half_width_m * squash * np.sin(angle)]
    )


def _free_places(rng: np.random.Generator, count: int) -> list[tuple[float, float]]:
    """Random places away from all routes and from the pylons."""
    corners = np.array([_corner(k) for k in range(FIELD.corners)])
    ways = [(corners[k], corners[(k + 1) % FIELD.corners]) for k in range(FIELD.corners)]
    ways += [(corners[k], corners[0]) for k in range(2, FIELD.corners - 1)]
    built = [(np.array(p), np.array(p) + 0.01) for p in (*FIELD.pylons_m, FIELD.barn_m)]
    places: list[tuple[float, float]] = []
    while len(places) < count:
        p = rng.uniform([-150.0, -110.0], [150.0, 110.0])
        if (
            min(distance_to_leg(p, a, b) for a, b in ways) > FIELD.clear_m + 2.5
            and min(distance_to_leg(p, a, b) for a, b in built) > 8.0
        ):
            places.append((float(p[0]), float(p[1])))
    return places


def _markers(builder: MeshBuilder) -> tuple[WorldMarker, ...]:
    """Plates of half a meter, 1.6 m inside of the path's corners."""
    markers = []
    for k in range(FIELD.corners):
        corner = _corner(k)
        inside = corner * (1.0 - 1.8 / np.linalg.norm(corner)) + np.array([2.0, 0.0])
        place = (float(inside[0]), float(inside[1]))
        markers.append(ground_marker(builder, f"M{k + 1}", place, ground=height, size_m=0.5))
    return tuple(markers)


def _route(rng: np.random.Generator, stops: int) -> list[Waypoint]:
    """Part of the path to the first corner and back, or from corner to corner and straight back."""
    order = list(range(1, max(stops - FIELD.short_stops, 0) + 1))
    if rng.random() < 0.5:
        order = [FIELD.corners - k for k in order]
    start = Waypoint(*_corner(0))
    way = [start]
    if stops <= FIELD.short_stops:
        fraction = stops / (FIELD.short_stops + 1)
        x, y = _corner(0) + fraction * (_corner(int(rng.choice([1, -1]))) - _corner(0))
        way.append(Waypoint(x, y, stop=True, look_deg=90.0))
    for k in order:
        x, y = _corner(k) + rng.uniform(-0.6, 0.6, 2)
        if rng.random() < 0.3:
            look = float(rng.choice([-90.0, 90.0]))
            way.append(Waypoint(x, y, stop=True, look_deg=look))
        else:
            way.append(Waypoint(x, y))
    return follow([*way, start], height, rng, stray_m=0.6)
