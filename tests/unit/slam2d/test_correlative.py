"""Correlative search: finds a pose from far away, and never a worse one than trying all."""

import numpy as np
import pytest

from recon4.geometry.se2 import inverse, transform
from recon4.kernels.correlation2d import branch_and_bound, max_filter
from recon4.slam2d.correlative import LikelihoodField, thinned
from tests.planar_walks import furnished_room
from tests.unit.slam2d.test_line_map import wall_points

START = np.array([1.0, 0.4, 0.6])


def test_the_pose_is_found_from_far_away():
    points = wall_points(furnished_room())
    scan = transform(inverse(START), points)

    found = LikelihoodField.of(points).search(
        scan,
        initial_pose=START + np.array([1.9, -1.4, -0.4]),
        half_window_m=2.5,
        half_window_rad=0.6,
        min_score=0.3,
    )

    assert found is not None
    assert found.score > 0.8
    np.testing.assert_allclose(found.pose[:2], START[:2], atol=0.1)
    assert found.pose[2] == pytest.approx(START[2], abs=0.02)


def test_nothing_is_found_outside_of_the_window():
    points = wall_points(furnished_room())
    scan = transform(inverse(START), points)

    found = LikelihoodField.of(points).search(
        scan,
        initial_pose=START + np.array([3.0, 0.0, 0.0]),
        half_window_m=0.5,
        half_window_rad=0.1,
        min_score=0.6,
    )

    assert found is None


def test_branch_and_bound_equals_trying_everything():
    rng = np.random.default_rng(4)
    field = rng.integers(0, 255, (60, 50)).astype(np.uint8)
    cells = rng.integers(10, 45, (3, 12, 2)).astype(np.int32)
    window, pyramid = 9, max_filter(field, 3)

    score, row, dx, dy = branch_and_bound(pyramid, cells, window, 0.0)

    def score_of(r, x, y):
        at = cells[r] + [x, y]
        inside = np.all((at >= 0) & (at < field.shape), axis=1)
        return field[at[inside, 0], at[inside, 1]].sum() / (255.0 * len(at))

    shifts = range(-window, window + 1)
    best = max(score_of(r, x, y) for r in range(3) for x in shifts for y in shifts)
    assert score == pytest.approx(best)
    assert score_of(row, dx, dy) == pytest.approx(best)


def test_thinning_keeps_one_point_a_cell():
    points = np.array([[0.01, 0.01], [0.05, 0.09], [0.15, 0.01], [-0.05, 0.01]])

    np.testing.assert_array_equal(thinned(points, 0.1, max_points=10), points[[0, 2, 3]])
    assert len(thinned(points, 0.01, max_points=2)) == 2
