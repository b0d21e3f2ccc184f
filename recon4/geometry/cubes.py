"""Cubes of a grid, and a number for each."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from recon4.geometry.distinct import distinct
from recon4.geometry.se3 import Array


def cubes_of(p: Array, edge_m: float) -> NDArray[np.int64]:
    """Cube of each point, (N, 3) -> (N, 3)."""
    return np.floor(p / edge_m).astype(np.int64)


def cube_keys(cubes: NDArray[np.int64]) -> NDArray[np.int64]:
    """A number for each cube that no other cube among them has, from 0 on, (N, 3) -> (N,).

    In the order of their coordinates, so it does not depend on where the grid begins.
    """
    if not len(cubes):
        return np.empty(0, np.int64)
    columns = np.ascontiguousarray(cubes.T)  # extremes of short rows take five times as long
    columns -= columns.min(axis=1)[:, None]
    x, y, z = columns
    _, size_y, size_z = columns.max(axis=1) + 1
    return np.asarray((x * size_y + y) * size_z + z, np.int64)


def count_cubes(p: Array, edge_m: float) -> int:
    """Number of cubes with a point."""
    return len(distinct(cube_keys(cubes_of(p, edge_m))))
