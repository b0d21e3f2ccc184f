"""Kernels of large things: planes of buildings, and what grows."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from numba import njit
from numpy.typing import NDArray

from recon4.kernels.cell_table import CellIndex, find_row, key_at, numbers_of
from recon4.kernels.moments import MOMENTS, add_point, plane_of


class NearLimits(NamedTuple):
    """What is kept of the surroundings of a cube."""

    planes: int = 4
    """Planes of buildings."""


NEAR = NearLimits()


class PlaneRules(NamedTuple):
    """Planes of cubes."""

    rounds: int
    """How often a plane is fitted."""
    fit_m: float
    """In all but the first round, farther cubes do not count [m]."""
    least: int
    """Cubes that a plane is fitted to, of 27."""
    alone: float
    """Least part of the cubes around that lie on the plane of a large surface: not at its edges."""
    thin_m: float
    """Largest standard deviation of the cubes of a plane [m]."""
    on_m: float
    """Nearer cubes lie on a plane [m]: both faces of a thin wall."""
    reach: int
    """Cubes around that are looked at, to each side."""
    flat: int
    """As many cubes on the plane are a large flat surface."""
    cos: float
    """Least cosine between the normals of neighbors on one surface."""
    bridge: int
    """Cubes between neighbors on one surface."""


class CubePlanes(NamedTuple):
    """The planes of cubes."""

    mean: NDArray[np.float64]
    """Of their returns [m], (C, 3)."""
    normal: NDArray[np.float32]
    """Unit normals, zeros = no plane, (C, 3)."""
    offset: NDArray[np.float64]
    """n · p of the plane [m], (C,)."""
    flat: NDArray[np.bool_]
    """Whether it is a part of a large flat surface, (C,)."""
    line: NDArray[np.bool_]
    """Whether the cubes around lie on a line, (C,)."""
    echoes: NDArray[np.float32]
    """Part of the returns that are further echoes of their beams, (C,)."""


@njit(cache=True, nogil=True, error_model="numpy")
def _fit(
    index: CellIndex, mean: NDArray[np.float64], n: Any, rules: PlaneRules, work: NDArray[Any]
) -> int:
    """Fit the plane of a cube: 2 = it is alone, 1 = there is one, 0 = none, -1 = a line.

    ``work`` receives normal, offset from the cube's mean and variances, (7,).
    """
    every = 0
    i, j, k = numbers_of(index.key[n])
    m = np.empty(MOMENTS)
    for r in range(rules.rounds):
        m[:] = 0.0
        for q in range(27):
            row = find_row(index, key_at(i + q % 3 - 1, j + q // 3 % 3 - 1, k + q // 9 - 1))
            if row < 0:
                continue
            # About the cube itself: coordinates may be large.
            x, y, z = (
                mean[row, 0] - mean[n, 0],
                mean[row, 1] - mean[n, 1],
                mean[row, 2] - mean[n, 2],
            )
            every += r == 0
            off = work[0] * x + work[1] * y + work[2] * z - work[3]
            if r == 0 or abs(off) <= rules.fit_m:
                add_point(m, 1.0, x, y, z)
        if m[0] < rules.least or not plane_of(m, work):
            return 0
        if work[5] < 0.05 * work[6]:
            return -1
    if work[4] > rules.thin_m * rules.thin_m:
        return 0
    return 2 if m[0] >= rules.alone * every else 1


@njit(cache=True, nogil=True, error_model="numpy")
def fit_cubes(index: CellIndex, planes: CubePlanes, rules: PlaneRules) -> None:
    """Fit the planes of cubes, and find those that are parts of large flat surfaces."""
    work = np.empty(7)
    for n in range(len(index.key)):
        kind = _fit(index, planes.mean, n, rules, work)
        planes.normal[n], planes.offset[n] = 0.0, 0.0
        planes.flat[n], planes.line[n] = False, kind < 0
        if kind <= 0:
            continue
        for d in range(3):
            planes.normal[n, d] = work[d]
            planes.offset[n] += work[d] * planes.mean[n, d]
        planes.offset[n] += work[3]
        planes.flat[n] = kind == 2 and _is_flat(index, planes, n, rules)


@njit(cache=True, nogil=True, error_model="numpy")
def _off(planes: CubePlanes, n: Any, p: tuple[float, float, float]) -> float:
    """Distance of a place from the plane of a cube, with its sign [m]."""
    a = planes.normal[n]
    return a[0] * p[0] + a[1] * p[1] + a[2] * p[2] - planes.offset[n]


@njit(cache=True, nogil=True, error_model="numpy", inline="always")
def _mean(planes: CubePlanes, n: Any) -> tuple[float, float, float]:
    return planes.mean[n, 0], planes.mean[n, 1], planes.mean[n, 2]


@njit(cache=True, nogil=True, error_model="numpy")
def _is_flat(index: CellIndex, planes: CubePlanes, n: Any, rules: PlaneRules) -> bool:
    """Whether enough of the cubes around one lie on its plane."""
    i, j, k = numbers_of(index.key[n])
    count, reach = 0, rules.reach
    for di in range(-reach, reach + 1):
        for dj in range(-reach, reach + 1):
            for dk in range(-reach, reach + 1):
                row = find_row(index, key_at(i + di, j + dj, k + dk))
                if row >= 0 and abs(_off(planes, n, _mean(planes, row))) <= rules.on_m:
                    count += 1
                if count == rules.flat:
                    return True
    return False


@njit(cache=True, nogil=True, error_model="numpy")
def _same_surface(planes: CubePlanes, a: Any, b: Any, rules: PlaneRules) -> bool:
    cos = 0.0
    for d in range(3):
        cos += planes.normal[a, d] * planes.normal[b, d]
    off = max(abs(_off(planes, a, _mean(planes, b))), abs(_off(planes, b, _mean(planes, a))))
    return abs(cos) >= rules.cos and off <= rules.on_m


@njit(cache=True, nogil=True, error_model="numpy")
def number_surfaces(
    index: CellIndex,
    planes: CubePlanes,
    rules: PlaneRules,
    surface: NDArray[np.int32],
    queue: NDArray[np.int32],
) -> int:
    """Number the large flat surfaces.

    Args:
        index: Of the cubes, (C,).
        planes: Their planes.
        rules: The rules.
        surface: Receives the number of the surface of each cube, -1 = none, (C,).
        queue: Memory to work in, (C,).

    Returns:
        How many there are.
    """
    surface[:] = -1
    count, side = 0, 2 * rules.bridge + 1
    for n in range(len(index.key)):
        if not planes.flat[n] or surface[n] >= 0:
            continue
        surface[n], queue[0], at, stop = count, n, 0, 1
        while at < stop:
            own: Any = np.int64(queue[at])
            at += 1
            i, j, k = numbers_of(index.key[own])
            for q in range(side * side * side):
                di, dj = q % side - rules.bridge, q // side % side - rules.bridge
                row = find_row(index, key_at(i + di, j + dj, k + q // (side * side) - rules.bridge))
                if row < 0 or not planes.flat[row] or surface[row] >= 0:
                    continue
                if _same_surface(planes, own, row, rules):
                    surface[row], queue[stop] = count, row
                    stop += 1
        count += 1
    return count


@njit(cache=True, nogil=True, error_model="numpy")
def extend_surfaces(
    index: CellIndex,
    planes: CubePlanes,
    rules: PlaneRules,
    chosen: NDArray[np.bool_],
    queue: NDArray[np.int32],
) -> None:
    """Extend surfaces to the cubes beside them that lie on them, flat or not.

    Args:
        index: Of the cubes, (C,).
        planes: Their planes.
        rules: The rules.
        chosen: Cubes of the surfaces; changed in place, (C,).
        queue: Memory to work in, (C,).
    """
    stop, at, side = 0, 0, 2 * rules.bridge + 1
    for n in range(len(chosen)):
        if chosen[n]:
            queue[stop] = n
            stop += 1
    while at < stop:
        own: Any = np.int64(queue[at])
        at += 1
        i, j, k = numbers_of(index.key[own])
        for q in range(side * side * side):
            di, dj = q % side - rules.bridge, q // side % side - rules.bridge
            row = find_row(index, key_at(i + di, j + dj, k + q // (side * side) - rules.bridge))
            if row < 0 or chosen[row] or not planes.normal[row].any():
                continue
            if _same_surface(planes, own, row, rules):
                chosen[row], queue[stop] = True, row
                stop += 1


@njit(cache=True, nogil=True, error_model="numpy")
def near_planes(
    index: CellIndex,
    planes: CubePlanes,
    of_building: NDArray[np.bool_],
    rules: PlaneRules,
    out: NDArray[np.int32],
) -> None:
    """Find the planes of buildings in the cubes around each, the nearest first.

    Args:
        index: Of the cubes, (C,).
        planes: Their planes.
        of_building: Which are parts of buildings, (C,).
        rules: The rules.
        out: Receives the rows of cubes with different planes, -1 = no more, (C, NEAR.planes).
    """
    reach = rules.bridge
    for n in range(len(index.key)):
        out[n] = -1
        i, j, k = numbers_of(index.key[n])
        count = 0
        for ring in range(reach + 1):
            for di in range(-ring, ring + 1):
                for dj in range(-ring, ring + 1):
                    for dk in range(-ring, ring + 1):
                        if max(abs(di), abs(dj), abs(dk)) != ring or count == NEAR.planes:
                            continue
                        row = find_row(index, key_at(i + di, j + dj, k + dk))
                        if row < 0 or not of_building[row]:
                            continue
                        known = False
                        for c in range(count):
                            known |= _same_surface(planes, np.int64(out[n, c]), row, rules)
                        if not known:
                            out[n, count] = row
                            count += 1


class GrowthRules(NamedTuple):
    """What grows."""

    reach: int
    """Cubes around that are looked at, to each side."""
    least: int
    """Cubes with returns among them."""
    irregular: float
    """Least part of these that are irregular."""


@njit(cache=True, nogil=True, error_model="numpy")
def find_growth(
    index: CellIndex,
    irregular: NDArray[np.bool_],
    open_: NDArray[np.bool_],
    rules: GrowthRules,
    out: NDArray[np.bool_],
) -> None:
    """Find the cubes of vegetation: most cubes around are irregular.

    Args:
        index: Of the cubes, (C,).
        irregular: Cubes without the planes of things that were built, (C,).
        open_: Cubes that may be vegetation; only these count, (C,).
        rules: The rules.
        out: Receives whether each is, (C,).
    """
    reach = rules.reach
    for n in range(len(index.key)):
        out[n] = False
        if not open_[n]:
            continue
        i, j, k = numbers_of(index.key[n])
        count, grown = 0, 0
        for di in range(-reach, reach + 1):
            for dj in range(-reach, reach + 1):
                for dk in range(-reach, reach + 1):
                    row = find_row(index, key_at(i + di, j + dj, k + dk))
                    if row < 0 or not open_[row]:
                        continue
                    count += 1
                    grown += irregular[row]
        out[n] = count >= rules.least and grown >= rules.irregular * count
