"""Definition of a world: surfaces, survey markers and routes."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from recon4.geometry.mesh import WorldMesh
from recon4.geometry.se3 import Array
from recon4.model.targets import TargetKind
from recon4.simulation.rides import ElevatorCar


@dataclass(frozen=True, slots=True)
class Waypoint:
    """A point on the floor of the person's route."""

    x_m: float
    y_m: float
    z_m: float = 0.0
    pace: float = 1.0
    """Speed of the leg that ends here, as a ratio of the walking speed (stairs: 0.5)."""
    stop: bool = False
    """Come to rest here and turn on the spot."""
    look_deg: float = 0.0
    """Turn by this angle, left positive, before turning to the next waypoint (needs `stop`)."""
    ride: bool = False
    """An elevator carries the person here from the waypoint before, straight up or down."""


@dataclass(frozen=True, slots=True)
class WorldMarker:
    """A survey marker: a square of retro-reflective paint on a surface."""

    name: str
    x_m: float
    y_m: float
    z_m: float


@dataclass(frozen=True, slots=True)
class WorldTarget:
    """A survey target that was put beside the path."""

    name: str
    kind: TargetKind
    p_map: tuple[float, float, float]
    """Its point [m]."""
    radius_m: float = 0.0
    """Of a sphere [m]."""


@dataclass(frozen=True, slots=True)
class WorldOrigin:
    """Where the map's origin lies on the earth (WGS 84); its axes are east, north and up there."""

    lat_deg: float
    lon_deg: float
    height_m: float


BRNO = WorldOrigin(lat_deg=49.2265, lon_deg=16.5967, height_m=275.0)
"""Origin of every world: near the faculty where the backpack of the thesis was built."""

Route = Callable[[np.random.Generator, int], list[Waypoint]]
"""One round with a number of places visited (1..stops); it ends at its start."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class World:
    """A place to walk and scan. Its geometry never changes; seeds change walks and noise."""

    name: str
    mesh: WorldMesh
    route: Route
    stops: int
    """Most places a round can visit."""
    markers: tuple[WorldMarker, ...] = ()
    targets: tuple[WorldTarget, ...] = ()
    car: ElevatorCar | None = None
    """Of the elevator that the route rides; None = there is none."""
    floor: tuple[float, float, float, float] | None = None
    """Middle x, y and half extents of a free floor for figures [m]; None = there is none."""
    outdoors: bool = False
    """GNSS can be received."""
    origin: WorldOrigin = BRNO


def distance_to_leg(place: Array, start: Array, end: Array) -> float:
    """From a place on the floor to a straight leg of a route [m], (2,) each."""
    step = end - start
    along = np.clip((place - start) @ step / (step @ step), 0.0, 1.0)
    return float(np.linalg.norm(place - start - along * step))
