"""The local map of lines: sums of cells, and the registration of scans to it."""

import numpy as np
import pytest

from recon4.geometry.se2 import inverse, transform
from recon4.kernels.lines2d import add_points, line_at
from recon4.slam2d.line_map import LineMap, Prior2d
from tests.planar_walks import furnished_room

START = np.array([0.4, -0.7, 0.3])


def wall_points(walls, spacing_m=0.04):
    rng = np.random.default_rng(2)
    parts = []
    for x0, y0, x1, y1 in walls:
        along = np.arange(0.0, np.hypot(x1 - x0, y1 - y0), spacing_m)[:, None]
        unit = np.array([x1 - x0, y1 - y0]) / np.hypot(x1 - x0, y1 - y0)
        parts.append(np.array([x0, y0]) + along * unit)
    points = np.concatenate(parts)
    return points + 0.005 * rng.standard_normal(points.shape)


@pytest.fixture(scope="module")
def room():
    points = wall_points(furnished_room())
    local = LineMap(cell_m=0.1, extent_m=30.0)
    local.add(points)
    return local, points


def test_a_cell_without_points_is_exactly_zero_again():
    points = np.random.default_rng(0).uniform(-50.0, 50.0, (2000, 2))
    sums = np.zeros((40, 40, 6))

    add_points(sums, points, 0.1, 1.0)
    filled = np.abs(sums).sum()
    add_points(sums, points[::-1].copy(), 0.1, -1.0)

    assert filled > 0.0
    assert np.all(sums == 0.0)


def test_the_line_of_a_wall_has_its_place_and_normal():
    x = np.linspace(0.0, 2.0, 81)
    points = np.stack([x, 0.5 + 0.1 * x], axis=1)
    sums, line = np.zeros((64, 64, 6)), np.zeros(5)
    add_points(sums, points, 0.1, 1.0)

    assert line_at(sums, 1.0, 0.6, 0.1, line)

    normal = np.array([-0.1, 1.0]) / np.hypot(0.1, 1.0)
    assert abs(line[2:4] @ normal) == pytest.approx(1.0, abs=1e-9)
    assert (line[:2] - [0.0, 0.5]) @ normal == pytest.approx(0.0, abs=1e-9)
    assert line[4] == pytest.approx(0.0, abs=1e-9)


def test_a_corner_is_no_line():
    ends = np.linspace(0.0, 0.15, 20)
    points = np.concatenate(
        [np.stack([ends, np.zeros(20)], axis=1), np.stack([np.zeros(20), ends], axis=1)]
    )
    sums = np.zeros((64, 64, 6))
    add_points(sums, points + 0.05, 0.1, 1.0)

    assert not line_at(sums, 0.05, 0.05, 0.1, np.zeros(5))


@pytest.mark.parametrize("offset", [[0.3, -0.2, 0.08], [-0.25, 0.3, -0.1]])
def test_a_scan_is_registered_from_a_wrong_start(room, offset):
    local, points = room
    scan = transform(inverse(START), points)

    match = local.register(scan, np.ones(len(scan)), start=START + np.array(offset), sd_m=0.01)

    assert match.converged
    assert match.match_ratio > 0.9
    np.testing.assert_allclose(match.pose, START, atol=2e-3)


def test_the_prior_decides_where_the_lines_say_nothing():
    wall = wall_points(np.array([[-8.0, 1.0, 8.0, 1.0], [-8.0, -1.0, 8.0, -1.0]]))
    local = LineMap(cell_m=0.1, extent_m=40.0)
    local.add(wall)
    scan = wall[np.abs(wall[:, 0]) < 3.0]
    prior = Prior2d(np.array([0.5, 0.2, 0.0]), np.diag([1e2, 1e2, 1e2]))

    match = local.register(scan, np.ones(len(scan)), start=prior.pose, prior=prior, sd_m=0.02)

    assert match.pose[1] == pytest.approx(0.0, abs=0.01)
    assert match.pose[0] == pytest.approx(0.5, abs=0.05)


def test_a_map_far_from_the_origin_registers_as_well():
    points = wall_points(furnished_room()) + np.array([3000.0, -2000.0])
    local = LineMap(cell_m=0.1, extent_m=30.0)
    local.add(points)
    pose = START + np.array([3000.0, -2000.0, 0.0])
    scan = transform(inverse(pose), points)

    match = local.register(
        scan, np.ones(len(scan)), start=pose + np.array([0.2, 0.1, 0.05]), sd_m=0.01
    )

    np.testing.assert_allclose(match.pose, pose, atol=2e-3)
