"""A ride in an elevator: a landing on every storey, and a car that moves with the person in it.

In the closed car a LiDAR sees walls that stand still. Only the IMU feels the ride.

From above::

    y
  1.6      +--------------------------------+
      +----+                                |
      |car |          landing               |
      +----+                                |
 -1.6      +--------------------------------+  x
      0    2.2                             15
"""

from __future__ import annotations

import numpy as np

from recon4.geometry.mesh import MeshBuilder
from recon4.simulation.rides import ElevatorCar
from recon4.simulation.world import Waypoint, World
from recon4.simulation.worlds.furniture import lamp, shelf
from recon4.simulation.worlds.walls import (
    CEILING,
    LINOLEUM,
    STEEL,
    WOOD,
    Opening,
    WallShape,
    wall,
)

_STOREY_M, _HEIGHT_M = 3.4, 2.8
_WIDTH_M, _END_M = 3.2, 15.0
_FRONT_M = 2.2
"""The wall between car and landing."""
_CAR_M = 1.05
"""Half of the width of the car, and of its depth."""
_DOOR_M = 1.1


def build(variant: int = 0) -> World:
    """Three storeys; other variants have two to six, furnished in another way."""
    rng = np.random.default_rng([150, variant])
    storeys = 3 if variant == 0 else int(rng.integers(2, 7))
    builder = MeshBuilder()
    for storey in range(storeys):
        _landing(builder, storey * _STOREY_M, rng=rng)

    def route(rng: np.random.Generator, stops: int) -> list[Waypoint]:
        return _route(rng, stops, storeys=storeys)

    return World(name="elevator", mesh=builder.mesh(), route=route, stops=4, car=_car())


def _landing(builder: MeshBuilder, floor_m: float, *, rng: np.random.Generator) -> None:
    half, length = _WIDTH_M / 2, _END_M - _FRONT_M
    corner = [_FRONT_M, -half]
    sill = [_FRONT_M - 0.1, -half, floor_m]
    builder.quad(sill, [length + 0.1, 0, 0], [0, _WIDTH_M, 0], reflectivity=LINOLEUM)
    top_m = floor_m + _HEIGHT_M
    builder.quad([*corner, top_m], [length, 0, 0], [0, _WIDTH_M, 0], reflectivity=CEILING)
    shape = WallShape(bottom_m=floor_m, height_m=_HEIGHT_M)
    opening = Opening(half, _DOOR_M, 0.0, 2.1)
    wall(builder, (_FRONT_M, -half), (_FRONT_M, half), shape=shape, openings=[opening])
    wall(builder, (_END_M, -half), (_END_M, half), shape=shape)
    for y in (-half, half):
        wall(builder, (_FRONT_M, y), (_END_M, y), shape=shape)
    part = MeshBuilder()
    for side in (-1.0, 1.0):
        x = float(rng.uniform(4.0, 5.5))
        while x < _END_M - 1.0:
            width = float(rng.uniform(0.4, 1.2))
            if rng.random() < 0.35:
                shelf(part, x, side * (half - 0.35), height_m=rng.uniform(1.0, 2.2), rng=rng)
            else:
                size = [width, 0.3, rng.uniform(0.5, 2.1)]
                part.block([x, side * (half - 0.22), 0.0], size, WOOD)
            x += width + float(rng.uniform(0.8, 2.5))
    for x in (4.5, 8.5, 12.5):
        lamp(part, x, 0.0, ceiling_m=_HEIGHT_M)
    builder.place(part, [0.0, 0.0, floor_m])


def _car() -> ElevatorCar:
    """Walls of steel with a handrail and a panel of buttons; the door is on the side of x."""
    shell, door = MeshBuilder(), MeshBuilder()
    low, high, top = _FRONT_M - 0.1 - 2 * _CAR_M, _FRONT_M - 0.1, 2.3
    deep, wide = [high - low, 0, 0], [0, 2 * _CAR_M, 0]
    for z, value in ((0.0, LINOLEUM), (top, CEILING)):
        shell.quad([low, -_CAR_M, z], deep, wide, reflectivity=value)
    for y in (-_CAR_M, _CAR_M):
        shell.quad([low, y, 0.0], deep, [0, 0, top], reflectivity=STEEL)
        shell.tube([low, 0.93 * y, 0.9], [high, 0.93 * y, 0.9], 0.02, reflectivity=STEEL)
    shell.quad([low, -_CAR_M, 0.0], wide, [0, 0, top], reflectivity=STEEL)
    for y in (-_CAR_M, _DOOR_M / 2):
        beside = [0, _CAR_M - _DOOR_M / 2, 0]
        shell.quad([high, y, 0.0], beside, [0, 0, top], reflectivity=STEEL)
    over = [high, -_DOOR_M / 2, 2.1]
    shell.quad(over, [0, _DOOR_M, 0], [0, 0, top - 2.1], reflectivity=STEEL)
    shell.box([high - 0.06, 0.65, 0.9], [high - 0.03, 0.85, 1.5], 0.2)
    door.quad([high, -_DOOR_M / 2, 0.0], [0, _DOOR_M, 0], [0, 0, 2.1], reflectivity=STEEL)
    return ElevatorCar(shell.mesh(), door.mesh())


def _route(rng: np.random.Generator, stops: int, *, storeys: int) -> list[Waypoint]:
    """Into the car, up, along the landing there, and the same way back; farther the more stops."""
    up_m = _STOREY_M * (1 if stops < 3 else storeys - 1)
    near_m = 4.6 if stops == 1 else 7.0
    far_m = near_m + 2.0 * (stops - 1)
    inside_m = _FRONT_M - 0.1 - _CAR_M
    y = float(rng.uniform(-0.2, 0.2))
    return [
        Waypoint(near_m, y),
        Waypoint(inside_m, 0.0, stop=True),
        Waypoint(inside_m, 0.0, up_m, ride=True),
        Waypoint(far_m, y, up_m, stop=True),
        Waypoint(inside_m, 0.0, up_m, stop=True),
        Waypoint(inside_m, 0.0, ride=True),
        Waypoint(near_m, y),
    ]
