"""Kernels of fitted surfaces: the planes that the returns of a cell support, fitted again."""

from __future__ import annotations

import numpy as np
from numba import njit
from numpy.typing import NDArray

from recon4.kernels.moments import MOMENTS, add_moved, add_point, plane_of
from recon4.kernels.surface_cells import (
    PLANE,
    SLOTS,
    center_of,
    distance_in_front,
    in_column,
    main_axis,
    neighbor,
)

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
    cell_m: float,
    planes: NDArray[np.float64],
    out: NDArray[np.float64],
) -> int:
    """Different planes among those of the 5 x 5 x 5 cells around a cell.

    Beside an edge every window within one cell holds returns of both faces, and its plane is
    thicker than that of a window two cells away; of similar planes the thinnest is listed.

    Args:
        c: Row of the cell.
        cells: Of `find_cells`, (C,).
        where: Of `find_cells`.
        side: Cells along tile and halo.
        cell_m: Edge of a cell [m].
        planes: Of `window_planes`, (C, 2, PLANE).
        out: Receives the planes, (L, PLANE); those of the cell itself first.

    Returns:
        How many there are.
    """
    count = 0
    cx, cy, cz = center_of(cells[c], side, cell_m)
    ci, cj, ck = cells[c] % side, cells[c] // side % side, cells[c] // (side * side)
    for k in range(125):
        k = (k + 62) % 125  # the cell itself first
        i, j, m = ci + k % 5 - 2, cj + k // 5 % 5 - 2, ck + k // 25 - 2
        if min(i, j, m) < 0 or max(i, j, m) >= side:
            continue
        at = (m * side + j) * side + i
        if where[at] < 0:
            continue
        for s in range(2):
            p = planes[where[at], s]
            if not p[4] > 0.0:
                continue
            away = p[0] * cx + p[1] * cy + p[2] * cz - p[3]
            if abs(away) > 0.87 * cell_m + 2.0 * p[4]:
                continue
            same = -1
            for q in range(count):
                d = out[q]
                if (
                    d[0] * p[0] + d[1] * p[1] + d[2] * p[2] > _SAME_COS
                    and abs(away - (d[0] * cx + d[1] * cy + d[2] * cz - d[3])) < _SAME * p[4]
                ):
                    same = q
                    break
            if same < 0 and count < len(out):
                out[count, :] = p
                count += 1
            elif same >= 0 and thickness_at_most(p) < _THINNER * thickness_at_most(out[same]):
                out[same, :] = p
    return count


@njit(cache=True, nogil=True, error_model="numpy", inline="always")
def thickness_at_most(plane: NDArray[np.float64]) -> float:
    """Standard deviation across a plane, plus what few returns leave uncertain of it [m]."""
    return plane[4] * (1.0 + 2.0 / np.sqrt(plane[5]))


@njit(cache=True, nogil=True, error_model="numpy")
def choose_planes(
    xyz: NDArray[np.float32],
    to_sensor: NDArray[np.float32],
    weight: NDArray[np.float32],
    starts: NDArray[np.int32],
    cells: NDArray[np.int32],
    where: NDArray[np.int32],
    side: int,
    cell_m: float,
    planes: NDArray[np.float64],
    gate: float,
    least: float,
    slots: NDArray[np.float64],
    slot_of: NDArray[np.uint8],
) -> None:
    """Give each cell the planes that its returns support, one after the other.

    A cell at an edge has no clean plane of its own: its neighbors' planes reach into it.

    Args:
        xyz: Points [m], (N, 3).
        to_sensor: Vectors to the sensor [m], (N, 3).
        weight: Of each point, (N,).
        starts: Of `find_cells`, (C + 1,).
        cells: Of `find_cells`, (C,).
        where: Of `find_cells`.
        side: Cells along tile and halo.
        cell_m: Edge of a cell [m].
        planes: Of `window_planes`, (C, 2, PLANE).
        gate: Returns within that many standard deviations support a plane.
        least: Least support of a second plane; a tenth of it is enough for the first.
        slots: Receives the planes, (C, SLOTS, PLANE).
        slot_of: Receives the slot each point supports, SLOTS = none, (N,).
    """
    listed = np.empty((24, PLANE))
    fit = np.zeros(len(xyz), np.float32)
    for c in range(len(cells)):
        first, stop = starts[c], starts[c + 1]
        slots[c, :, 4] = 0.0
        slot_of[first:stop] = SLOTS
        count = list_candidates(c, cells, where, side, cell_m, planes, listed)
        for slot in range(min(SLOTS, count)):
            best, chosen = 0.0, -1
            enough = least if slot else 0.1 * least
            for q in range(count):
                support = 0.0
                scale = 1.0 / (gate * listed[q, 4])
                for p in range(first, stop):
                    if slot_of[p] == SLOTS:
                        away = scale * distance_in_front(listed[q], xyz, to_sensor, p)
                        support += weight[p] * max(0.0, 1.0 - away * away)
                # A plane through the tail of another surface's noise has less weight than that one.
                if support > enough and support * listed[q, 5] > best:
                    best, chosen = support * listed[q, 5], q
            if chosen < 0 and slot == 0:
                chosen = whose_tail(listed, count, weight[first:stop])
            if chosen < 0:
                break
            slots[c, slot, :] = listed[chosen]
            scale = 1.0 / (gate * listed[chosen, 4])
            for p in range(first, stop):
                away = scale * distance_in_front(listed[chosen], xyz, to_sensor, p)
                if 1.0 - away * away > fit[p]:
                    fit[p] = 1.0 - away * away
                    slot_of[p] = slot


@njit(cache=True, nogil=True, error_model="numpy")
def whose_tail(listed: NDArray[np.float64], count: int, weight: NDArray[np.float32]) -> int:
    """The plane that a cell of few returns may be the noise of: the one with most; -1 = none.

    Args:
        listed: Planes near the cell, (L, PLANE).
        count: How many there are.
        weight: Returns of the cell's points, (P,).
    """
    best, chosen = _MIN_TAIL * weight.sum(), -1
    for q in range(count):
        if listed[q, 5] > best:
            best, chosen = listed[q, 5], q
    return chosen


@njit(cache=True, nogil=True, error_model="numpy")
def slot_moments(
    xyz: NDArray[np.float32],
    weight: NDArray[np.float32],
    starts: NDArray[np.int32],
    cells: NDArray[np.int32],
    side: int,
    cell_m: float,
    slot_of: NDArray[np.uint8],
    moments: NDArray[np.float64],
) -> None:
    """Moments of the points of each plane of each cell, (C, SLOTS, MOMENTS)."""
    moments[:] = 0.0
    for c in range(len(cells)):
        cx, cy, cz = center_of(cells[c], side, cell_m)
        for p in range(starts[c], starts[c + 1]):
            if slot_of[p] < SLOTS:
                m = moments[c, slot_of[p]]
                add_point(m, weight[p], xyz[p, 0] - cx, xyz[p, 1] - cy, xyz[p, 2] - cz)


@njit(cache=True, nogil=True, error_model="numpy")
def refit_planes(
    cells: NDArray[np.int32],
    where: NDArray[np.int32],
    side: int,
    cell_m: float,
    slots: NDArray[np.float64],
    moments: NDArray[np.float64],
    limits: NDArray[np.float64],
    out: NDArray[np.float64],
) -> None:
    """Fit every plane of every cell again, to its points in the 3 x 3 x 3 cells around.

    Args:
        cells: Of `find_cells`, (C,).
        where: Of `find_cells`.
        side: Cells along tile and halo.
        cell_m: Edge of a cell [m].
        slots: Planes so far, (C, SLOTS, PLANE).
        moments: Of `slot_moments`, (C, SLOTS, MOMENTS).
        limits: Least weight, largest standard deviation across [m], least along [m], standard
            deviation of a cell's own offset [m], (4,).
        out: Receives the planes, (C, SLOTS, PLANE).
    """
    total, column, found = np.zeros(MOMENTS), np.zeros(MOMENTS), np.zeros(7)
    for c in range(len(cells)):
        cx, cy, cz = center_of(cells[c], side, cell_m)
        for s in range(SLOTS):
            mine, new = slots[c, s], out[c, s]
            new[:] = mine
            new[7] = np.nan
            if not mine[4] > 0.0:
                continue
            total[:] = 0.0
            column[:] = 0.0
            along = main_axis(mine)
            for k in range(27):
                o = neighbor(cells[c], k, side, where)
                if o < 0:
                    continue
                di, dj, dk = k % 3 - 1, k // 3 % 3 - 1, k // 9 - 1
                dx, dy, dz = di * cell_m, dj * cell_m, dk * cell_m
                x, y, z = cx + 0.5 * dx, cy + 0.5 * dy, cz + 0.5 * dz
                away = mine[0] * x + mine[1] * y + mine[2] * z - mine[3]
                for t in range(SLOTS):
                    q = slots[o, t]
                    if (
                        q[4] > 0.0
                        and mine[0] * q[0] + mine[1] * q[1] + mine[2] * q[2] > 0.96
                        and abs(q[0] * x + q[1] * y + q[2] * z - q[3] - away) < 0.7 * mine[4]
                    ):
                        add_moved(total, moments[o, t], dx, dy, dz)
                        if in_column(di, dj, dk, along):
                            add_moved(column, moments[o, t], dx, dy, dz)
            if total[0] < limits[0] or not plane_of(total, found):
                continue
            dot = found[0] * mine[0] + found[1] * mine[1] + found[2] * mine[2]
            if found[5] < limits[2] ** 2 or abs(dot) < 0.94:
                continue
            sign = 1.0 if dot > 0.0 else -1.0
            new[0], new[1], new[2] = sign * found[0], sign * found[1], sign * found[2]
            away = sign * found[3]
            new[4] = max(np.sqrt(found[4]), 1e-4)
            new[5] = total[0]
            new[6] = (found[5] - found[4]) / found[6]
            new[7] = total[1] / total[0] + cx
            new[8] = total[2] / total[0] + cy
            new[9] = total[3] / total[0] + cz
            # What the nearest returns say of a surface that is not quite flat: those of the cell
            # and of the two beyond it along the normal, because noise crosses their borders.
            m = column
            if m[0] > 0.0:
                own = (new[0] * m[1] + new[1] * m[2] + new[2] * m[3]) / m[0] - away
                prior = limits[3] ** 2
                away += own * prior / (prior + new[4] * new[4] / m[0])
            new[3] = away + new[0] * cx + new[1] * cy + new[2] * cz
