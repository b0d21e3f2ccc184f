"""Kernels of fitted surfaces: points moved onto the planes of their cells."""

from __future__ import annotations

import numpy as np
from numba import njit
from numpy.typing import NDArray

from recon4.kernels.moments import MOMENTS
from recon4.kernels.surface_cells import PLANE, SLOTS, center_of, distance_in_front
from recon4.kernels.surface_slots import refit_plane

SURFACE = 6
"""Unit normal, standard deviation across [m], returns, planarity; without a surface the normal of
the neighborhood, NaN, 0, 0."""
_MOST_EDGES = 6
"""Planes of a cell and of its neighbors that its points are compared with."""
_MIN_AROUND = 12.0
"""Returns around each stray return at least; fewer say nothing of it."""
_ALIKE = 0.9
"""A plane of a neighbor with a larger cosine makes no edge."""
_ONE_SIDE_M = 0.012
"""A surface whose middle is nearer to a plane than this lies on both sides of it [m]."""


@njit(cache=True, nogil=True, error_model="numpy")
def planes_at(
    c: int,
    cells: NDArray[np.int32],
    grid: tuple[int, int, float],
    neighbors: tuple[NDArray[np.int32], NDArray[np.int32], NDArray[np.uint8]],
    planes: NDArray[np.float64],
    slots: NDArray[np.int32],
    other: NDArray[np.int32],
    moments: NDArray[np.float64],
    sums: NDArray[np.float64],
    limits: NDArray[np.float64],
    found: NDArray[np.float64],
    out: NDArray[np.float64],
) -> tuple[int, int]:
    """Planes of a cell, fitted again, and after them those that only its neighbors have.

    Args:
        c: Row of the cell.
        cells: Of `find_cells`, (C,).
        grid: Cells along tile and halo, cells of the halo, edge of a cell [m].
        neighbors: Of `list_neighbors`: begin, near, at.
        planes: Of `window_planes`, two rows for each cell, (2 C, PLANE).
        slots: Of `choose_planes`, (C, SLOTS).
        other: Of `only_plane`, (C,).
        moments: As in `refit_plane`.
        sums: As in `refit_plane`.
        limits: As in `refit_plane`.
        found: As in `refit_plane`.
        out: Receives the planes, (L, PLANE).

    Returns:
        How many there are of the cell, and of both.
    """
    if other[c] < 0:
        # Fitted to the same points when the window was.
        out[0] = planes[slots[c, 0]]
        out[0, 3] = out[0, 10]
        return 1, 1
    begin, near, at = neighbors
    count = 0
    center = center_of(cells[c], *grid)
    run = begin[c], begin[c + 1]
    while count < SLOTS and slots[c, count] >= 0:
        refit_plane(
            slots[c, count], center, grid[2], run, near, at,
            planes, slots, other, moments, sums, limits, found, out[count],
        )  # fmt: skip
        count += 1
    every = count
    for k in range(run[0], run[1]):
        o = near[k]
        for t in range(SLOTS):
            row = slots[o, t]
            if row < 0:
                break
            u, v, w = planes[row, 0], planes[row, 1], planes[row, 2]
            known = count == 0
            for q in range(every):
                known |= out[q, 0] * u + out[q, 1] * v + out[q, 2] * w > _ALIKE
            if not known and every < len(out):
                out[every] = planes[row]
                every += 1
    return count, every


@njit(cache=True, nogil=True, error_model="numpy")
def onto_planes(
    xyz: NDArray[np.float32],
    to_sensor: NDArray[np.float32],
    starts: NDArray[np.int32],
    rings: NDArray[np.uint8],
    cells: NDArray[np.int32],
    grid: tuple[int, int, float],
    neighbors: tuple[NDArray[np.int32], NDArray[np.int32], NDArray[np.uint8]],
    normals: NDArray[np.float64],
    planes: NDArray[np.float64],
    slots: NDArray[np.int32],
    other: NDArray[np.int32],
    moments: NDArray[np.float64],
    sums: NDArray[np.float64],
    limits: NDArray[np.float64],
    gate: float,
    slot_of: NDArray[np.uint8],
    shift_m: NDArray[np.float32],
    surface_of: NDArray[np.int32],
    out: NDArray[np.float32],
) -> int:
    """Move every point along the normal onto the nearest plane of its cell.

    Args:
        xyz: Points [m], (N, 3) or more columns.
        to_sensor: Vectors to the sensor [m], (N, 3).
        starts: Of `find_cells`, (C + 1,).
        rings: Of `find_rings`; the points of the outermost cells stay, (C,).
        cells: Of `find_cells`, (C,).
        grid: As in `planes_at`.
        neighbors: As in `planes_at`.
        normals: Of points without a plane [unit], (C, 3).
        planes: Of `window_planes`, two rows for each cell, (2 C, PLANE).
        slots: Of `choose_planes`, (C, SLOTS).
        other: Of `only_plane`, (C,).
        moments: As in `refit_plane`.
        sums: As in `refit_plane`.
        limits: As in `refit_plane`.
        gate: Farther points keep their place [standard deviations].
        slot_of: Receives the plane of each point, SLOTS = none, (N,).
        shift_m: Receives the shift onto the surface [m], (N, 3).
        surface_of: Receives the row of each point's surface, (N,).
        out: Receives the surfaces, (at most (SLOTS + 1) C, SURFACE).

    Returns:
        How many surfaces there are.
    """
    mine_of, side_of = np.zeros((_MOST_EDGES, PLANE)), np.zeros((_MOST_EDGES, _MOST_EDGES))
    rows, shift, found = np.empty(SLOTS + 1, np.int32), np.zeros(3), np.empty(MOMENTS + 11)
    made = 0
    for c in range(len(cells)):
        count = every = 0
        rows[:] = -1
        if rings[c] > 0 and (other[c] < 0 or slots[c, 0] >= 0):
            count, every = planes_at(
                c, cells, grid, neighbors, planes, slots, other, moments, sums, limits, found,
                mine_of,
            )  # fmt: skip
        if every > 1:
            edge_sides(mine_of, count, every, side_of)
        for p in range(starts[c], starts[c + 1]):
            mine = SLOTS
            best = gate
            off = 0.0
            for s in range(count):
                away = distance_in_front(mine_of[s], xyz, to_sensor, p)
                if abs(away) < best * mine_of[s, 4]:
                    best = abs(away) / mine_of[s, 4]
                    mine = s
                    off = away
            slot_of[p] = mine
            if rows[mine] < 0:
                rows[mine] = made
                write_surface(out[made], mine_of, mine, normals[c])
                made += 1
            surface_of[p] = rows[mine]
            shift[:] = 0.0
            if mine < SLOTS:
                for d in range(3):
                    shift[d] = -off * mine_of[mine, d]
                if every > 1:
                    keep_inside(xyz, p, mine_of, every, mine, side_of, shift)
            for d in range(3):
                shift_m[p, d] = shift[d]
    return made


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
    shift_m: NDArray[np.float32],
    surface_of: NDArray[np.int32],
    surfaces: NDArray[np.float32],
    offset: NDArray[np.float32],
    normal: NDArray[np.float32],
    facts: NDArray[np.float32],
    returns: NDArray[np.uint16],
) -> None:
    """Copy what is known of the surfaces of points to columns.

    Args:
        rows: Row of each point, (M,).
        shift_m: Of `onto_planes`, (N, 3).
        surface_of: Of `onto_planes`, (N,).
        surfaces: Of `onto_planes`, (K, SURFACE).
        offset: Receives the offset from the surface to where each was measured [m], (M, 3).
        normal: Receives the normals, (M, 3).
        facts: Receives standard deviation across [m] and planarity, (2, M).
        returns: Receives the number of returns, 1 without a surface, (M,).
    """
    for m in range(len(rows)):
        n = rows[m]
        one = surfaces[surface_of[n]]
        for d in range(3):
            offset[m, d] = -shift_m[n, d]
            normal[m, d] = one[d]
        facts[0, m] = one[3]
        facts[1, m] = one[5]
        returns[m] = min(max(one[4], 1.0), 65535.0)


@njit(cache=True, nogil=True, error_model="numpy")
def find_strays(
    to_sensor: NDArray[np.float32],
    weight: NDArray[np.float32],
    starts: NDArray[np.int32],
    begin: NDArray[np.int32],
    near: NDArray[np.int32],
    slot_of: NDArray[np.uint8],
    limits: NDArray[np.float64],
    sums: NDArray[np.float64],
    stray: NDArray[np.bool_],
) -> None:
    """Mark points on no surface that are few beside the returns of the surfaces around them.

    Args:
        to_sensor: Vectors to the sensor [m], (N, 3).
        weight: Returns of each point, (N,).
        starts: Of `find_cells`, (C + 1,).
        begin: Of `list_neighbors`, (C + 1,).
        near: Of `list_neighbors`.
        slot_of: Plane of each point, SLOTS = none, (N,).
        limits: Largest ratio of such returns in the 3 x 3 x 3 cells around; as many are few in any
            case; largest ratio of those from afar; how many times the mean range is afar, (4,).
        sums: Receives of each cell the returns, those on no surface, the ranges of the others,
            those on no surface from afar, and the range that is afar, (C, 5).
        stray: Receives the marks, (N,).
    """
    ratio, alone, far_ratio, afar = limits
    count = len(starts) - 1
    for c in range(count):
        sums[c] = 0.0
        for p in range(starts[c], starts[c + 1]):
            sums[c, 0] += weight[p]
            if slot_of[p] == SLOTS:
                sums[c, 1] += weight[p]
            else:
                sums[c, 2] += weight[p] * range_of(to_sensor, p)
    for c in range(count):
        if sums[c, 1] > 0.0:
            sums[c, 4] = afar * mean_range_around(c, begin, near, sums)
            for p in range(starts[c], starts[c + 1]):
                if slot_of[p] == SLOTS and range_of(to_sensor, p) > sums[c, 4]:
                    sums[c, 3] += weight[p]
    for c in range(count):
        few = far_few = False
        if sums[c, 1] > 0.0:
            every = loose = far = 0.0
            for k in range(begin[c], begin[c + 1]):
                every += sums[near[k], 0]
                loose += sums[near[k], 1]
                far += sums[near[k], 3]
            few = loose <= max(ratio * every, alone) and every >= _MIN_AROUND * loose
            far_few = far <= far_ratio * every
        for p in range(starts[c], starts[c + 1]):
            from_afar = far_few and range_of(to_sensor, p) > sums[c, 4]
            stray[p] = slot_of[p] == SLOTS and (few or from_afar)


@njit(cache=True, nogil=True, error_model="numpy")
def range_of(to_sensor: NDArray[np.float32], p: int) -> float:
    """Range of a point [m]."""
    x, y, z = to_sensor[p, 0], to_sensor[p, 1], to_sensor[p, 2]
    return np.sqrt(x * x + y * y + z * z)


@njit(cache=True, nogil=True, error_model="numpy")
def mean_range_around(
    c: int, begin: NDArray[np.int32], near: NDArray[np.int32], sums: NDArray[np.float64]
) -> float:
    """Mean range of the returns on surfaces around a cell [m], infinite without any."""
    ranges = held = 0.0
    for k in range(begin[c], begin[c + 1]):
        ranges += sums[near[k], 2]
        held += sums[near[k], 0] - sums[near[k], 1]
    return ranges / held if held > 0.0 else np.inf


@njit(cache=True, nogil=True, error_model="numpy")
def edge_sides(
    planes: NDArray[np.float64], count: int, every: int, out: NDArray[np.float64]
) -> None:
    """On which side of each plane of a cell the surfaces of the others lie: 1, -1, 0 = both.

    Args:
        planes: Of `planes_at`, (L, PLANE).
        count: How many there are of the cell.
        every: How many there are.
        out: Receives the sides: ``out[a, b]`` = surface a, side of b, (L, L).
    """
    for a in range(count):
        middle = planes[a, 7:10]
        for b in range(every):
            q = planes[b]
            away = q[0] * middle[0] + q[1] * middle[1] + q[2] * middle[2] - q[3]
            out[a, b] = 0.0
            if abs(away) > _ONE_SIDE_M:
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
        away = -q[3]
        for d in range(3):
            away += q[d] * (xyz[p, d] + shift[d])
        if away * side_of[mine, b] >= 0.0:
            continue
        dot = a[0] * q[0] + a[1] * q[1] + a[2] * q[2]
        if abs(dot) > 0.9 or abs(away) > 3.0 * q[4]:
            continue
        # Within plane a, against the part of b's normal that lies in it.
        scale = away / (1.0 - dot * dot)
        for d in range(3):
            shift[d] -= scale * (q[d] - dot * a[d])
