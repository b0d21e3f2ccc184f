"""Tables of cells in space: what is beside each other along an axis does not share a place."""

import numpy as np

from recon4.kernels.live import EMPTY, add_voxels
from recon4.registration.plane_map import PlaneMap
from recon4.registration.tuning import PlaneTuning

BY_CHANCE = 200
"""Half full, a table with independent places has a longer run less than once in 10^10 tables."""


def office_walls():
    """Numbers of cells of the six sides of an office, in the order of a walk, (N, 3)."""
    size = np.array([160, 120, 12])
    cells = np.stack(np.meshgrid(*map(np.arange, size), indexing="ij"), axis=-1).reshape(-1, 3)
    at_side = ((cells == 0) | (cells == size - 1)).any(axis=1)
    return cells[at_side].astype(np.int64) - 60


def longest_run(used):
    """Most slots in use that follow each other."""
    free = np.flatnonzero(~used)
    return int(np.diff(free).max()) - 1


def test_cubes_of_planes_lie_apart_in_their_table():
    planes = PlaneMap()
    planes.add((office_walls() + 0.5) * PlaneTuning().finest_m)

    used = planes._keys != -1

    assert len(planes) == np.count_nonzero(used) > 40_000
    assert longest_run(used) < BY_CHANCE


def test_voxels_of_the_preview_lie_apart_in_their_table():
    table, voxels = np.full(1 << 17, EMPTY), office_walls()

    add_voxels(table, voxels, np.zeros(len(voxels), np.bool_))

    assert longest_run(table != EMPTY) < BY_CHANCE
