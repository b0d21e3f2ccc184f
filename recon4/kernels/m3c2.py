"""Kernels of M3C2 (Lague et al. 2013): normals at a scale, and layers of points in cylinders.

Points are those around one tile: float32 from its middle, sorted by the cubes they lie in.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numba import njit
from numpy.typing import NDArray

from recon4.kernels.cell_table import CellIndex, find_row, key_at
from recon4.kernels.moments import MOMENTS, add_point, plane_of


class NearPoints(NamedTuple):
    """Points of one map around a tile, cube by cube."""

    xyz: NDArray[np.float32]
    """From the middle of the tile [m], (N, 3)."""
    normal: NDArray[np.float32]
    """Unit normals towards the sensor, zeros = not known, (N, 3)."""
    sd_m: NDArray[np.float32]
    """Stated standard deviation of each position [m], (N,)."""
    first: NDArray[np.int64]
    """First point of each cube, and the number of points, (C + 1,)."""
    cubes: CellIndex
    """Rows of the cubes."""


class CylinderLimits(NamedTuple):
    """Sizes of the search."""

    cell_m: float
    """Edge of the cubes of `NearPoints` [m]."""
    radius_m: float
    """Of a cylinder [m]."""
    depth_m: float
    """Half its length [m]."""
    layer_m: float
    """Half the thickness of what counts as one surface [m]; ``depth_m`` or more: all of it."""
    farthest_m: float
    """The search for a layer begins at most this far from the core point [m]; 0 = only there."""
    min_points: int
    """Fewer points are no surface."""


class Layers(NamedTuple):
    """The surface of a map in the cylinder of each core point."""

    mean_m: NDArray[np.float64]
    """Along the normal from the core point [m], (M,); NaN = there is none."""
    variance_m2: NDArray[np.float64]
    """Along the normal [m²], (M,); NaN = there is none."""
    points: NDArray[np.float64]
    """How many points it has, else how many are in the cylinder, (M,)."""
    sd_m: NDArray[np.float64]
    """Mean of the stated standard deviations of its points [m], (M,); NaN = there is none."""


@njit(cache=True, nogil=True, error_model="numpy")
def numbers_of_cubes(xyz: NDArray[np.float32], cell_m: float, key: NDArray[np.int64]) -> None:
    """Key of the cube of each point (`recon4.kernels.cell_table.key_at`), int64 (N,)."""
    for n in range(len(xyz)):
        i = np.int64(np.floor(xyz[n, 0] / cell_m))
        j = np.int64(np.floor(xyz[n, 1] / cell_m))
        k = np.int64(np.floor(xyz[n, 2] / cell_m))
        key[n] = key_at(i, j, k)


@njit(cache=True, nogil=True, error_model="numpy", inline="always")
def _faces(normal: NDArray[np.float32], x: float, y: float, z: float) -> bool:
    """Whether a point may be of a surface that faces a direction; unknown normals may."""
    return normal[0] * x + normal[1] * y + normal[2] * z >= 0.0


@njit(cache=True, nogil=True, error_model="numpy")
def normals_at_scale(
    core: NDArray[np.float32],
    facing: NDArray[np.float32],
    near: NearPoints,
    scale: tuple[float, float, int],
    out: NDArray[np.float32],
) -> None:
    """Normals of the planes through the neighbors of core points (Lague et al. 2013, step 1).

    Neighbors that face away from the core point are of the other side of a thin wall: they are
    left out. A normal points to the side from which the surface was seen, else up.

    Args:
        core: Core points [m], (M, 3).
        facing: Normal of each core point towards the sensor, zeros = not known, (M, 3).
        near: Points of the same map; its cubes are at least as large as the radius.
        scale: Radius of the neighborhood [m], edge of the cubes [m], fewest neighbors.
        out: Receives unit normals, zeros = there is none, (M, 3).
    """
    radius, cell_m, least = scale
    m, plane = np.zeros(MOMENTS), np.zeros(7)
    for c in range(len(core)):
        m[:] = 0.0
        x0, y0, z0 = np.float64(core[c, 0]), np.float64(core[c, 1]), np.float64(core[c, 2])
        u = v = w = 0.0
        i0 = np.int64(np.floor(x0 / cell_m))
        j0 = np.int64(np.floor(y0 / cell_m))
        k0 = np.int64(np.floor(z0 / cell_m))
        for cube in range(27):
            i, j, k = i0 + cube % 3 - 1, j0 + (cube // 3) % 3 - 1, k0 + cube // 9 - 1
            row = find_row(near.cubes, key_at(i, j, k))
            if row < 0:
                continue
            for n in range(near.first[row], near.first[row + 1]):
                x, y, z = near.xyz[n, 0] - x0, near.xyz[n, 1] - y0, near.xyz[n, 2] - z0
                if x * x + y * y + z * z > radius * radius:
                    continue
                if not _faces(near.normal[n], facing[c, 0], facing[c, 1], facing[c, 2]):
                    continue
                add_point(m, 1.0, x, y, z)
                u += near.normal[n, 0]
                v += near.normal[n, 1]
                w += near.normal[n, 2]
        out[c, :] = 0.0
        if m[0] < least or not plane_of(m, plane):
            continue
        side = plane[0] * u + plane[1] * v + plane[2] * w
        if side == 0.0:
            side = plane[2]
        sign = -1.0 if side < 0.0 else 1.0
        for d in range(3):
            out[c, d] = sign * plane[d]


@njit(cache=True, nogil=True, error_model="numpy")
def _in_cylinder(
    p: NDArray[np.float32],
    normal: NDArray[np.float32],
    near: NearPoints,
    limits: CylinderLimits,
    along: NDArray[np.float64],
    sd_m: NDArray[np.float64],
) -> int:
    """Positions along the axis of the points in a cylinder that face as it does; their number."""
    cell, r, depth = limits.cell_m, limits.radius_m, limits.depth_m
    a, b, c = np.float64(normal[0]), np.float64(normal[1]), np.float64(normal[2])
    x0, y0, z0 = np.float64(p[0]), np.float64(p[1]), np.float64(p[2])
    dx, dy, dz = depth * abs(a) + r, depth * abs(b) + r, depth * abs(c) + r
    beside = (r + 0.8661 * cell) ** 2
    count = 0
    for i in range(np.int64(np.floor((x0 - dx) / cell)), np.int64(np.floor((x0 + dx) / cell)) + 1):
        for j in range(
            np.int64(np.floor((y0 - dy) / cell)), np.int64(np.floor((y0 + dy) / cell)) + 1
        ):
            for k in range(
                np.int64(np.floor((z0 - dz) / cell)), np.int64(np.floor((z0 + dz) / cell)) + 1
            ):
                x, y, z = (i + 0.5) * cell - x0, (j + 0.5) * cell - y0, (k + 0.5) * cell - z0
                t = a * x + b * y + c * z
                if x * x + y * y + z * z - t * t > beside:
                    continue
                row = find_row(near.cubes, key_at(i, j, k))
                if row < 0:
                    continue
                for n in range(near.first[row], near.first[row + 1]):
                    x, y, z = near.xyz[n, 0] - x0, near.xyz[n, 1] - y0, near.xyz[n, 2] - z0
                    t = a * x + b * y + c * z
                    if abs(t) > depth or x * x + y * y + z * z - t * t > r * r:
                        continue
                    if _faces(near.normal[n], a, b, c):
                        along[count], sd_m[count] = t, near.sd_m[n]
                        count += 1
    return count


@njit(cache=True, nogil=True, error_model="numpy")
def _mean_within(
    along: NDArray[np.float64], count: int, middle: float, half: float
) -> tuple[int, float]:
    """Number and mean of the positions within ``half`` of ``middle``."""
    n, total = 0, 0.0
    for k in range(count):
        if abs(along[k] - middle) <= half:
            n += 1
            total += along[k]
    return n, total / max(n, 1)


@njit(cache=True, nogil=True, error_model="numpy")
def _middle_of_nearest(
    along: NDArray[np.float64], count: int, limits: CylinderLimits
) -> tuple[float, float]:
    """Middle of the nearest layer and half its thickness; NaN = there is none."""
    if limits.layer_m >= limits.depth_m:
        return (0.0 if count >= limits.min_points else np.nan), limits.depth_m
    steps = np.int64(np.ceil(limits.farthest_m / limits.layer_m))
    for step in range(2 * steps + 1):
        side = 1.0 if step % 2 else -1.0
        middle = side * ((step + 1) // 2) * limits.layer_m
        n, mean = _mean_within(along, count, middle, limits.layer_m)
        if n < limits.min_points:
            continue
        for _ in range(4):
            n, again = _mean_within(along, count, mean, limits.layer_m)
            if n < limits.min_points or again == mean:
                break
            mean = again
        if n >= limits.min_points:
            return mean, limits.layer_m
    return np.nan, limits.layer_m


@njit(cache=True, nogil=True, error_model="numpy")
def layers(
    core: NDArray[np.float32],
    normals: NDArray[np.float32],
    near: NearPoints,
    limits: CylinderLimits,
    out: Layers,
) -> None:
    """The surface of a map in the cylinder of each core point (Lague et al. 2013, step 2).

    The cylinder lies along the normal. Of its points those of the layer nearest to the core point
    count: what stands before a wall is another surface. With ``layer_m >= depth_m`` all count, as
    in the paper.

    Args:
        core: Core points [m], (M, 3).
        normals: Their unit normals, zeros = none, (M, 3).
        near: Points of the map.
        limits: Sizes.
        out: Receives the layers.
    """
    along, sd_m = np.empty(len(near.xyz)), np.empty(len(near.xyz))
    for c in range(len(core)):
        out.mean_m[c] = out.variance_m2[c] = out.sd_m[c] = np.nan
        out.points[c] = 0.0
        if normals[c, 0] == 0.0 and normals[c, 1] == 0.0 and normals[c, 2] == 0.0:
            continue
        count = _in_cylinder(core[c], normals[c], near, limits, along, sd_m)
        out.points[c] = count
        middle, half = _middle_of_nearest(along, count, limits)
        if np.isnan(middle):
            continue
        n, mean = _mean_within(along, count, middle, half)
        squares = stated = 0.0
        for k in range(count):
            if abs(along[k] - middle) <= half:
                squares += (along[k] - mean) ** 2
                stated += sd_m[k]
        out.mean_m[c], out.variance_m2[c] = mean, squares / max(n - 1, 1)
        out.points[c], out.sd_m[c] = n, stated / n


@njit(cache=True, nogil=True, error_model="numpy")
def one_of_each_cube(
    xyz: NDArray[np.float32],
    order: NDArray[np.int64],
    key: NDArray[np.int64],
    cell_m: float,
    chosen: NDArray[np.int64],
) -> int:
    """The point nearest to the middle of each cube that has any; of equal ones the first.

    Args:
        xyz: Points from the corner of the cubes [m], (N, 3).
        order: Their rows, cube by cube, (N,).
        key: Of each point: `numbers_of_cubes`, (N,).
        cell_m: Edge of the cubes [m].
        chosen: Receives the rows, int64 (N,).

    Returns:
        Number of cubes.
    """
    count, best = 0, np.inf
    for n in range(len(order)):
        row = order[n]
        if n == 0 or key[row] != key[order[n - 1]]:
            count += 1
            best = np.inf
        away = 0.0
        for d in range(3):
            part = xyz[row, d] / cell_m
            away += (part - np.floor(part) - 0.5) ** 2
        if away < best:
            best = away
            chosen[count - 1] = row
    return count
