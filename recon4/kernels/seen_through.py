"""Kernels of the stage ``classes``: at which points other scans of the walk see through."""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import numpy as np
from numba import njit
from numpy.typing import NDArray

from recon4.kernels.free_space import VERDICT, Sights, cell_towards, sight, to_sensor

Place = tuple[float, float, float]


class RangeViews(NamedTuple):
    """Scans of S sensors as images of ranges; V of M are asked."""

    asked: NDArray[np.int64]
    """Rows of those that are asked, in this order, (V,)."""
    before: NDArray[np.int64]
    after: NDArray[np.int64]
    """Rows of those before and after, the farthest in time first, (B,) and (A,)."""
    sights: Sights
    """All M of them."""
    slopes: NDArray[np.float64]
    """Least and largest slope, z through x and y, of what they see, (M, S, 2)."""


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
    """As many scans see through a moving point."""
    surely_moved: int
    surely_met: int
    """If as many more see through than meet it, or meet it than see through, no more are asked."""
    gone: int
    """What stands until it drives off is gone if the last scans, this many of them, see
    through."""
    least_ratio: float
    """If all are asked, as many see through a moving point for each that meets it."""
    place_m: float
    """Edge of the cubes of which all points are like the first."""


@njit(cache=True, nogil=True, error_model="numpy", inline="always")
def _vote(p: Place, own: int, v: int, views: RangeViews, rules: SightRules) -> int:
    """What a scan says of a place.

    It meets a surface if one of its sensors does: that which measured the point is asked first.
    """
    images = views.sights.images
    shape, sensors = images.shape[2:], images.shape[1]
    vote = VERDICT.unknown
    for other in range(sensors):
        s = (own + other) % sensors
        x, y, z = to_sensor(p, views.sights, v, s)
        flat = math.sqrt(x * x + y * y)
        if z < views.slopes[v, s, 0] * flat or z > views.slopes[v, s, 1] * flat:
            continue
        row, column, range_m = cell_towards(x, y, z, shape)
        if range_m < rules.nearest_m or range_m > rules.farthest_m:
            continue
        limits = (
            rules.behind_m + rules.behind_per_m * range_m,
            rules.same_m + rules.same_per_m * range_m,
        )
        seen = sight(images, (v, s), (row, column), range_m, limits)
        if seen == VERDICT.met:
            return VERDICT.met
        vote = max(vote, seen)
    return vote


@njit(cache=True, nogil=True, error_model="numpy")
def _verdict(p: Place, own: int, views: RangeViews, rules: SightRules) -> int:
    """Whether more scans see through a place than meet a surface there, or it was left for good."""
    passes = meets = 0
    for v in views.asked:
        vote = _vote(p, own, v, views, rules)
        passes += vote == VERDICT.seen_through
        meets += vote == VERDICT.met
        if passes - meets >= rules.surely_moved or meets - passes >= rules.surely_met:
            break
    if passes >= rules.enough and passes > rules.least_ratio * meets:
        return VERDICT.seen_through
    if meets == 0:
        return VERDICT.unknown
    is_gone = _is_empty(p, own, views.after, views, rules) or _is_empty(
        p, own, views.before, views, rules
    )
    return VERDICT.seen_through if is_gone else VERDICT.met


@njit(cache=True, nogil=True, error_model="numpy")
def _is_empty(
    p: Place,
    own: int,
    rows: NDArray[np.int64],
    views: RangeViews,
    rules: SightRules,
) -> bool:
    """Whether the first of some scans that see a place see through it, one after the other."""
    passes = 0
    for v in rows:
        vote = _vote(p, own, v, views, rules)
        if vote == VERDICT.met:
            return False
        passes += vote == VERDICT.seen_through
        if passes >= rules.gone:
            return True
    return False


@njit(cache=True, nogil=True, error_model="numpy")
def find_seen_through(
    p: NDArray[np.float64],
    sensor: NDArray[np.uint8],
    views: RangeViews,
    rules: SightRules,
    held: NDArray[np.int64],
    verdict: NDArray[np.int8],
) -> None:
    """Which points of some scans other scans see through.

    What other scans say of a place they say of all points in it: the first point of each cube of
    `SightRules.place_m` is compared.

    Args:
        p: In the map, in the order of measurement [m], (N, 3).
        sensor: Number of the sensor of each, (N,).
        views: Other scans.
        rules: Limits.
        held: What is known of places, zeros at first, for further calls with the same scans; a
            power of two. When three quarters are full all is forgotten, (H,).
        verdict: Of `VERDICT`, filled, (N,).
    """
    size, bits = len(held), (1 << 20) - 1  # of an index of a cube
    room: Any = 3 * size // 4 - np.count_nonzero(held)
    last_key: Any = np.int64(-1)
    last_verdict: Any = VERDICT.unknown
    for n in range(len(p)):
        i = np.int64(math.floor(p[n, 0] / rules.place_m))
        j = np.int64(math.floor(p[n, 1] / rules.place_m))
        k = np.int64(math.floor(p[n, 2] / rules.place_m))
        key = ((i & bits) << 40) | ((j & bits) << 20) | (k & bits)
        if key != last_key:
            # Neighbors are near to each other in the table, too.
            at = ((i & 127) | ((j & 127) << 7) | (k << 14)) & (size - 1)
            while held[at] != 0 and held[at] >> 2 != key:
                at = (at + 1) & (size - 1)
            if held[at] == 0:
                if room == 0:
                    held[:] = 0
                    room = 3 * size // 4
                place = p[n, 0], p[n, 1], p[n, 2]
                known = 2 + _verdict(place, sensor[n], views, rules)
                held[at] = (key << 2) | known
                room -= 1
            last_key, last_verdict = key, (held[at] & 3) - 2
        verdict[n] = last_verdict


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


@njit(cache=True, nogil=True, error_model="numpy")
def spread_to_neighbors(
    p: NDArray[np.float64],
    body_m: NDArray[np.float64],
    rules: SpreadRules,
    cubes: Cubes,
    verdict: NDArray[np.int8],
) -> None:
    """Let neighbors decide: a thing moves as a whole.

    Points near to several that move also move if no scan meets them: hands, seams. So do points
    below them, between them and the floor: beams that pass above the floor meet it just behind a
    foot.

    Args:
        p: In the leveled map [m], (N, 3).
        body_m: Where the body was [m], (3,).
        rules: Limits.
        cubes: Memory, its content does not matter.
        verdict: Of `find_seen_through`, changed, (N,).
    """
    at, shape = np.empty(3, np.int64), cubes.moving.shape
    cubes.moving[:] = 0
    cubes.met[:] = 0
    cubes.low_m[:] = np.inf
    for n in range(len(p)):
        if _cube((p[n, 0], p[n, 1], p[n, 2]), body_m, rules.cube_m, shape, at):
            i, j, k = at[0], at[1], at[2]
            cubes.low_m[i, j] = min(cubes.low_m[i, j], p[n, 2])
            cubes.moving[i, j, k] += verdict[n] == VERDICT.seen_through
            cubes.met[i, j, k] += verdict[n] == VERDICT.met
    for n in range(len(p)):
        if _cube((p[n, 0], p[n, 1], p[n, 2]), body_m, rules.cube_m, shape, at):
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
def _cube(
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


@njit(cache=True, nogil=True, error_model="numpy")
def points_in_body(
    xyz: NDArray[np.float32],
    sensor: NDArray[np.uint8],
    R: NDArray[np.float64],
    t: NDArray[np.float64],
    limits: NDArray[np.float64],
    rows: NDArray[np.int64],
    p_body: NDArray[np.float64],
) -> int:
    """Find the points in an upright cylinder around the body.

    Args:
        xyz: In the frames of their sensors [m], (N, 3).
        sensor: Number of the sensor of each, (N,).
        R: Rotations of the sensors in the body, (S, 3, 3).
        t: Their places [m], (S, 3).
        limits: Its radius, bottom and top [m], (3,).
        rows: Receives the rows of the points, (N,).
        p_body: Receives them in the body [m], (N, 3).

    Returns:
        How many there are.
    """
    found = 0
    for n in range(len(xyz)):
        s, x, y, z = sensor[n], xyz[n, 0], xyz[n, 1], xyz[n, 2]
        for i in range(3):
            p_body[found, i] = R[s, i, 0] * x + R[s, i, 1] * y + R[s, i, 2] * z + t[s, i]
        a, b, c = p_body[found, 0], p_body[found, 1], p_body[found, 2]
        if a * a + b * b < limits[0] ** 2 and limits[1] < c < limits[2]:
            rows[found] = n
            found += 1
    return found
