"""Which points of a cube lie on one plane."""

import numpy as np
import pytest

from recon4.calibration.joint import NEAR_ROUNDS, ROUNDS
from recon4.calibration.purity import only_own_points
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


CUBE_M = 0.6


def floor(height_m, rng, *, clutter=0):
    """A floor seen from 1.5 m above it and 4 m aside, with some points 2 to 3 cm above it."""
    along = rng.uniform(0.02, 0.58, (2000, 2))
    p = np.column_stack([along, np.full(2000, height_m)])
    p[:clutter, 2] += rng.uniform(0.02, 0.03, clutter)
    eye = np.array([-4.0, 0.3, height_m + 1.5])
    beam = (p - eye) / np.linalg.norm(p - eye, axis=1)[:, None]
    return p + rng.normal(0.0, 0.015, 2000)[:, None] * beam, beam


def planes(p, beam):
    sensor = np.zeros(len(p), np.uint8)
    found = find_surfaces(p, sensor, cube_m=CUBE_M, max_sd_m=0.03, gate_m=0.08)
    return found, only_own_points(found, p, beam, cube_m=CUBE_M)


def height_m(found, row):
    """Of a plane at the middle of the cube."""
    away = np.array([0.3, 0.3]) - found.center[row, :2]
    return found.center[row, 2] - away @ found.normal[row, :2] / found.normal[row, 2]


def test_what_stands_on_a_floor_does_not_lift_it():
    p, beam = floor(0.3, np.random.default_rng(1), clutter=150)
    found, own = planes(p, beam)

    assert len(own) == 1
    assert height_m(found, 0) - 0.3 > 1e-3
    assert height_m(own, 0) == pytest.approx(0.3, abs=3e-4)
    assert np.mean(own.point < 150) < 0.02


def test_a_cube_full_of_other_things_is_left_out():
    p, beam = floor(0.3, np.random.default_rng(1), clutter=600)
    assert len(planes(p, beam)[1]) == 0


def test_a_wall_at_the_face_of_a_cube_is_one_plane_with_all_its_points():
    rng = np.random.default_rng(2)
    along = rng.uniform(0.02, 0.58, (4000, 2))
    eye = np.array([-3.0, 0.3, 0.3])
    p = np.column_stack([np.full(4000, CUBE_M + 0.002), along])
    beam = (p - eye) / np.linalg.norm(p - eye, axis=1)[:, None]
    p += rng.normal(0.0, 0.015, 4000)[:, None] * beam
    found, own = planes(p, beam)

    assert len(found) == 2
    assert np.ptp(found.center[:, 0]) > 0.015
    assert len(own) == 1
    assert len(own.point) > 0.98 * 4000
    assert own.center[0] @ own.normal[0] / own.normal[0, 0] == pytest.approx(0.602, abs=1e-3)


def test_the_underside_of_a_board_is_another_surface():
    rng = np.random.default_rng(3)
    p, beam = floor(0.3, rng)
    below = np.column_stack([rng.uniform(0.02, 0.58, (300, 2)), np.full(300, 0.28)])
    up = np.tile([0.0, 0.0, 1.0], (300, 1))
    found, own = planes(np.concatenate([p, below]), np.concatenate([beam, up]))

    assert len(found) == len(own) == 1
    assert own.point.max() < len(p)
