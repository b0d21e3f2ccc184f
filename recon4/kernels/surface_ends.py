"""Kernels of fitted surfaces: points that were moved onto a plane beyond the end of its surface."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numba import njit
from numpy.typing import NDArray

from recon4.kernels.surface_cells import OWN_COLUMN, center_of, column_of, main_axis
from recon4.kernels.surface_records import SLOTS, Cells, Moved, Neighbors, Returns, Supported

KEPT = SLOTS + 1
"""In place of a plane: the point has none, but is not a stray return."""


class EndLimits(NamedTuple):
    """When returns were moved beyond the end of a surface."""

    halves: int = 2
    """Parts of a cell along each axis of its plane."""
    uneven: float = 0.5
    """Largest mean distance of the returns of such a part from their plane [standard
    deviations]."""
    certain: float = 3.0
    """The mean distance is that many of its own standard deviations, at least."""
    same_cos: float = 0.95
    """Planes of other cells with a larger cosine are parts of the same surface."""


ENDS = EndLimits()


@njit(cache=True, nogil=True, error_model="numpy", inline="always")
def _part_of(
    xyz: NDArray[np.float32], p: int, center: tuple[float, float, float], along: int
) -> int:
    """Which quarter of its cell a point lies in, seen along an axis."""
    part = 0
    for d in range(3):
        if d != along:
            part = ENDS.halves * part + (1 if xyz[p, d] > center[d] else 0)
    return part


@njit(cache=True, nogil=True, error_model="numpy")
def _add_column(
    returns: Returns,
    cell: int,
    center: tuple[float, float, float],
    normal: NDArray[np.float64],
    of_point: NDArray[np.uint8],
    moved: Moved,
    parts: NDArray[np.float64],
) -> None:
    """Add weights and weighted distances of the points of one cell that lie on a surface.

    Points moved to an edge do not count.
    """
    xyz, _, weight, first = returns
    shift_m, surface_of, surfaces = moved
    along = main_axis(normal)
    for p in range(first[cell], first[cell + 1]):
        if of_point[p] >= SLOTS:
            continue
        one = surfaces[surface_of[p]]
        if one[0] * normal[0] + one[1] * normal[1] + one[2] * normal[2] < ENDS.same_cos:
            continue
        u, v, w = shift_m[p, 0], shift_m[p, 1], shift_m[p, 2]
        off = -(one[0] * u + one[1] * v + one[2] * w)
        if u * u + v * v + w * w > 1.02 * off * off + 1e-8:
            continue
        part = _part_of(xyz, p, center, along)
        parts[part, 0] += weight[p]
        parts[part, 1] += weight[p] * off


@njit(cache=True, nogil=True, error_model="numpy")
def find_beyond(
    returns: Returns,
    cells: Cells,
    neighbors: Neighbors,
    supported: Supported,
    moved: Moved,
    beyond: NDArray[np.bool_],
) -> None:
    """Find quarters of cells whose returns lie on one side of the plane that they were moved to.

    Noise lies on both sides of its surface. So these returns are of another one, that has no plane
    of its own: a reveal narrower than a window, behind the end of a wall.

    Args:
        returns: Of the tile, with the positions as they were measured.
        cells: Of `find_cells`.
        neighbors: Of `list_neighbors`.
        supported: Of `onto_planes`; cells of one plane are not looked at.
        moved: Of `onto_planes`.
        beyond: Receives the quarters of each plane of a cell, (C, SLOTS, 4).
    """
    first, of_point = returns.first, supported.of_point
    _, surface_of, surfaces = moved
    parts, normal = np.zeros((ENDS.halves * ENDS.halves, 2)), np.zeros(3)
    row_of = np.empty(SLOTS, np.int64)
    for c in range(len(cells.number)):
        beyond[c] = False
        if supported.several[c] < 0:
            continue
        row_of[:] = -1
        for p in range(first[c], first[c + 1]):
            if of_point[p] < SLOTS:
                row_of[of_point[p]] = surface_of[p]
        center = center_of(c, cells)
        for s in range(SLOTS):
            if row_of[s] < 0:
                continue
            for d in range(3):
                normal[d] = surfaces[row_of[s], d]
            along = main_axis(normal)
            parts[:] = 0.0
            for k in range(neighbors.first[c], neighbors.first[c + 1]):
                if column_of(neighbors.offset[k], along) == OWN_COLUMN:
                    cell = neighbors.row[k]
                    _add_column(returns, cell, center, normal, of_point, moved, parts)
            for q in range(len(parts)):
                least = max(ENDS.uneven * parts[q, 0], ENDS.certain * np.sqrt(parts[q, 0]))
                beyond[c, s, q] = abs(parts[q, 1]) > surfaces[row_of[s], 3] * least


@njit(cache=True, nogil=True, error_model="numpy")
def put_back(
    returns: Returns,
    cells: Cells,
    normals: NDArray[np.float64],
    beyond: NDArray[np.bool_],
    of_point: NDArray[np.uint8],
    moved: Moved,
    count: int,
) -> int:
    """Leave the points of the quarters found by `find_beyond` where they were measured.

    Args:
        returns: As in `find_beyond`.
        cells: As in `find_beyond`.
        normals: Of points without a plane [unit], (C, 3).
        beyond: Of `find_beyond`, (C, SLOTS, 4).
        of_point: Plane of each point; `KEPT` afterwards, (N,).
        moved: Their shifts, zero afterwards; receives the surfaces of points without one, a row
            for each cell at most.
        count: How many surfaces there are.

    Returns:
        How many there are then.
    """
    shift_m, surface_of, surfaces = moved
    normal = np.zeros(3)
    for c in range(len(cells.number)):
        if not beyond[c].any():
            continue
        center = center_of(c, cells)
        used = False
        for p in range(returns.first[c], returns.first[c + 1]):
            s = of_point[p]
            if s >= SLOTS:
                continue
            for d in range(3):
                normal[d] = surfaces[surface_of[p], d]
            if not beyond[c, s, _part_of(returns.xyz, p, center, main_axis(normal))]:
                continue
            of_point[p] = KEPT
            surface_of[p] = count
            shift_m[p, 0] = shift_m[p, 1] = shift_m[p, 2] = 0.0
            used = True
        if used:
            for d in range(3):
                surfaces[count, d] = normals[c, d]
            surfaces[count, 3], surfaces[count, 4], surfaces[count, 5] = np.nan, 0.0, 0.0
            count += 1
    return count
