"""Kernels of `recon4.calibration.purity`: which points lie on which plane, and better planes."""

from __future__ import annotations

import math

import numpy as np
from numba import njit
from numpy.typing import NDArray

_STEEPEST = 0.02
"""Cosine of the incidence below which a beam meets no place of a plane in particular."""


@njit(cache=True, nogil=True, error_model="numpy")
def along_normal(
    vectors: NDArray[np.float64],
    point: NDArray[np.int64],
    plane: NDArray[np.int64],
    normal: NDArray[np.float64],
) -> NDArray[np.float64]:
    """Component of the vector of each point along the normal of its plane.

    Args:
        vectors: Of all points, (N, 3).
        point: Rows of the points, (M,).
        plane: Row of the plane of each, (M,).
        normal: Unit normals, (V, 3).

    Returns:
        (M,).
    """
    out = np.empty(len(point))
    for m in range(len(point)):
        out[m] = _dot(vectors[point[m]], normal[plane[m]])
    return out


@njit(cache=True, nogil=True, error_model="numpy")
def plane_equations(
    p: NDArray[np.float64],
    point: NDArray[np.int64],
    plane: NDArray[np.int64],
    frames: NDArray[np.float64],
    center: NDArray[np.float64],
    sd_m: NDArray[np.float64],
    most_sds: float,
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Normal equations of planes of which some points are far off.

    The weight is that of Geman and McClure: what is far off hardly counts, and nothing jumps.

    Args:
        p: All points [m], (N, 3).
        point: Rows of the points on planes, (M,).
        plane: Row of the plane of each, (M,).
        frames: Normal and two tangents of each plane in its rows, (V, 3, 3).
        center: Centers of the planes [m], (V, 3).
        sd_m: Standard deviation of each distance [m], (M,).
        most_sds: At this many standard deviations a point has a quarter of its weight.

    Returns:
        Information on a shift along the normal and the slopes along both tangents, (V, 3, 3), and
        the right side, (V, 3).
    """
    H, g = np.zeros((len(center), 3, 3)), np.zeros((len(center), 3))
    row = np.ones(3)
    for m in range(len(point)):
        n, v = point[m], plane[m]
        away = p[n] - center[v]
        r = _dot(away, frames[v, 0])
        row[1], row[2] = _dot(away, frames[v, 1]), _dot(away, frames[v, 2])
        root = sd_m[m] * (1.0 + (r / (most_sds * sd_m[m])) ** 2)
        w = 1.0 / (root * root)
        for i in range(3):
            g[v, i] += w * r * row[i]
            for j in range(3):
                H[v, i, j] += w * row[i] * row[j]
    return H, g


@njit(cache=True, nogil=True, error_model="numpy")
def planes_met(
    p: NDArray[np.float64],
    beam: NDArray[np.float64],
    cubes: NDArray[np.int64],
    center: NDArray[np.float64],
    normal: NDArray[np.float64],
    count: NDArray[np.float64],
    cube_m: float,
    noise: NDArray[np.float64],
) -> NDArray[np.int64]:
    """The plane that each point lies on; -1 = none.

    A point lies on the plane of a cube if its noise explains the distance, it sees the front, and
    its *beam* meets the plane inside of the cube. Were it the point itself, a face of the cube near
    a wall would choose points by their noise. Of several planes the one with most points counts.

    Args:
        p: Points [m], (N, 3).
        beam: Unit vectors from the sensors to them, (N, 3).
        cubes: Indices of the cube of each plane and its row, sorted, (V, 4).
        center: Centers of the planes [m], (V, 3).
        normal: Unit normals, towards the sensors, (V, 3).
        count: Points on each plane so far, (V,).
        cube_m: Edge of a cube.
        noise: Standard deviation of a range and of a point across its plane [m], the largest
            distance in standard deviations, how near to a face other cubes are asked [m], (4,).

    Returns:
        (N,).
    """
    out = np.full(len(p), -1, np.int64)
    cell, other = np.empty(3, np.int64), np.empty(3, np.int64)
    low, high = np.empty(3, np.int64), np.empty(3, np.int64)
    for n in range(len(p)):
        for i in range(3):
            cell[i] = math.floor(p[n, i] / cube_m)
            low[i] = math.floor((p[n, i] - noise[3]) / cube_m)
            high[i] = math.floor((p[n, i] + noise[3]) / cube_m)
        most = 0.0
        for x in range(low[0], high[0] + 1):
            for y in range(low[1], high[1] + 1):
                for z in range(low[2], high[2] + 1):
                    other[0], other[1], other[2] = x, y, z
                    v = _find(cubes, other)
                    if v < 0 or count[v] <= most:
                        continue
                    if _is_on(p[n], beam[n], center[v], normal[v], other, cube_m, noise):
                        out[n], most = v, count[v]
    return out


@njit(cache=True, nogil=True, error_model="numpy")
def _is_on(p, beam, center, normal, cube, cube_m, noise):  # type: ignore[no-untyped-def]
    """Whether a point lies on a plane, and its beam meets it inside of its cube."""
    cosine = -_dot(beam, normal)
    if cosine < _STEEPEST:
        return False
    r = _dot(p, normal) - _dot(center, normal)
    sd_m = math.sqrt((noise[0] * cosine) ** 2 + noise[1] ** 2)
    if abs(r) > noise[2] * sd_m:
        return False
    inside = True
    for i in range(3):
        inside &= math.floor((p[i] + r / cosine * beam[i]) / cube_m) == cube[i]
    return inside


@njit(cache=True, nogil=True, error_model="numpy")
def _find(cubes, cube):  # type: ignore[no-untyped-def]
    """Row of the plane of a cube, -1 = it has none: binary search."""
    first, last = 0, len(cubes)
    while first < last:
        middle = (first + last) // 2
        if _before(cubes[middle], cube):
            first = middle + 1
        else:
            last = middle
    if first == len(cubes) or _before(cube, cubes[first]):
        return -1
    return cubes[first, 3]


@njit(cache=True, nogil=True, error_model="numpy")
def _before(a, b):  # type: ignore[no-untyped-def]
    for i in range(3):
        if a[i] != b[i]:
            return a[i] < b[i]
    return False


@njit(cache=True, nogil=True, error_model="numpy")
def _dot(a, b):  # type: ignore[no-untyped-def]
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
