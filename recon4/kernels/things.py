"""Kernels of the stage ``classes``: things move as a whole, with what no scan sees through."""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import numpy as np
from numba import njit
from numpy.typing import NDArray

from recon4.kernels.free_space import VERDICT
from recon4.kernels.seen_through import EVIDENCE, Place


class JudgedPoints(NamedTuple):
    """Points of a scan, and what other scans say of them."""

    p: NDArray[np.float64]
    """In the leveled map [m], (N, 3)."""
    evidence: NDArray[np.int8]
    """Of `EVIDENCE`, (N,)."""
    verdict: NDArray[np.int8]
    """Of `VERDICT`, (N,)."""


class SpreadRules(NamedTuple):
    """What belongs to a moving thing although no scan sees through it, or the floor hides it."""

    cube_m: float
    """Edge of the cubes in which points are counted."""
    few: int
    """Moving points in the cubes around, or above, that are needed."""
    most: float
    """All of a cube moves if it has this many moving points for each met one …"""
    stands: float
    """… and nothing does if it has this many met ones for each moving one."""
    floor_m: float
    """The floor reaches this far above its lowest point around …"""
    feet_m: float
    """… and surfaces below something that moves are its feet up to this far above …"""
    legs_m: float
    """… and what no scan meets is its legs."""
    above: int
    """This many cubes above a point are looked at."""


class Cubes(NamedTuple):
    """Cubes around the body, which is in the middle."""

    moving: NDArray[np.int32]
    met: NDArray[np.int32]
    """Points in them that move, and that others meet, (I, J, K): all points of a scan may lie in
    one cube."""
    low_m: NDArray[np.float32]
    """Lowest point of each column [m], (I, J)."""
    floor_m: NDArray[np.float32]
    """Lowest point around each column [m], (I, J)."""
    near: NDArray[np.bool_]
    """Whether something moves in a column or beside it, (I, J)."""


@njit(cache=True, nogil=True, error_model="numpy")
def spread_to_neighbors(
    points: JudgedPoints, body_m: NDArray[np.float64], rules: SpreadRules, cubes: Cubes
) -> None:
    """Let neighbors decide: a thing moves as a whole.

    Points near to several that move also move if no scan meets them: hands, seams. So do points
    below them, between them and the floor: beams that pass above the floor meet it just behind a
    foot.

    Args:
        points: Their verdicts are filled.
        body_m: Where the body was [m], (3,).
        rules: Limits.
        cubes: Memory, its content does not matter.
    """
    p, evidence, verdict = points
    at, shape = np.empty(3, np.int64), cubes.moving.shape
    cubes.moving[:] = 0
    cubes.met[:] = 0
    cubes.low_m[:] = np.inf
    cubes.near[:] = False
    for n in range(len(p)):
        verdict[n] = VERDICT.met if evidence[n] <= EVIDENCE.doubted else VERDICT.unknown
        if evidence[n] == EVIDENCE.moved:
            verdict[n] = VERDICT.seen_through
        if _cube_of((p[n, 0], p[n, 1], p[n, 2]), body_m, rules.cube_m, shape, at):
            i, j, k = at[0], at[1], at[2]
            cubes.low_m[i, j] = min(cubes.low_m[i, j], p[n, 2])
            cubes.met[i, j, k] += verdict[n] == VERDICT.met
            if verdict[n] == VERDICT.seen_through:
                if cubes.moving[i, j, k] == 0:
                    cubes.near[i - 1 : i + 2, j - 1 : j + 2] = True
                cubes.moving[i, j, k] += 1
    for n in range(len(p)):
        is_inside = _cube_of((p[n, 0], p[n, 1], p[n, 2]), body_m, rules.cube_m, shape, at)
        if is_inside and cubes.near[at[0], at[1]]:
            verdict[n] = _by_neighbors(verdict[n], p[n, 2], at, rules, cubes)


@njit(cache=True, nogil=True, error_model="numpy")
def _by_neighbors(
    verdict: int, z_m: float, at: NDArray[np.int64], rules: SpreadRules, cubes: Cubes
) -> int:
    """Verdict of a point by those in the cubes around it, and above."""
    i, j, k = at[0], at[1], at[2]
    moving, met = cubes.moving[i, j, k], cubes.met[i, j, k]
    if verdict == VERDICT.seen_through:
        return VERDICT.met if met > rules.stands * moving else verdict
    if verdict == VERDICT.met and moving >= rules.few and moving > rules.most * met:
        return VERDICT.seen_through
    if verdict == VERDICT.unknown and _around(cubes.moving, at) >= rules.few:
        return VERDICT.seen_through
    above: Any = 0
    for higher in range(k + 1, min(k + 1 + rules.above, cubes.moving.shape[2])):
        above += cubes.moving[i, j, higher]
    if above < rules.few:
        return verdict
    floor_m = np.float64(np.inf)
    for a in range(i - 1, i + 2):
        for b in range(j - 1, j + 2):
            floor_m = min(floor_m, cubes.low_m[a, b])
    reach_m = rules.feet_m if verdict == VERDICT.met else rules.legs_m
    is_below = rules.floor_m < z_m - floor_m < reach_m
    return VERDICT.seen_through if is_below else verdict


@njit(cache=True, nogil=True, error_model="numpy")
def _around(count: NDArray[np.int32], at: NDArray[np.int64]) -> int:
    """Points in the 27 cubes around one."""
    found: Any = 0
    for i in range(at[0] - 1, at[0] + 2):
        for j in range(at[1] - 1, at[1] + 2):
            for k in range(at[2] - 1, at[2] + 2):
                found += count[i, j, k]
    return int(found)


@njit(cache=True, nogil=True, error_model="numpy")
def _cube_of(
    p: Place,
    body_m: NDArray[np.float64],
    cube_m: float,
    shape: tuple[int, int, int],
    at: NDArray[np.int64],
) -> bool:
    """Cube of a point; False = it is in the outermost ones or beyond."""
    for d in range(3):
        at[d] = math.floor((p[d] - body_m[d]) / cube_m) + shape[d] // 2
        if at[d] < 1 or at[d] > shape[d] - 2:
            return False
    return True


class ThingRules(NamedTuple):
    """When all of a connected thing moves."""

    cube_m: float
    """Edge of the cubes in which points are connected."""
    floor_m: float
    """The floor reaches this far above its lowest point …"""
    around: int
    """… in this many columns of cubes to each side."""
    few: int
    surely: float
    """Moving points that are needed, and their part of its points."""
    share: float
    """Part of its points that move or are in doubt."""


@njit(cache=True, nogil=True, error_model="numpy")
def move_as_things(
    points: JudgedPoints,
    chosen: NDArray[np.bool_],
    body_m: NDArray[np.float64],
    rules: ThingRules,
    cubes: Cubes,
) -> None:
    """Let connected things decide: if enough of one moves, all of it does, but what surely stands.

    What stays in one place for a while is met there, and hides what is behind it.

    Args:
        points: Their verdicts are changed.
        chosen: Which points things consist of, (N,).
        body_m: Where the body was [m], (3,).
        rules: Limits.
        cubes: With the lowest points of `spread_to_neighbors`; the counts are overwritten.
    """
    p, evidence, verdict = points
    if _count_moving(verdict, chosen) < rules.few:
        return
    label, cube = cubes.moving, np.full((len(p), 3), -1, np.int64)
    label[:] = -1
    _find_floor(cubes, rules.around)
    for n in range(len(p)):
        at, is_part = cube[n], chosen[n]
        if is_part and _cube_of((p[n, 0], p[n, 1], p[n, 2]), body_m, rules.cube_m, label.shape, at):
            is_part = p[n, 2] - cubes.floor_m[at[0], at[1]] >= rules.floor_m
        else:
            is_part = False
        if is_part:
            label[at[0], at[1], at[2]] = 0
        else:
            at[0] = -1
    sums = np.zeros((_connect(cube, label) + 1, 4), np.int64)
    for n in range(len(p)):
        if cube[n, 0] >= 0:
            _count(evidence[n], verdict[n], sums[label[cube[n, 0], cube[n, 1], cube[n, 2]]])
    for n in range(len(p)):
        i, j, k = cube[n, 0], cube[n, 1], cube[n, 2]
        if i >= 0 and evidence[n] != EVIDENCE.stands and _moves(sums[label[i, j, k]], rules):
            verdict[n] = VERDICT.seen_through


@njit(cache=True, nogil=True, error_model="numpy")
def _count_moving(verdict: NDArray[np.int8], chosen: NDArray[np.bool_]) -> int:
    moving: Any = 0
    for n in range(len(verdict)):
        moving += chosen[n] and verdict[n] == VERDICT.seen_through
    return int(moving)


@njit(cache=True, nogil=True, error_model="numpy")
def _count(evidence: int, verdict: int, sums: NDArray[np.int64]) -> None:
    """Add a point to those of its thing: all, that move, that move or are in doubt, that stand."""
    moves = verdict == VERDICT.seen_through
    sums[0] += 1
    sums[1] += moves
    sums[2] += moves or evidence == EVIDENCE.doubted or evidence == EVIDENCE.glimpsed
    sums[3] += evidence == EVIDENCE.stands


@njit(cache=True, nogil=True, error_model="numpy")
def _moves(sums: NDArray[np.int64], rules: ThingRules) -> bool:
    """Whether a thing moves, by its counts: few of it may surely stand."""
    is_moving = sums[1] >= rules.few and sums[1] >= rules.surely * sums[0]
    return bool(is_moving and sums[2] > rules.share * sums[0] and sums[2] > sums[3])


@njit(cache=True, nogil=True, error_model="numpy")
def _find_floor(cubes: Cubes, around: int) -> None:
    """Write the lowest point around each column that has points."""
    low_m = cubes.low_m
    for i in range(low_m.shape[0]):
        for j in range(low_m.shape[1]):
            floor_m = low_m[i, j]
            if floor_m < np.inf:
                for a in range(max(i - around, 0), min(i + around + 1, low_m.shape[0])):
                    for b in range(max(j - around, 0), min(j + around + 1, low_m.shape[1])):
                        floor_m = min(floor_m, low_m[a, b])
            cubes.floor_m[i, j] = floor_m


@njit(cache=True, nogil=True, error_model="numpy")
def _connect(cube: NDArray[np.int64], label: NDArray[np.int32]) -> int:
    """Number connected cubes from 1 on, in place of 0.

    Args:
        cube: Of each point, the first number is -1 = of none; never an outermost one, (N, 3).
        label: 0 = has points, -1 = has none, (I, J, K).

    Returns:
        How many things there are.
    """
    things: Any = 0
    stack = np.empty((len(cube), 3), np.int64)
    for n in range(len(cube)):
        i, j, k = cube[n, 0], cube[n, 1], cube[n, 2]
        if i < 0 or label[i, j, k] != 0:
            continue
        things += 1
        label[i, j, k] = things
        stack[0] = cube[n]
        top: Any = 1
        while top > 0:
            top -= 1
            i, j, k = stack[top, 0], stack[top, 1], stack[top, 2]
            for a in range(i - 1, i + 2):
                for b in range(j - 1, j + 2):
                    for c in range(k - 1, k + 2):
                        if label[a, b, c] == 0:
                            label[a, b, c] = things
                            stack[top, 0], stack[top, 1], stack[top, 2] = a, b, c
                            top += 1
    return int(things)
