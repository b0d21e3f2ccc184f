"""Kernels of fitted surfaces: points moved onto the planes of their cells."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numba import njit
from numpy.typing import NDArray

from recon4.kernels.moments import MOMENTS
from recon4.kernels.surface_cells import distance_in_front
from recon4.kernels.surface_records import (
    PLANE,
    SLOTS,
    Cells,
    Moved,
    Neighbors,
    PlaneLimits,
    Returns,
    StrayLimits,
    Supported,
)
from recon4.kernels.surface_slots import refit_plane


class PointLimits(NamedTuple):
    """When a point is compared with a plane, and is stray."""

    most_edges: int = 6
    """Planes of a cell and of its neighbors that its points are compared with."""
    min_around: float = 12.0
    """Returns around each stray return at least; fewer say nothing of it."""
    alike: float = 0.9
    """A plane of a neighbor with a larger cosine makes no edge."""
    one_side_m: float = 0.012
    """A surface whose middle is nearer to a plane than this lies on both sides of it [m]."""


POINTS = PointLimits()


@njit(cache=True, nogil=True, error_model="numpy")
def planes_at(
    c: int,
    cells: Cells,
    neighbors: Neighbors,
    planes: NDArray[np.float64],
    supported: Supported,
    moments: NDArray[np.float64],
    limits: PlaneLimits,
    scratch: NDArray[np.float64],
    out: NDArray[np.float64],
) -> tuple[int, int]:
    """Planes of a cell, fitted again, and after them those that only its neighbors have.

    Args:
        c: Row of the cell.
        cells: Of `find_cells`.
        neighbors: Of `list_neighbors`.
        planes: Of `window_planes`, two rows for each cell, (2 C, 11).
        supported: Of `choose_planes`.
        moments: As in `refit_plane`.
        limits: As in `refit_plane`.
        scratch: As in `refit_plane`.
        out: Receives the planes, (L, 11).

    Returns:
        How many there are of the cell, and of both.
    """
    slots = supported.plane
    if supported.several[c] < 0:
        # Fitted to the same points when the window was.
        out[0] = planes[slots[c, 0]]
        out[0, PLANE.offset] = out[0, PLANE.own_offset]
        return 1, 1
    count = 0
    while count < SLOTS and slots[c, count] >= 0:
        refit_plane(
            slots[c, count], c, cells, neighbors, planes, supported, moments, limits, scratch,
            out[count],
        )  # fmt: skip
        count += 1
    every = count
    for k in range(neighbors.first[c], neighbors.first[c + 1]):
        o = neighbors.row[k]
        for t in range(SLOTS):
            row = slots[o, t]
            if row < 0:
                break
            u, v, w = planes[row, 0], planes[row, 1], planes[row, 2]
            known = count == 0
            for q in range(every):
                known |= out[q, 0] * u + out[q, 1] * v + out[q, 2] * w > POINTS.alike
            if not known and every < len(out):
                out[every] = planes[row]
                every += 1
    return count, every


@njit(cache=True, nogil=True, error_model="numpy")
def onto_planes(
    returns: Returns,
    cells: Cells,
    rings: NDArray[np.uint8],
    neighbors: Neighbors,
    normals: NDArray[np.float64],
    planes: NDArray[np.float64],
    moments: NDArray[np.float64],
    supported: Supported,
    limits: PlaneLimits,
    gate: float,
    out: Moved,
) -> int:
    """Move every point along the normal onto the nearest plane of its cell.

    Args:
        returns: Of the tile, with the positions as they were measured.
        cells: Of `find_cells`.
        rings: Of `find_rings`; the points of the outermost cells stay, (C,).
        neighbors: Of `list_neighbors`.
        normals: Of points without a plane [unit], (C, 3).
        planes: Of `window_planes`, two rows for each cell, (2 C, 11).
        moments: As in `refit_plane`.
        supported: Of `choose_planes`; receives the plane of each point.
        limits: As in `refit_plane`.
        gate: Farther points keep their place [standard deviations].
        out: Receives the shifts and the surfaces.

    Returns:
        How many surfaces there are.
    """
    first, of_point = returns.first, supported.of_point
    edges = POINTS.most_edges
    mine_of, side_of = np.zeros((edges, PLANE.numbers)), np.zeros((edges, edges))
    rows, shift, scratch = np.empty(SLOTS + 1, np.int32), np.zeros(3), np.empty(MOMENTS + 11)
    surfaces = 0
    for c in range(len(cells.number)):
        count = every = 0
        rows[:] = -1
        if rings[c] > 0 and (supported.several[c] < 0 or supported.plane[c, 0] >= 0):
            count, every = planes_at(
                c, cells, neighbors, planes, supported, moments, limits, scratch, mine_of
            )
        if every > 1:
            edge_sides(mine_of, count, every, side_of)
        for p in range(first[c], first[c + 1]):
            mine = SLOTS
            best = gate
            off = 0.0
            for s in range(count):
                away = distance_in_front(mine_of[s], returns, p)
                if abs(away) < best * mine_of[s, PLANE.sigma]:
                    best = abs(away) / mine_of[s, PLANE.sigma]
                    mine = s
                    off = away
            of_point[p] = mine
            if rows[mine] < 0:
                rows[mine] = surfaces
                write_surface(out.surfaces[surfaces], mine_of, mine, normals[c])
                surfaces += 1
            out.surface_of[p] = rows[mine]
            shift[:] = 0.0
            if mine < SLOTS:
                for d in range(3):
                    shift[d] = -off * mine_of[mine, d]
                if every > 1:
                    keep_inside(returns.xyz, p, mine_of, every, mine, side_of, shift)
            for d in range(3):
                out.shift_m[p, d] = shift[d]
    return surfaces


@njit(cache=True, nogil=True, error_model="numpy")
def write_surface(
    out: NDArray[np.float32],
    planes: NDArray[np.float64],
    mine: int,
    normal: NDArray[np.float64],
) -> None:
    """Write what points say of their surface; that of points without one is `SLOTS`."""
    if mine == SLOTS:
        for d in range(3):
            out[d] = normal[d]
        out[3], out[4], out[5] = np.nan, 0.0, 0.0
        return
    for d in range(3):
        out[d] = planes[mine, d]
        out[3 + d] = planes[mine, 4 + d]


@njit(cache=True, nogil=True, error_model="numpy")
def spread_surfaces(
    rows: NDArray[np.int64],
    moved: Moved,
    offset: NDArray[np.float32],
    normal: NDArray[np.float32],
    facts: NDArray[np.float32],
    returns: NDArray[np.uint16],
) -> None:
    """Copy what is known of the surfaces of points to columns.

    Args:
        rows: Row of each point, (M,).
        moved: Of `onto_planes`.
        offset: Receives the offset from the surface to where each was measured [m], (M, 3).
        normal: Receives the normals, (M, 3).
        facts: Receives standard deviation across [m] and planarity, (2, M).
        returns: Receives the number of returns, 1 without a surface, (M,).
    """
    for m in range(len(rows)):
        n = rows[m]
        one = moved.surfaces[moved.surface_of[n]]
        for d in range(3):
            offset[m, d] = -moved.shift_m[n, d]
            normal[m, d] = one[d]
        facts[0, m] = one[3]
        facts[1, m] = one[5]
        returns[m] = min(max(one[4], 1.0), 65535.0)


@njit(cache=True, nogil=True, error_model="numpy")
def find_strays(
    returns: Returns,
    neighbors: Neighbors,
    of_point: NDArray[np.uint8],
    limits: StrayLimits,
    sums: NDArray[np.float64],
    stray: NDArray[np.bool_],
) -> None:
    """Mark points on no surface that are few beside the returns of the surfaces around them.

    Args:
        returns: Of the tile.
        neighbors: Of `list_neighbors`.
        of_point: Plane of each point, SLOTS = none, (N,).
        limits: Which are few.
        sums: Receives of each cell the returns, those on no surface, the ranges of the others,
            those on no surface from afar, and the range that is afar, (C, 5).
        stray: Receives the marks, (N,).
    """
    _, to_sensor, weight, first = returns
    count = len(first) - 1
    for c in range(count):
        sums[c] = 0.0
        for p in range(first[c], first[c + 1]):
            sums[c, 0] += weight[p]
            if of_point[p] == SLOTS:
                sums[c, 1] += weight[p]
            else:
                sums[c, 2] += weight[p] * range_of(to_sensor, p)
    for c in range(count):
        if sums[c, 1] > 0.0:
            sums[c, 4] = limits.afar * mean_range_around(c, neighbors, sums)
            for p in range(first[c], first[c + 1]):
                if of_point[p] == SLOTS and range_of(to_sensor, p) > sums[c, 4]:
                    sums[c, 3] += weight[p]
    for c in range(count):
        few = far_few = False
        if sums[c, 1] > 0.0:
            every = loose = far = 0.0
            for k in range(neighbors.first[c], neighbors.first[c + 1]):
                around = sums[neighbors.row[k]]
                every += around[0]
                loose += around[1]
                far += around[3]
            few = loose <= max(limits.ratio * every, limits.few)
            few = few and every >= POINTS.min_around * loose
            far_few = far <= limits.far_ratio * every
        for p in range(first[c], first[c + 1]):
            from_afar = far_few and range_of(to_sensor, p) > sums[c, 4]
            stray[p] = of_point[p] == SLOTS and (few or from_afar)


@njit(cache=True, nogil=True, error_model="numpy")
def range_of(to_sensor: NDArray[np.float32], p: int) -> float:
    """Range of a point [m]."""
    x, y, z = to_sensor[p, 0], to_sensor[p, 1], to_sensor[p, 2]
    return np.sqrt(x * x + y * y + z * z)


@njit(cache=True, nogil=True, error_model="numpy")
def mean_range_around(c: int, neighbors: Neighbors, sums: NDArray[np.float64]) -> float:
    """Mean range of the returns on surfaces around a cell [m], infinite without any."""
    ranges = count = 0.0
    for k in range(neighbors.first[c], neighbors.first[c + 1]):
        around = sums[neighbors.row[k]]
        ranges += around[2]
        count += around[0] - around[1]
    return ranges / count if count > 0.0 else np.inf


@njit(cache=True, nogil=True, error_model="numpy")
def edge_sides(
    planes: NDArray[np.float64], count: int, every: int, out: NDArray[np.float64]
) -> None:
    """On which side of each plane of a cell the surfaces of the others lie: 1, -1, 0 = both.

    Args:
        planes: Of `planes_at`, (L, 11).
        count: How many there are of the cell.
        every: How many there are.
        out: Receives the sides: ``out[a, b]`` = surface a, side of b, (L, L).
    """
    for a in range(count):
        middle = planes[a, PLANE.middle : PLANE.middle + 3]
        for b in range(every):
            q = planes[b]
            away = q[0] * middle[0] + q[1] * middle[1] + q[2] * middle[2] - q[PLANE.offset]
            out[a, b] = 0.0
            if abs(away) > POINTS.one_side_m:
                out[a, b] = 1.0 if away > 0.0 else -1.0


@njit(cache=True, nogil=True, error_model="numpy")
def keep_inside(
    xyz: NDArray[np.float32],
    p: int,
    planes: NDArray[np.float64],
    count: int,
    mine: int,
    side_of: NDArray[np.float64],
    shift: NDArray[np.float64],
) -> None:
    """Move a point that its plane puts beyond an edge onto the edge."""
    a = planes[mine]
    for b in range(count):
        q = planes[b]
        if b == mine or side_of[mine, b] == 0.0:
            continue
        away = -q[PLANE.offset]
        for d in range(3):
            away += q[d] * (xyz[p, d] + shift[d])
        if away * side_of[mine, b] >= 0.0:
            continue
        dot = a[0] * q[0] + a[1] * q[1] + a[2] * q[2]
        if abs(dot) > 0.9 or abs(away) > 3.0 * q[PLANE.sigma]:
            continue
        # Within plane a, against the part of b's normal that lies in it.
        scale = away / (1.0 - dot * dot)
        for d in range(3):
            shift[d] -= scale * (q[d] - dot * a[d])
