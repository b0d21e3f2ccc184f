"""Kernels of fitted surfaces: the planes that the returns of a cell support, fitted again."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from numba import njit
from numpy.typing import NDArray

from recon4.kernels.moments import MOMENTS, add_point, plane_of
from recon4.kernels.surface_cells import (
    OWN_COLUMN,
    center_of,
    column_of,
    distance_in_front,
    main_axis,
)
from recon4.kernels.surface_records import (
    PLANE,
    SLOTS,
    Cells,
    Neighbors,
    PlaneLimits,
    Returns,
    Supported,
)
from recon4.kernels.surface_shapes import own_offset, write_plane


class SlotLimits(NamedTuple):
    """Which planes of a cell and its neighbors are candidates, and when two are one."""

    most_listed: int = 24
    min_tail: float = 250.0
    """A surface has this many times the returns of a cell that holds the end of its noise only."""
    same_cos: float = 0.95
    """Planes are similar with a larger cosine …"""
    same: float = 1.0
    """… and a smaller distance [standard deviations]."""
    thinner: float = 0.95
    """A similar plane takes the place of another one below this ratio of their deviations."""


LISTS = SlotLimits()


@njit(cache=True, nogil=True, error_model="numpy")
def list_candidates(
    c: int,
    cells: Cells,
    planes: NDArray[np.float64],
    thickness: NDArray[np.float64],
    out: NDArray[np.int64],
) -> int:
    """Different planes among those of the 5 x 5 x 5 cells around a cell.

    Beside an edge every window within one cell holds returns of both faces, and its plane is
    thicker than that of a window two cells away; of similar planes the thinnest is listed.

    Args:
        c: Row of the cell.
        cells: Of `find_cells`.
        planes: Of `window_planes`, two rows for each cell, (2 C, 11).
        thickness: Of `thickness_of`, (2 C,).
        out: Receives the rows of the planes, (L,).

    Returns:
        How many there are.
    """
    side = cells.side
    count = 0
    cx, cy, cz = center_of(c, cells)
    cell = cells.number[c]
    ci, cj, ck = cell % side, cell // side % side, cell // (side * side)
    for k in range(max(ck - 2, 0), min(ck + 3, side)):
        for j in range(max(cj - 2, 0), min(cj + 3, side)):
            for i in range(max(ci - 2, 0), min(ci + 3, side)):
                first = 2 * np.int64(cells.row[(k * side + j) * side + i])
                if first < 0:
                    continue
                for p in range(first, first + 2):
                    if not thickness[p] < np.inf:
                        continue
                    nx, ny, nz = planes[p, 0], planes[p, 1], planes[p, 2]
                    away = nx * cx + ny * cy + nz * cz - planes[p, PLANE.offset]
                    if abs(away) > 0.87 * cells.edge_m + 2.0 * planes[p, PLANE.sigma]:
                        continue
                    same = -1
                    for q in range(count):
                        d = out[q]
                        ux, uy, uz = planes[d, 0], planes[d, 1], planes[d, 2]
                        off = away - (ux * cx + uy * cy + uz * cz - planes[d, PLANE.offset])
                        if (
                            ux * nx + uy * ny + uz * nz > LISTS.same_cos
                            and abs(off) < LISTS.same * planes[p, PLANE.sigma]
                        ):
                            same = q
                            break
                    if same < 0 and count < len(out):
                        out[count] = p
                        count += 1
                    elif same >= 0 and thickness[p] < LISTS.thinner * thickness[out[same]]:
                        out[same] = p
    return count


@njit(cache=True, nogil=True, error_model="numpy")
def thickness_of(planes: NDArray[np.float64], out: NDArray[np.float64]) -> None:
    """Standard deviation across planes, plus what few returns leave uncertain of it.

    Args:
        planes: (K, 11).
        out: Receives it [m], inf where there is no plane, (K,).
    """
    for k in range(len(planes)):
        out[k] = np.inf
        if planes[k, PLANE.sigma] > 0.0:
            out[k] = planes[k, PLANE.sigma] * (1.0 + 2.0 / np.sqrt(planes[k, PLANE.weight]))


@njit(cache=True, nogil=True, error_model="numpy")
def only_plane(
    returns: Returns,
    planes: NDArray[np.float64],
    calm: NDArray[np.bool_],
    gate: float,
    least: float,
    out: Supported,
) -> int:
    """Give cells of calm windows the only plane they have, if their returns support no other one.

    Args:
        returns: Of the tile.
        planes: Of `window_planes`, (C, 2, 11).
        calm: Of `window_planes`, (C,).
        gate: Returns within that many standard deviations support a plane.
        least: Least support of a second plane.
        out: Receives the planes of these cells and of their points; the other cells are counted.

    Returns:
        How many others there are.
    """
    first, weight = returns.first, returns.weight
    count = 0
    for c in range(len(planes)):
        out.several[c] = count
        count += 1
        out.plane[c] = -1
        s = 0 if planes[c, 0, PLANE.sigma] > 0.0 else 1
        plane = planes[c, s]
        is_sure = calm[c] and plane[PLANE.sigma] > 0.0
        if not is_sure or (s == 0 and planes[c, 1, PLANE.sigma] > 0.0):
            continue
        loose = 0.0
        for p in range(first[c], first[c + 1]):
            out.of_point[p] = 0
            if not abs(distance_in_front(plane, returns, p)) <= gate * plane[PLANE.sigma]:
                out.of_point[p] = SLOTS
                loose += weight[p]
        if loose > least:
            continue
        out.plane[c, 0] = 2 * c + s
        out.several[c] = -1
        count -= 1
    return count


@njit(cache=True, nogil=True, error_model="numpy")
def choose_planes(
    returns: Returns,
    cells: Cells,
    planes: NDArray[np.float64],
    thickness: NDArray[np.float64],
    gate: float,
    least: float,
    out: Supported,
) -> None:
    """Give each cell of several planes those that its returns support, one after the other.

    A cell at an edge has no clean plane of its own: its neighbors' planes reach into it.

    Args:
        returns: Of the tile.
        cells: Of `find_cells`.
        planes: Of `window_planes`, two rows for each cell, (2 C, 11).
        thickness: Of `thickness_of`, (2 C,).
        gate: Returns within that many standard deviations support a plane.
        least: Least support of a second plane; a tenth of it is enough for the first.
        out: Of `only_plane`; receives the planes of the other cells.
    """
    xyz, _, weight, first_point = returns
    several, of_point = out.several, out.of_point
    listed = np.empty(LISTS.most_listed, np.int64)
    most = 0
    for c in range(len(cells.number)):
        most = max(most, first_point[c + 1] - first_point[c])
    fits, fit = np.empty((len(listed), most)), np.empty(most)
    for c in range(len(cells.number)):
        if several[c] < 0:
            continue
        first, points = first_point[c], first_point[c + 1] - first_point[c]
        total = 0.0
        for p in range(points):
            of_point[first + p] = SLOTS
            fit[p] = 0.0
            total += weight[first + p]
        count = list_candidates(c, cells, planes, thickness, listed)
        for q in range(count):
            plane = planes[listed[q]]
            scale = 1.0 / (gate * plane[PLANE.sigma])
            for p in range(points):
                away = scale * distance_in_front(plane, returns, first + p)
                fits[q, p] = 1.0 - away * away
        for slot in range(min(SLOTS, count)):
            best, chosen = 0.0, -1
            enough = least if slot else 0.1 * least
            for q in range(count):
                support = 0.0
                for p in range(points):
                    if of_point[first + p] == SLOTS and fits[q, p] > 0.0:
                        support += weight[first + p] * fits[q, p]
                # A plane through the tail of another surface's noise has less weight than that one.
                if support > enough and support * planes[listed[q], PLANE.weight] > best:
                    best, chosen = support * planes[listed[q], PLANE.weight], q
            if chosen < 0 and slot == 0:
                # A cell of few returns may hold the noise of a surface of many.
                best = LISTS.min_tail * total
                for q in range(count):
                    if planes[listed[q], PLANE.weight] > best:
                        best, chosen = planes[listed[q], PLANE.weight], q
            if chosen < 0:
                break
            out.plane[c, slot] = listed[chosen]
            for p in range(points):
                if fits[chosen, p] > fit[p]:
                    fit[p] = fits[chosen, p]
                    of_point[first + p] = slot
        mine = out.sums[several[c]]
        mine[:] = 0.0
        for p in range(first, first + points):
            if of_point[p] < SLOTS:
                x, y, z = np.float64(xyz[p, 0]), np.float64(xyz[p, 1]), np.float64(xyz[p, 2])
                add_point(mine[of_point[p]], np.float64(weight[p]), x, y, z)


@njit(cache=True, nogil=True, error_model="numpy")
def refit_plane(
    row: int,
    c: int,
    cells: Cells,
    neighbors: Neighbors,
    planes: NDArray[np.float64],
    supported: Supported,
    moments: NDArray[np.float64],
    limits: PlaneLimits,
    scratch: NDArray[np.float64],
    new: NDArray[np.float64],
) -> None:
    """Fit a plane of a cell again, to the points that support it in the 3 x 3 x 3 cells around.

    Args:
        row: Of the plane so far.
        c: Row of the cell.
        cells: Of `find_cells`.
        neighbors: Of `list_neighbors`.
        planes: Of `window_planes`, two rows for each cell, (2 C, 11).
        supported: Of `choose_planes`.
        moments: Of the sides of each cell, two rows for each, (2 C, MOMENTS).
        limits: What is a plane.
        scratch: (MOMENTS + 11,).
        new: Receives the plane, (11,).
    """
    center, cell_m = center_of(c, cells), cells.edge_m
    total, column, fitted = (
        scratch[:MOMENTS],
        scratch[MOMENTS : MOMENTS + 4],
        scratch[MOMENTS + 4 :],
    )
    mine = planes[row]
    along = main_axis(mine)
    nx, ny, nz, reach = mine[0], mine[1], mine[2], 0.7 * mine[PLANE.sigma]
    middle = nx * center[0] + ny * center[1] + nz * center[2] - mine[PLANE.offset]
    total[:] = 0.0
    column[:] = 0.0
    for k in range(neighbors.first[c], neighbors.first[c + 1]):
        o = neighbors.row[k]
        cell: Any = np.int64(neighbors.offset[k])
        x = 0.5 * cell_m * (cell % 3 - 1)
        y = 0.5 * cell_m * (cell // 3 % 3 - 1)
        z = 0.5 * cell_m * (cell // 9 - 1)
        away = middle + nx * x + ny * y + nz * z
        x, y, z = center[0] + x, center[1] + y, center[2] + z
        for t in range(SLOTS):
            s = supported.plane[o, t]
            if s < 0:
                break
            u, v, w = planes[s, 0], planes[s, 1], planes[s, 2]
            if (
                nx * u + ny * v + nz * w <= 0.96
                or abs(u * x + v * y + w * z - planes[s, PLANE.offset] - away) >= reach
            ):
                continue
            own = column_of(cell, along) == OWN_COLUMN
            if supported.several[o] < 0:
                for d in range(MOMENTS):
                    total[d] += moments[s, d]
                if own:
                    for d in range(4):
                        column[d] += moments[s, d]
            else:
                j = supported.several[o]
                for d in range(MOMENTS):
                    total[d] += supported.sums[j, t, d]
                if own:
                    for d in range(4):
                        column[d] += supported.sums[j, t, d]
    new[:] = mine
    if total[0] < limits.min_returns or not plane_of(total, fitted):
        return
    dot = fitted[0] * nx + fitted[1] * ny + fitted[2] * nz
    if fitted[5] < limits.min_along_m**2 or abs(dot) < 0.94:
        return
    write_plane(new, fitted, 1.0 if dot > 0.0 else -1.0, total)
    new[PLANE.offset] = own_offset(new, column, limits.bend_m)
