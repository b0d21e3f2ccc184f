"""Kernels of fitted surfaces: the planes that the returns of a cell support, fitted again."""

from __future__ import annotations

from typing import Any

import numpy as np
from numba import njit
from numpy.typing import NDArray

from recon4.kernels.moments import MOMENTS, add_point, plane_of
from recon4.kernels.surface_cells import (
    OWN_COLUMN,
    SLOTS,
    center_of,
    column_of,
    distance_in_front,
    main_axis,
)
from recon4.kernels.surface_shapes import own_offset, write_plane

_MOST_LISTED = 24
_MIN_TAIL = 250.0
"""A surface has this many times the returns of a cell that holds the end of its noise only."""
_SAME_COS, _SAME = 0.95, 1.0
"""Planes are similar with a larger cosine and a smaller distance [standard deviations]."""
_THINNER = 0.95
"""A similar plane takes the place of another one below this ratio of their deviations."""


@njit(cache=True, nogil=True, error_model="numpy")
def list_candidates(
    c: int,
    cells: NDArray[np.int32],
    where: NDArray[np.int32],
    side: int,
    halo: int,
    cell_m: float,
    planes: NDArray[np.float64],
    thickness: NDArray[np.float64],
    out: NDArray[np.int64],
) -> int:
    """Different planes among those of the 5 x 5 x 5 cells around a cell.

    Beside an edge every window within one cell holds returns of both faces, and its plane is
    thicker than that of a window two cells away; of similar planes the thinnest is listed.

    Args:
        c: Row of the cell.
        cells: Of `find_cells`, (C,).
        where: Of `find_cells`.
        side: Cells along tile and halo.
        halo: Cells of the halo.
        cell_m: Edge of a cell [m].
        planes: Of `window_planes`, two rows for each cell, (2 C, PLANE).
        thickness: Of `thickness_of`, (2 C,).
        out: Receives the rows of the planes, (L,).

    Returns:
        How many there are.
    """
    count = 0
    cx, cy, cz = center_of(cells[c], side, halo, cell_m)
    ci, cj, ck = cells[c] % side, cells[c] // side % side, cells[c] // (side * side)
    for k in range(max(ck - 2, 0), min(ck + 3, side)):
        for j in range(max(cj - 2, 0), min(cj + 3, side)):
            for i in range(max(ci - 2, 0), min(ci + 3, side)):
                at = 2 * np.int64(where[(k * side + j) * side + i])
                if at < 0:
                    continue
                for p in range(at, at + 2):
                    if not thickness[p] < np.inf:
                        continue
                    nx, ny, nz = planes[p, 0], planes[p, 1], planes[p, 2]
                    away = nx * cx + ny * cy + nz * cz - planes[p, 3]
                    if abs(away) > 0.87 * cell_m + 2.0 * planes[p, 4]:
                        continue
                    same = -1
                    for q in range(count):
                        d = out[q]
                        ux, uy, uz = planes[d, 0], planes[d, 1], planes[d, 2]
                        off = away - (ux * cx + uy * cy + uz * cz - planes[d, 3])
                        if (
                            ux * nx + uy * ny + uz * nz > _SAME_COS
                            and abs(off) < _SAME * planes[p, 4]
                        ):
                            same = q
                            break
                    if same < 0 and count < len(out):
                        out[count] = p
                        count += 1
                    elif same >= 0 and thickness[p] < _THINNER * thickness[out[same]]:
                        out[same] = p
    return count


@njit(cache=True, nogil=True, error_model="numpy")
def thickness_of(planes: NDArray[np.float64], out: NDArray[np.float64]) -> None:
    """Standard deviation across planes, plus what few returns leave uncertain of it.

    Args:
        planes: (K, PLANE).
        out: Receives it [m], inf where there is no plane, (K,).
    """
    for k in range(len(planes)):
        out[k] = np.inf
        if planes[k, 4] > 0.0:
            out[k] = planes[k, 4] * (1.0 + 2.0 / np.sqrt(planes[k, 5]))


@njit(cache=True, nogil=True, error_model="numpy")
def only_plane(
    xyz: NDArray[np.float32],
    to_sensor: NDArray[np.float32],
    weight: NDArray[np.float32],
    starts: NDArray[np.int32],
    planes: NDArray[np.float64],
    calm: NDArray[np.bool_],
    gate: float,
    least: float,
    slots: NDArray[np.int32],
    slot_of: NDArray[np.uint8],
    other: NDArray[np.int32],
) -> int:
    """Give cells of calm windows the only plane they have, if their returns support no other one.

    Args:
        xyz: Points [m], (N, 3).
        to_sensor: Vectors to the sensor [m], (N, 3).
        weight: Of each point, (N,).
        starts: Of `find_cells`, (C + 1,).
        planes: Of `window_planes`, (C, 2, PLANE).
        calm: Of `window_planes`, (C,).
        gate: Returns within that many standard deviations support a plane.
        least: Least support of a second plane.
        slots: Receives the rows of the planes among all, -1 = none, (C, SLOTS).
        slot_of: Receives the slot each point supports, SLOTS = none, (N,).
        other: Receives -1 for these cells; the others are counted, (C,).

    Returns:
        How many others there are.
    """
    count = 0
    for c in range(len(planes)):
        other[c] = count
        count += 1
        slots[c] = -1
        s = 0 if planes[c, 0, 4] > 0.0 else 1
        plane = planes[c, s]
        if not (calm[c] and plane[4] > 0.0) or (s == 0 and planes[c, 1, 4] > 0.0):
            continue
        loose = 0.0
        for p in range(starts[c], starts[c + 1]):
            slot_of[p] = 0
            if not abs(distance_in_front(plane, xyz, to_sensor, p)) <= gate * plane[4]:
                slot_of[p] = SLOTS
                loose += weight[p]
        if loose > least:
            continue
        slots[c, 0] = 2 * c + s
        other[c] = -1
        count -= 1
    return count


@njit(cache=True, nogil=True, error_model="numpy")
def choose_planes(
    xyz: NDArray[np.float32],
    to_sensor: NDArray[np.float32],
    weight: NDArray[np.float32],
    starts: NDArray[np.int32],
    where: NDArray[np.int32],
    cells: NDArray[np.int32],
    side: int,
    halo: int,
    cell_m: float,
    planes: NDArray[np.float64],
    thickness: NDArray[np.float64],
    gate: float,
    least: float,
    other: NDArray[np.int32],
    slots: NDArray[np.int32],
    slot_of: NDArray[np.uint8],
    sums: NDArray[np.float64],
) -> None:
    """Give each other cell the planes that its returns support, one after the other.

    A cell at an edge has no clean plane of its own: its neighbors' planes reach into it.

    Args:
        xyz: Points [m], (N, 3).
        to_sensor: Vectors to the sensor [m], (N, 3).
        weight: Of each point, (N,).
        starts: Of `find_cells`, (C + 1,).
        where: Of `find_cells`.
        cells: Of `find_cells`, (C,).
        side: Cells along tile and halo.
        halo: Cells of the halo.
        cell_m: Edge of a cell [m].
        planes: Of `window_planes`, two rows for each cell, (2 C, PLANE).
        thickness: Of `thickness_of`, (2 C,).
        gate: Returns within that many standard deviations support a plane.
        least: Least support of a second plane; a tenth of it is enough for the first.
        other: Of `only_plane`, (C,).
        slots: Receives the rows of the planes, -1 = none, (C, SLOTS).
        slot_of: Receives the slot each point supports, SLOTS = none, (N,).
        sums: Receives the moments of each slot of the other cells, (K, SLOTS, MOMENTS).
    """
    listed = np.empty(_MOST_LISTED, np.int64)
    most = 0
    for c in range(len(cells)):
        most = max(most, starts[c + 1] - starts[c])
    fits, fit = np.empty((len(listed), most)), np.empty(most)
    for c in range(len(cells)):
        if other[c] < 0:
            continue
        first, points = starts[c], starts[c + 1] - starts[c]
        returns = 0.0
        for p in range(points):
            slot_of[first + p] = SLOTS
            fit[p] = 0.0
            returns += weight[first + p]
        count = list_candidates(c, cells, where, side, halo, cell_m, planes, thickness, listed)
        for q in range(count):
            plane = planes[listed[q]]
            scale = 1.0 / (gate * plane[4])
            for p in range(points):
                away = scale * distance_in_front(plane, xyz, to_sensor, first + p)
                fits[q, p] = 1.0 - away * away
        for slot in range(min(SLOTS, count)):
            best, chosen = 0.0, -1
            enough = least if slot else 0.1 * least
            for q in range(count):
                support = 0.0
                for p in range(points):
                    if slot_of[first + p] == SLOTS and fits[q, p] > 0.0:
                        support += weight[first + p] * fits[q, p]
                # A plane through the tail of another surface's noise has less weight than that one.
                if support > enough and support * planes[listed[q], 5] > best:
                    best, chosen = support * planes[listed[q], 5], q
            if chosen < 0 and slot == 0:
                # A cell of few returns may hold the noise of a surface of many.
                best = _MIN_TAIL * returns
                for q in range(count):
                    if planes[listed[q], 5] > best:
                        best, chosen = planes[listed[q], 5], q
            if chosen < 0:
                break
            slots[c, slot] = listed[chosen]
            for p in range(points):
                if fits[chosen, p] > fit[p]:
                    fit[p] = fits[chosen, p]
                    slot_of[first + p] = slot
        mine = sums[other[c]]
        mine[:] = 0.0
        for p in range(first, first + points):
            if slot_of[p] < SLOTS:
                x, y, z = np.float64(xyz[p, 0]), np.float64(xyz[p, 1]), np.float64(xyz[p, 2])
                add_point(mine[slot_of[p]], np.float64(weight[p]), x, y, z)


@njit(cache=True, nogil=True, error_model="numpy")
def refit_plane(
    row: int,
    center: tuple[float, float, float],
    cell_m: float,
    run: tuple[int, int],
    near: NDArray[np.int32],
    at: NDArray[np.uint8],
    planes: NDArray[np.float64],
    slots: NDArray[np.int32],
    other: NDArray[np.int32],
    moments: NDArray[np.float64],
    sums: NDArray[np.float64],
    limits: NDArray[np.float64],
    found: NDArray[np.float64],
    new: NDArray[np.float64],
) -> None:
    """Fit a plane of a cell again, to the points that support it in the 3 x 3 x 3 cells around.

    Args:
        row: Of the plane so far.
        center: Of the cell [m].
        cell_m: Edge of a cell [m].
        run: First of its neighbors of `list_neighbors`, itself included, and the first beyond.
        near: Of `list_neighbors`.
        at: Of `list_neighbors`.
        planes: Of `window_planes`, two rows for each cell, (2 C, PLANE).
        slots: Of `choose_planes`, (C, SLOTS).
        other: Of `only_plane`, (C,).
        moments: Of the sides of each cell, two rows for each, (2 C, MOMENTS).
        sums: Of `choose_planes`, (K, SLOTS, MOMENTS).
        limits: Least weight, least standard deviation along [m], standard deviation of a cell's
            own offset [m], (3,).
        found: Scratch, (MOMENTS + 11,).
        new: Receives the plane, (PLANE,).
    """
    total, column, fitted = found[:MOMENTS], found[MOMENTS : MOMENTS + 4], found[MOMENTS + 4 :]
    mine = planes[row]
    along = main_axis(mine)
    nx, ny, nz, reach = mine[0], mine[1], mine[2], 0.7 * mine[4]
    middle = nx * center[0] + ny * center[1] + nz * center[2] - mine[3]
    total[:] = 0.0
    column[:] = 0.0
    for k in range(run[0], run[1]):
        o = near[k]
        cell: Any = np.int64(at[k])
        x = 0.5 * cell_m * (cell % 3 - 1)
        y = 0.5 * cell_m * (cell // 3 % 3 - 1)
        z = 0.5 * cell_m * (cell // 9 - 1)
        away = middle + nx * x + ny * y + nz * z
        x, y, z = center[0] + x, center[1] + y, center[2] + z
        for t in range(SLOTS):
            s = slots[o, t]
            if s < 0:
                break
            u, v, w = planes[s, 0], planes[s, 1], planes[s, 2]
            if (
                nx * u + ny * v + nz * w <= 0.96
                or abs(u * x + v * y + w * z - planes[s, 3] - away) >= reach
            ):
                continue
            own = column_of(cell, along) == OWN_COLUMN
            if other[o] < 0:
                for d in range(MOMENTS):
                    total[d] += moments[s, d]
                if own:
                    for d in range(4):
                        column[d] += moments[s, d]
            else:
                j = other[o]
                for d in range(MOMENTS):
                    total[d] += sums[j, t, d]
                if own:
                    for d in range(4):
                        column[d] += sums[j, t, d]
    new[:] = mine
    if total[0] < limits[0] or not plane_of(total, fitted):
        return
    dot = fitted[0] * nx + fitted[1] * ny + fitted[2] * nz
    if fitted[5] < limits[1] ** 2 or abs(dot) < 0.94:
        return
    write_plane(new, fitted, 1.0 if dot > 0.0 else -1.0, total)
    new[3] = own_offset(new, column, limits[2])
