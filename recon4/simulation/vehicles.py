"""Vehicles that move while the carrier walks: surfaces that do not stand still.

Three kinds, in this order: a car that keeps beside the carrier, a bus that stands beside the path
and drives off, a car that overtakes. Each is a box on the ground.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from recon4.geometry.raycast import Hits
from recon4.geometry.se3 import Array
from recon4.simulation.person import GAIT
from recon4.simulation.walk import Walk


@dataclass(frozen=True, slots=True, kw_only=True)
class VehicleModel:
    """Sizes of vehicles and how they drive."""

    clearance_m: float = 0.25
    """Of their underside above the ground."""
    car_m: tuple[float, float, float] = (4.3, 1.8, 1.5)
    bus_m: tuple[float, float, float] = (12.0, 2.5, 3.0)
    """Length, width, and height of the top above the ground."""
    beside_m: tuple[float, float] = (2.2, 3.0)
    bus_side_m: tuple[float, float] = (3.2, 4.5)
    overtaking_m: tuple[float, float] = (2.4, 3.2)
    """From the carrier to the middle of each kind, from and to."""
    lag_s: float = 1.0
    steady_s: float = 2.0
    """The car beside the carrier follows the heading this much later, and its mean over this time:
    no car sways with the steps of a person."""
    bus_ahead_m: float = 6.0
    bus_stands: float = 0.4
    bus_m_s2: float = 1.0
    """The bus stands so far ahead of the start, drives off after this part of the walk, and becomes
    faster by this."""
    passes: tuple[float, float] = (0.55, 0.75)
    faster_m_s: tuple[float, float] = (3.0, 8.0)
    """The car that overtakes is beside the carrier after this part of the walk, with this speed,
    from and to."""


VEHICLE = VehicleModel()


@dataclass(frozen=True, slots=True)
class _DrawnVehicle:
    """What differs from vehicle to vehicle."""

    kind: int
    side_m: float
    """Left of the carrier is positive [m]."""
    ahead_m: float
    part: float
    """Part of the walk after which it passes."""
    speed_m_s: float


@dataclass(frozen=True, slots=True, eq=False)
class Vehicles:
    """Some vehicles, as boxes."""

    boxes: tuple[_DrawnVehicle, ...]

    @staticmethod
    def drawn(count: int, rng: np.random.Generator) -> Vehicles:
        """Vehicles on both sides, the kinds by turns."""
        found: list[_DrawnVehicle] = []
        for k in range(count):
            away_m = rng.uniform(
                *(VEHICLE.beside_m, VEHICLE.bus_side_m, VEHICLE.overtaking_m)[k % 3]
            )
            side = rng.choice([-1.0, 1.0]) if k == 0 else -np.sign(found[-1].side_m)
            found.append(
                _DrawnVehicle(
                    k % 3,
                    float(side * away_m),
                    float(rng.uniform(-0.8, 0.8)),
                    float(rng.uniform(*VEHICLE.passes)),
                    float(rng.uniform(*VEHICLE.faster_m_s)),
                )
            )
        return Vehicles(tuple(found))

    def __len__(self) -> int:
        return len(self.boxes)

    def places(self, walk: Walk, t_s: Array) -> Array:
        """x, y of the middle [m] and heading [rad] at some times, (M, N, 3)."""
        kinds = (_beside, _bus, _overtaking)
        return np.stack([kinds[one.kind](one, walk, t_s) for one in self.boxes])

    def sizes_m(self) -> Array:
        """Length, width and height of each, (M, 3)."""
        return np.array([VEHICLE.bus_m if one.kind == 1 else VEHICLE.car_m for one in self.boxes])

    def hide(
        self, hits: Hits, rays: NDArray[np.float32], *, walk: Walk, t_s: Array, surface: int
    ) -> Hits:
        """Hits of rays after those that meet a vehicle first are replaced.

        Args:
            hits: Of the standing world.
            rays: Origins and unit directions, (N, 6).
            walk: The carrier.
            t_s: Time of each ray [s], (N,).
            surface: What to put as the triangle of a vehicle.
        """
        out = Hits(hits.range_m.copy(), hits.triangle.copy(), hits.normal.copy())
        ground_m = walk.state(t_s)[:, 2] - GAIT.body_height_m
        for place, size in zip(self.places(walk, t_s), self.sizes_m(), strict=True):
            entry, normal = _enter(rays, place, size, ground_m=ground_m)
            met = entry < out.range_m
            out.range_m[met] = entry[met]
            out.triangle[met] = surface
            out.normal[met] = normal[met]
        return out


def _enter(
    rays: NDArray[np.float32], place: Array, size: Array, *, ground_m: Array
) -> tuple[Array, Array]:
    """Range at which each ray enters a box, inf = never, and the normal there, (N,) and (N, 3)."""
    cos, sin = np.cos(place[:, 2]), np.sin(place[:, 2])
    origin, along = rays[:, :3].astype(np.float64), rays[:, 3:].astype(np.float64)
    x, y = origin[:, 0] - place[:, 0], origin[:, 1] - place[:, 1]
    middle_m = ground_m + 0.5 * (VEHICLE.clearance_m + size[2])
    start = np.stack([cos * x + sin * y, cos * y - sin * x, origin[:, 2] - middle_m], axis=1)
    way = np.stack(
        [cos * along[:, 0] + sin * along[:, 1], cos * along[:, 1] - sin * along[:, 0], along[:, 2]],
        axis=1,
    )
    half = 0.5 * np.array([size[0], size[1], size[2] - VEHICLE.clearance_m])
    way = np.where(np.abs(way) < 1e-9, 1e-9, way)
    first, second = (-half - start) / way, (half - start) / way
    near, far = np.minimum(first, second), np.maximum(first, second).min(axis=1)
    axis = near.argmax(axis=1)
    every = np.arange(len(rays))
    entry = near[every, axis]
    normal = np.zeros((len(rays), 3))
    side = -np.sign(way[every, axis])
    normal[:, 0] = np.where(axis == 0, cos, -sin) * side * (axis < 2)
    normal[:, 1] = np.where(axis == 0, sin, cos) * side * (axis < 2)
    normal[:, 2] = side * (axis == 2)
    return np.where((entry > 0.0) & (entry < far), entry, np.inf), normal


def _heading(walk: Walk, t_s: Array) -> Array:
    """Steady heading of the carrier some time before [rad]."""
    slots = np.linspace(-0.5, 0.5, 9) * VEHICLE.steady_s
    times = np.clip(t_s[:, None] - VEHICLE.lag_s + slots, 0.0, walk.seconds - 1e-6)
    return np.asarray(walk.state(times.ravel())[:, 5].reshape(times.shape).mean(axis=1))


def _moved(place: Array, heading: Array, *, ahead_m: Array | float, left_m: float) -> Array:
    """A place ahead and left of others with a heading, (N, 3)."""
    x = place[:, 0] + np.cos(heading) * ahead_m - np.sin(heading) * left_m
    y = place[:, 1] + np.sin(heading) * ahead_m + np.cos(heading) * left_m
    return np.stack([x, y, heading], axis=1)


def _beside(one: _DrawnVehicle, walk: Walk, t_s: Array) -> Array:
    return _moved(walk.state(t_s), _heading(walk, t_s), ahead_m=one.ahead_m, left_m=one.side_m)


def _bus(one: _DrawnVehicle, walk: Walk, t_s: Array) -> Array:
    begin = np.zeros_like(t_s)
    gone_s = np.maximum(t_s - VEHICLE.bus_stands * walk.seconds, 0.0)
    ahead_m = VEHICLE.bus_ahead_m + 0.5 * VEHICLE.bus_m_s2 * gone_s**2
    return _moved(walk.state(begin), _heading(walk, begin), ahead_m=ahead_m, left_m=one.side_m)


def _overtaking(one: _DrawnVehicle, walk: Walk, t_s: Array) -> Array:
    passes = np.full_like(t_s, one.part * walk.seconds)
    ahead_m = one.speed_m_s * (t_s - passes)
    return _moved(walk.state(passes), _heading(walk, passes), ahead_m=ahead_m, left_m=one.side_m)
