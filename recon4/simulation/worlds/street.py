"""A block of houses 60 m x 36 m with a street around it, on a slope of two percent.

Distances ``d`` are measured outwards from the block's facades: sidewalk to 2.5 m, roadway to
9.5 m, sidewalk to 12 m, then the facades of the houses opposite.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import ArrayLike

from recon4.geometry.mesh import MeshBuilder, SurfaceKind
from recon4.geometry.se3 import Array
from recon4.simulation.materials import MATERIAL
from recon4.simulation.world import Waypoint, World, WorldMarker
from recon4.simulation.worlds.outdoors import car, follow, ground_marker, pole, sign, tree
from recon4.simulation.worlds.walls import Opening, SlabExtent, WallShape, slab, wall


@dataclass(frozen=True, slots=True, kw_only=True)
class StreetPlan:
    """Measures of the block; distances ``d`` as at the top."""

    length_m: float = 60.0
    width_m: float = 36.0
    """Of the block, along x and y."""
    kerb_m: float = 2.5
    far_kerb_m: float = 9.5
    far_facade_m: float = 12.0
    """d of both kerbs and of the facades opposite."""
    near_walk_m: float = 1.2
    far_walk_m: float = 10.9
    """d of where people walk on the two sidewalks."""
    kerb_height_m: float = 0.12
    storey_m: float = 3.4
    bottom_m: float = -2.5
    """Houses reach down to here, below the lowest ground."""
    stops: int = 10


STREET = StreetPlan()


def build() -> World:
    """The block; houses, cars and trees are drawn once and for all."""
    builder = MeshBuilder()
    rng = np.random.default_rng(1907)
    _ground(builder)
    far = STREET.far_facade_m
    for low, high, near in [(0.0, STREET.length_m, True), (-far, STREET.length_m + far, False)]:
        out = 0.0 if near else far
        low_side, high_side = (-1, 1) if near else (1, -1)
        _row(builder, (low, -out), high - low, front=_Front(0, low_side), rng=rng)
        _row(builder, (low, STREET.width_m + out), high - low, front=_Front(0, high_side), rng=rng)
        span = STREET.width_m + 2 * out
        _row(builder, (-out, -out), span, front=_Front(1, low_side), rng=rng)
        _row(builder, (STREET.length_m + out, -out), span, front=_Front(1, high_side), rng=rng)
    for side in range(4):
        _furnish_side(builder, side, rng)
    markers = _markers(builder)
    return World(
        name="street",
        mesh=builder.mesh(),
        route=_route,
        stops=STREET.stops,
        markers=markers,
        outdoors=True,
    )


def height(x_m: ArrayLike, y_m: ArrayLike) -> Array:
    """Height of the ground [m]: a slope, a slow wave, kerbs."""
    x, y = np.asarray(x_m, dtype=np.float64), np.asarray(y_m, dtype=np.float64)
    out = np.maximum(np.maximum(-x, x - STREET.length_m), np.maximum(-y, y - STREET.width_m))
    road = (out > STREET.kerb_m) & (out < STREET.far_kerb_m)
    slope = 0.02 * (x - 30.0) + 0.008 * (y + STREET.near_walk_m) + 0.15 * np.sin(x / 17.0) - 0.147
    return np.asarray(slope - np.where(road, STREET.kerb_height_m, 0.0))


def _ground(builder: MeshBuilder) -> None:
    def lines(size_m: float) -> Array:
        kerbs = [edge for d in (STREET.kerb_m, STREET.far_kerb_m) for edge in (-d, size_m + d)]
        steps = np.array([[k - 0.01, k + 0.01] for k in kerbs]).ravel()
        even = np.arange(-16.0, size_m + 16.1, 2.0)
        return np.union1d(steps, even)

    x, y = lines(STREET.length_m), lines(STREET.width_m)
    grid_x, grid_y = np.meshgrid(x, y)
    middle_x, middle_y = np.meshgrid((x[1:] + x[:-1]) / 2, (y[1:] + y[:-1]) / 2)
    out = np.maximum(
        np.maximum(-middle_x, middle_x - STREET.length_m),
        np.maximum(-middle_y, middle_y - STREET.width_m),
    )
    road = (out > STREET.kerb_m) & (out < STREET.far_kerb_m)
    surface = np.where(road, MATERIAL.asphalt, MATERIAL.concrete)
    with builder.of(SurfaceKind.GROUND):
        builder.terrain(x, y, height(grid_x, grid_y), reflectivity=surface)


def _row(
    builder: MeshBuilder,
    start: tuple[float, float],
    length_m: float,
    *,
    front: _Front,
    rng: np.random.Generator,
) -> None:
    """Houses in a row, each of its own width, height and rhythm of windows."""
    at = 0.0
    while at < length_m - 0.1:
        width = rng.uniform(8.0, 14.0)
        width = length_m - at if length_m - at - width < 6.0 else width
        corner = np.array(start)
        corner[front.along] += at
        _house(builder, corner, width, front=front, rng=rng)
        at += width


@dataclass(frozen=True, slots=True)
class _Front:
    """Where a row of houses stands and looks to."""

    along: int
    """Axis of the row: 0 = x, 1 = y."""
    facing: int
    """Direction of the street on the other axis, 1 or -1."""


@dataclass(frozen=True, slots=True, eq=False)
class _Facade:
    """One house towards the street."""

    builder: MeshBuilder
    front: _Front
    start_m: float
    end_m: float
    middle_m: float
    """Of the wall, across the facade."""
    base_m: float
    """Ground in front of it."""
    reflectivity: float

    @property
    def face_m(self) -> float:
        """Its outer surface."""
        return self.middle_m + 0.15 * self.front.facing

    def slab(
        self,
        span: tuple[float, float],
        depth: tuple[float, float],
        *,
        level: tuple[float, float],
        value: float,
    ) -> None:
        """A box before the face; depths and levels from the face and the ground [m]."""
        facing = self.front.facing
        reach = (self.face_m + facing * depth[0], self.face_m + facing * depth[1])
        levels = (self.base_m + level[0], self.base_m + level[1])
        extent = SlabExtent(span, reach, levels)
        slab(self.builder, extent, along=self.front.along, reflectivity=value)

    def storey(self, number: int, openings: list[Opening]) -> None:
        """The wall of a storey; the lowest one reaches into the ground."""
        low = STREET.bottom_m - self.base_m if number == 0 else number * STREET.storey_m
        shift = number * STREET.storey_m - low
        corners = np.full((2, 2), self.middle_m)
        corners[:, self.front.along] = self.start_m, self.end_m
        wall(
            self.builder,
            (float(corners[0, 0]), float(corners[0, 1])),
            (float(corners[1, 0]), float(corners[1, 1])),
            shape=WallShape(
                bottom_m=self.base_m + low,
                height_m=STREET.storey_m + shift,
                thickness_m=0.3,
                reflectivity=self.reflectivity,
            ),
            openings=[
                replace(hole, bottom_m=hole.bottom_m + shift, top_m=hole.top_m + shift)
                for hole in openings
            ],
        )


def _house(
    builder: MeshBuilder, corner: Array, width_m: float, *, front: _Front, rng: np.random.Generator
) -> None:
    """A door, windows with recesses, a cornice, a downpipe and perhaps a balcony."""
    along = front.along
    middle = float(corner[1 - along] - front.facing * (0.15 + rng.choice([0.0, 0.1, 0.3])))
    start, end = float(corner[along]), float(corner[along] + width_m)
    center = np.full(2, middle)
    center[along] = 0.5 * (start + end)
    base = float(height(*center))
    value = MATERIAL.plaster * rng.uniform(0.5, 1.3)
    facade = _Facade(builder, front, start, end, middle, base, value)
    storeys = int(rng.integers(2, 5))
    step = rng.uniform(2.0, 2.9)
    places = np.arange(step / 2 + 0.3, width_m - step / 2, step)
    door = int(rng.integers(len(places)))
    wide, tall = rng.uniform(0.9, 1.3), rng.uniform(1.4, 1.9)
    windows = [Opening(float(p), wide, 1.0, 1.0 + tall, glazed=True) for p in places]
    for number in range(storeys):
        facade.storey(number, windows if number else windows[:door] + windows[door + 1 :])
    top = storeys * STREET.storey_m
    facade.slab((start, end), (-0.02, 0.3), level=(top - 0.25, top), value=value)
    at = start + float(places[door])
    facade.slab((at - 0.5, at + 0.5), (-0.02, 0.02), level=(0.0, 2.2), value=MATERIAL.wood)
    facade.slab(
        (start + 0.15, start + 0.25), (0.01, 0.11), level=(-0.3, top - 0.25), value=MATERIAL.steel
    )
    if rng.random() < 0.4:
        balcony, floor = (at - 1.0, at + 1.0), STREET.storey_m
        facade.slab(balcony, (0.0, 1.0), level=(floor, floor + 0.15), value=MATERIAL.concrete)
        facade.slab(balcony, (0.95, 1.0), level=(floor + 0.15, floor + 1.1), value=MATERIAL.steel)


def _place(side: int, along_m: float, d_m: float) -> tuple[float, float]:
    """A point ``along_m`` counter-clockwise on a side of the block, ``d_m`` outside of it."""
    return (
        (along_m, -d_m),
        (STREET.length_m + d_m, along_m),
        (STREET.length_m - along_m, STREET.width_m + d_m),
        (-d_m, STREET.width_m - along_m),
    )[side]


def _length(side: int) -> float:
    return STREET.length_m if side % 2 == 0 else STREET.width_m


def _furnish_side(builder: MeshBuilder, side: int, rng: np.random.Generator) -> None:
    """Parked cars, trees, lamps and signs; the middle of the side stays free to cross."""
    length = _length(side)
    yaw = 0.5 * np.pi * side
    outward = np.array(_place(side, 0.0, 1.0)) - np.array(_place(side, 0.0, 0.0))
    forward = np.array(_place(side, 1.0, 0.0)) - np.array(_place(side, 0.0, 0.0))
    for d, turn in ((STREET.kerb_m + 1.15, 0.0), (STREET.far_kerb_m - 1.15, np.pi)):
        for along in np.arange(3.0, length - 2.0, 6.0):
            if rng.random() < 0.65 and abs(along - length / 2) > 5.0:
                x, y = _place(side, along, d)
                angle = yaw + turn + rng.uniform(-0.03, 0.03)
                car(builder, (x, y), yaw_rad=angle, ground=height, rng=rng)
    for along in np.arange(7.0, length, 12.0):
        if abs(along - length / 2) > 3.0:
            x, y = _place(side, along, STREET.kerb_m - 0.35)
            tree(builder, x, y, ground=height, rng=rng)
        x, y = _place(side, along + 4.0, STREET.far_kerb_m + 0.4)
        pole(builder, x, y, ground=height, arm=-1.6 * outward)
    for along in (4.5, length - 4.5):
        x, y = _place(side, along, STREET.far_kerb_m + 0.45)
        sign(builder, x, y, ground=height, along=outward if along < 10 else forward)


def _markers(builder: MeshBuilder) -> tuple[WorldMarker, ...]:
    places = [
        _place(side, fraction * _length(side), 0.55) for side in range(4) for fraction in (0.3, 0.8)
    ]
    return tuple(
        ground_marker(builder, f"M{k + 1}", place, ground=height, size_m=0.3)
        for k, place in enumerate(places)
    )


def _route(rng: np.random.Generator, stops: int) -> list[Waypoint]:
    """A route along the block and back, or around it with all stops."""
    start = Waypoint(*_place(0, 0.5 * STREET.length_m, STREET.near_walk_m))
    if stops < STREET.stops:
        out = [start, *_along(9.0 * stops)]
        corners = [*out, *out[-2::-1]]
    else:
        corners = [start, *_around(rng), start]
        corners = corners if rng.random() < 0.5 else corners[::-1]
    return follow(corners, height, rng, stray_m=0.12)


def _along(reach_m: float) -> list[Waypoint]:
    """Corners up to the point of the block where the person turns back."""
    way: list[Waypoint] = []
    begin = 0.5 * STREET.length_m
    for side in range(4):
        end = min(begin + reach_m, _length(side) + STREET.near_walk_m)
        way.append(Waypoint(*_place(side, end, STREET.near_walk_m)))
        reach_m -= end - begin
        if reach_m < 2.0:
            break
        begin = -STREET.near_walk_m
    return [*way[:-1], replace(way[-1], stop=True, look_deg=90.0)]


def _around(rng: np.random.Generator) -> list[Waypoint]:
    """Corners of a round; on some sides by the sidewalk opposite."""
    near, far = STREET.near_walk_m, STREET.far_walk_m
    lanes = [near, *rng.choice([near, far], 3, p=[0.7, 0.3]), near]
    way: list[Waypoint] = []
    for side in range(4):
        way.append(Waypoint(*_place(side, _length(side) + lanes[side], lanes[side])))
        after = (side + 1) % 4
        if lanes[side] != lanes[side + 1]:
            # Along the next side in the old lane, and across the street in its middle.
            cross = 0.5 * _length(after)
            way.append(Waypoint(*_place(after, cross, lanes[side])))
            way.append(Waypoint(*_place(after, cross, lanes[side + 1])))
    return way
