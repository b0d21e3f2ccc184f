"""Kernel of the classes of points by what stands there: ground, building, vegetation."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from numba import njit
from numpy.typing import NDArray

from recon4.kernels.cell_table import CellIndex, find_row, key_at
from recon4.kernels.ground_cells import ground_below
from recon4.kernels.structure_cells import NEAR


class Structure(NamedTuple):
    """What stands in a map."""

    ground: CellIndex
    """Cells of the ground, (G,)."""
    ground_m: NDArray[np.float32]
    """Height of the ground in each [m], (G,)."""
    below: CellIndex
    """Cubes of one meter with ground in or near them, (B,)."""
    below_m: NDArray[np.float32]
    """Height of the ground in each [m], (B,)."""
    cubes: CellIndex
    """Cubes with returns, (C,)."""
    normal: NDArray[np.float32]
    """Of the planes of the cubes, (C, 3)."""
    offset: NDArray[np.float64]
    """n · p of the planes [m], (C,)."""
    near: NDArray[np.int32]
    """Rows of the cubes of buildings around each, -1 = no more, (C, NEAR.planes)."""
    growth: NDArray[np.bool_]
    """Whether each cube is vegetation, (C,)."""


class PointRules(NamedTuple):
    """Which class a point has."""

    cell_m: tuple[float, float, float]
    """Edge and height of the cells of the ground, edge of the cubes [m]."""
    ground_m: float
    """Points this near to the height of the ground are of it [m]."""
    bare_m: float
    """The same of points whose surface is not known [m]."""
    upward: float
    """Least vertical part of the normal of the ground, towards the sensor."""
    beside: int
    """Cells beside those of the ground, in which it goes on at the same height."""
    wall_m: float
    """Points this near to a plane of a building are of it [m]."""
    along: float
    """Least cosine between their normal and that of the plane."""
    low_m: float
    medium_m: float
    """Heights over the ground up to which vegetation is low, and medium [m]."""
    down: int
    """Cubes that are looked at downwards for the ground."""


class StructureCodes(NamedTuple):
    """Classes that points can get."""

    ground: int
    low: int
    medium: int
    high: int
    building: int


@njit(cache=True, nogil=True, error_model="numpy")
def _is_ground(
    s: Structure, p: tuple[float, float, float], limit_m: float, rules: PointRules
) -> bool:
    i, j = np.int64(np.floor(p[0] / rules.cell_m[0])), np.int64(np.floor(p[1] / rules.cell_m[0]))
    low = np.int64(np.floor((p[2] - limit_m) / rules.cell_m[1]))
    high = np.int64(np.floor((p[2] + limit_m) / rules.cell_m[1]))
    for ring in range(rules.beside + 1):
        for di in range(-ring, ring + 1):
            for dj in range(-ring, ring + 1):
                if max(abs(di), abs(dj)) != ring:
                    continue
                for k in range(low, high + 1):
                    row = find_row(s.ground, key_at(i + di, j + dj, k))
                    if row >= 0 and abs(p[2] - s.ground_m[row]) <= limit_m:
                        return True
    return False


@njit(cache=True, nogil=True, error_model="numpy")
def _on_building(
    s: Structure,
    cube: Any,
    p: tuple[float, float, float],
    normal: tuple[float, float, float],
    rules: PointRules,
) -> bool:
    u, v, w = normal
    known = u != 0.0 or v != 0.0 or w != 0.0
    for c in range(NEAR.planes):
        row = s.near[cube, c]
        if row < 0:
            return False
        a, b, d = s.normal[row, 0], s.normal[row, 1], s.normal[row, 2]
        off = abs(a * p[0] + b * p[1] + d * p[2] - s.offset[row])
        cos = abs(a * u + b * v + d * w)
        if known and cos >= rules.along and off <= rules.wall_m:
            return True
        if not known and off <= rules.bare_m:
            return True
    return False


@njit(cache=True, nogil=True, error_model="numpy")
def classify_points(
    xyz: NDArray[np.float32],
    origin_m: NDArray[np.float64],
    normals: tuple[NDArray[np.float32], NDArray[np.int32]],
    s: Structure,
    rules: PointRules,
    codes: StructureCodes,
    open_class: int,
    classes: NDArray[np.uint8],
) -> None:
    """Give the points of a tile that have no class yet that of the ground, building, vegetation.

    Args:
        xyz: From the tile's origin [m], (N, 3).
        origin_m: Of the tile in the map, (3,).
        normals: Unit normals towards the sensor, zeros = none, (K, 3) or more columns, and the row
            of each point, (N,).
        s: What stands in the map.
        rules: The rules.
        codes: Codes of the classes.
        open_class: Code of the points that may get one.
        classes: Of the points; changed in place, (N,).
    """
    edge = rules.cell_m[2]
    for n in range(len(xyz)):
        if classes[n] != open_class:
            continue
        p = origin_m[0] + xyz[n, 0], origin_m[1] + xyz[n, 1], origin_m[2] + xyz[n, 2]
        of = normals[1][n]
        normal = normals[0][of, 0], normals[0][of, 1], normals[0][of, 2]
        known = normal[0] != 0.0 or normal[1] != 0.0 or normal[2] != 0.0
        limit_m = rules.ground_m if known else rules.bare_m
        if (normal[2] >= rules.upward or not known) and _is_ground(s, p, limit_m, rules):
            classes[n] = codes.ground
            continue
        i, j = np.int64(np.floor(p[0] / edge)), np.int64(np.floor(p[1] / edge))
        row = find_row(s.cubes, key_at(i, j, np.int64(np.floor(p[2] / edge))))
        if row < 0:
            continue
        if _on_building(s, row, p, normal, rules):
            classes[n] = codes.building
        elif s.growth[row]:
            over = p[2] - ground_below(s.below, s.below_m, p, rules.down)
            if over > rules.medium_m:
                classes[n] = codes.high
            elif over > rules.low_m:
                classes[n] = codes.medium
            elif over <= rules.low_m:  # not where it is not known
                classes[n] = codes.low
