"""Desks, chairs, cabinets, lamps and what else stands and hangs in offices."""

from __future__ import annotations

import numpy as np

from recon4.geometry.mesh import MeshBuilder
from recon4.simulation.materials import MATERIAL

Box = tuple[float, float, float, float]


def furnish(
    builder: MeshBuilder, room: Box, *, north: bool, kind: int, rng: np.random.Generator
) -> None:
    """Fill a room along its sides; its middle and the 3.6 m next to the corridor stay free.

    Args:
        builder: Receives the furniture.
        room: West, east, south, north of its inside [m].
        north: The corridor is to the south of it.
        kind: 0 desks, 1 desks on one side and shelves, 2 meeting room, 3 store room.
        rng: Draws sizes and places.
    """
    west, east, south, north_y = room
    far, inward = (north_y, -1.0) if north else (south, 1.0)
    near = south if north else north_y
    for x in (west + 1.4, east - 1.4):
        radiator(builder, x, far + 0.12 * inward)
    for row in (0.3, 0.7):
        for x in (west + 1.3, east - 1.3):
            lamp(builder, x, south + row * (north_y - south), ceiling_m=2.9)
    reach = abs(far - near) - 3.7
    for side, wall_x in ((1.0, west), (-1.0, east)):
        along = 0.45
        while along < reach - 0.9:
            y = far + inward * (along + 0.8)
            along += _piece(builder, (wall_x, y), side=side, kind=kind, rng=rng)
    if kind == 2:
        board(builder, west + 0.02, 0.5 * (south + north_y), length_m=2.0)
    cupboard_y = near - 0.35 * inward
    cupboard_x = east - 0.6 if north else west + 0.6
    builder.block([cupboard_x, cupboard_y, 0], [0.9, 0.42, rng.uniform(1.6, 2.1)], MATERIAL.wood)


def _piece(
    builder: MeshBuilder,
    at_wall: tuple[float, float],
    *,
    side: float,
    kind: int,
    rng: np.random.Generator,
) -> float:
    """A piece of furniture against a side wall at x, y [m]; returns how much of it it takes."""
    wall_x, y = at_wall
    choice = rng.random()
    if kind == 3 or (kind == 1 and side > 0) or choice < 0.2:
        shelf(builder, wall_x + 0.2 * side, y, height_m=rng.uniform(1.4, 2.2), rng=rng)
        return 1.1
    if choice < 0.85:
        desk(builder, wall_x + 0.42 * side, y, side=side, rng=rng)
        return 1.9
    builder.tube(
        [wall_x + 0.3 * side, y, 0],
        [wall_x + 0.3 * side, y, 0.4],
        0.16,
        reflectivity=MATERIAL.wood,
        sides=10,
    )
    builder.ball([wall_x + 0.3 * side, y, 0.85], [0.3, 0.3, 0.45], 0.3)
    return 0.9


def desk(
    builder: MeshBuilder, x: float, y: float, *, side: float, rng: np.random.Generator
) -> None:
    """A desk with legs, drawers, a screen and a chair in front of it."""
    builder.block([x, y, 0.71], [0.8, 1.6, 0.03], MATERIAL.wood)
    for dx in (-0.36, 0.36):
        for dy in (-0.76, 0.76):
            builder.block([x + dx, y + dy, 0], [0.04, 0.04, 0.71], MATERIAL.steel)
    builder.block([x, y - 0.5, 0.05], [0.6, 0.4, 0.6], MATERIAL.wood)
    turn = rng.uniform(-0.3, 0.3)
    screen_y = y + rng.uniform(-0.2, 0.3)
    builder.block(
        [x - 0.15 * side, screen_y, 0.84], [0.04, 0.55, 0.33], MATERIAL.dark, yaw_rad=turn
    )
    builder.block([x - 0.15 * side, screen_y, 0.74], [0.15, 0.2, 0.1], MATERIAL.dark, yaw_rad=turn)
    builder.block(
        [x + 0.15 * side, screen_y - 0.45, 0.74],
        [0.21, 0.3, rng.uniform(0.02, 0.1)],
        MATERIAL.paper,
    )
    chair(builder, x + 0.62 * side, y + rng.uniform(-0.3, 0.3), yaw_rad=rng.uniform(-0.6, 0.6))


def chair(builder: MeshBuilder, x: float, y: float, *, yaw_rad: float) -> None:
    """A swivel chair."""
    builder.tube([x, y, 0.06], [x, y, 0.44], 0.035, reflectivity=MATERIAL.steel)
    builder.block([x, y, 0.44], [0.44, 0.44, 0.07], MATERIAL.dark, yaw_rad=yaw_rad)
    back = 0.21
    place = [x + back * np.cos(yaw_rad), y + back * np.sin(yaw_rad), 0.55]
    builder.block(place, [0.06, 0.42, 0.45], MATERIAL.dark, yaw_rad=yaw_rad)
    for angle in yaw_rad + np.arange(5) * 0.4 * np.pi:
        foot = [x + 0.28 * np.cos(angle), y + 0.28 * np.sin(angle), 0.05]
        builder.tube([x, y, 0.09], foot, 0.02, reflectivity=MATERIAL.steel, sides=4)


def shelf(
    builder: MeshBuilder, x: float, y: float, *, height_m: float, rng: np.random.Generator
) -> None:
    """An open shelf with binders."""
    builder.block([x, y - 0.49, 0], [0.38, 0.02, height_m], MATERIAL.wood)
    builder.block([x, y + 0.49, 0], [0.38, 0.02, height_m], MATERIAL.wood)
    for level in np.arange(0.05, height_m, 0.36):
        builder.block([x, y, level], [0.38, 1.0, 0.02], MATERIAL.wood)
        if level < height_m - 0.3:
            width = rng.uniform(0.3, 0.9)
            place = y - 0.47 + width / 2
            builder.block([x, place, level + 0.02], [0.28, width, 0.3], rng.uniform(0.15, 0.8))


def radiator(builder: MeshBuilder, x: float, y: float) -> None:
    """A radiator under a window."""
    builder.block([x, y, 0.15], [1.2, 0.08, 0.55], MATERIAL.paper)


def lamp(
    builder: MeshBuilder,
    x: float,
    y: float,
    *,
    ceiling_m: float,
    size: tuple[float, float] = (1.2, 0.3),
) -> None:
    """A lamp on the ceiling: the brightest thing in the intensity image."""
    builder.block([x, y, ceiling_m - 0.07], [size[0], size[1], 0.06], MATERIAL.lamp)


def board(builder: MeshBuilder, x: float, y: float, *, length_m: float) -> None:
    """A whiteboard on a wall that runs north-south, with a strip of dark writing."""
    builder.block([x, y, 1.0], [0.03, length_m, 1.2], 0.9)
    for k in range(6):
        builder.block([x, y - 0.7 + 0.25 * k, 1.6], [0.034, 0.12, 0.2], MATERIAL.dark)


def corridor_things(
    builder: MeshBuilder, length_m: float, width_m: float, *, height_m: float
) -> None:
    """Extinguisher, notice boards, exit signs, bins and a cable duct: no two places look alike."""
    builder.tube([10.1, 0.1, 0.5], [10.1, 0.1, 1.05], 0.08, reflectivity=MATERIAL.steel, sides=10)
    builder.block([8.3, width_m - 0.03, 0.9], [1.2, 0.03, 0.9], 0.25)
    builder.block([17.3, 0.03, 1.0], [1.6, 0.03, 0.8], 0.3)
    for k in range(5):
        builder.block(
            [7.85 + 0.22 * k, width_m - 0.05, 1.1 + 0.1 * (k % 3)],
            [0.16, 0.004, 0.22],
            MATERIAL.paper,
        )
    for x in (5.0, 14.7, 21.9):
        builder.block([x, width_m / 2, height_m - 0.3], [0.03, 0.4, 0.2], 1.6)
    builder.block([19.9, width_m - 0.19, 0], [0.3, 0.26, 0.7], MATERIAL.dark)
    builder.box(
        [0.2, width_m - 0.1, height_m - 0.12],
        [length_m - 0.2, width_m - 0.02, height_m],
        MATERIAL.steel,
    )
    builder.block([25.55, 0.35, 0], [0.4, 0.5, 1.0], MATERIAL.wood)
