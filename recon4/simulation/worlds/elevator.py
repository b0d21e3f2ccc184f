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

from dataclasses import dataclass, replace
from functools import partial

import numpy as np

from recon4.geometry.mesh import MeshBuilder
from recon4.simulation.materials import MATERIAL
from recon4.simulation.rides import ElevatorCar
from recon4.simulation.world import Waypoint, World
from recon4.simulation.worlds.furniture import lamp, shelf
from recon4.simulation.worlds.walls import Opening, WallShape, wall


@dataclass(frozen=True, slots=True, kw_only=True)
class ElevatorPlan:
    """Measures of a variant, see the drawing."""

    storeys: int = 3
    storey_m: float = 3.4
    height_m: float = 2.8
    """From one floor to the next, and to the ceiling."""
    width_m: float = 3.2
    front_m: float = 2.2
    end_m: float = 15.0
    """Of a landing, and x of its two ends: the wall between it and the car, and the far wall."""
    car_half_m: float = 1.05
    """Half of the width of the car, and of its depth."""
    door_m: float = 1.1
    door_top_m: float = 2.1

    @property
    def car_front_m(self) -> float:
        """X of the side of the car that has the door."""
        return self.front_m - 0.1


def build(variant: int = 0) -> World:
    """Three storeys; other variants have two to six, furnished in another way."""
    rng = np.random.default_rng([150, variant])
    plan = ElevatorPlan()
    if variant:
        plan = replace(plan, storeys=int(rng.integers(2, 7)))
    builder = MeshBuilder()
    for storey in range(plan.storeys):
        _landing(builder, plan, storey * plan.storey_m, rng=rng)
    return World(
        name="elevator", mesh=builder.mesh(), route=partial(_route, plan), stops=4, car=_car(plan)
    )


def _landing(
    builder: MeshBuilder, plan: ElevatorPlan, floor_m: float, *, rng: np.random.Generator
) -> None:
    front_m, end_m, height_m = plan.front_m, plan.end_m, plan.height_m
    half, length, across = plan.width_m / 2, end_m - front_m, [0, plan.width_m, 0]
    sill, top = [plan.car_front_m, -half, floor_m], [front_m, -half, floor_m + height_m]
    builder.quad(sill, [length + 0.1, 0, 0], across, reflectivity=MATERIAL.linoleum)
    builder.quad(top, [length, 0, 0], across, reflectivity=MATERIAL.ceiling)
    shape = WallShape(bottom_m=floor_m, height_m=height_m)
    opening = Opening(half, plan.door_m, 0.0, plan.door_top_m)
    wall(builder, (front_m, -half), (front_m, half), shape=shape, openings=[opening])
    wall(builder, (end_m, -half), (end_m, half), shape=shape)
    for y in (-half, half):
        wall(builder, (front_m, y), (end_m, y), shape=shape)
    part = MeshBuilder()
    for side in (-1.0, 1.0):
        x = float(rng.uniform(4.0, 5.5))
        while x < end_m - 1.0:
            width = float(rng.uniform(0.4, 1.2))
            if rng.random() < 0.35:
                shelf(part, x, side * (half - 0.35), height_m=rng.uniform(1.0, 2.2), rng=rng)
            else:
                size = [width, 0.3, rng.uniform(0.5, 2.1)]
                part.block([x, side * (half - 0.22), 0.0], size, MATERIAL.wood)
            x += width + float(rng.uniform(0.8, 2.5))
    for x in (4.5, 8.5, 12.5):
        lamp(part, x, 0.0, ceiling_m=height_m)
    builder.place(part, [0.0, 0.0, floor_m])


def _car(plan: ElevatorPlan) -> ElevatorCar:
    """Walls of steel with a handrail and a panel of buttons; the door is on the side of x."""
    shell, door = MeshBuilder(), MeshBuilder()
    half, door_m, lintel, top = plan.car_half_m, plan.door_m, plan.door_top_m, 2.3
    low, high = plan.car_front_m - 2 * half, plan.car_front_m
    deep, wide = [high - low, 0, 0], [0, 2 * half, 0]
    for z, value in ((0.0, MATERIAL.linoleum), (top, MATERIAL.ceiling)):
        shell.quad([low, -half, z], deep, wide, reflectivity=value)
    for y in (-half, half):
        shell.quad([low, y, 0.0], deep, [0, 0, top], reflectivity=MATERIAL.steel)
        shell.tube([low, 0.93 * y, 0.9], [high, 0.93 * y, 0.9], 0.02, reflectivity=MATERIAL.steel)
    shell.quad([low, -half, 0.0], wide, [0, 0, top], reflectivity=MATERIAL.steel)
    for y in (-half, door_m / 2):
        beside = [0, half - door_m / 2, 0]
        shell.quad([high, y, 0.0], beside, [0, 0, top], reflectivity=MATERIAL.steel)
    over = [high, -door_m / 2, lintel]
    shell.quad(over, [0, door_m, 0], [0, 0, top - lintel], reflectivity=MATERIAL.steel)
    shell.box([high - 0.06, 0.65, 0.9], [high - 0.03, 0.85, 1.5], 0.2)
    door.quad([high, -door_m / 2, 0.0], [0, door_m, 0], [0, 0, lintel], reflectivity=MATERIAL.steel)
    return ElevatorCar(shell.mesh(), door.mesh())


def _route(plan: ElevatorPlan, rng: np.random.Generator, stops: int) -> list[Waypoint]:
    """Into the car, up, along the landing there, and the same way back; farther the more stops."""
    up_m = plan.storey_m * (1 if stops < 3 else plan.storeys - 1)
    near_m = 4.6 if stops == 1 else 7.0
    far_m = near_m + 2.0 * (stops - 1)
    inside_m = plan.car_front_m - plan.car_half_m
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
