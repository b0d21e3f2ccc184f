"""Which points of a cube lie on one plane."""

import numpy as np

from recon4.calibration.joint import NEAR_ROUNDS, ROUNDS
from recon4.calibration.surfaces import find_surfaces

SIDES_M = 0.15


def thin_wall():
    """Two sides of a wall, each seen by one LiDAR: points [m] and rows of the LiDARs."""
    rng = np.random.default_rng(4)
    along = rng.uniform(0.05, 0.55, (400, 2))
    sensor = np.repeat(np.array([0, 1], np.uint8), 200)
    across = 0.2 + SIDES_M * sensor + rng.normal(0.0, 0.01, 400)
    return np.column_stack([across, along]), sensor


def shared(bounds):
    p, sensor = thin_wall()
    found = find_surfaces(
        p, sensor, cube_m=bounds.cube_m, max_sd_m=bounds.max_sd_m, gate_m=bounds.gate_m
    )
    return found.shared.any()


def test_near_the_right_rig_the_sides_of_a_thin_wall_are_two_surfaces():
    assert shared(ROUNDS[0])
    assert not any(shared(bounds) for bounds in NEAR_ROUNDS)
