"""Picks snap to corners, edges and planes whose places are known."""

import numpy as np
import pytest

from recon4.slices.snap import PickRay, radius_around, snap

NOISE_M = 0.005
CORNER = np.array([4.0, -2.0, 1.0])
TURN = np.linalg.qr(np.random.default_rng(8).normal(size=(3, 3)))[0]
"""Axes of the corner's three walls: none is level."""


def walls(count=3, noise_m=NOISE_M, reach_m=0.6):
    """Points of some walls that meet in the corner, along their positive axes, (N, 3)."""
    rng = np.random.default_rng(4)
    parts = []
    for axis in range(count):
        part = rng.uniform(0.0, reach_m, (4000, 3))
        part[:, axis] = rng.normal(0.0, noise_m, 4000)
        parts.append(part)
    return CORNER + np.concatenate(parts) @ TURN


def picked(points, at, reach_m=0.05):
    """Snap the ray from inside of the corner through a place of its walls."""
    eye = CORNER + np.array([2.0, 2.3, 1.7]) @ TURN
    direction = (at - eye) / np.linalg.norm(at - eye)
    beside = points - eye
    off = np.linalg.norm(beside - (beside @ direction)[:, None] * direction, axis=1)
    hit = points[np.argmin(off)]
    around = points[np.linalg.norm(points - hit, axis=1) <= radius_around(reach_m)]
    ray = PickRay(eye, direction, hit, reach_m)
    return snap(around, ray, rng=np.random.default_rng(1)), eye, direction


def on_walls(*offsets):
    return CORNER + np.array(offsets) @ TURN


def test_near_a_corner_the_pick_is_the_corner():
    found, *_ = picked(walls(), on_walls(0.02, 0.03, 0.0))

    assert found.kind == "corner"
    assert np.linalg.norm(found.p_map - CORNER) < 0.001
    assert found.sd_m == pytest.approx(NOISE_M, rel=0.25)


def test_near_an_edge_the_pick_is_the_point_of_the_edge_nearest_to_the_ray():
    found, eye, direction = picked(walls(), on_walls(0.03, 0.0, 0.3))

    local = TURN @ (found.p_map - CORNER)
    assert found.kind == "edge"
    assert np.abs(local[:2]).max() < 0.001
    along = eye + direction * ((found.p_map - eye) @ direction)
    assert np.linalg.norm(found.p_map - along) < 0.05
    assert abs(local[2] - 0.3) < 0.03


def test_elsewhere_the_pick_is_where_the_ray_goes_through_the_plane():
    at = on_walls(0.3, 0.35, 0.0)
    found, *_ = picked(walls(), at)

    assert found.kind == "plane"
    assert np.linalg.norm(found.p_map - at) < 0.001
    assert found.sd_m == pytest.approx(NOISE_M, rel=0.25)


def test_an_edge_of_walls_that_end_before_it_is_none():
    points = walls(count=2)
    gap = points[np.linalg.norm((points - CORNER) @ TURN.T[:, :2], axis=1) > 0.12]

    found, *_ = picked(gap, on_walls(0.13, 0.0, 0.3), reach_m=0.2)

    assert found.kind == "plane"


def test_loose_points_attract_nothing():
    loose = CORNER + np.random.default_rng(2).uniform(-0.3, 0.3, (3000, 3))

    found, *_ = picked(loose, CORNER)
    few, *_ = picked(walls()[:20], on_walls(0.3, 0.35, 0.0))

    assert (found, few) == (None, None)
