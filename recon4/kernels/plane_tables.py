"""Columns, states and order of the tables of the plane map, which `planes` fills and reads."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numba import njit
from numpy.typing import NDArray

EMPTY = np.int64(-1)
"""Key of a slot without a cube, and row of none."""


class CubeStates(NamedTuple):
    """What is known of the plane of a cube."""

    dirty: np.uint8 = np.uint8(0)
    """Points came or went since it was fitted."""
    plane: np.uint8 = np.uint8(1)
    no_plane: np.uint8 = np.uint8(2)


STATE = CubeStates()


class CubeColumns(NamedTuple):
    """Columns of the tables of cubes: ``sums`` begins with ten moments."""

    batches: int = 10
    """From how many places points were seen."""
    newest: int = 11
    """Number of the newest of them."""
    seen_from: int = 12
    """First of the sum of these places (NaN = unknown)."""
    sums: int = 15
    """All columns of ``sums``."""
    fits: int = 10
    """All columns of ``fits``, see `_fit`."""


CUBE = CubeColumns()


@njit(cache=True, nogil=True, error_model="numpy")
def compact(sums: NDArray[np.float64], used: int) -> tuple[NDArray[np.int32], int]:
    """Move the rows of cubes that have points to the front, in their order; zero the others.

    Returns the new row of each of the ``used`` ones, `EMPTY` = dropped, and how many are left.
    """
    moved = np.full(used, np.int32(EMPTY), np.int32)
    kept = 0
    for row in range(used):
        if sums[row, 0] > 0.5:
            if kept != row:
                sums[kept] = sums[row]
            moved[row] = kept
            kept += 1
    sums[kept:used] = 0.0
    return moved, kept
