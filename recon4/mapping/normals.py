"""Surface normals of many points at once, from the moments of small cells."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from recon4.kernels.normals import bounds, cell_keys, cell_moments, spread_to_points, window_normals
from recon4.kernels.sorting import radix_sort
from recon4.mapping.tuning import NORMALS


@dataclass(frozen=True, slots=True, eq=False)
class Normals:
    """Normals of points, with the number of points each is computed from."""

    normal: NDArray[np.float32]
    """Unit vectors of arbitrary sign; zeros where there is none, (N, 3)."""
    support: NDArray[np.int32]
    """Points in the neighborhood, the point itself included, (N,)."""


def local_normals(xyz_m: NDArray[np.float32], cell_m: float) -> Normals:
    """Normals of the planes through the 3 x 3 x 3 cells around each point's cell.

    All points of a cell have the same normal, so the cost is a sort and a sum, not a search for
    neighbors: cells of 5 cm use neighborhoods of 15 cm.

    Args:
        xyz_m: Points near the origin, finite [m], (N, 3).
        cell_m: Edge of a cell [m].
    """
    n = len(xyz_m)
    out = Normals(np.zeros((n, 3), np.float32), np.zeros(n, np.int32))
    if n == 0:
        return out
    # A border of empty cells keeps the window of the outermost cells inside the box.
    least, most = np.empty(3), np.empty(3)
    bounds(xyz_m, least, most)
    low = np.floor(least / cell_m).astype(np.int64) - 1
    shape = np.floor(most / cell_m).astype(np.int64) + 2 - low
    shift, bits = n.bit_length(), math.prod(shape.tolist()).bit_length()
    assert bits + shift < 64, f"a box of {shape.tolist()} cells is too large for {n} points"
    order = np.empty(n, np.int64)
    if not cell_keys(xyz_m, low, shape, cell_m, shift, order):
        order = radix_sort(order, shift, shift + bits, np.empty(n, np.int64))
    count = 1 + int(np.count_nonzero(np.diff(order >> shift)))
    cells, moments = np.empty(count, np.int64), np.empty((count, 10))
    cell_moments(xyz_m, order, shift, low, shape, cell_m, cells, moments)
    normals, support = np.empty((count, 3), np.float32), np.empty(count, np.int32)
    window_normals(cells, moments, shape, cell_m, NORMALS.min_points, normals, support)
    spread_to_points(order, shift, normals, support, out.normal, out.support)
    return out
