"""Kernel that merges runs of records, each in the order of its voxels."""

from __future__ import annotations

from typing import Any

import numpy as np
from numba import njit
from numpy.typing import NDArray

from recon4.kernels.voxels import joined_returns, voxel_at, voxel_rank

MERGED, FULL = -1, -2
"""In place of a run: all are merged, the output is full."""
_DONE = np.iinfo(np.int64).max
"""Voxel of a run without further records."""


@njit(cache=True, nogil=True, error_model="numpy")
def merge_runs(
    f4: NDArray[np.float32],
    i4: NDArray[np.int32],
    i2: NDArray[np.int16],
    u1: NDArray[np.uint8],
    cells: tuple[float, int, int, int],
    head: NDArray[np.int64],
    stop: NDArray[np.int64],
    left: NDArray[np.int64],
    keys: NDArray[np.int64],
    out_i4: NDArray[np.int32],
    out_i2: NDArray[np.int16],
    out_u1: NDArray[np.uint8],
    state: NDArray[np.int64],
) -> int:
    """Merge until a run needs more records or the output more room; called again, it continues.

    The nearest of each voxel is kept, of equal ones that of the first run, as
    `recon4.kernels.voxels.nearest_in_voxels` does.

    Args:
        f4: Some records of each run as float32, (N, 8).
        i4: The same as int32, (N, 8).
        i2: The same as int16, (N, 16).
        u1: The same as uint8, (N, 32).
        cells: Edge of a voxel [m], voxels along a cell, cells along tile and halo, of the halo.
        head: Next record of each run, advanced, (R,).
        stop: First record that is not of the run, (R,).
        left: Records of each run that are not among these, (R,).
        keys: Voxel of each next record, -1 = to be computed, (R,).
        out_i4: Receives the records as int32, (M, 8).
        out_i2: The same as int16, (M, 16).
        out_u1: The same as uint8, (M, 32).
        state: Records written and the voxel of the last one, continued, (2,).

    Returns:
        The run that needs records, `MERGED` or `FULL`.
    """
    for r in range(len(head)):
        if head[r] < stop[r]:
            if keys[r] < 0:
                keys[r] = voxel_at(f4, head[r], cells[0], cells[1], cells[2], cells[3])
        elif left[r] > 0:
            return r
        else:
            keys[r] = _DONE
    losers, lost = _tournament(keys)
    best = losers[0]
    while keys[best] != _DONE:
        n, fresh = head[best], keys[best] != state[1]
        if fresh and state[0] == len(out_i4):
            return FULL
        at = state[0] if fresh else state[0] - 1
        returns: Any = np.int64(u1[n, 31])
        nearest = fresh
        if not fresh:
            rank, kept = voxel_rank(i2, u1, n), voxel_rank(out_i2, out_u1, at)
            returns = joined_returns(kept, np.int64(out_u1[at, 31]), rank, returns)
            nearest = rank < kept
        if nearest:
            for d in range(8):
                out_i4[at, d] = i4[n, d]
        out_u1[at, 31] = returns
        if fresh:
            state[0], state[1] = at + 1, keys[best]
        head[best] += 1
        if head[best] < stop[best]:
            keys[best] = voxel_at(f4, head[best], cells[0], cells[1], cells[2], cells[3])
        elif left[best] > 0:
            keys[best] = -1
            return best
        else:
            keys[best] = _DONE
        best = _replayed(best, keys[best], losers, lost)
    return MERGED


@njit(cache=True, nogil=True, error_model="numpy", inline="always")
def _tournament(keys: NDArray[np.int64]) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """Runs in a tree of matches, in which the smaller key wins, of equal ones the first run.

    Knuth, The Art of Computer Programming 3, 5.4.1: a tree of losers. The next record is found in
    as many steps as the tree has levels, however many runs there are.

    Args:
        keys: Of the runs, (R,).

    Returns:
        The run that lost each match, and its key, (W,), W a power of two; the winner is the first.
    """
    width = 1
    while width < len(keys):
        width *= 2
    winners, won = np.arange(-width, width), np.full(2 * width, _DONE)
    won[width : width + len(keys)] = keys
    losers, lost = np.empty((2, width), np.int64)
    for match in range(width - 1, 0, -1):
        a, b = 2 * match, 2 * match + 1
        if won[b] < won[a]:
            a, b = b, a
        winners[match], won[match] = winners[a], won[a]
        losers[match], lost[match] = winners[b], won[b]
    losers[0] = winners[1]
    return losers, lost


@njit(cache=True, nogil=True, error_model="numpy", inline="always")
def _replayed(run: int, key: int, losers: NDArray[np.int64], lost: NDArray[np.int64]) -> int:
    """The winner after the one before, ``run``, got another key."""
    match = (len(losers) + run) >> 1
    while match > 0:
        other, its = losers[match], lost[match]
        if its < key or (its == key and other < run):
            losers[match], lost[match] = run, key
            run, key = other, its
        match >>= 1
    return run
