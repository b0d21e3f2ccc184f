"""Sums over the points of cubes, to the last bit as NumPy counts them."""

import numpy as np

from recon4.kernels.cube_sums import add_to_cubes, sort_into_cubes


def test_points_are_summed_by_cube_in_their_order_and_unused_cubes_are_left_out():
    edge_m, p = 0.3, np.random.default_rng(5).normal([-7.0, 0.0, 900.0], size=(2_000, 3))
    cube = np.floor(p / edge_m).astype(np.int64)
    grid = np.array([cube.min(axis=0), np.ptp(cube, axis=0) + 1])
    local_m, key = np.empty_like(p), np.empty(len(p), np.int64)
    count = np.zeros(grid[1].prod(), np.int64)

    sort_into_cubes(p, edge_m, grid, local_m, key, count)
    used = np.flatnonzero(count >= 3)
    row = np.full(len(count), -1, np.int32)
    row[used] = np.arange(len(used))
    sums, middle_m = np.zeros((len(used), 9)), np.array([0.01, -0.02, 0.03])
    add_to_cubes(local_m, middle_m, row, key, sums)

    np.testing.assert_array_equal(key, np.ravel_multi_index((cube - grid[0]).T, grid[1]))
    np.testing.assert_array_equal(count, np.bincount(key, minlength=len(count)))
    np.testing.assert_array_equal(local_m, p - (cube + 0.5) * edge_m)
    at = local_m - middle_m
    x, y, z = at.T
    weights = (x, y, z, x * x, x * y, x * z, y * y, y * z, z * z)
    expected = [np.bincount(key, weight, len(count))[used] for weight in weights]
    assert len(used) > 50 and sums.tobytes() == np.transpose(expected).tobytes()
