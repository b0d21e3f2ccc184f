"""Kernels of fitted surfaces: points that were moved onto a plane beyond the end of its surface."""

from __future__ import annotations

import numpy as np
from numba import njit
from numpy.typing import NDArray

from recon4.kernels.surface_cells import OWN_COLUMN, SLOTS, center_of, column_of, main_axis

KEPT = SLOTS + 1
"""In place of a plane: the point has none, but is not a stray return."""
_HALVES = 2
"""Parts of a cell along each axis of its plane."""
_UNEVEN = 0.5
"""Largest mean distance of the returns of such a part from their plane [standard deviations]."""
_CERTAIN = 3.0
"""The mean distance is that many of its own standard deviations, at least."""
_SAME_COS = 0.95
"""Planes of other cells with a larger cosine are parts of the same surface."""


@njit(cache=True, nogil=True, error_model="numpy", inline="always")
def _part_of(
    xyz: NDArray[np.float32], p: int, center: tuple[float, float, float], along: int
) -> int:
    """Which quarter of its cell a point lies in, seen along an axis."""
    part = 0
    for d in range(3):
        if d != along:
            part = _HALVES * part + (1 if xyz[p, d] > center[d] else 0)
    return part


@njit(cache=True, nogil=True, error_model="numpy")
def _add_column(
    xyz: NDArray[np.float32],
    weight: NDArray[np.float32],
    run: tuple[int, int],
    center: tuple[float, float, float],
    normal: NDArray[np.float64],
    slot_of: NDArray[np.uint8],
    shift_m: NDArray[np.float32],
    surface_of: NDArray[np.int32],
    surfaces: NDArray[np.float32],
    parts: NDArray[np.float64],
) -> None:
    """Add weights and weighted distances of the points of one cell that lie on a surface.

    Points moved to an edge do not count.
    """
    along = main_axis(normal)
    for p in range(run[0], run[1]):
        if slot_of[p] >= SLOTS:
            continue
        one = surfaces[surface_of[p]]
        if one[0] * normal[0] + one[1] * normal[1] + one[2] * normal[2] < _SAME_COS:
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
    xyz: NDArray[np.float32],
    weight: NDArray[np.float32],
    starts: NDArray[np.int32],
    cells: NDArray[np.int32],
    grid: tuple[int, int, float],
    neighbors: tuple[NDArray[np.int32], NDArray[np.int32], NDArray[np.uint8]],
    other: NDArray[np.int32],
    slot_of: NDArray[np.uint8],
    shift_m: NDArray[np.float32],
    surface_of: NDArray[np.int32],
    surfaces: NDArray[np.float32],
    beyond: NDArray[np.bool_],
) -> None:
    """Find quarters of cells whose returns lie on one side of the plane that they were moved to.

    Noise lies on both sides of its surface. So these returns are of another one, that has no plane
    of its own: a reveal narrower than a window, behind the end of a wall.

    Args:
        xyz: Points [m], (N, 3) or more columns.
        weight: Returns of each point, (N,).
        starts: Of `find_cells`, (C + 1,).
        cells: Of `find_cells`, (C,).
        grid: As in `planes_at`.
        neighbors: Of `list_neighbors`: begin, near, at.
        other: Of `only_plane`; cells of one plane are not looked at, (C,).
        slot_of: Of `onto_planes`, (N,).
        shift_m: Of `onto_planes` [m], (N, 3).
        surface_of: Of `onto_planes`, (N,).
        surfaces: Of `onto_planes`, (K, SURFACE).
        beyond: Receives the quarters of each plane of a cell, (C, SLOTS, 4).
    """
    begin, near, at = neighbors
    parts, normal = np.zeros((_HALVES * _HALVES, 2)), np.zeros(3)
    row_of = np.empty(SLOTS, np.int64)
    for c in range(len(cells)):
        beyond[c] = False
        if other[c] < 0:
            continue
        row_of[:] = -1
        for p in range(starts[c], starts[c + 1]):
            if slot_of[p] < SLOTS:
                row_of[slot_of[p]] = surface_of[p]
        center = center_of(cells[c], *grid)
        for s in range(SLOTS):
            if row_of[s] < 0:
                continue
            for d in range(3):
                normal[d] = surfaces[row_of[s], d]
            along = main_axis(normal)
            parts[:] = 0.0
            for k in range(begin[c], begin[c + 1]):
                if column_of(at[k], along) == OWN_COLUMN:
                    run = starts[near[k]], starts[near[k] + 1]
                    _add_column(
                        xyz, weight, run, center, normal, slot_of, shift_m, surface_of,
                        surfaces, parts,
                    )  # fmt: skip
            for q in range(len(parts)):
                least = max(_UNEVEN * parts[q, 0], _CERTAIN * np.sqrt(parts[q, 0]))
                beyond[c, s, q] = abs(parts[q, 1]) > surfaces[row_of[s], 3] * least


@njit(cache=True, nogil=True, error_model="numpy")
def put_back(
    xyz: NDArray[np.float32],
    starts: NDArray[np.int32],
    cells: NDArray[np.int32],
    grid: tuple[int, int, float],
    normals: NDArray[np.float64],
    beyond: NDArray[np.bool_],
    slot_of: NDArray[np.uint8],
    shift_m: NDArray[np.float32],
    surface_of: NDArray[np.int32],
    surfaces: NDArray[np.float32],
    made: int,
) -> int:
    """Leave the points of the quarters found by `find_beyond` where they were measured.

    Args:
        xyz: As in `find_beyond`.
        starts: As in `find_beyond`.
        cells: As in `find_beyond`.
        grid: As in `find_beyond`.
        normals: Of points without a plane [unit], (C, 3).
        beyond: Of `find_beyond`, (C, SLOTS, 4).
        slot_of: Plane of each point; `KEPT` afterwards, (N,).
        shift_m: Onto it [m]; zero afterwards, (N, 3).
        surface_of: Row of each point's surface, (N,).
        surfaces: Receives those of points without one, a row for each cell at most, (K, SURFACE).
        made: How many surfaces there are.

    Returns:
        How many there are then.
    """
    normal = np.zeros(3)
    for c in range(len(cells)):
        if not beyond[c].any():
            continue
        center = center_of(cells[c], *grid)
        used = False
        for p in range(starts[c], starts[c + 1]):
            s = slot_of[p]
            if s >= SLOTS:
                continue
            for d in range(3):
                normal[d] = surfaces[surface_of[p], d]
            if not beyond[c, s, _part_of(xyz, p, center, main_axis(normal))]:
                continue
            slot_of[p] = KEPT
            surface_of[p] = made
            shift_m[p, 0] = shift_m[p, 1] = shift_m[p, 2] = 0.0
            used = True
        if used:
            for d in range(3):
                surfaces[made, d] = normals[c, d]
            surfaces[made, 3], surfaces[made, 4], surfaces[made, 5] = np.nan, 0.0, 0.0
            made += 1
    return made
