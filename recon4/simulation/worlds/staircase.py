"""A staircase of four storeys with half-landings and a hall on each floor.

From above, one storey (it climbs along +x at the south, back along -x at the north)::

        y
    2.6 +--------+--+---------------+-------+
        | hall   |  |  <-- up       |       |
        |        D  |===== rails ===| half  |
        |        |  |  up -->       |landing|
    0.0 +--------+--+---------------+-------+  x
      -4.1      0.0 1.6           4.21     5.8
"""

from __future__ import annotations

import numpy as np

from recon4.geometry.mesh import MeshBuilder
from recon4.simulation.world import Waypoint, World
from recon4.simulation.worlds.furniture import chair, desk, lamp, radiator, shelf
from recon4.simulation.worlds.walls import (
    CEILING,
    DARK,
    LINOLEUM,
    PAPER,
    PLASTER,
    STEEL,
    WOOD,
    Opening,
    WallShape,
    door,
    wall,
    window,
)

FLOORS = 4
STOREY_M = 3.3
RISERS = 10
RISER_M = STOREY_M / (2 * RISERS)
TREAD_M = 0.29
FLIGHT_M = (RISERS - 1) * TREAD_M
LANDING_M = 1.6
LENGTH_M = 2 * LANDING_M + FLIGHT_M
WIDTH_M = 2.6
FLIGHT_WIDTH_M = 1.2
HALL_M = 4.0
_HALL_SOUTH_M, _HALL_NORTH_M = -1.2, 4.0
_SLAB_M = 0.2
_HALL_HEIGHT_M = 2.9
_DOOR_Y_M = 1.3


def build() -> World:
    """The staircase; every floor is furnished in another way."""
    return stack("staircase", floors=FLOORS, alike=False)


def stack(name: str, *, floors: int, alike: bool) -> World:
    """A staircase of any number of storeys.

    Args:
        name: Of the world.
        floors: Number of halls, 2 or more.
        alike: Every floor looks like the ground floor: same furniture, same signs.
    """
    builder = MeshBuilder()
    rng = np.random.default_rng(1907)
    _well(builder, floors)
    for floor in range(floors):
        z = floor * STOREY_M
        builder.box([0, 0, z - _SLAB_M], [LANDING_M, WIDTH_M, z], LINOLEUM)
        rise = STOREY_M if floor + 1 < floors else _HALL_HEIGHT_M
        _hall(builder, floor, rise_m=rise)
        look = 0 if alike else floor
        _furnish(builder, z, look, rng=np.random.default_rng(1907) if alike else rng)
        _signs(builder, z, look)
        if floor + 1 < floors:
            _flight(builder, z, up=True)
            _flight(builder, z + STOREY_M / 2, up=False)
            half = z + STOREY_M / 2
            start = LENGTH_M - LANDING_M
            builder.box([start, 0, half - _SLAB_M], [LENGTH_M, WIDTH_M, half], LINOLEUM)
    _top_rail(builder, floors)

    def route(rng: np.random.Generator, stops: int) -> list[Waypoint]:
        return _route(rng, stops, floors=floors)

    return World(name=name, mesh=builder.mesh(), route=route, stops=4 * floors - 6)


def _well(builder: MeshBuilder, floors: int) -> None:
    """The walls around the stairs, windows at the half-landings, ground and roof."""
    top = (floors - 1) * STOREY_M + _HALL_HEIGHT_M
    for y in (-0.15, WIDTH_M + 0.15):
        wall(builder, (0, y), (LENGTH_M, y), shape=WallShape(height_m=top, thickness_m=0.3))
    for storey in range(floors):
        bottom = storey * STOREY_M + STOREY_M / 2 if storey else 0.0
        height = min(STOREY_M, top - bottom) if storey else STOREY_M * 1.5
        sill = 0.9 if storey else STOREY_M / 2 + 0.9
        view = Opening(WIDTH_M / 2, 1.4, sill, sill + 1.2, glazed=True)
        if bottom + sill + 1.3 > top:
            continue
        x = LENGTH_M + 0.15
        span = (0.0, STOREY_M * 1.5) if storey == 0 else (bottom, height)
        wall(
            builder,
            (x, 0),
            (x, WIDTH_M),
            shape=WallShape(bottom_m=span[0], height_m=span[1], thickness_m=0.3),
            openings=[view],
        )
    builder.quad(
        [LANDING_M, 0, 0], [LENGTH_M - LANDING_M, 0, 0], [0, WIDTH_M, 0], reflectivity=LINOLEUM
    )
    builder.quad([0, 0, top], [LENGTH_M, 0, 0], [0, WIDTH_M, 0], reflectivity=CEILING)
    lamp(builder, 3.0, WIDTH_M / 2, ceiling_m=top)


def _flight(builder: MeshBuilder, z: float, *, up: bool) -> None:
    """Ten risers with a sloping underside, a rail with balusters on its inner side."""
    sign = 1.0 if up else -1.0
    start = LANDING_M if up else LENGTH_M - LANDING_M
    south = 0.0 if up else WIDTH_M - FLIGHT_WIDTH_M
    north = south + FLIGHT_WIDTH_M
    for k in range(RISERS - 1):
        a, b = sorted([start + sign * k * TREAD_M, start + sign * (k + 1) * TREAD_M])
        builder.box([a, south, z + k * RISER_M], [b, north, z + (k + 1) * RISER_M], LINOLEUM)
    run, rise = sign * FLIGHT_M, (RISERS - 1) * RISER_M
    builder.quad(
        [start, south, z - 0.15], [run, 0, rise], [0, FLIGHT_WIDTH_M, 0], reflectivity=PLASTER
    )
    inner = north if up else south
    builder.quad([start, inner, z - 0.15], [run, 0, rise], [0, 0, 0.2], reflectivity=PLASTER)
    _rail(builder, [start, inner, z + RISER_M], [start + run, inner, z + RISER_M + rise])


def _rail(builder: MeshBuilder, start: list[float], end: list[float]) -> None:
    a, b = np.array(start), np.array(end)
    up = np.array([0.0, 0.0, 0.9])
    builder.tube(a + up, b + up, 0.025, reflectivity=WOOD)
    for fraction in np.linspace(0.0, 1.0, 10):
        foot = a + fraction * (b - a)
        builder.tube(
            foot, foot + up, 0.03 if fraction in {0.0, 1.0} else 0.009, reflectivity=STEEL, sides=4
        )


def _top_rail(builder: MeshBuilder, floors: int) -> None:
    """Keeps people from falling into the well on the last floor."""
    z = (floors - 1) * STOREY_M
    _rail(builder, [LANDING_M, 0.05, z], [LANDING_M, FLIGHT_WIDTH_M + 0.1, z])


def _hall(builder: MeshBuilder, floor: int, *, rise_m: float) -> None:
    """The walls of a hall west of the stairs, open towards them by a door."""
    z, height = floor * STOREY_M, _HALL_HEIGHT_M
    west, south, north = -HALL_M - 0.12, _HALL_SOUTH_M, _HALL_NORTH_M
    builder.quad([west, south, z], [-west, 0, 0], [0, north - south, 0], reflectivity=LINOLEUM)
    builder.quad(
        [west, south, z + height], [-west, 0, 0], [0, north - south, 0], reflectivity=CEILING
    )
    wall(
        builder,
        (-0.06, south),
        (-0.06, north),
        shape=WallShape(bottom_m=z, height_m=rise_m),
        openings=[door(_DOOR_Y_M - south)],
    )
    wall(
        builder,
        (west, south),
        (west, north),
        shape=WallShape(bottom_m=z, height_m=height, thickness_m=0.3),
        openings=[window(2.6)],
    )
    side = WallShape(bottom_m=z, height_m=height)
    wall(builder, (west, south), (0, south), shape=side)
    wall(builder, (west, north), (0, north), shape=side)


def _furnish(builder: MeshBuilder, z: float, look: int, *, rng: np.random.Generator) -> None:
    """What stands in a hall; the look is the number of the floor of which it is typical."""
    west, south, north = -HALL_M - 0.12, _HALL_SOUTH_M, _HALL_NORTH_M
    things = MeshBuilder()
    radiator(things, -2.0, north - 0.12)
    lamp(things, -2.0, 1.3, ceiling_m=_HALL_HEIGHT_M)
    if look % 2 == 0:
        desk(things, west + 0.6, north - 1.1, side=1.0, rng=rng)
        shelf(things, -0.35, north - 0.7, height_m=1.8, rng=rng)
    else:
        shelf(things, west + 0.4, south + 0.8, height_m=2.0, rng=rng)
        chair(things, -1.0, south + 0.5, yaw_rad=1.2)
    if look == 0:
        things.block([-1.8, south + 0.2, 0.8], [1.6, 0.25, 0.8], STEEL)
    builder.place(things, [0.0, 0.0, z])


def _signs(builder: MeshBuilder, z: float, look: int) -> None:
    """One bar more than the look, and a notice board and an extinguisher."""
    for bar in range(look + 1):
        x = 0.3 + 0.12 * bar
        builder.box([x, -0.001, z + 1.5], [x + 0.06, 0.004, z + 1.8], 0.95)
    x = 0.2 + 0.3 * look
    builder.box([x, WIDTH_M - 0.02, z + 1.1], [x + 0.4 + 0.1 * look, WIDTH_M, z + 1.7], PAPER)
    if look % 2:
        builder.tube([0.15, 2.4, z + 0.4], [0.15, 2.4, z + 0.95], 0.08, reflectivity=DARK, sides=10)


def _route(rng: np.random.Generator, stops: int, *, floors: int) -> list[Waypoint]:
    """A number of half-storeys up and down again; beyond the last one, halls are visited too."""
    halves = min(stops, 2 * (floors - 1))
    top = halves // 2
    between = [(floor, way) for floor in range(1, top) for way in (0, 1)]
    picks = rng.permutation(len(between))[: stops - halves]
    visits = {between[k] for k in picks}
    way = [Waypoint(-2.2, _DOOR_Y_M), *_door(0, outward=True)]
    for floor in range(top):
        way += _climb(floor)
        if (floor + 1, 0) in visits:
            way += _visit(floor + 1, rng)
    way += _turn_back(top) if halves % 2 else _visit(top, rng)
    for floor in range(top, 0, -1):
        way += _climb(floor - 1, down=True)[::-1]
        if (floor - 1, 1) in visits:
            way += _visit(floor - 1, rng)
    return [*way, *_door(0, outward=False), Waypoint(-2.2, _DOOR_Y_M)]


def _turn_back(floor: int) -> list[Waypoint]:
    """Up to the half-landing above a floor, a look around, and down by the same flight."""
    up, down = _climb(floor)[:3], _climb(floor, down=True)[:3]
    half = (floor + 0.5) * STOREY_M
    place = Waypoint(LENGTH_M - 0.8, 0.7, half, pace=0.8, stop=True, look_deg=90.0)
    return [*up, place, *down[::-1]]


def _door(floor: int, *, outward: bool) -> list[Waypoint]:
    z = floor * STOREY_M
    way = [Waypoint(-0.7, _DOOR_Y_M, z), Waypoint(-0.06, _DOOR_Y_M, z), Waypoint(0.6, _DOOR_Y_M, z)]
    return way if outward else way[::-1]


def _visit(floor: int, rng: np.random.Generator) -> list[Waypoint]:
    look = float(rng.choice([-120, -90, 90, 120]))
    place = Waypoint(
        -1.9 + rng.uniform(-0.4, 0.4),
        _DOOR_Y_M + rng.uniform(-0.5, 0.5),
        floor * STOREY_M,
        stop=True,
        look_deg=look,
    )
    return [*_door(floor, outward=False), place, *_door(floor, outward=True)]


def _climb(floor: int, *, down: bool = False) -> list[Waypoint]:
    """From the landing of a floor to the next one; reversed for the descent."""
    z, half, top = floor * STOREY_M, (floor + 0.5) * STOREY_M, (floor + 1) * STOREY_M
    south, north = FLIGHT_WIDTH_M / 2, WIDTH_M - FLIGHT_WIDTH_M / 2
    near, far = LANDING_M - 0.15, LENGTH_M - LANDING_M + 0.15
    # A pace belongs to the leg that ends at a waypoint: reversed ways need it at the other end.
    stairs = 0.5
    return [
        Waypoint(0.8, south, z),
        Waypoint(near, south, z, pace=stairs if down else 1.0),
        Waypoint(far, south, half, pace=1.0 if down else stairs),
        Waypoint(far + 0.6, south + 0.1, half, pace=0.8),
        Waypoint(far + 0.6, north - 0.1, half, pace=0.8),
        Waypoint(far, north, half, pace=stairs if down else 0.8),
        Waypoint(near, north, top, pace=1.0 if down else stairs),
        Waypoint(0.8, north, top),
    ]
