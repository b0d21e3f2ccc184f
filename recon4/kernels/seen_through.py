"""Kernels of the stage ``classes``: at which points other scans of the walk see through."""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import numpy as np
from numba import njit
from numpy.typing import NDArray

from recon4.kernels.free_space import VERDICT, cell_of, sight


class RangeViews(NamedTuple):
    """Scans of S sensors as images of ranges; V of M are asked."""

    asked: NDArray[np.int64]
    """Rows of those that are asked, in this order, (V,)."""
    R: NDArray[np.float64]
    """Rotations of the sensors in the map, (M, S, 3, 3)."""
    t: NDArray[np.float64]
    """Their places [m], (M, S, 3)."""
    images: NDArray[np.float32]
    """Of `free_space.nearest_ranges`, (M, S, rows, columns) [m]."""


class SightRules(NamedTuple):
    """When a scan sees through a point, and when it meets a surface there."""

    behind_m: float
    """Everything around its direction lies this far behind a point that is seen through …"""
    behind_per_m: float
    """… and this times its range."""
    same_m: float
    """A surface is met if a return lies within this of the point …"""
    same_per_m: float
    """… and this times its range."""
    nearest_m: float
    farthest_m: float
    """Range of points that are compared."""
    enough: int
    """As many more scans see through a moving point than meet a surface there …"""
    surely_met: int
    """… and as many more meet it than see through; then no more are asked."""
    least_ratio: float
    """If all are asked, as many see through a moving point for each that meets it."""
    apart_m: float
    """Points between two of the same ring are like both if these are nearer to each other."""
    every: int
    """Of the points of a ring, one of this many is compared first."""


@njit(cache=True, nogil=True, error_model="numpy")
def _verdict(p: NDArray[np.float64], own: int, views: RangeViews, rules: SightRules) -> int:
    """Whether more scans see through a point than meet a surface there.

    A scan meets a surface if one of its sensors does: that which measured the point is asked first.
    """
    shape, sensors = views.images.shape[2:], views.images.shape[1]
    passes = meets = 0
    for v in views.asked:
        vote = VERDICT.unknown
        for other in range(sensors):
            s = (own + other) % sensors
            row, column, range_m = cell_of(p, views.R[v, s], views.t[v, s], shape)
            if range_m < rules.nearest_m or range_m > rules.farthest_m:
                continue
            limits = (
                rules.behind_m + rules.behind_per_m * range_m,
                rules.same_m + rules.same_per_m * range_m,
            )
            seen = sight(views.images[v, s], row, column, range_m, limits)
            if seen == VERDICT.met:
                vote = VERDICT.met
                break
            vote = max(vote, seen)
        passes += vote == VERDICT.seen_through
        meets += vote == VERDICT.met
        if passes - meets >= rules.enough or meets - passes >= rules.surely_met:
            break
    if passes >= rules.enough and passes > rules.least_ratio * meets:
        return VERDICT.seen_through
    return VERDICT.met if meets > 0 else VERDICT.unknown


@njit(cache=True, nogil=True, error_model="numpy")
def find_seen_through(
    p: NDArray[np.float64],
    ring: NDArray[np.uint8],
    sensor: NDArray[np.uint8],
    views: RangeViews,
    rules: SightRules,
    verdict: NDArray[np.int8],
) -> None:
    """Which points of a scan other scans see through.

    Args:
        p: In the map, in the order of measurement [m], (N, 3).
        ring: Beam of its sensor that measured each, (N,).
        sensor: Number of its sensor, (N,).
        views: Other scans.
        rules: Limits.
        verdict: Of `VERDICT`, filled, (N,).
    """
    count, beams = len(p), 256 * views.images.shape[1]
    since, last = np.zeros(beams, np.int64), np.full(beams, -1, np.int64)
    before, after = np.full(count, -1, np.int64), np.full(count, -1, np.int64)
    for n in range(count):
        b = 256 * np.int64(sensor[n]) + ring[n]
        if since[b] % rules.every == 0:
            verdict[n] = _verdict(p[n], sensor[n], views, rules)
            last[b] = n
        before[n] = last[b]
        since[b] += 1
    last[:] = -1
    for n in range(count - 1, -1, -1):
        b = 256 * np.int64(sensor[n]) + ring[n]
        if before[n] == n:
            last[b] = n
        after[n] = last[b]
    for n in range(count):
        i, j = before[n], after[n]
        if i == n:
            continue
        like = j >= 0 and verdict[i] == verdict[j]
        if like and _apart(p[i], p[j]) < rules.apart_m and _apart(p[i], p[n]) < rules.apart_m:
            verdict[n] = verdict[i]
        else:
            verdict[n] = _verdict(p[n], sensor[n], views, rules)


@njit(cache=True, nogil=True, error_model="numpy")
def _apart(a: NDArray[np.float64], b: NDArray[np.float64]) -> float:
    x, y, z = a[0] - b[0], a[1] - b[1], a[2] - b[2]
    return math.sqrt(x * x + y * y + z * z)


@njit(cache=True, nogil=True, error_model="numpy")
def spread_to_neighbors(
    p: NDArray[np.float64],
    verdict: NDArray[np.int8],
    cube_m: float,
    few: int,
    count: NDArray[np.int16],
    moving: NDArray[np.bool_],
) -> None:
    """Moving points, and those near to several that no scan meets: feet, hands, seams.

    Args:
        p: In the body [m], (N, 3).
        verdict: Of `find_seen_through`, (N,).
        cube_m: Edge of the cubes in which moving points are counted [m].
        few: Moving points in the cubes around that are needed.
        count: Zeros, and zeros again afterwards; the body is in its middle, (I, J, K).
        moving: Filled, (N,).
    """
    at = np.empty(3, np.int64)
    for n in range(len(p)):
        moving[n] = verdict[n] == VERDICT.seen_through
        if moving[n] and _cube(p[n], cube_m, count.shape, at):
            count[at[0], at[1], at[2]] += 1
    for n in range(len(p)):
        if verdict[n] != VERDICT.unknown or not _cube(p[n], cube_m, count.shape, at):
            continue
        found: Any = 0
        for i in range(at[0] - 1, at[0] + 2):
            for j in range(at[1] - 1, at[1] + 2):
                for k in range(at[2] - 1, at[2] + 2):
                    found += count[i, j, k]
        moving[n] = found >= few
    for n in range(len(p)):
        if verdict[n] == VERDICT.seen_through and _cube(p[n], cube_m, count.shape, at):
            count[at[0], at[1], at[2]] = 0


@njit(cache=True, nogil=True, error_model="numpy")
def _cube(
    p: NDArray[np.float64], cube_m: float, shape: tuple[int, int, int], at: NDArray[np.int64]
) -> bool:
    """Cube of a point; False = it is in the outermost ones or beyond."""
    for d in range(3):
        at[d] = math.floor(p[d] / cube_m) + shape[d] // 2
        if at[d] < 1 or at[d] > shape[d] - 2:
            return False
    return True
