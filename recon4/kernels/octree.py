"""Kernels of an octree: which points a node takes, and in which node below it the others lie."""

from __future__ import annotations

import numpy as np
from numba import njit
from numpy.typing import NDArray


@njit(cache=True, nogil=True, error_model="numpy")
def first_of_cells(
    steps: NDArray[np.int32],
    rows: NDArray[np.int32],
    low_bit: int,
    side_bits: int,
    first: NDArray[np.bool_],
) -> None:
    """Mark the first row in each cell of a node.

    Args:
        steps: Steps of all points, axis by axis, int32 (3, N).
        rows: Those of the node, int32 (M,).
        low_bit: Lowest bit of the index of a cell.
        side_bits: Bits of this index along each axis.
        first: Receives the mark of each row, bool (M,).
    """
    taken = np.zeros(1 << 3 * side_bits, np.bool_)
    side = np.int32((1 << side_bits) - 1)
    for m in range(len(rows)):
        n = rows[m]
        x = (steps[0, n] >> low_bit) & side
        y = (steps[1, n] >> low_bit) & side
        z = (steps[2, n] >> low_bit) & side
        cell = (((np.int64(z) << side_bits) | y) << side_bits) | x
        first[m] = not taken[cell]
        taken[cell] = True


@njit(cache=True, nogil=True, error_model="numpy")
def by_octant(
    steps: NDArray[np.int32],
    rows: NDArray[np.int32],
    bit: int,
    left_out: NDArray[np.bool_],
    out: NDArray[np.int32],
) -> NDArray[np.int64]:
    """Sort rows by the nodes below a node; within each of them their order stays.

    Args:
        steps: Steps of all points, axis by axis, int32 (3, N).
        rows: Those of the node, int32 (M,).
        bit: The bit of a step that says in which half of the node it is.
        left_out: Rows that are in none of them, bool (M,).
        out: Receives the rows, those of the first octant first, int32 (M,).

    Returns:
        Where each octant begins, and the end of the last one, (9,).
    """
    octants = np.empty(len(rows), np.uint8)
    begins = np.zeros(9, np.int64)
    for m in range(len(rows)):
        n = rows[m]
        x, y, z = (steps[0, n] >> bit) & 1, (steps[1, n] >> bit) & 1, (steps[2, n] >> bit) & 1
        octants[m] = x | (y << 1) | (z << 2)
        begins[octants[m] + 1] += not left_out[m]
    begins = np.cumsum(begins)
    ends = begins.copy()
    for m in range(len(rows)):
        if not left_out[m]:
            out[ends[octants[m]]] = rows[m]
            ends[octants[m]] += 1
    return begins
