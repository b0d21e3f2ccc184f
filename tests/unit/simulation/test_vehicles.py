"""Vehicles that move while the carrier walks."""

import numpy as np
import pytest

from recon4.errors import ConfigError
from recon4.geometry.raycast import Hits
from recon4.geometry.se3 import Array
from recon4.simulation.crowd import Crowd
from recon4.simulation.setup import prepare
from recon4.simulation.vehicles import Vehicles
from recon4.simulation.walk import Walk

BESIDE, BUS, FAST = range(3)


def straight(seconds: float = 20.0) -> Walk:
    """One meter a second along x, 1.5 m above the ground."""
    t_s = np.arange(0.0, seconds + 0.01, 0.02)
    return Walk.through(np.column_stack([t_s, 0 * t_s, 1.5 + 0 * t_s, 0 * t_s, 0 * t_s, 0 * t_s]))


def drawn(seed: int = 1) -> Vehicles:
    return Vehicles.drawn(3, np.random.default_rng(seed))


def ahead_m(t_s: list[float]) -> Array:
    """How far ahead of the carrier each vehicle is, (3, N)."""
    times = np.array(t_s)
    return np.asarray(drawn().places(straight(), times)[:, :, 0] - times)


def test_a_car_keeps_beside_the_carrier() -> None:
    assert np.ptp(ahead_m([0.0, 10.0, 19.0])[BESIDE]) < 0.01
    assert 2.2 <= abs(drawn().places(straight(), np.array([5.0]))[BESIDE, 0, 1]) <= 3.0


def test_a_bus_stands_and_drives_off() -> None:
    x = drawn().places(straight(), np.array([0.0, 8.0, 12.0]))[BUS, :, 0]

    assert x == pytest.approx([6.0, 6.0, 6.0 + 0.5 * 4.0**2])


def test_a_fast_car_overtakes() -> None:
    before, after = ahead_m([5.0, 19.0])[FAST]

    assert before < -10.0 and after > 10.0


def test_a_car_hides_the_wall_behind_and_nothing_above() -> None:
    cars = drawn()
    x, y, _ = cars.places(straight(), np.array([0.0]))[BESIDE, 0]
    side = np.sign(y)
    origin, low, high = [x, 0.0, 1.5], [0, 0.96 * side, -0.28], [0, side, 0.05]
    wall = Hits(np.full(2, 30.0, np.float32), np.zeros(2, np.uint32), np.zeros((2, 3), np.float32))

    hits = cars.hide(
        wall, np.float32([origin + low, origin + high]), walk=straight(), t_s=np.zeros(2), surface=7
    )

    near_m = abs(y) - 0.9  # the side of the car
    assert hits.range_m[0] == pytest.approx(near_m / 0.96, abs=1e-4)
    assert hits.normal[0] == pytest.approx([0.0, -side, 0.0], abs=1e-6)
    assert hits.triangle.tolist() == [7, 0]
    assert hits.range_m[1] == 30.0


def test_too_many_vehicles_are_refused() -> None:
    with pytest.raises(ConfigError, match="0 to 6 vehicles can move, got 7"):
        prepare("plaza", seconds=5.0, seed=1, crowd=Crowd(vehicles=7))
