import numpy as np

from recon4.geometry.lines import Lines, closest_points
from recon4.geometry.se3 import SE3


def lines(*pairs):
    a, b = (np.array(ends, dtype=np.float64) for ends in zip(*pairs, strict=True))
    return Lines.through(a, b)


def test_a_line_is_its_midpoint_and_unit_direction():
    line = lines(([0, 0, 0], [2, 0, 0]))

    np.testing.assert_array_equal(line.mid, [[1, 0, 0]])
    np.testing.assert_array_equal(line.dir, [[1, 0, 0]])


def test_closest_points_of_two_crossing_bridges():
    # Along x at height 0, along y at height 3 above (4, .).
    along_x, along_y = lines(([0, 0, 0], [1, 0, 0])), lines(([4, 5, 3], [4, 7, 3]))

    on_x, on_y = closest_points(along_x, along_y)

    np.testing.assert_allclose(on_x, [[4, 0, 0]], atol=1e-12)
    np.testing.assert_allclose(on_y, [[4, 0, 3]], atol=1e-12)


def test_the_connection_is_square_to_both_lines():
    rng = np.random.default_rng(1)
    a, b = (Lines.through(*rng.normal(0, 5, (2, 200, 3))) for _ in range(2))

    on_a, on_b = closest_points(a, b)

    np.testing.assert_allclose(np.sum((on_a - on_b) * a.dir, axis=1), 0.0, atol=1e-8)
    np.testing.assert_allclose(np.sum((on_a - on_b) * b.dir, axis=1), 0.0, atol=1e-8)
    np.testing.assert_allclose(np.linalg.norm(np.cross(on_a - a.mid, a.dir), axis=1), 0, atol=1e-8)


def test_closest_points_move_with_the_world():
    rng = np.random.default_rng(2)
    a, b = (Lines.through(*rng.normal(0, 5, (2, 50, 3))) for _ in range(2))
    T = SE3.from_rpy(0.3, -1.0, 2.0, t=[10.0, -20.0, 5.0])

    on_a, on_b = closest_points(a, b)
    moved_a, moved_b = closest_points(a.moved(T), b.moved(T))

    np.testing.assert_allclose(moved_a, T @ on_a, atol=1e-6)
    np.testing.assert_allclose(moved_b, T @ on_b, atol=1e-6)


def test_parallel_lines_have_no_closest_points():
    one = lines(([0, 0, 0], [1, 0, 0]), ([0, 0, 0], [1, 0, 0]))
    other = lines(([0, 1, 0], [2, 1, 0]), ([0, 1, 0], [-1, 1, 0]))

    on_one, on_other = closest_points(one, other)

    assert np.isnan(on_one).all()
    assert np.isnan(on_other).all()


def test_some_lines_of_many():
    three = lines(([0, 0, 0], [1, 0, 0]), ([0, 0, 0], [0, 1, 0]), ([0, 0, 0], [0, 0, 1]))

    np.testing.assert_array_equal(three[np.array([False, True, False])].dir, [[0, 1, 0]])
    assert len(three[np.array([2, 0])]) == 2
