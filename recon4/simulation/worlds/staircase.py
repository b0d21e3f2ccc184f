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

from dataclasses import dataclass
from functools import partial

import numpy as np

from recon4.geometry.mesh import MeshBuilder, SurfaceKind
from recon4.simulation.materials import MATERIAL
from recon4.simulation.world import Waypoint, World
from recon4.simulation.worlds.furniture import chair, desk, lamp, radiator, shelf
from recon4.simulation.worlds.walls import Opening, WallShape, door, wall, window


@dataclass(frozen=True, slots=True, kw_only=True)
class StaircasePlan:
    """Measures of a staircase, see the drawing."""

    floors: int = 4
    """Number of halls, 2 or more."""
    alike: bool = False
    """Every floor looks like the ground floor: same furniture, same signs."""
    storey_m: float = 3.3
    """From floor to floor, in two flights."""
    risers: int = 10
    """Of a flight."""
    tread_m: float = 0.29
    flight_width_m: float = 1.2
    landing_m: float = 1.6
    """Length of the landings of a floor and between two of them."""
    width_m: float = 2.6
    """Of the well."""
    slab_m: float = 0.2
    """Thickness of a landing."""
    hall_m: float = 4.0
    """Length of the hall, along x."""
    hall_south_m: float = -1.2
    hall_north_m: float = 4.0
    """y of its walls."""
    hall_height_m: float = 2.9
    door_y_m: float = 1.3
    """Of the middle of the door between hall and stairs."""

    @property
    def riser_m(self) -> float:
        """Height of a step."""
        return self.storey_m / (2 * self.risers)

    @property
    def flight_m(self) -> float:
        """Horizontal length of a flight; the landing is its last tread."""
        return (self.risers - 1) * self.tread_m

    @property
    def length_m(self) -> float:
        """Of the well, along x."""
        return 2 * self.landing_m + self.flight_m

    @property
    def hall_west_m(self) -> float:
        """X of the outer wall of the hall."""
        return -self.hall_m - 0.12


def build() -> World:
    """The staircase; every floor is furnished in another way."""
    return stack("staircase", StaircasePlan())


def stack(name: str, plan: StaircasePlan) -> World:
    """A staircase of any number of storeys."""
    floors = plan.floors
    builder, rng = MeshBuilder(), np.random.default_rng(1907)
    _well(builder, plan)
    for floor in range(floors):
        z = floor * plan.storey_m
        with builder.of(SurfaceKind.GROUND):
            low, high = [0, 0, z - plan.slab_m], [plan.landing_m, plan.width_m, z]
            builder.box(low, high, MATERIAL.linoleum)
        rise = plan.storey_m if floor + 1 < floors else plan.hall_height_m
        _hall(builder, plan, floor, rise_m=rise)
        look = 0 if plan.alike else floor
        _furnish(
            builder, plan, z, look=look, rng=np.random.default_rng(1907) if plan.alike else rng
        )
        _signs(builder, plan, z, look=look)
        if floor + 1 < floors:
            _flight(builder, plan, z, up=True)
            _flight(builder, plan, z + plan.storey_m / 2, up=False)
            _half_landing(builder, plan, z + plan.storey_m / 2)
    _top_rail(builder, plan)
    return World(name=name, mesh=builder.mesh(), route=partial(_route, plan), stops=4 * floors - 6)


def _half_landing(builder: MeshBuilder, plan: StaircasePlan, z: float) -> None:
    low = [plan.length_m - plan.landing_m, 0, z - plan.slab_m]
    with builder.of(SurfaceKind.GROUND):
        builder.box(low, [plan.length_m, plan.width_m, z], MATERIAL.linoleum)


def _well(builder: MeshBuilder, plan: StaircasePlan) -> None:
    """The walls around the stairs, windows at the half-landings, ground and roof."""
    floors, length_m, width_m = plan.floors, plan.length_m, plan.width_m
    storey_m, landing_m = plan.storey_m, plan.landing_m
    top = (floors - 1) * storey_m + plan.hall_height_m
    for y in (-0.15, width_m + 0.15):
        wall(builder, (0, y), (length_m, y), shape=WallShape(height_m=top, thickness_m=0.3))
    for storey in range(floors):
        bottom = storey * storey_m + storey_m / 2 if storey else 0.0
        height = min(storey_m, top - bottom) if storey else storey_m * 1.5
        sill = 0.9 if storey else storey_m / 2 + 0.9
        view = Opening(width_m / 2, 1.4, sill, sill + 1.2, glazed=True)
        if bottom + sill + 1.3 > top:
            continue
        x = length_m + 0.15
        span = (0.0, storey_m * 1.5) if storey == 0 else (bottom, height)
        wall(
            builder,
            (x, 0),
            (x, width_m),
            shape=WallShape(bottom_m=span[0], height_m=span[1], thickness_m=0.3),
            openings=[view],
        )
    floor = [landing_m, 0, 0], [length_m - landing_m, 0, 0], [0, width_m, 0]
    with builder.of(SurfaceKind.GROUND):
        builder.quad(*floor, reflectivity=MATERIAL.linoleum)
    with builder.of(SurfaceKind.BUILDING):
        builder.quad([0, 0, top], [length_m, 0, 0], [0, width_m, 0], reflectivity=MATERIAL.ceiling)
    lamp(builder, 3.0, width_m / 2, ceiling_m=top)


def _flight(builder: MeshBuilder, plan: StaircasePlan, z: float, *, up: bool) -> None:
    """Ten risers with a sloping underside, a rail with balusters on its inner side."""
    riser_m, tread_m = plan.riser_m, plan.tread_m
    flight_m, flight_width_m = plan.flight_m, plan.flight_width_m
    sign = 1.0 if up else -1.0
    start = plan.landing_m if up else plan.length_m - plan.landing_m
    south = 0.0 if up else plan.width_m - flight_width_m
    north = south + flight_width_m
    for k in range(plan.risers - 1):
        a, b = sorted([start + sign * k * tread_m, start + sign * (k + 1) * tread_m])
        low, high = [a, south, z + k * riser_m], [b, north, z + (k + 1) * riser_m]
        with builder.of(SurfaceKind.GROUND):
            builder.box(low, high, MATERIAL.linoleum)
    run, rise = sign * flight_m, (plan.risers - 1) * riser_m
    inner = north if up else south
    along, across = [run, 0, rise], [0, flight_width_m, 0]
    with builder.of(SurfaceKind.BUILDING):
        builder.quad([start, south, z - 0.15], along, across, reflectivity=MATERIAL.plaster)
        builder.quad([start, inner, z - 0.15], along, [0, 0, 0.2], reflectivity=MATERIAL.plaster)
    _rail(builder, [start, inner, z + riser_m], [start + run, inner, z + riser_m + rise])


def _rail(builder: MeshBuilder, start: list[float], end: list[float]) -> None:
    a, b = np.array(start), np.array(end)
    up = np.array([0.0, 0.0, 0.9])
    builder.tube(a + up, b + up, 0.025, reflectivity=MATERIAL.wood)
    for fraction in np.linspace(0.0, 1.0, 10):
        foot = a + fraction * (b - a)
        builder.tube(
            foot,
            foot + up,
            0.03 if fraction in {0.0, 1.0} else 0.009,
            reflectivity=MATERIAL.steel,
            sides=4,
        )


def _top_rail(builder: MeshBuilder, plan: StaircasePlan) -> None:
    """Keeps people from falling into the well on the last floor."""
    z = (plan.floors - 1) * plan.storey_m
    _rail(builder, [plan.landing_m, 0.05, z], [plan.landing_m, plan.flight_width_m + 0.1, z])


def _hall(builder: MeshBuilder, plan: StaircasePlan, floor: int, *, rise_m: float) -> None:
    """The walls of a hall west of the stairs, open towards them by a door."""
    z, height = floor * plan.storey_m, plan.hall_height_m
    west, south, north = plan.hall_west_m, plan.hall_south_m, plan.hall_north_m
    span = [-west, 0, 0], [0, north - south, 0]
    with builder.of(SurfaceKind.GROUND):
        builder.quad([west, south, z], *span, reflectivity=MATERIAL.linoleum)
    with builder.of(SurfaceKind.BUILDING):
        builder.quad([west, south, z + height], *span, reflectivity=MATERIAL.ceiling)
    wall(
        builder,
        (-0.06, south),
        (-0.06, north),
        shape=WallShape(bottom_m=z, height_m=rise_m),
        openings=[door(plan.door_y_m - south)],
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


def _furnish(
    builder: MeshBuilder, plan: StaircasePlan, z: float, *, look: int, rng: np.random.Generator
) -> None:
    """What stands in a hall; the look is the number of the floor of which it is typical."""
    west, south, north = plan.hall_west_m, plan.hall_south_m, plan.hall_north_m
    things = MeshBuilder()
    radiator(things, -2.0, north - 0.12)
    lamp(things, -2.0, 1.3, ceiling_m=plan.hall_height_m)
    if look % 2 == 0:
        desk(things, west + 0.6, north - 1.1, side=1.0, rng=rng)
        shelf(things, -0.35, north - 0.7, height_m=1.8, rng=rng)
    else:
        shelf(things, west + 0.4, south + 0.8, height_m=2.0, rng=rng)
        chair(things, -1.0, south + 0.5, yaw_rad=1.2)
    if look == 0:
        things.block([-1.8, south + 0.2, 0.8], [1.6, 0.25, 0.8], MATERIAL.steel)
    builder.place(things, [0.0, 0.0, z])


def _signs(builder: MeshBuilder, plan: StaircasePlan, z: float, *, look: int) -> None:
    """One bar more than the look, and a notice board and an extinguisher."""
    for bar in range(look + 1):
        x = 0.3 + 0.12 * bar
        builder.box([x, -0.001, z + 1.5], [x + 0.06, 0.004, z + 1.8], 0.95)
    x = 0.2 + 0.3 * look
    builder.box(
        [x, plan.width_m - 0.02, z + 1.1],
        [x + 0.4 + 0.1 * look, plan.width_m, z + 1.7],
        MATERIAL.paper,
    )
    if look % 2:
        builder.tube(
            [0.15, 2.4, z + 0.4], [0.15, 2.4, z + 0.95], 0.08, reflectivity=MATERIAL.dark, sides=10
        )


def _route(plan: StaircasePlan, rng: np.random.Generator, stops: int) -> list[Waypoint]:
    """A number of half-storeys up and down again; beyond the last one, halls are visited too."""
    halves = min(stops, 2 * (plan.floors - 1))
    top = halves // 2
    between = [(floor, way) for floor in range(1, top) for way in (0, 1)]
    picks = rng.permutation(len(between))[: stops - halves]
    visits = {between[k] for k in picks}
    way = [Waypoint(-2.2, plan.door_y_m), *_door(plan, 0, outward=True)]
    for floor in range(top):
        way += _climb(plan, floor)
        if (floor + 1, 0) in visits:
            way += _visit(plan, floor + 1, rng)
    way += _turn_back(plan, top) if halves % 2 else _visit(plan, top, rng)
    for floor in range(top, 0, -1):
        way += _climb(plan, floor - 1, down=True)[::-1]
        if (floor - 1, 1) in visits:
            way += _visit(plan, floor - 1, rng)
    return [*way, *_door(plan, 0, outward=False), Waypoint(-2.2, plan.door_y_m)]


def _turn_back(plan: StaircasePlan, floor: int) -> list[Waypoint]:
    """Up to the half-landing above a floor, a look around, and down by the same flight."""
    up, down = _climb(plan, floor)[:3], _climb(plan, floor, down=True)[:3]
    half = (floor + 0.5) * plan.storey_m
    place = Waypoint(plan.length_m - 0.8, 0.7, half, pace=0.8, stop=True, look_deg=90.0)
    return [*up, place, *down[::-1]]


def _door(plan: StaircasePlan, floor: int, *, outward: bool) -> list[Waypoint]:
    z = floor * plan.storey_m
    way = [
        Waypoint(-0.7, plan.door_y_m, z),
        Waypoint(-0.06, plan.door_y_m, z),
        Waypoint(0.6, plan.door_y_m, z),
    ]
    return way if outward else way[::-1]


def _visit(plan: StaircasePlan, floor: int, rng: np.random.Generator) -> list[Waypoint]:
    look = float(rng.choice([-120, -90, 90, 120]))
    place = Waypoint(
        -1.9 + rng.uniform(-0.4, 0.4),
        plan.door_y_m + rng.uniform(-0.5, 0.5),
        floor * plan.storey_m,
        stop=True,
        look_deg=look,
    )
    return [*_door(plan, floor, outward=False), place, *_door(plan, floor, outward=True)]


def _climb(plan: StaircasePlan, floor: int, *, down: bool = False) -> list[Waypoint]:
    """From the landing of a floor to the next one; reversed for the descent."""
    z, half, top = floor * plan.storey_m, (floor + 0.5) * plan.storey_m, (floor + 1) * plan.storey_m
    south, north = plan.flight_width_m / 2, plan.width_m - plan.flight_width_m / 2
    near, far = plan.landing_m - 0.15, plan.length_m - plan.landing_m + 0.15
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
