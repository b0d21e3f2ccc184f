"""What each point of a simulated walk really is: the truth for the classes of points."""

from __future__ import annotations

from dataclasses import dataclass
from enum import IntEnum

import numpy as np
from numpy.typing import NDArray

from recon4.geometry.raycast import Scene
from recon4.geometry.se3 import Array
from recon4.geometry.tuning import SURFACES
from recon4.simulation.companions import COMPANION
from recon4.simulation.person import GAIT, TORSO
from recon4.simulation.setup import SimulationSetup
from recon4.simulation.vehicles import VEHICLE


class Cause(IntEnum):
    """Why a LiDAR has a point where it is."""

    SURFACE = 0
    """A surface of the world is there."""
    MIXED = 1
    """A beam met two surfaces, or nothing is there for another reason."""
    MOVING = 2
    """A person or a vehicle."""
    CARRIER = 3
    """The person who carries the sensors."""
    REFLECTION = 4
    """A mirror, or a pane at grazing incidence, was met before."""
    IN_WALL = 5
    """A person who walks through a wall or furniture, as nobody can."""


@dataclass(frozen=True, slots=True, kw_only=True)
class CauseTolerance:
    """How near a point is to its cause."""

    surface_m: float = 0.08
    """Of surfaces of the world: five standard deviations of a range."""
    body_m: float = 0.08
    """Of people and vehicles."""
    behind_m: float = 0.15
    """A reflection lies at least this far behind the mirror."""


TOLERANCE = CauseTolerance()


def causes(
    setup: SimulationSetup, points: Array, origins: Array, *, t_ns: NDArray[np.int64]
) -> NDArray[np.uint8]:
    """The `Cause` of points that are placed by the true poses, (N,).

    Args:
        setup: The walk.
        points: In the map [m], (N, 3).
        origins: Positions of the sensors [m], (N, 3).
        t_ns: Absolute times [ns], (N,).
    """
    t_s: Array = np.asarray(1e-9 * (t_ns - setup.epoch_ns), np.float64)
    surroundings = setup.surroundings
    found = np.full(len(points), Cause.MIXED, np.uint8)
    away_m = surroundings.scene.distance(points)
    found[away_m < TOLERANCE.surface_m] = Cause.SURFACE
    found[_behind_mirror(setup, points, origins)] = Cause.REFLECTION
    # People walk through walls here, and what of a wall is in one of them is the wall.
    people_m, in_wall = _to_people(setup, points, t_s)
    moving_m = np.minimum(people_m, _to_vehicles(setup, points, t_s))
    moves = moving_m < np.minimum(TOLERANCE.body_m, away_m)
    found[moves] = np.where(in_wall & (people_m <= moving_m), Cause.IN_WALL, Cause.MOVING)[moves]
    carrier_m = _to_carrier(setup, points, t_s)
    found[carrier_m < np.minimum(TOLERANCE.body_m, away_m)] = Cause.CARRIER
    return found


def _behind_mirror(setup: SimulationSetup, points: Array, origins: Array) -> NDArray[np.bool_]:
    """Whether a beam met a mirror before, or a pane behind which no surface is."""
    scene, reflectivity = setup.surroundings.scene, setup.world.mesh.reflectivity
    ray = points - origins
    range_m = np.linalg.norm(ray, axis=1)
    rays = np.concatenate([origins, ray / range_m[:, None]], axis=1).astype(np.float32)
    hits = scene.cast(rays)
    before = hits.range_m < range_m - TOLERANCE.behind_m
    met = np.zeros(len(points), np.float32)
    met[before] = reflectivity[hits.triangle[before]]
    mirror = before & (met <= SURFACES.mirror)
    pane = before & (met <= SURFACES.clear)
    return np.asarray(mirror | (pane & (_distance(scene, points, pane) > TOLERANCE.surface_m)))


def _distance(scene: Scene, points: Array, rows: NDArray[np.bool_]) -> Array:
    out = np.zeros(len(points))
    out[rows] = scene.distance(points[rows])
    return out


def _to_people(
    setup: SimulationSetup, points: Array, t_s: Array
) -> tuple[Array, NDArray[np.bool_]]:
    """Distance to the surface of the nearest person [m], inf = none at this height, (N,), and
    whether he is in a wall at this height, (N,).
    """
    found, in_wall = np.full(len(points), np.inf), np.zeros(len(points), np.bool_)
    companions = setup.surroundings.companions
    if companions is None:
        return found, in_wall
    centers, feet_m = companions.centers(setup.walk, t_s)
    high = points[:, 2] - feet_m
    inside = (high > 0.0) & (high < COMPANION.height_m + TOLERANCE.body_m)
    for center in centers:
        away_m = np.abs(np.linalg.norm(points[:, :2] - center, axis=1) - COMPANION.radius_m)
        near = inside & (away_m < np.minimum(found, 2.0 * TOLERANCE.body_m))
        found[near] = away_m[near]
        axis = np.column_stack([center, points[:, 2]])[near]
        in_wall[near] = setup.surroundings.scene.distance(axis) < COMPANION.radius_m
    return found, in_wall


def _to_vehicles(setup: SimulationSetup, points: Array, t_s: Array) -> Array:
    """Distance to the surface of the nearest vehicle [m], inf = there are none, (N,)."""
    found = np.full(len(points), np.inf)
    vehicles = setup.surroundings.vehicles
    if vehicles is None:
        return found
    ground_m = setup.walk.state(t_s)[:, 2] - GAIT.body_height_m
    for place, size in zip(vehicles.places(setup.walk, t_s), vehicles.sizes_m(), strict=True):
        cos, sin = np.cos(place[:, 2]), np.sin(place[:, 2])
        x, y = points[:, 0] - place[:, 0], points[:, 1] - place[:, 1]
        half = 0.5 * np.array([size[0], size[1], size[2] - VEHICLE.clearance_m])
        z = points[:, 2] - ground_m - VEHICLE.clearance_m - half[2]
        beyond = np.abs(np.stack([cos * x + sin * y, cos * y - sin * x, z], axis=1)) - half
        outside_m = np.linalg.norm(np.maximum(beyond, 0.0), axis=1)
        found = np.minimum(found, np.where(outside_m > 0.0, outside_m, -beyond.max(axis=1)))
    return found


def _to_carrier(setup: SimulationSetup, points: Array, t_s: Array) -> Array:
    """Distance to the surface of the carrier [m], inf = nothing of him at this height, (N,)."""
    T_map_body = setup.walk.poses(t_s)
    p_body = np.einsum("nji,nj->ni", T_map_body.R, points - T_map_body.t)
    away_m = np.hypot(p_body[:, 0] - TORSO.x_m, p_body[:, 1] - TORSO.y_m)
    high = (p_body[:, 2] > TORSO.bottom_m + TOLERANCE.body_m) & (
        p_body[:, 2] < TORSO.top_m + TOLERANCE.body_m
    )
    return np.where(high, np.abs(away_m - TORSO.radius_m), np.inf)
