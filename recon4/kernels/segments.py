"""Kernel of collar line segments: draw random pairs of points of neighboring rings."""

from __future__ import annotations

import numpy as np
from numba import njit
from numpy.typing import NDArray

_RING_GAP = 3
"""An empty ring of a cell is skipped; largest difference of the rings of a segment."""


@njit(cache=True, nogil=True, error_model="numpy")
def _next_random(state: np.uint64) -> tuple[np.uint64, np.uint64]:
    """Next state and value of Splitmix64 (Steele 2014): reproducible for a seed."""
    state = np.uint64(state + np.uint64(0x9E3779B97F4A7C15))
    z = state
    z = (z ^ (z >> np.uint64(30))) * np.uint64(0xBF58476D1CE4E5B9)
    z = (z ^ (z >> np.uint64(27))) * np.uint64(0x94D049BB133111EB)
    return state, z ^ (z >> np.uint64(31))


@njit(cache=True, nogil=True, error_model="numpy")
def points_of_sensor(
    sensor: NDArray[np.uint8],
    row: int,
    xyz: NDArray[np.float32],
    ring: NDArray[np.uint8],
    dt_ns: NDArray[np.int32],
) -> tuple[NDArray[np.float32], NDArray[np.uint8], NDArray[np.int32]]:
    """Positions, rings and times of the points of one sensor, in one pass over all points.

    Args:
        sensor: Of each point, (N,).
        row: The one that is chosen.
        xyz: Positions [m], (N, 3).
        ring: Beams, (N,).
        dt_ns: Times, (N,).
    """
    count = 0
    for k in range(len(sensor)):
        count += sensor[k] == row
    p, r, t = np.empty((count, 3), np.float32), np.empty(count, np.uint8), np.empty(count, np.int32)
    at = 0
    for k in range(len(sensor)):
        if sensor[k] == row:
            p[at, 0], p[at, 1], p[at, 2] = xyz[k, 0], xyz[k, 1], xyz[k, 2]
            r[at], t[at] = ring[k], dt_ns[k]
            at += 1
    return p, r, t


@njit(cache=True, nogil=True, error_model="numpy")
def _sort_by_cell(
    xyz: NDArray[np.float32], ring: NDArray[np.uint8], rings: int, bins: int
) -> tuple[NDArray[np.int32], NDArray[np.int64]]:
    """Rows ordered by (azimuth bin, ring), and the start of each cell."""
    count = len(xyz)
    cell = np.empty(count, np.int32)
    start = np.zeros(bins * rings + 1, np.int64)
    scale = bins / (2.0 * np.pi)
    edge = np.arange(bins + 1) / scale - np.pi
    c, s = np.cos(edge), np.sin(edge)
    column = -1
    for k in range(count):
        x, y = np.float64(xyz[k, 0]), np.float64(xyz[k, 1])
        # Mostly the bin of the point before: at least 1e-5 rad within it, while an azimuth in
        # single precision is rounded by less than 1e-6.
        inside = 1e-5 * (abs(x) + abs(y))
        if (
            column < 0
            or not c[column] * y - s[column] * x > inside
            or not s[column + 1] * x - c[column + 1] * y > inside
        ):
            azimuth = np.arctan2(xyz[k, 1], xyz[k, 0]) + np.float32(np.pi)
            column = min(int(azimuth * scale), bins - 1)
        cell[k] = column * rings + ring[k]
        start[cell[k] + 1] += 1
    for k in range(bins * rings):
        start[k + 1] += start[k]
    fill = start[:-1].copy()
    order = np.empty(count, np.int32)
    for k in range(count):
        order[fill[cell[k]]] = k
        fill[cell[k]] += 1
    return order, start


@njit(cache=True, nogil=True, error_model="numpy")
def draw_pairs(
    xyz: NDArray[np.float32],
    ring: NDArray[np.uint8],
    rings: int,
    bins: int,
    generated: int,
    preserved: int,
    max_length_per_range: float,
    seed: int,
) -> NDArray[np.int32]:
    """Rows of the two ends of each collar line segment of one sensor (requirements A3.1, 1-2).

    In every azimuth bin and between every two neighboring rings ``generated`` random pairs are
    drawn and the ``preserved`` shortest are kept. A pair longer than the range of its nearer end
    times ``max_length_per_range`` crosses a depth edge and is dropped.

    Args:
        xyz: Points of one sensor in its own frame, spin axis z [m], (N, 3).
        ring: Beam of each, below ``rings``, (N,).

    Returns:
        (M, 2) int32, ordered by cell.
    """
    order, start = _sort_by_cell(xyz, ring, rings, bins)
    out = np.empty((bins * (rings - 1) * preserved, 2), np.int32)
    size = 0
    best_sq = np.empty(preserved, np.float64)
    best = np.empty((preserved, 2), np.int32)
    state = np.uint64(seed)
    for column in range(bins):
        for lower in range(rings - 1):
            a0, a1 = start[column * rings + lower], start[column * rings + lower + 1]
            if a0 == a1:
                continue
            upper = lower + 1
            while (
                upper < rings - 1
                and upper < lower + _RING_GAP
                and start[column * rings + upper] == start[column * rings + upper + 1]
            ):
                upper += 1
            b0, b1 = start[column * rings + upper], start[column * rings + upper + 1]
            if b0 == b1:
                continue
            kept = 0
            for _ in range(min(generated, (a1 - a0) * (b1 - b0))):
                state, r1 = _next_random(state)
                state, r2 = _next_random(state)
                a = order[a0 + np.int64(r1 % np.uint64(a1 - a0))]
                b = order[b0 + np.int64(r2 % np.uint64(b1 - b0))]
                sq = (
                    (xyz[a, 0] - xyz[b, 0]) ** 2
                    + (xyz[a, 1] - xyz[b, 1]) ** 2
                    + (xyz[a, 2] - xyz[b, 2]) ** 2
                )
                known = False
                for m in range(kept):
                    if best[m, 0] == a and best[m, 1] == b:
                        known = True
                if known or (kept == preserved and sq >= best_sq[kept - 1]):
                    continue
                row = kept if kept < preserved else kept - 1
                while row > 0 and best_sq[row - 1] > sq:
                    best_sq[row] = best_sq[row - 1]
                    best[row] = best[row - 1]
                    row -= 1
                best_sq[row] = sq
                best[row, 0] = a
                best[row, 1] = b
                kept = min(kept + 1, preserved)
            for m in range(kept):
                a, b = best[m, 0], best[m, 1]
                near_sq = min(
                    xyz[a, 0] ** 2 + xyz[a, 1] ** 2 + xyz[a, 2] ** 2,
                    xyz[b, 0] ** 2 + xyz[b, 1] ** 2 + xyz[b, 2] ** 2,
                )
                if best_sq[m] > 0.0 and best_sq[m] <= near_sq * max_length_per_range**2:
                    out[size] = best[m]
                    size += 1
    return out[:size]


@njit(cache=True, nogil=True, error_model="numpy")
def segment_ends(
    xyz: NDArray[np.float32],
    dt_ns: NDArray[np.int32],
    pairs: NDArray[np.int32],
    ends: NDArray[np.float32],
    times_s: NDArray[np.float64],
    range_m: NDArray[np.float64],
) -> None:
    """Positions and times of the ends of segments, in one pass over them.

    Args:
        xyz: Points of one sensor in its own frame [m], (N, 3).
        dt_ns: Their times, (N,).
        pairs: Rows of the two ends, (M, 2).
        ends: Receives the positions [m], (2, M, 3).
        times_s: Receives the times [s], (2, M).
        range_m: Receives the distance of the nearer end [m], (M,).
    """
    for m in range(len(pairs)):
        nearer_sq = np.inf
        for e in range(2):
            row = pairs[m, e]
            squared = 0.0
            for d in range(3):
                ends[e, m, d] = xyz[row, d]
                squared += np.float64(xyz[row, d]) ** 2
            nearer_sq = min(nearer_sq, squared)
            times_s[e, m] = dt_ns[row] * 1e-9
        range_m[m] = np.sqrt(nearer_sq)
