"""Hot loops of the live preview: which voxels are new, and what the rays have seen in plan."""

from __future__ import annotations

from typing import Any

from numba import njit

EMPTY = -(1 << 62)
"""A free place of the table."""


@njit(cache=True, nogil=True, error_model="numpy")
def add_voxels(table: Any, voxels: Any, fresh: Any) -> int:
    """Put voxels into a hash set and mark those that were not in it.

    Args:
        table: Keys or `EMPTY`, int64 (a power of two,); at most half full afterwards.
        voxels: Whole coordinates, -2^20 to 2^20 - 1, int64 (N, 3).
        fresh: Receives whether a voxel was added, bool (N,).

    Returns:
        How many were added.
    """
    mask = len(table) - 1
    added = 0
    for n in range(len(voxels)):
        key = (
            ((voxels[n, 0] + (1 << 20)) << 42)
            | ((voxels[n, 1] + (1 << 20)) << 21)
            | (voxels[n, 2] + (1 << 20))
        )
        place = ((key * 0x9E3779B97F4A7C1) ^ (key >> 29)) & mask
        while table[place] != EMPTY and table[place] != key:
            place = (place + 1) & mask
        fresh[n] = table[place] == EMPTY
        if fresh[n]:
            table[place] = key
            added += 1
    return added


@njit(cache=True, nogil=True, error_model="numpy")
def trace(
    start: Any, ends: Any, ranges: Any, solid: Any, free: Any, hits: Any, nearest: Any
) -> None:
    """Walk the cells from the sensor to where its rays ended, in plan.

    Args:
        start: Cell of the sensor, float64 (2,).
        ends: Cells of the ends, float64 (N, 2); all inside of the grid, as is the start.
        ranges: Lengths of the rays [m], float64 (N,).
        solid: Whether the ray ended at something that stands in the way, bool (N,).
        free: Rays that passed a cell, uint16 (H, W), counted up to 65535.
        hits: Rays that ended in a cell at something solid, uint16 (H, W).
        nearest: Shortest ray that did [m], float32 (H, W).
    """
    for n in range(len(ends)):
        d0, d1 = ends[n, 0] - start[0], ends[n, 1] - start[1]
        steps = int(max(abs(d0), abs(d1))) + 1
        last_a, last_b = int(ends[n, 0]), int(ends[n, 1])
        for k in range(steps):
            a = int(start[0] + d0 * k / steps)
            b = int(start[1] + d1 * k / steps)
            if (a != last_a or b != last_b) and free[a, b] < 65535:
                free[a, b] += 1
        if solid[n]:
            if hits[last_a, last_b] < 65535:
                hits[last_a, last_b] += 1
            nearest[last_a, last_b] = min(nearest[last_a, last_b], ranges[n])
        elif free[last_a, last_b] < 65535:
            free[last_a, last_b] += 1
