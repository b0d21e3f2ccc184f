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

from dataclasses import dataclass

import numpy as np

from recon4.geometry.mesh import MeshBuilder, SurfaceKind
from recon4.simulation.materials import MATERIAL
from recon4.simulation.world import Waypoint, World, WorldMarker
from recon4.simulation.worlds.furniture import corridor_things, furnish, lamp
from recon4.simulation.worlds.walls import WallShape, door, wall, window


@dataclass(frozen=True, slots=True, kw_only=True)
class OfficePlan:
    """Measures of the office, see the drawing."""

    rooms: int = 5
    """In each of the two rows."""
    room_m: float = 5.2
    """Width of a room, along the corridor."""
    corridor_m: float = 1.6
    """Width of the corridor."""
    north_m: float = 10.7
    south_m: float = -8.0
    """y of the outer walls."""
    height_m: float = 2.9
    corridor_height_m: float = 2.55
    """Of rooms and of the corridor, below the ceiling."""
    door_at_m: float = 1.3
    """Of a room's door to the corridor, from the room's western wall."""
    passage_at_m: float = 1.6
    """Of the doors between rooms, from the corridor."""

    @property
    def length_m(self) -> float:
        """From the western to the eastern wall."""
        return self.room_m * self.rooms


OFFICE = OfficePlan()


def build() -> World:
    """The office; its furniture is drawn once and for all."""
    builder = MeshBuilder()
    rng = np.random.default_rng(1907)
    _shell(builder)
    for row in (0, 1):
        for column in range(OFFICE.rooms):
            furnish(
                builder, _room(row, column), north=row == 0, kind=(row + 2 * column) % 4, rng=rng
            )
    corridor_things(builder, OFFICE.length_m, OFFICE.corridor_m, height_m=OFFICE.corridor_height_m)
    markers = _markers(builder)
    return World(
        name="office", mesh=builder.mesh(), route=_route, stops=2 * OFFICE.rooms, markers=markers
    )


def _room(row: int, column: int) -> tuple[float, float, float, float]:
    """West, east, south, north of the inside of a room [m]."""
    west, east = column * OFFICE.room_m + 0.06, (column + 1) * OFFICE.room_m - 0.06
    if row == 0:
        return west, east, OFFICE.corridor_m + 0.12, OFFICE.north_m - 0.15
    return west, east, OFFICE.south_m + 0.15, -0.12


def _shell(builder: MeshBuilder) -> None:
    """Floor, ceilings and walls."""
    room_m, corridor_m, length_m = OFFICE.room_m, OFFICE.corridor_m, OFFICE.length_m
    south_m, north_m = OFFICE.south_m, OFFICE.north_m
    floor = [0, south_m, 0], [length_m, 0, 0], [0, north_m - south_m, 0]
    with builder.of(SurfaceKind.GROUND):
        builder.quad(*floor, reflectivity=MATERIAL.linoleum)
    for low, high, z in [
        (south_m, 0.0, OFFICE.height_m),
        (0.0, corridor_m, OFFICE.corridor_height_m),
        (corridor_m, north_m, OFFICE.height_m),
    ]:
        ceiling = [0, low, z], [length_m, 0, 0], [0, high - low, 0]
        with builder.of(SurfaceKind.BUILDING):
            builder.quad(*ceiling, reflectivity=MATERIAL.ceiling)
    doors = [door(column * room_m + OFFICE.door_at_m) for column in range(OFFICE.rooms)]
    south_doors = [door((column + 1) * room_m - OFFICE.door_at_m) for column in range(OFFICE.rooms)]
    wall(builder, (0, corridor_m + 0.06), (length_m, corridor_m + 0.06), openings=doors)
    wall(builder, (0, -0.06), (length_m, -0.06), openings=south_doors)
    windows = [
        window(column * room_m + at) for column in range(OFFICE.rooms) for at in (1.45, 3.75)
    ]
    for y in (north_m, south_m):
        wall(builder, (0, y), (length_m, y), shape=WallShape(thickness_m=0.3), openings=windows)
    for x in (0.0, length_m):
        wall(builder, (x, south_m), (x, 0.0))
        wall(builder, (x, corridor_m), (x, north_m))
        end = window(corridor_m / 2, 1.0)
        wall(builder, (x, 0.0), (x, corridor_m), shape=WallShape(thickness_m=0.3), openings=[end])
    for column in range(1, OFFICE.rooms):
        x = column * room_m
        passage = door(OFFICE.passage_at_m)
        wall(builder, (x, corridor_m + 0.12), (x, north_m), openings=[passage])
        south = door(-0.12 - south_m - OFFICE.passage_at_m)
        wall(builder, (x, south_m), (x, -0.12), openings=[south])
    for x in (room_m * 0.5, room_m * 1.7, room_m * 2.6, room_m * 3.5, room_m * 4.4):
        lamp(builder, x, corridor_m / 2, ceiling_m=OFFICE.corridor_height_m, size=(1.2, 0.15))


def _markers(builder: MeshBuilder) -> tuple[WorldMarker, ...]:
    """Retro-reflective squares on walls of the corridor and rooms."""
    places = [(4.8, 0.002, 1.4), (13.2, OFFICE.corridor_m - 0.002, 1.5), (22.9, 0.002, 1.6)]
    for x, y, z in places:
        builder.box([x - 0.1, y - 0.002, z - 0.1], [x + 0.1, y + 0.002, z + 0.1], 2.2)
    for x in (2.9, 8.1, 13.3, 18.5, 23.7):
        builder.box([x, -0.002, 1.5], [x + 0.3, 0.002, 1.7], MATERIAL.paper)
    return tuple(WorldMarker(f"M{k + 1}", *place) for k, place in enumerate(places))


def _route(rng: np.random.Generator, stops: int) -> list[Waypoint]:
    """From the corridor's west end through rooms to the east and back.

    One row of rooms outbound, the other inbound; some neighbors by the inner door.
    """
    rows = [0, 1] if rng.random() < 0.5 else [1, 0]
    visits = [(rows[0], column) for column in range(OFFICE.rooms)]
    visits += [(rows[1], column) for column in reversed(range(OFFICE.rooms))]
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
    return column * OFFICE.room_m + (
        OFFICE.door_at_m if row == 0 else OFFICE.room_m - OFFICE.door_at_m
    )


def _in_corridor(x_m: float, rng: np.random.Generator, *, wiggle: float = 0.12) -> Waypoint:
    return Waypoint(x_m, OFFICE.corridor_m / 2 + wiggle * rng.uniform(-1, 1))


def _enter(row: int, column: int, rng: np.random.Generator) -> list[Waypoint]:
    x = _door_x(row, column)
    wall_y, inward = (OFFICE.corridor_m + 0.06, 1.0) if row == 0 else (-0.06, -1.0)
    stop = bool(rng.random() < 0.3)
    at_door = Waypoint(x, OFFICE.corridor_m / 2, stop=stop)
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
    x = (column + (1 if side > 0 else 0)) * OFFICE.room_m
    y = OFFICE.corridor_m + 0.12 + OFFICE.passage_at_m if row == 0 else -0.12 - OFFICE.passage_at_m
    return [Waypoint(x - 0.9 * side, y), Waypoint(x, y), Waypoint(x + 0.9 * side, y)]
