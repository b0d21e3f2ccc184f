"""Ten furnished rooms along a corridor 1.6 m wide, 26 m x 19 m.

       y
10.7 +-----+-----+-----+-----+-----+
     | N0  | N1  | N2  | N3  | N4  |     doors to the corridor, and from each room
 1.6 +-----+-----+-----+-----+-----+     to the next one of its row
     |          corridor           |
 0.0 +-----+-----+-----+-----+-----+
     | S0  | S1  | S2  | S3  | S4  |
-8.0 +-----+-----+-----+-----+-----+  x
     0    5.2  10.4  15.6  20.8  26
"""

from __future__ import annotations

import numpy as np

from recon4.geometry.mesh import MeshBuilder
from recon4.simulation.world import Waypoint, World, WorldMarker
from recon4.simulation.worlds.furniture import corridor_things, furnish, lamp
from recon4.simulation.worlds.walls import (
    CEILING,
    LINOLEUM,
    PAPER,
    WallShape,
    door,
    wall,
    window,
)

ROOM_M = 5.2
ROOMS = 5
LENGTH_M = ROOM_M * ROOMS
CORRIDOR_M = 1.6
NORTH_M, SOUTH_M = 10.7, -8.0
HEIGHT_M, CORRIDOR_HEIGHT_M = 2.9, 2.55
_DOOR_AT_M = 1.3
"""Of a room's door to the corridor, from the room's western wall."""
_PASSAGE_AT_M = 1.6
"""Of the doors between rooms, from the corridor."""


def build() -> World:
    """The office; its furniture is drawn once and for all."""
    builder = MeshBuilder()
    rng = np.random.default_rng(1907)
    _shell(builder)
    for row in (0, 1):
        for column in range(ROOMS):
            furnish(
                builder, _room(row, column), north=row == 0, kind=(row + 2 * column) % 4, rng=rng
            )
    corridor_things(builder, LENGTH_M, CORRIDOR_M, height_m=CORRIDOR_HEIGHT_M)
    markers = _markers(builder)
    return World(name="office", mesh=builder.mesh(), route=_route, stops=2 * ROOMS, markers=markers)


def _room(row: int, column: int) -> tuple[float, float, float, float]:
    """West, east, south, north of the inside of a room [m]."""
    west, east = column * ROOM_M + 0.06, (column + 1) * ROOM_M - 0.06
    if row == 0:
        return west, east, CORRIDOR_M + 0.12, NORTH_M - 0.15
    return west, east, SOUTH_M + 0.15, -0.12


def _shell(builder: MeshBuilder) -> None:
    """Floor, ceilings and walls."""
    builder.quad(
        [0, SOUTH_M, 0], [LENGTH_M, 0, 0], [0, NORTH_M - SOUTH_M, 0], reflectivity=LINOLEUM
    )
    for low, high, z in [
        (SOUTH_M, 0.0, HEIGHT_M),
        (0.0, CORRIDOR_M, CORRIDOR_HEIGHT_M),
        (CORRIDOR_M, NORTH_M, HEIGHT_M),
    ]:
        builder.quad([0, low, z], [LENGTH_M, 0, 0], [0, high - low, 0], reflectivity=CEILING)
    doors = [door(column * ROOM_M + _DOOR_AT_M) for column in range(ROOMS)]
    south_doors = [door((column + 1) * ROOM_M - _DOOR_AT_M) for column in range(ROOMS)]
    wall(builder, (0, CORRIDOR_M + 0.06), (LENGTH_M, CORRIDOR_M + 0.06), openings=doors)
    wall(builder, (0, -0.06), (LENGTH_M, -0.06), openings=south_doors)
    windows = [window(column * ROOM_M + at) for column in range(ROOMS) for at in (1.45, 3.75)]
    for y in (NORTH_M, SOUTH_M):
        wall(builder, (0, y), (LENGTH_M, y), shape=WallShape(thickness_m=0.3), openings=windows)
    for x in (0.0, LENGTH_M):
        wall(builder, (x, SOUTH_M), (x, 0.0))
        wall(builder, (x, CORRIDOR_M), (x, NORTH_M))
        end = window(CORRIDOR_M / 2, 1.0)
        wall(builder, (x, 0.0), (x, CORRIDOR_M), shape=WallShape(thickness_m=0.3), openings=[end])
    for column in range(1, ROOMS):
        x = column * ROOM_M
        passage = door(_PASSAGE_AT_M)
        wall(builder, (x, CORRIDOR_M + 0.12), (x, NORTH_M), openings=[passage])
        south = door(-0.12 - SOUTH_M - _PASSAGE_AT_M)
        wall(builder, (x, SOUTH_M), (x, -0.12), openings=[south])
    for x in (ROOM_M * 0.5, ROOM_M * 1.7, ROOM_M * 2.6, ROOM_M * 3.5, ROOM_M * 4.4):
        lamp(builder, x, CORRIDOR_M / 2, ceiling_m=CORRIDOR_HEIGHT_M, size=(1.2, 0.15))


def _markers(builder: MeshBuilder) -> tuple[WorldMarker, ...]:
    """Retro-reflective squares on walls of the corridor and rooms."""
    places = [(4.8, 0.002, 1.4), (13.2, CORRIDOR_M - 0.002, 1.5), (22.9, 0.002, 1.6)]
    for x, y, z in places:
        builder.box([x - 0.1, y - 0.002, z - 0.1], [x + 0.1, y + 0.002, z + 0.1], 2.2)
    for x in (2.9, 8.1, 13.3, 18.5, 23.7):
        builder.box([x, -0.002, 1.5], [x + 0.3, 0.002, 1.7], PAPER)
    return tuple(WorldMarker(f"M{k + 1}", *place) for k, place in enumerate(places))


def _route(rng: np.random.Generator, stops: int) -> list[Waypoint]:
    """From the corridor's west end through rooms to the east and back.

    One row of rooms outbound, the other inbound; some neighbors by the inner door.
    """
    rows = [0, 1] if rng.random() < 0.5 else [1, 0]
    visits = [(rows[0], column) for column in range(ROOMS)]
    visits += [(rows[1], column) for column in reversed(range(ROOMS))]
    # A short round stays near its start, so that it sees rooms and not only the corridor.
    near = [k for k, (_, column) in enumerate(visits) if 2 * column < stops + 1]
    chosen = sorted(rng.choice(near, size=stops, replace=False))
    way = [_in_corridor(0.9, rng, wiggle=0.0)]
    inside = False
    for order, place in enumerate(chosen):
        row, column = visits[place]
        last = order + 1 == len(chosen)
        following = None if last else visits[chosen[order + 1]]
        if not inside:
            way += _enter(row, column, rng)
        way.append(_look_around(row, column, rng))
        side = -1 if row != rows[0] else 1
        inside = following == (row, column + side) and rng.random() < 0.5
        way += _pass_through(row, column, side, rng=rng) if inside else _leave(row, column, rng)
    return [*way, _in_corridor(0.9, rng, wiggle=0.0)]


def _door_x(row: int, column: int) -> float:
    return column * ROOM_M + (_DOOR_AT_M if row == 0 else ROOM_M - _DOOR_AT_M)


def _in_corridor(x_m: float, rng: np.random.Generator, *, wiggle: float = 0.12) -> Waypoint:
    return Waypoint(x_m, CORRIDOR_M / 2 + wiggle * rng.uniform(-1, 1))


def _enter(row: int, column: int, rng: np.random.Generator) -> list[Waypoint]:
    x = _door_x(row, column)
    wall_y, inward = (CORRIDOR_M + 0.06, 1.0) if row == 0 else (-0.06, -1.0)
    stop = bool(rng.random() < 0.3)
    at_door = Waypoint(x, CORRIDOR_M / 2, stop=stop)
    return [at_door, Waypoint(x, wall_y), Waypoint(x, wall_y + 0.9 * inward)]


def _leave(row: int, column: int, rng: np.random.Generator) -> list[Waypoint]:
    return list(reversed(_enter(row, column, rng)))


def _look_around(row: int, column: int, rng: np.random.Generator) -> Waypoint:
    """A place in the free middle of a room where the person turns to look."""
    west, east, south, north = _room(row, column)
    x = 0.5 * (west + east) + rng.uniform(-0.35, 0.35)
    depth = rng.uniform(3.4, 6.0)
    y = south + depth if row == 0 else north - depth
    return Waypoint(x, y, stop=True, look_deg=float(rng.choice([-180, -120, -90, 90, 120, 180])))


def _pass_through(row: int, column: int, side: int, *, rng: np.random.Generator) -> list[Waypoint]:
    """By the inner door into the next room of the row."""
    x = (column + (1 if side > 0 else 0)) * ROOM_M
    y = CORRIDOR_M + 0.12 + _PASSAGE_AT_M if row == 0 else -0.12 - _PASSAGE_AT_M
    return [Waypoint(x - 0.9 * side, y), Waypoint(x, y), Waypoint(x + 0.9 * side, y)]
