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


class EquationSums(NamedTuple):
    """Where the sums of `planes.accumulate` begin in one array; see `recon4.kernels.lanes`."""

    start: int = 0
    """Of w J^T J for the correction at the start of the frame, (6, 8)."""
    cross: int = 48
    """For that at the start by that at the end, (6, 8)."""
    end: int = 96
    """For that at the end, (6, 8)."""
    g_start: int = 144
    """Of w J^T r, (8,)."""
    g_end: int = 152
    normals: int = 160
    """Of n n^T, (3, 4)."""
    all: int = 172
    """Numbers of all of them."""


SUMS = EquationSums()


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
