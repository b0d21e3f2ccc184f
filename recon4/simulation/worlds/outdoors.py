"""Trees, poles, cars, wires and paths: what worlds under the open sky have in common."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from itertools import pairwise

import numpy as np
from numpy.typing import ArrayLike

from recon4.geometry.mesh import MeshBuilder, SurfaceKind
from recon4.geometry.se3 import Array
from recon4.simulation.materials import MATERIAL
from recon4.simulation.world import Waypoint, WorldMarker

Ground = Callable[[ArrayLike, ArrayLike], Array]
"""Height of the ground [m] at x, y."""


def tree(
    builder: MeshBuilder, x: float, y: float, *, ground: Ground, rng: np.random.Generator
) -> None:
    """A trunk, two boughs and a bumpy crown."""
    with builder.of(SurfaceKind.VEGETATION):
        z = float(ground(x, y))
        crown = rng.uniform(1.3, 2.3)
        height = rng.uniform(2.3, 3.2) + 0.5 * crown
        top = np.array([x + rng.uniform(-0.2, 0.2), y + rng.uniform(-0.2, 0.2), z + height])
        builder.tube([x, y, z - 0.3], top, (0.16, 0.1), reflectivity=MATERIAL.wood, sides=8)
        for _ in range(2):
            angle = rng.uniform(0.0, 2.0 * np.pi)
            bough = top + np.array([np.cos(angle), np.sin(angle), 1.2])
            builder.tube(
                top - [0, 0, 0.4], bough, (0.07, 0.03), reflectivity=MATERIAL.wood, sides=5
            )
        bumps = rng.uniform(0.75, 1.15, (7, 12))
        builder.ball(
            top + np.array([0, 0, 0.8 * crown]),
            [crown, crown, 1.1 * crown],
            MATERIAL.leaves,
            bumps=bumps,
        )


def bush(
    builder: MeshBuilder, x: float, y: float, *, ground: Ground, rng: np.random.Generator
) -> None:
    """A low crown on the ground."""
    with builder.of(SurfaceKind.VEGETATION):
        size = rng.uniform(0.5, 1.1, 3)
        place = [x, y, float(ground(x, y)) + 0.4 * size[2]]
        builder.ball(place, size, MATERIAL.leaves, bumps=rng.uniform(0.7, 1.2, (7, 12)))


def pole(builder: MeshBuilder, x: float, y: float, *, ground: Ground, arm: ArrayLike) -> None:
    """A street lamp with an arm (dx, dy) [m]."""
    z, (dx, dy) = float(ground(x, y)), np.asarray(arm, dtype=np.float64)
    builder.tube(
        [x, y, z - 0.3], [x, y, z + 6.0], (0.08, 0.05), reflectivity=MATERIAL.steel, sides=10
    )
    builder.tube([x, y, z + 5.9], [x + dx, y + dy, z + 6.2], 0.04, reflectivity=MATERIAL.steel)
    builder.block([x + dx, y + dy, z + 6.1], [0.5, 0.5, 0.12], 0.6)


def sign(builder: MeshBuilder, x: float, y: float, *, ground: Ground, along: ArrayLike) -> None:
    """A traffic sign: a retro-reflective square on a pole, in the plane of a direction."""
    z, (ux, uy) = float(ground(x, y)), np.asarray(along, dtype=np.float64)
    builder.tube([x, y, z - 0.3], [x, y, z + 2.7], 0.03, reflectivity=MATERIAL.steel)
    corner = np.array([x - 0.3 * ux + 0.04 * uy, y - 0.3 * uy - 0.04 * ux, z + 2.1])
    builder.quad(corner, [0.6 * ux, 0.6 * uy, 0.0], [0.0, 0.0, 0.6], reflectivity=MATERIAL.retro)


def car(
    builder: MeshBuilder,
    at: tuple[float, float],
    *,
    yaw_rad: float,
    ground: Ground,
    rng: np.random.Generator,
) -> None:
    """A parked car at x, y [m]: body, cabin, wheels, number plates."""
    x, y = at
    z = float(ground(x, y))
    paint, length = rng.uniform(0.08, 0.8), rng.uniform(3.9, 4.7)
    builder.block([x, y, z + 0.25], [length, 1.78, 0.6], paint, yaw_rad=yaw_rad)
    c, s = np.cos(yaw_rad), np.sin(yaw_rad)
    back = -0.1 * length
    cabin = [x + back * c, y + back * s, z + 0.85]
    builder.block(cabin, [0.5 * length, 1.55, 0.55], MATERIAL.dark, yaw_rad=yaw_rad)
    for ahead in (-0.31 * length, 0.31 * length):
        for side in (-0.8, 0.8):
            hub = np.array([x + ahead * c - side * s, y + ahead * s + side * c, z + 0.31])
            axle = 0.1 * np.array([-s, c, 0.0])
            builder.tube(hub - axle, hub + axle, 0.31, reflectivity=MATERIAL.dark, sides=12)
    for end in (-0.5 * length - 0.01, 0.5 * length + 0.01):
        plate = [x + end * c, y + end * s, z + 0.5]
        builder.block(plate, [0.01, 0.5, 0.11], MATERIAL.retro, yaw_rad=yaw_rad)


def wire(
    builder: MeshBuilder, start: ArrayLike, end: ArrayLike, *, sag_m: float, radius_m: float
) -> None:
    """A hanging wire: a parabola of 16 pieces."""
    a, b = np.asarray(start, dtype=np.float64), np.asarray(end, dtype=np.float64)
    fraction = np.linspace(0.0, 1.0, 17)[:, None]
    points = a + fraction * (b - a)
    points[:, 2:] -= 4.0 * sag_m * fraction * (1.0 - fraction)
    for p, q in pairwise(points):
        builder.tube(p, q, radius_m, reflectivity=MATERIAL.steel, sides=5)


def ground_marker(
    builder: MeshBuilder, name: str, place: tuple[float, float], *, ground: Ground, size_m: float
) -> WorldMarker:
    """A level plate with retro-reflective paint; the marker is the middle of its top."""
    x, y = place
    top = float(ground(x, y)) + 0.04
    with builder.of(SurfaceKind.GROUND):
        builder.block([x, y, top - 0.15], [size_m, size_m, 0.15], MATERIAL.retro)
    return WorldMarker(name, x, y, top)


def follow(
    corners: Sequence[Waypoint],
    ground: Ground,
    rng: np.random.Generator,
    *,
    stray_m: float,
    leg_m: float = 2.0,
) -> list[Waypoint]:
    """Legs of about `leg_m` on the ground between waypoints, straying a little as people do."""
    way = [_grounded(corners[0], ground)]
    for start, end in pairwise(corners):
        a, b = np.array([start.x_m, start.y_m]), np.array([end.x_m, end.y_m])
        length = float(np.linalg.norm(b - a))
        side = np.array([a[1] - b[1], b[0] - a[0]]) / max(length, 1e-9)
        legs = max(1, round(length / leg_m))
        fraction = np.arange(1, legs) / legs
        # Three waves with random phases, nothing at the ends of the leg.
        waves = np.arange(1, 4)[:, None] * np.pi * fraction
        offsets = stray_m * rng.uniform(-1.0, 1.0, 3) @ np.sin(waves)
        for s, offset in zip(fraction, offsets, strict=True):
            x, y = a + s * (b - a) + offset * side
            way.append(_grounded(Waypoint(x, y, pace=end.pace), ground))
        way.append(_grounded(end, ground))
    return way


def _grounded(waypoint: Waypoint, ground: Ground) -> Waypoint:
    z = float(ground(waypoint.x_m, waypoint.y_m))
    return Waypoint(
        float(waypoint.x_m),
        float(waypoint.y_m),
        z,
        pace=waypoint.pace,
        stop=waypoint.stop,
        look_deg=waypoint.look_deg,
    )
