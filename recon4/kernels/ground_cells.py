"""Kernels of the ground: level cells that lead on from below the walk; heights over them."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from numba import njit
from numpy.typing import NDArray

from recon4.kernels.cell_table import CellIndex, find_row, key_at, numbers_of


class GroundRules(NamedTuple):
    """What is ground."""

    cell_m: float
    """Edge of a cell along x and y [m]."""
    height_m: float
    """Height of a cell [m]."""
    seen_above: float
    """Least part of the returns of a cell that sensors saw from above."""
    clear: tuple[int, int]
    """Among the cells from the first to the last of these above one …"""
    upright: int
    """… as many with returns are something upright, or a bush."""
    carried_m: tuple[float, float]
    """Least and largest height of the sensors over the ground that is walked on [m]."""
    same_m: float
    """They are carried at the same height to this [m]."""
    step_m: float
    """Highest step between neighboring cells: stairs and kerbs, but no chair [m]."""
    reach: int
    """Cells between which a step is looked for."""


@njit(cache=True, nogil=True, error_model="numpy")
def find_level(
    index: CellIndex, above: NDArray[np.float32], rules: GroundRules, out: NDArray[np.bool_]
) -> None:
    """Find the cells that may be ground: seen from above, and nothing upright stands in them.

    Args:
        index: Of the cells, (C,).
        above: Part of the returns of each that was seen from above, (C,).
        rules: The rules.
        out: Receives whether each may be ground, (C,).
    """
    for n in range(len(index.key)):
        out[n] = above[n] >= rules.seen_above
        if not out[n]:
            continue
        filled = 0
        for k in range(rules.clear[0], rules.clear[1] + 1):
            filled += find_row(index, index.key[n] + k) >= 0
        out[n] = filled < rules.upright


@njit(cache=True, nogil=True, error_model="numpy")
def find_below(
    index: CellIndex,
    level: NDArray[np.bool_],
    walk: NDArray[np.float64],
    rules: GroundRules,
    out: NDArray[np.int64],
) -> None:
    """Find the highest level cell right below each position of a walk.

    Args:
        index: Of the cells, (C,).
        level: Whether each may be ground, (C,).
        walk: Positions of the body [m], (W, 3).
        rules: The rules.
        out: Receives the rows of the cells, -1 = there is none, (W,).
    """
    for w in range(len(walk)):
        out[w] = -1
        i = np.int64(np.floor(walk[w, 0] / rules.cell_m))
        j = np.int64(np.floor(walk[w, 1] / rules.cell_m))
        first = np.int64(np.floor((walk[w, 2] - rules.carried_m[0]) / rules.height_m))
        last = np.int64(np.floor((walk[w, 2] - rules.carried_m[1]) / rules.height_m))
        for k in range(first, last - 1, -1):
            row = find_row(index, key_at(i, j, k))
            if row >= 0 and level[row]:
                out[w] = row
                break


@njit(cache=True, nogil=True, error_model="numpy")
def grow_ground(
    index: CellIndex,
    z: NDArray[np.float32],
    level: NDArray[np.bool_],
    rules: GroundRules,
    ground: NDArray[np.bool_],
    queue: NDArray[np.int32],
) -> None:
    """Go on from ground to level cells beside it that are not a step away.

    Args:
        index: Of the cells, (C,).
        z: Mean height of the returns of each [m], (C,).
        level: Whether each may be ground, (C,).
        rules: The rules.
        ground: Where to begin; receives all cells of the ground, (C,).
        queue: Memory to work in, (C,).
    """
    stop = 0
    for n in range(len(ground)):
        if ground[n]:
            queue[stop] = n
            stop += 1
    at, rise = 0, np.int64(np.ceil(rules.step_m / rules.height_m))
    while at < stop:
        own: Any = np.int64(queue[at])
        at += 1
        i, j, k = numbers_of(index.key[own])
        for di in range(-rules.reach, rules.reach + 1):
            for dj in range(-rules.reach, rules.reach + 1):
                for dk in range(-rise, rise + 1):
                    row = find_row(index, key_at(i + di, j + dj, k + dk))
                    if row < 0 or ground[row] or not level[row]:
                        continue
                    if abs(z[row] - z[own]) <= rules.step_m:
                        ground[row] = True
                        queue[stop] = row
                        stop += 1


@njit(cache=True, nogil=True, error_model="numpy")
def ground_below(
    index: CellIndex, height: NDArray[np.float32], p: tuple[float, float, float], most: int
) -> float:
    """Height of the ground below a place, by cubes of one meter.

    Args:
        index: Of the cubes with ground, (G,).
        height: Of the ground in each [m], (G,).
        p: The place [m].
        most: Cubes that are looked at downwards.

    Returns:
        The height [m]; NaN = there is none.
    """
    i, j = np.int64(np.floor(p[0])), np.int64(np.floor(p[1]))
    # Ground may be a little higher than what lies on it, where it slopes.
    highest = p[2] + 0.5
    top = np.int64(np.floor(highest))
    for k in range(top, top - most, -1):
        row = find_row(index, key_at(i, j, k))
        if row >= 0 and height[row] <= highest:
            return float(height[row])
    return np.nan


@njit(cache=True, nogil=True, error_model="numpy")
def heights_over(
    index: CellIndex,
    height: NDArray[np.float32],
    p_map: NDArray[np.float64],
    ceiling: NDArray[np.bool_],
    most: int,
    out: NDArray[np.float32],
) -> None:
    """Heights of places over the ground below [m].

    Args:
        index: Of the cubes with ground, (G,).
        height: Of the ground in each [m], (G,).
        p_map: The places [m], (N, 3).
        ceiling: Places of ceilings: the ground right above them is another one's, (N,).
        most: Cubes that are looked at downwards.
        out: Receives the heights, NaN = there is no ground, (N,).
    """
    for n in range(len(p_map)):
        z = p_map[n, 2] - (1.0 if ceiling[n] else 0.0)
        p = p_map[n, 0], p_map[n, 1], z
        out[n] = p_map[n, 2] - ground_below(index, height, p, most)
