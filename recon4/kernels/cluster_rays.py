"""Kernels of free space: which clusters of cells beams pass through, and which they end in."""

from __future__ import annotations

from typing import Any

import numpy as np
from numba import njit
from numpy.typing import NDArray

from recon4.kernels.cell_table import CellIndex, find_row, key_at


@njit(cache=True, nogil=True, error_model="numpy", inline="always")
def _row_at(cells: Any, at: Any) -> Any:
    """Row of the cell in which a place [edges] lies, -1 = none."""
    return find_row(
        cells,
        key_at(
            np.int64(np.floor(at[0])),
            np.int64(np.floor(at[1])),
            np.int64(np.floor(at[2])),
        ),
    )


@njit(cache=True, nogil=True, error_model="numpy")
def count_passes(
    origin: NDArray[np.float64],
    end: NDArray[np.float64],
    cells: CellIndex,
    cluster_of: NDArray[np.int32],
    rules: tuple[float, float, float],
    counts: NDArray[np.int64],
) -> None:
    """Count beams that end in clusters, and those that pass through them.

    A beam is followed in steps of a cell. It passes through a cluster if it is in one of its cells
    farther from its end than a margin, and does not end in it; each beam counts once for a cluster.

    Args:
        origin: Positions of the sensor [m], (N, 3).
        end: Where the beams ended [m], (N, 3).
        cells: Of the clusters.
        cluster_of: Cluster of each cell, (C,).
        rules: Edge of a cell, margin before the end, farthest range [m].
        counts: Beams that passed through and that ended in each cluster, added to, (K, 2).
    """
    edge, margin, farthest = rules
    step = np.empty(3)
    at = np.empty(3)
    for n in range(len(end)):
        range_m = 0.0
        for d in range(3):
            step[d] = end[n, d] - origin[n, d]
            range_m += step[d] * step[d]
        range_m = np.sqrt(range_m)
        if not edge < range_m <= farthest:
            continue
        for d in range(3):
            at[d] = end[n, d] / edge
        own = _row_at(cells, at)
        mine = cluster_of[own] if own >= 0 else np.int32(-1)
        if mine >= 0:
            counts[mine, 1] += 1
        last = np.int32(-1)
        for k in range(int(max(range_m - margin, 0.0) / edge)):
            for d in range(3):
                at[d] = (origin[n, d] + step[d] * ((k + 0.5) * edge / range_m)) / edge
            row = _row_at(cells, at)
            if row >= 0 and cluster_of[row] != mine and cluster_of[row] != last:
                last = cluster_of[row]
                counts[last, 0] += 1


@njit(cache=True, nogil=True, error_model="numpy")
def find_crossing(
    origin: NDArray[np.float64],
    end: NDArray[np.float64],
    cells: CellIndex,
    stands: NDArray[np.bool_],
    rules: tuple[float, float, float],
    crosses: NDArray[np.bool_],
) -> None:
    """Find beams that cross a cell of something that stands.

    Args:
        origin: Positions of the sensor [m], (N, 3).
        end: Where the beams ended [m], (N, 3).
        cells: Of the map.
        stands: Which of them no beam should cross, (C,).
        rules: As in `count_passes`.
        crosses: Which beams do, filled, (N,).
    """
    edge, margin, farthest = rules
    at = np.empty(3)
    for n in range(len(end)):
        crosses[n] = False
        range_m = 0.0
        for d in range(3):
            range_m += (end[n, d] - origin[n, d]) ** 2
        range_m = np.sqrt(range_m)
        if not edge < range_m <= farthest:
            continue
        for k in range(int(max(range_m - margin, 0.0) / edge)):
            part = (k + 0.5) * edge / range_m
            for d in range(3):
                at[d] = (origin[n, d] + part * (end[n, d] - origin[n, d])) / edge
            row = _row_at(cells, at)
            if row >= 0 and stands[row]:
                crosses[n] = True
                break
