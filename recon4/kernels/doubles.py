"""Kernels of the double-wall check: moments of patches by time, and their best split in two."""

from __future__ import annotations

import numpy as np
from numba import njit
from numpy.typing import NDArray

COLUMNS = 12
"""n, x y z, xx xy xz yy yz zz about the center of the cell [m], first and last multiframe."""
_EMPTY = np.int64(-1)


@njit(cache=True, nogil=True, error_model="numpy", inline="always")
def middle_of(along: int, a: int, b: int, depth: int) -> int:
    """The middle cell of a long one, whose ends depend on its column (a, b)."""
    shift = (a * 7 + b * 11) % depth
    return (along + shift) // depth * depth - shift + depth // 2


@njit(cache=True, nogil=True, error_model="numpy")
def gather(
    xyz: NDArray[np.float32],
    normal_bits: NDArray[np.uint16],
    t_ns: NDArray[np.int64],
    frame_id: NDArray[np.uint32],
    first_ns: int,
    window_ns: int,
    low: NDArray[np.float64],
    base: NDArray[np.int64],
    cell_m: float,
    depth: int,
    side: int,
    keys: NDArray[np.int64],
    sums: NDArray[np.float64],
    used: int,
) -> int:
    """Add points to the moments of their patch: column, side they were seen from, time window.

    The side is the largest component of the normal, which points to the sensor: the two faces of
    a thin wall are two patches. A half float without its sign bit sorts like its magnitude. Along
    that axis a cell is ``depth`` times as long. Its ends differ from column to column, so that no
    wall lies on the ends of all its cells.

    Args:
        xyz: Points from the tile's origin [m], float32 (N, 3).
        normal_bits: Normals, float16 viewed as uint16 (N, 3); points with all zero are skipped.
        t_ns: Times [ns], (N,).
        frame_id: Multiframes, (N,).
        first_ns: Start of the first time window [ns].
        window_ns: Length of a time window [ns].
        low: Corner of the box of cells, from the tile's origin [m], (3,).
        base: That corner in the map [cells], so that all tiles use the same ends, (3,).
        cell_m: Width of a column [m].
        depth: Length of a cell [widths].
        side: Cells along an edge of the box.
        keys: Hash table, `_EMPTY` where free, int64 (2**k,).
        sums: Moments, (2**k, COLUMNS).
        used: Entries in the table.

    Returns:
        Entries in the table; -1 = it is too full and invalid: double it and start again.
    """
    mask = np.uint64(len(keys) - 1)
    limit = len(keys) // 2
    for k in range(len(xyz)):
        best, face = np.uint16(0), 0
        for a in range(3):
            size = normal_bits[k, a] & np.uint16(0x7FFF)
            if size > best:
                best, face = size, 2 * a + (normal_bits[k, a] >> 15)
        if best == 0:
            continue
        x, y, z = xyz[k, 0] - low[0], xyz[k, 1] - low[1], xyz[k, 2] - low[2]
        i, j, m = int(x / cell_m), int(y / cell_m), int(z / cell_m)
        if face < 2:
            i = middle_of(i + base[0], j + base[1], m + base[2], depth) - base[0]
        elif face < 4:
            j = middle_of(j + base[1], m + base[2], i + base[0], depth) - base[1]
        else:
            m = middle_of(m + base[2], i + base[0], j + base[1], depth) - base[2]
        window = (t_ns[k] - first_ns) // window_ns
        key = ((((window * side + m) * side + j) * side + i) * 6) + face
        slot = (np.uint64(key) * np.uint64(0x9E3779B97F4A7C15)) >> np.uint64(20) & mask
        while keys[slot] != key and keys[slot] != _EMPTY:
            slot = (slot + np.uint64(1)) & mask
        s = sums[slot]
        if keys[slot] == _EMPTY:
            if used >= limit:
                return -1
            keys[slot] = key
            used += 1
            s[10], s[11] = frame_id[k], frame_id[k]
        x -= (i + 0.5) * cell_m
        y -= (j + 0.5) * cell_m
        z -= (m + 0.5) * cell_m
        s[0] += 1.0
        s[1] += x
        s[2] += y
        s[3] += z
        s[4] += x * x
        s[5] += x * y
        s[6] += x * z
        s[7] += y * y
        s[8] += y * z
        s[9] += z * z
        s[10] = min(s[10], frame_id[k])
        s[11] = max(s[11], frame_id[k])
    return used


@njit(cache=True, nogil=True, error_model="numpy")
def best_split(
    start: NDArray[np.int64],
    n: NDArray[np.float64],
    mean: NDArray[np.float64],
    order: NDArray[np.int64],
    split: NDArray[np.int64],
) -> None:
    """Split the time windows of each patch into two groups with the largest distance.

    Over the windows in the order of their means along the normal this maximizes the variance
    between the groups ``n_a n_b / n (mean_b - mean_a)**2``: exact two-means in one dimension.

    Args:
        start: First window of each patch, and the end of the last, (P + 1,).
        n: Points of each window, (K,).
        mean: Mean distance along the patch's normal of each window [m], (K,).
        order: Windows of each patch by increasing mean, (K,).
        split: Receives the number of windows in the lower group, 0 = a single window, (P,).
    """
    for p in range(len(start) - 1):
        total, weighted = 0.0, 0.0
        for k in range(start[p], start[p + 1]):
            total += n[order[k]]
            weighted += n[order[k]] * mean[order[k]]
        best, below, sum_below = -1.0, 0.0, 0.0
        split[p] = 0
        for k in range(start[p], start[p + 1] - 1):
            below += n[order[k]]
            sum_below += n[order[k]] * mean[order[k]]
            above = total - below
            apart = (weighted - sum_below) / above - sum_below / below
            value = below * above / total * apart * apart
            if value > best:
                best = value
                split[p] = k - start[p] + 1
