"""Values that occur, and cubes that hold a point."""

import numpy as np
import pytest

from recon4.geometry.cubes import count_cubes, cube_keys
from recon4.geometry.distinct import distinct


@pytest.mark.parametrize("kind", [np.uint8, np.uint16, np.int64, np.float64])
@pytest.mark.parametrize("shape", [0, 1, 1000, (40, 25)])
def test_each_value_is_there_once_in_order(kind, shape):
    values = np.random.default_rng(1).integers(0, 200, shape).astype(kind)
    before = values.copy()

    found = distinct(values)

    assert found.dtype == kind
    assert found.tolist() == sorted(set(values.ravel().tolist()))
    np.testing.assert_array_equal(values, before)


def test_cubes_are_numbered_in_the_order_of_their_coordinates():
    cubes = np.random.default_rng(2).integers(-7, 9, (500, 3)) + np.array([0, 10**9, -(10**6)])
    before = cubes.copy()

    keys = cube_keys(cubes)

    _, row = np.unique(keys, return_index=True)
    assert list(map(tuple, cubes[row].tolist())) == sorted(set(map(tuple, cubes.tolist())))
    assert keys.min() >= 0
    assert count_cubes(cubes + 0.5, 1.0) == len(row)
    np.testing.assert_array_equal(cubes, before)
