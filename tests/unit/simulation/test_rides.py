"""Elevators: a car that moves with the person in it."""

import numpy as np
import pytest

from recon4.geometry.raycast import Scene
from recon4.simulation.gait import plan_walk
from recon4.simulation.lidar import Surroundings
from recon4.simulation.person import GAIT
from recon4.simulation.walk import Walk
from recon4.simulation.world import World
from recon4.simulation.worlds import build_world


@pytest.fixture(scope="module")
def building() -> World:
    return build_world("elevator")


@pytest.fixture(scope="module")
def walk(building: World) -> Walk:
    return plan_walk(building, seconds=60.0, rng=np.random.default_rng(3))


def down(building: World, walk: Walk, t_s: np.ndarray) -> np.ndarray:
    """Range of beams from the body straight down [m]."""
    around = Surroundings(building.mesh, Scene(building.mesh), car=building.car)
    rays = np.hstack([walk.state(t_s)[:, :3], np.tile([0.0, 0.0, -1.0], (len(t_s), 1))])
    return around.cast(rays.astype(np.float32), walk, t_s).range_m


def test_the_floor_rises_with_the_person(building: World, walk: Walk) -> None:
    t_s = np.arange(0.0, walk.seconds, 0.1)

    assert down(building, walk, t_s) == pytest.approx(GAIT.body_height_m, abs=0.12)
    assert np.ptp(walk.state(t_s)[:, 2]) > 3.3


def test_a_ride_is_as_smooth_as_that_of_an_elevator(walk: Walk) -> None:
    assert walk.ride is not None
    t_s = np.arange(0.0, walk.seconds, 0.02)
    height_m, closed = walk.ride.at(t_s)
    speed = np.gradient(height_m, t_s)

    assert 0.9 < np.abs(speed).max() < 1.5
    assert np.abs(np.gradient(speed, t_s)).max() < 1.2  # about a tenth of gravity
    assert 0.1 < closed.mean() < 0.7
    assert np.abs(speed[~closed]).max() < 0.1


def test_the_car_comes_back(walk: Walk) -> None:
    assert walk.ride is not None
    height_m, _ = walk.ride.at(np.array([0.0, walk.seconds]))

    assert height_m == pytest.approx([0.0, 0.0], abs=1e-6)


def test_the_landing_is_hidden_during_the_ride(building: World, walk: Walk) -> None:
    assert walk.ride is not None
    t_s = np.arange(0.0, walk.seconds, 0.05)
    _, closed = walk.ride.at(t_s)
    around = Surroundings(building.mesh, Scene(building.mesh), car=building.car)
    place = walk.state(t_s[closed])[:, :3]

    rays = np.hstack([place, np.tile([1.0, 0.0, 0.0], (len(place), 1))])
    hits = around.cast(rays.astype(np.float32), walk, t_s[closed])

    assert hits.range_m.max() < 1.5
