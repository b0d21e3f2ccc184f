"""Kernels of the live preview: new voxels, and the cells that rays pass in plan."""

from __future__ import annotations

import numpy as np
from numba import njit
from numpy.typing import NDArray

from recon4.kernels.cell_table import key_at, place_of

EMPTY = -(1 << 62)
"""Free entry of the table."""


@njit(cache=True, nogil=True, error_model="numpy")
def add_voxels(
    table: NDArray[np.int64], voxels: NDArray[np.int64], fresh: NDArray[np.bool_]
) -> int:
    """Add voxels to a hash set and mark the new ones.

    Args:
        table: Keys or `EMPTY`, int64 (a power of two,); at most half full afterwards.
        voxels: Integer coordinates, -2^20 to 2^20 - 1, int64 (N, 3).
        fresh: Receives whether a voxel was added, bool (N,).

    Returns:
        Number of voxels added.
    """
    mask = len(table) - 1
    added = 0
    for n in range(len(voxels)):
        key = key_at(voxels[n, 0], voxels[n, 1], voxels[n, 2])
        place = place_of(key, mask)
        while table[place] != EMPTY and table[place] != key:
            place = (place + 1) & mask
        fresh[n] = table[place] == EMPTY
        if fresh[n]:
            table[place] = key
            added += 1
    return added


@njit(cache=True, nogil=True, error_model="numpy")
def trace(
    start: NDArray[np.float64],
    ends: NDArray[np.float64],
    ranges: NDArray[np.float64],
    solid: NDArray[np.bool_],
    free: NDArray[np.uint32],
    hits: NDArray[np.uint32],
    nearest: NDArray[np.float32],
) -> None:
    """Trace rays from the sensor to their ends through the cells of a plan.

    Args:
        start: Cell of the sensor, float64 (2,).
        ends: Cells of the ends, float64 (N, 2); all inside the grid, like the start.
        ranges: Lengths of the rays [m], float64 (N,).
        solid: Whether the ray ended at an obstacle, bool (N,).
        free: Number of rays that passed a cell, uint32 (H, W). Its ratio to ``hits`` counts, so
            neither may end before the other.
        hits: Number of rays that ended in a cell at an obstacle, uint32 (H, W).
        nearest: Shortest of these rays [m], float32 (H, W).
    """
    for n in range(len(ends)):
        d0, d1 = ends[n, 0] - start[0], ends[n, 1] - start[1]
        steps = int(max(abs(d0), abs(d1))) + 1
        last_a, last_b = int(ends[n, 0]), int(ends[n, 1])
        for k in range(steps):
            a = int(start[0] + d0 * k / steps)
            b = int(start[1] + d1 * k / steps)
            if a != last_a or b != last_b:
                free[a, b] += np.uint32(1)
        if solid[n]:
            hits[last_a, last_b] += np.uint32(1)
            nearest[last_a, last_b] = min(nearest[last_a, last_b], ranges[n])
        else:
            free[last_a, last_b] += np.uint32(1)
