"""Kernels of cells in space: found by a hash of their place, filled with sums of returns."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from numba import njit
from numpy.typing import NDArray


class KeyBits(NamedTuple):
    """A key has three numbers of cells."""

    each: int = 21
    zero: int = 1 << 20
    """Number 0 of an axis."""


KEY = KeyBits()


class OffsetUnits(NamedTuple):
    """Offsets in cells are whole numbers."""

    steps: int = 256
    """Along an edge."""


OFFSET = OffsetUnits()


class CellSums(NamedTuple):
    """Sums of the returns in cells, in the places of a hash table."""

    key: NDArray[np.int64]
    """-1 = a free place, (S,), a power of two."""
    total: NDArray[np.uint32]
    """Returns, their offsets x, y, z from the corner of the cell [edge/`OFFSET.steps`], how many
    were seen from above, and how many are further echoes of their beams, (S, 6)."""


class CellIndex(NamedTuple):
    """Rows of cells by their keys."""

    key: NDArray[np.int64]
    """Ascending, (C,)."""
    slots: NDArray[np.int32]
    """Rows in the places of a hash table, -1 = a free place, (S,), a power of two."""


@njit(cache=True, nogil=True, error_model="numpy", inline="always")
def key_at(i: Any, j: Any, k: Any) -> Any:
    """Key of a cell by its numbers along x, y and z; ascends with i, then j, then k."""
    return ((i + KEY.zero) << (2 * KEY.each)) | ((j + KEY.zero) << KEY.each) | (k + KEY.zero)


@njit(cache=True, nogil=True, error_model="numpy", inline="always")
def numbers_of(key: Any) -> tuple[Any, Any, Any]:
    """Numbers i, j, k of a cell by its key."""
    mask = (1 << KEY.each) - 1
    i = (key >> (2 * KEY.each)) - KEY.zero
    return i, ((key >> KEY.each) & mask) - KEY.zero, (key & mask) - KEY.zero


@njit(cache=True, nogil=True, error_model="numpy", inline="always")
def place_of(key: Any, mask: Any) -> Any:
    """Where the search for a key begins: every bit of the key counts (Steele et al. 2014)."""
    mixed = np.uint64(key) * np.uint64(0x9E3779B97F4A7C15)
    mixed = (mixed ^ (mixed >> np.uint64(32))) * np.uint64(0xBF58476D1CE4E5B9)
    return np.int64(mixed >> np.uint64(32)) & mask


@njit(cache=True, nogil=True, error_model="numpy", inline="always")
def _steps(part: Any) -> Any:
    """Whole steps from the corner of a cell by the part of its edge, below 1 but for rounding."""
    return np.uint32(min(max(part, 0.0) * OFFSET.steps, OFFSET.steps - 1.0))


@njit(cache=True, nogil=True, error_model="numpy")
def add_returns(
    xyz: NDArray[np.float64],
    origin: NDArray[np.float64],
    chosen: NDArray[np.bool_],
    echo: NDArray[np.uint8],
    cell_m: tuple[float, float],
    range_m: float,
    sums: CellSums,
    used: int,
) -> int:
    """Add returns to the sums of their cells.

    Args:
        xyz: In the map [m], (N, 3).
        origin: Positions of the sensor [m], (N, 3).
        chosen: Which returns are added, (N,).
        echo: Number of the echo of its beam, 0 = the first, (N,).
        cell_m: Edge of a cell along x and y, and along z [m].
        range_m: Farther returns are not added [m].
        sums: The table, with a free place for each return; changed in place.
        used: Cells that it has.

    Returns:
        Cells that it has now.
    """
    mask, reach = np.int64(len(sums.key) - 1), np.int64(KEY.zero - 1)
    for n in range(len(xyz)):
        far = 0.0
        for d in range(3):
            far += (xyz[n, d] - origin[n, d]) ** 2
        if not (chosen[n] and far <= range_m * range_m):
            continue
        i = np.int64(np.floor(xyz[n, 0] / cell_m[0]))
        j = np.int64(np.floor(xyz[n, 1] / cell_m[0]))
        k = np.int64(np.floor(xyz[n, 2] / cell_m[1]))
        if max(abs(i), abs(j), abs(k)) >= reach:
            continue
        key = key_at(i, j, k)
        at = place_of(key, mask)
        while sums.key[at] != key and sums.key[at] >= 0:
            at = (at + 1) & mask
        if sums.key[at] < 0:
            sums.key[at] = key
            used += 1
        total = sums.total[at]
        total[0] += 1
        total[1] += _steps(xyz[n, 0] / cell_m[0] - i)
        total[2] += _steps(xyz[n, 1] / cell_m[0] - j)
        total[3] += _steps(xyz[n, 2] / cell_m[1] - k)
        total[4] += origin[n, 2] > xyz[n, 2]
        total[5] += echo[n] > 0
    return used


@njit(cache=True, nogil=True, error_model="numpy")
def index_keys(key: NDArray[np.int64], slots: NDArray[np.int32]) -> None:
    """Fill the hash table of a `CellIndex`, which is empty (-1)."""
    mask = np.int64(len(slots) - 1)
    for n in range(len(key)):
        at = place_of(key[n], mask)
        while slots[at] >= 0:
            at = (at + 1) & mask
        slots[at] = n


@njit(cache=True, nogil=True, error_model="numpy")
def find_row(index: CellIndex, key: Any) -> Any:
    """Row of a cell, -1 = there is none."""
    mask = np.int64(len(index.slots) - 1)
    at = place_of(key, mask)
    while index.slots[at] >= 0:
        row = index.slots[at]
        if index.key[row] == key:
            return np.int64(row)
        at = (at + 1) & mask
    return np.int64(-1)
