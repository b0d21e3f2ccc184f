"""Kernels of the stage ``classes``: at which points other scans of the walk see through."""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import numpy as np
from numba import njit
from numpy.typing import NDArray

from recon4.kernels.cell_table import place_of
from recon4.kernels.free_space import (
    VERDICT,
    Sights,
    cell_towards,
    column_beside,
    sight,
    to_sensor,
)

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
    confirmed: float
    """Where scans also meet a surface, as many meet the end of a beam that sees through for each
    that has something before it."""


class PlaceEvidence(NamedTuple):
    """What other scans say of a place, from what stands to what moved."""

    stands: int = 1
    """Many scans meet a surface there, and none sees through."""
    met: int = 2
    doubted: int = 3
    """Some scans see through, too, but too few."""
    unknown: int = 4
    glimpsed: int = 5
    """Too few scans see through, and none meets a surface."""
    moved: int = 6


EVIDENCE = PlaceEvidence()


@njit(cache=True, nogil=True, error_model="numpy", inline="always")
def _limits(range_m: float, rules: SightRules) -> tuple[float, float]:
    """How far everything behind a place lies, and a surface that is met there [m]."""
    return (
        rules.behind_m + rules.behind_per_m * range_m,
        rules.same_m + rules.same_per_m * range_m,
    )


@njit(cache=True, nogil=True, error_model="numpy", inline="always")
def _vote(p: Place, own: int, v: int, views: RangeViews, rules: SightRules) -> int:
    """What a scan says of a place: one of `VERDICT`."""
    return _look(p, (v, own), views, rules, False)


@njit(cache=True, nogil=True, error_model="numpy", inline="always")
def _look(
    p: Place, scan: tuple[int, int], views: RangeViews, rules: SightRules, asks_hidden: bool
) -> int:
    """What a scan says of a place: one of `VERDICT`, hidden in place of unknown only if asked.

    It meets a surface if one of its sensors does: that which measured the point is asked first.
    """
    (v, own), images = scan, views.sights.images
    shape, sensors = images.shape[2:], images.shape[1]
    vote, is_hidden = VERDICT.unknown, False
    for other in range(sensors):
        s = (own + other) % sensors
        x, y, z = to_sensor(p, views.sights, v, s)
        flat = math.sqrt(x * x + y * y)
        if z < views.slopes[v, s, 0] * flat or z > views.slopes[v, s, 1] * flat:
            continue
        # Angles are dear: most places that are too far need none.
        range_m = math.sqrt(flat * flat + z * z)
        is_near = rules.nearest_m <= range_m <= rules.farthest_m
        if not (is_near or asks_hidden):
            continue
        row, column, _ = cell_towards(x, y, z, shape)
        limits = _limits(range_m, rules)
        if is_near:
            seen = sight(images, (v, s), (row, column), range_m, limits)
            if seen == VERDICT.met:
                return VERDICT.met
            vote = max(vote, seen)
        if asks_hidden and not is_hidden and vote == VERDICT.unknown:
            is_hidden = _is_before(images, (v, s), (row, column), range_m - limits[0])
    return VERDICT.hidden if is_hidden and vote == VERDICT.unknown else vote


@njit(cache=True, nogil=True, error_model="numpy")
def _evidence(p: Place, own: int, views: RangeViews, rules: SightRules) -> int:
    """Whether more scans see through a place than meet a surface there, or it was left for good."""
    passes: Any = 0
    meets: Any = 0
    for v in views.asked:
        vote = _vote(p, own, v, views, rules)
        passes += vote == VERDICT.seen_through
        meets += vote == VERDICT.met
        if passes - meets >= rules.surely_moved or meets - passes >= rules.surely_met:
            break
    if meets == 0:
        if passes >= rules.enough:
            return int(EVIDENCE.moved)
        return int(EVIDENCE.glimpsed if passes else EVIDENCE.unknown)
    if passes >= rules.enough and _moved_surely(p, own, meets, views, rules):
        return int(EVIDENCE.moved)
    gone = max(
        _is_empty(p, own, views.after, views, rules), _is_empty(p, own, views.before, views, rules)
    )
    if gone == EVIDENCE.met and passes == 0:
        return int(EVIDENCE.stands if meets >= rules.surely_met else EVIDENCE.met)
    return int(max(gone, EVIDENCE.doubted))


@njit(cache=True, nogil=True, error_model="numpy")
def _moved_surely(p: Place, own: int, meets: int, views: RangeViews, rules: SightRules) -> bool:
    """Whether enough scans see through a place with beams whose ends others confirm."""
    sure: Any = 0
    for v in views.asked:
        if _vote(p, own, v, views, rules) == VERDICT.seen_through:
            sure += _is_confirmed(p, v, views, rules)
            if sure >= rules.enough and sure > rules.least_ratio * meets:
                return True
    return False


@njit(cache=True, nogil=True, error_model="numpy")
def _is_confirmed(p: Place, v: int, views: RangeViews, rules: SightRules) -> bool:
    """Whether other scans meet the end of the beam with which a scan sees through a place.

    A beam that a small mirror reflects has the range of its whole path. Its end seems to lie
    beyond a wall, which hides it from nearly all others.
    """
    end, found = _end_of_beam(p, v, views, rules)
    if not found:
        return False
    meets: Any = 0
    hides: Any = 0
    left: Any = len(views.asked)
    for w in views.asked:
        left -= 1
        if w == v:
            continue
        vote = _look(end, (w, 0), views, rules, True)
        meets += vote == VERDICT.met
        hides += vote == VERDICT.hidden
        if meets - rules.confirmed * hides >= rules.surely_met:
            return True
        # What is left changes nothing.
        if meets >= rules.confirmed * (hides + left):
            return True
        if meets + left < rules.confirmed * hides:
            return False
    return bool(meets >= rules.confirmed * hides)


@njit(cache=True, nogil=True, error_model="numpy")
def _end_of_beam(p: Place, v: int, views: RangeViews, rules: SightRules) -> tuple[Place, bool]:
    """Where the beam of a scan through a place ends, and whether there is one."""
    images, t = views.sights.images, views.sights.t
    for s in range(images.shape[1]):
        x, y, z = to_sensor(p, views.sights, v, s)
        row, column, range_m = cell_towards(x, y, z, images.shape[2:])
        if not rules.nearest_m <= range_m <= rules.farthest_m:
            continue
        limits = _limits(range_m, rules)
        if sight(images, (v, s), (row, column), range_m, limits) == VERDICT.seen_through:
            seen_m = images[v, s, row, column]
            if seen_m == np.inf:
                seen_m = _nearest(images, (v, s), (row, column))
            part = seen_m / range_m
            x, y, z = t[v, s, 0], t[v, s, 1], t[v, s, 2]
            end = x + part * (p[0] - x), y + part * (p[1] - y), z + part * (p[2] - z)
            return end, True
    return p, False


@njit(cache=True, nogil=True, error_model="numpy")
def _nearest(images: NDArray[np.float32], image: tuple[int, int], cell: tuple[int, int]) -> float:
    """Least range of a cell and those around it [m], inf = they are empty."""
    nearest_m = np.inf
    (v, s), (row, column) = image, cell
    rows, columns = images.shape[2:]
    for i in range(max(row - 1, 0), min(row + 2, rows)):
        for step in range(-1, 2):
            nearest_m = min(nearest_m, images[v, s, i, column_beside(column, step, columns)])
    return nearest_m


@njit(cache=True, nogil=True, error_model="numpy")
def _is_before(
    images: NDArray[np.float32], image: tuple[int, int], cell: tuple[int, int], limit_m: float
) -> bool:
    """Whether a cell has a return, and all that it and those around it have are this near."""
    (v, s), (row, column) = image, cell
    if images[v, s, row, column] >= limit_m:
        return False
    rows, columns = images.shape[2:]
    for i in range(max(row - 1, 0), min(row + 2, rows)):
        for step in range(-1, 2):
            if limit_m < images[v, s, i, column_beside(column, step, columns)] < np.inf:
                return False
    return True


@njit(cache=True, nogil=True, error_model="numpy")
def _is_empty(
    p: Place,
    own: int,
    rows: NDArray[np.int64],
    views: RangeViews,
    rules: SightRules,
) -> int:
    """Whether the first of some scans that see a place see through it, one after the other.

    Returns:
        `EVIDENCE.moved`; doubted, if too few of their beams are confirmed; met = no.
    """
    passes: Any = 0
    for v in rows:
        vote = _vote(p, own, v, views, rules)
        passes += vote == VERDICT.seen_through
        if vote == VERDICT.met or passes >= rules.gone:
            break
    if passes < rules.gone:
        return int(EVIDENCE.met)
    # Most places end above: beams are confirmed only where there are enough.
    sure: Any = 0
    for v in rows:
        vote = _vote(p, own, v, views, rules)
        if vote == VERDICT.met:
            break
        sure += vote == VERDICT.seen_through and _is_confirmed(p, v, views, rules)
        if sure >= rules.gone:
            return int(EVIDENCE.moved)
    return int(EVIDENCE.doubted)


@njit(cache=True, nogil=True, error_model="numpy")
def find_seen_through(
    p: NDArray[np.float64],
    sensor: NDArray[np.uint8],
    views: RangeViews,
    rules: SightRules,
    held: NDArray[np.int64],
    evidence: NDArray[np.int8],
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
        evidence: Of `EVIDENCE`, filled, (N,).
    """
    size, bits = len(held), (1 << 20) - 1  # of an index of a cube
    room: Any = 3 * size // 4 - np.count_nonzero(held)
    last_key: Any = np.int64(-1)
    last: Any = EVIDENCE.unknown
    for n in range(len(p)):
        i = np.int64(math.floor(p[n, 0] / rules.place_m))
        j = np.int64(math.floor(p[n, 1] / rules.place_m))
        k = np.int64(math.floor(p[n, 2] / rules.place_m))
        key = ((i & bits) << 40) | ((j & bits) << 20) | (k & bits)
        if key != last_key:
            # Mixed bits: streets repeat low ones, and with these alone, searches were long.
            at = place_of(key, size - 1)
            while held[at] != 0 and held[at] >> 3 != key:
                at = (at + 1) & (size - 1)
            if held[at] == 0:
                if room == 0:
                    held[:] = 0
                    room = 3 * size // 4
                place = p[n, 0], p[n, 1], p[n, 2]
                held[at] = (key << 3) | _evidence(place, sensor[n], views, rules)
                room -= 1
            last_key, last = key, held[at] & 7
        evidence[n] = last


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
