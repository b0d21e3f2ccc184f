"""A building that only its variant knows: rooms of any size behind doors in any place.

A grid of rooms whose rows and columns are 2.4 to 12 m wide, so that there are closets, corridors
and halls. Doors connect all of them, further ones close loops. What stands in a room is drawn, up
to nothing at all; only the legs from door to door stay free.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Iterator
from dataclasses import dataclass
from functools import partial
from itertools import pairwise

import numpy as np

from recon4.geometry.mesh import MeshBuilder
from recon4.geometry.se3 import Array
from recon4.simulation.materials import MATERIAL
from recon4.simulation.world import Waypoint, World, distance_to_leg
from recon4.simulation.worlds.walls import USUAL_WALL, Opening, WallShape, wall, window


@dataclass(frozen=True, slots=True, kw_only=True)
class RoomsPlan:
    """What a variant is drawn from."""

    widths_m: tuple[tuple[float, float], ...] = ((2.4, 3.0), (3.2, 5.5), (6.0, 12.0))
    """Least and most width of a row or column: closets and corridors, rooms, halls …"""
    width_chances: tuple[float, ...] = (0.3, 0.5, 0.2)
    """… and the chance of each."""
    doors_m: tuple[float, ...] = (0.95, 1.3, 2.0)
    """Widths of doors."""
    door_tops_m: tuple[float, float] = (2.1, 2.35)
    """Least and most height of a door."""
    another_door: float = 0.3
    """Chance of a door between rooms that are connected without it."""
    corner_m: float = 0.85
    """Least distance from a door's middle to the corner of the room."""
    before_m: float = 0.9
    """How far before a door people turn to it."""
    free_m: float = 0.6
    """Nothing stands nearer to the legs between doors."""
    things_m2: tuple[float, ...] = (0.0, 0.08, 0.2)
    """Things on a square meter of a room."""


ROOMS = RoomsPlan()

_Room = tuple[int, int]


@dataclass(frozen=True, slots=True)
class _DrawnDoor:
    """An opening between two rooms that lie side by side along an axis."""

    rooms: frozenset[_Room]
    along: int
    """Axis of the wall."""
    at_m: float
    """Its middle along the wall [m]."""
    wall_m: float
    """Place of the wall on the other axis [m]."""
    width_m: float
    top_m: float

    def place(self, before_m: float = 0.0) -> Array:
        """Middle of the opening, or a place before it on the positive side, (2,)."""
        place = np.full(2, self.wall_m + before_m)
        place[self.along] = self.at_m
        return place


@dataclass(frozen=True, slots=True, eq=False)
class _FloorPlan:
    """Floor plan."""

    lines: tuple[Array, Array]
    """Places of the walls along x and along y [m]."""
    height_m: Array
    """Of each room [m], (X, Y)."""
    doors: tuple[_DrawnDoor, ...]

    @property
    def rooms(self) -> list[_Room]:
        """All rooms; the first one is where people start."""
        columns, rows = self.height_m.shape
        return [(i, j) for i in range(columns) for j in range(rows)]

    def corners(self, room: _Room) -> Array:
        """Lowest and highest x, y of a room [m], (2, 2)."""
        return np.array(
            [[lines[k], lines[k + 1]] for lines, k in zip(self.lines, room, strict=True)]
        ).T

    def middle(self, room: _Room) -> Array:
        """Where people stop in a room [m], (2,)."""
        return np.asarray(self.corners(room).mean(axis=0))

    def doors_of(self, room: _Room) -> list[_DrawnDoor]:
        """The doors of a room."""
        return [door for door in self.doors if room in door.rooms]

    def before(self, door: _DrawnDoor, room: _Room) -> Array:
        """Where people in a room turn to a door [m], (2,)."""
        across = 1 - door.along
        middle = self.middle(room)[across]
        step = np.clip(middle - door.wall_m, -ROOMS.before_m, ROOMS.before_m)
        return door.place(float(step))

    def legs(self, room: _Room) -> Iterator[tuple[Array, Array]]:
        """Both ends of the straight legs that people walk in a room [m]."""
        for door in self.doors_of(room):
            turn = self.before(door, room)
            yield door.place(), turn
            yield turn, self.middle(room)

    def path(self, start: _Room, goal: _Room) -> list[_Room]:
        """The rooms of a shortest path, with both ends."""
        came: dict[_Room, _Room] = {start: start}
        queue = deque([start])
        while queue:
            room = queue.popleft()
            for door in self.doors_of(room):
                (other,) = door.rooms - {room}
                if other not in came:
                    came[other] = room
                    queue.append(other)
        found = [goal]
        while found[-1] != start:
            found.append(came[found[-1]])
        return found[::-1]


def build(variant: int = 0) -> World:
    """The building of a variant."""
    rng = np.random.default_rng([4114, variant])
    plan = _drawn_plan(rng)
    builder = MeshBuilder()
    for room in plan.rooms:
        low, high = plan.corners(room)
        x, y = high - low
        for z, value in ((0.0, MATERIAL.linoleum), (float(plan.height_m[room]), MATERIAL.ceiling)):
            builder.quad(
                [*low, z], [x, 0, 0], [0, y, 0], reflectivity=value * rng.uniform(0.6, 1.2)
            )
        _fill(builder, plan, room, rng=rng)
    _lay_walls(builder, plan, rng)

    return World(
        name="rooms", mesh=builder.mesh(), route=partial(_round, plan), stops=len(plan.rooms) - 1
    )


def _drawn_plan(rng: np.random.Generator) -> _FloorPlan:
    lines = tuple(_drawn_lines(rng, count) for count in (int(rng.integers(3, 5)), 3))
    shape = len(lines[0]) - 1, len(lines[1]) - 1
    height_m = rng.uniform(2.5, 3.2, shape) + (rng.random(shape) < 0.2) * rng.uniform(0.5, 3.0)
    plan = _FloorPlan((lines[0], lines[1]), height_m, ())
    walls = [
        (room, other)
        for room in plan.rooms
        for other in ((room[0] + 1, room[1]), (room[0], room[1] + 1))
        if other in plan.rooms
    ]
    group = {room: room for room in plan.rooms}
    doors = []
    for row in rng.permutation(len(walls)):
        room, other = walls[row]
        if group[room] == group[other] and rng.random() > ROOMS.another_door:
            continue
        joined = group[other]
        group = {key: group[room] if value == joined else value for key, value in group.items()}
        doors.append(_drawn_door(plan, room, other, rng=rng))
    return _FloorPlan(plan.lines, height_m, tuple(doors))


def _drawn_lines(rng: np.random.Generator, count: int) -> Array:
    kinds = rng.choice(len(ROOMS.widths_m), size=count, p=ROOMS.width_chances)
    widths = [rng.uniform(*ROOMS.widths_m[kind]) for kind in kinds]
    return np.concatenate([[0.0], np.cumsum(widths)])


def _drawn_door(
    plan: _FloorPlan, room: _Room, other: _Room, *, rng: np.random.Generator
) -> _DrawnDoor:
    along = 1 if other[0] > room[0] else 0
    low, high = plan.corners(room)
    width_m = min(float(rng.choice(ROOMS.doors_m)), 0.6 * float(high[along] - low[along]))
    margin = max(ROOMS.corner_m, width_m / 2.0 + 0.2)
    at_m = float(rng.uniform(low[along] + margin, high[along] - margin))
    top_m = float(rng.uniform(*ROOMS.door_tops_m))
    return _DrawnDoor(frozenset({room, other}), along, at_m, float(high[1 - along]), width_m, top_m)


def _lay_walls(builder: MeshBuilder, plan: _FloorPlan, rng: np.random.Generator) -> None:
    """A wall along each side of each room, as high as the higher of its two rooms."""
    for along in (0, 1):
        pieces = plan.lines[along]
        for line, at in enumerate(plan.lines[1 - along]):
            for k, (start, end) in enumerate(pairwise(pieces)):
                beside = [
                    (k, side) if along == 0 else (side, k)
                    for side in (line - 1, line)
                    if 0 <= side < len(plan.lines[1 - along]) - 1
                ]
                shape = WallShape(
                    height_m=float(max(plan.height_m[room] for room in beside)),
                    thickness_m=USUAL_WALL.thickness_m if len(beside) == 2 else 0.3,
                    reflectivity=MATERIAL.plaster * float(rng.uniform(0.6, 1.3)),
                )
                ends = [(start, at), (end, at)] if along == 0 else [(at, start), (at, end)]
                holes = _holes(plan, beside, (start, end), rng=rng)
                a, b = ((float(x), float(y)) for x, y in ends)
                wall(builder, a, b, shape=shape, openings=holes)


def _holes(
    plan: _FloorPlan, beside: list[_Room], span: tuple[float, float], *, rng: np.random.Generator
) -> list[Opening]:
    """The door between two rooms, or a window to the outside."""
    start, end = span
    if len(beside) == 1:
        wide = end - start > 2.5 and rng.random() < 0.5
        return [window(float(end - start) / 2.0)] if wide else []
    return [
        Opening(door.at_m - float(start), door.width_m, 0.0, door.top_m)
        for door in plan.doors
        if door.rooms == frozenset(beside)
    ]


def _fill(builder: MeshBuilder, plan: _FloorPlan, room: _Room, *, rng: np.random.Generator) -> None:
    """Put things into a room, away from the legs between its doors."""
    low, high = plan.corners(room)
    legs = list(plan.legs(room))
    wanted = round(float(rng.choice(ROOMS.things_m2)) * float(np.prod(high - low)))
    for _ in range(10 * wanted):
        place = rng.uniform(low + 0.2, high - 0.2)
        radius_m = float(rng.uniform(0.1, 1.0))
        if min(distance_to_leg(place, *leg) for leg in legs) > radius_m + ROOMS.free_m:
            ceiling_m = float(plan.height_m[room])
            _thing(builder, place, radius_m=radius_m, ceiling_m=ceiling_m, rng=rng)
            wanted -= 1
        if wanted == 0:
            return


def _thing(
    builder: MeshBuilder,
    place: Array,
    *,
    radius_m: float,
    ceiling_m: float,
    rng: np.random.Generator,
) -> None:
    """A box, a board on a foot, a column or a ball, turned by any angle."""
    x, y = place
    value = float(rng.choice([MATERIAL.dark, MATERIAL.steel, MATERIAL.wood, MATERIAL.paper]))
    yaw = float(rng.uniform(0.0, np.pi))
    long, wide = 1.6 * radius_m, 1.2 * radius_m * rng.uniform(0.3, 1.0)
    height_m = float(rng.uniform(0.3, min(2.2, ceiling_m - 0.1)))
    kind = rng.integers(4)
    if kind == 0:
        builder.block([x, y, 0], [long, wide, height_m], value, yaw_rad=yaw)
    elif kind == 1:
        builder.block([x, y, 0], [0.1, 0.1, height_m], MATERIAL.steel)
        builder.block([x, y, height_m], [long, wide, 0.04], value, yaw_rad=yaw)
    elif kind == 2:
        builder.tube([x, y, 0], [x, y, ceiling_m], min(radius_m, 0.4), reflectivity=value, sides=16)
    else:
        half = np.array([radius_m, radius_m, min(1.0, ceiling_m / 2.2)])
        builder.ball([x, y, float(half[2])], list(half), value)


def _round(plan: _FloorPlan, rng: np.random.Generator, stops: int) -> list[Waypoint]:
    """From the first room through others, the nearest ones in a drawn order, and back."""
    start, *others = plan.rooms
    shuffled = [others[k] for k in rng.permutation(len(others))]
    goals = sorted(shuffled, key=lambda room: len(plan.path(start, room)))[:stops]
    x, y = (float(place) for place in plan.middle(start))
    path = [Waypoint(x, y)]
    here = start
    for goal in [*goals, start]:
        rooms = plan.path(here, goal)
        for room, other in pairwise(rooms):
            path += _through(plan, room, other)
            x, y = (float(place) for place in plan.middle(other))
            last = other == rooms[-1] and goal != start
            look_deg = float(rng.choice([-180, -90, 90, 180])) if last else 0.0
            path.append(Waypoint(x, y, stop=last, look_deg=look_deg))
        here = goal
    return path


def _through(plan: _FloorPlan, room: _Room, other: _Room) -> list[Waypoint]:
    """From the middle of a room through a door."""
    (door,) = (door for door in plan.doors if door.rooms == {room, other})
    places = plan.before(door, room), door.place(), plan.before(door, other)
    return [Waypoint(float(x), float(y)) for x, y in places]
