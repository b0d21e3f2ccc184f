"""Kernels of fitted surfaces: points moved onto the planes of their cells."""

from __future__ import annotations

import numpy as np
from numba import njit
from numpy.typing import NDArray

from recon4.kernels.surface_cells import SLOTS, distance_in_front

SURFACE = 9
"""Shift x y z onto the surface [m], unit normal, standard deviation across [m], returns, planarity;
without a surface 0, the normal of the neighborhood, NaN, 0, 0."""
_ONE_SIDE_M = 0.012
"""A surface whose middle is nearer to a plane than this lies on both sides of it [m]."""


@njit(cache=True, nogil=True, error_model="numpy")
def onto_planes(
    xyz: NDArray[np.float32],
    to_sensor: NDArray[np.float32],
    starts: NDArray[np.int32],
    normals: NDArray[np.float64],
    slots: NDArray[np.float64],
    gate: float,
    slot_of: NDArray[np.uint8],
    out: NDArray[np.float32],
) -> None:
    """Move every point along the normal onto the nearest plane of its cell.

    Args:
        xyz: Points [m], (N, 3) or more columns.
        to_sensor: Vectors to the sensor [m], (N, 3).
        starts: Of `find_cells`, (C + 1,).
        normals: Of points without a plane [unit], (C, 3).
        slots: Planes of each cell, (C, SLOTS, PLANE).
        gate: Farther points keep their place [standard deviations].
        slot_of: Receives the plane of each point, SLOTS = none, (N,).
        out: Receives a row of `SURFACE` for each point, (N, SURFACE).
    """
    side_of, shift = np.zeros((SLOTS, SLOTS)), np.zeros(3)
    for c in range(len(starts) - 1):
        count = 0
        while count < SLOTS and slots[c, count, 4] > 0.0:
            count += 1
        if count > 1:
            edge_sides(slots[c], count, side_of)
        for p in range(starts[c], starts[c + 1]):
            mine = SLOTS
            best = gate
            off = 0.0
            for s in range(count):
                away = distance_in_front(slots[c, s], xyz, to_sensor, p)
                if abs(away) < best * slots[c, s, 4]:
                    best = abs(away) / slots[c, s, 4]
                    mine = s
                    off = away
            slot_of[p] = mine
            if mine == SLOTS:
                for d in range(3):
                    out[p, d] = 0.0
                    out[p, 3 + d] = normals[c, d]
                out[p, 6], out[p, 7], out[p, 8] = np.nan, 0.0, 0.0
                continue
            plane = slots[c, mine]
            for d in range(3):
                shift[d] = -off * plane[d]
            if count > 1:
                keep_inside(xyz, p, slots[c], count, mine, side_of, shift)
            for d in range(3):
                out[p, d] = shift[d]
                out[p, 3 + d] = plane[d]
                out[p, 6 + d] = plane[4 + d]


@njit(cache=True, nogil=True, error_model="numpy")
def spread_surfaces(
    rows: NDArray[np.int64],
    surfaces: NDArray[np.float32],
    offset: NDArray[np.float32],
    normal: NDArray[np.float32],
    facts: NDArray[np.float32],
    returns: NDArray[np.uint16],
) -> None:
    """Copy what is known of the surfaces of points to columns.

    Args:
        rows: Row of each point in ``surfaces``, (M,).
        surfaces: Of `onto_planes`, (N, SURFACE).
        offset: Receives the offset from the surface to where each was measured [m], (M, 3).
        normal: Receives the normals, (M, 3).
        facts: Receives standard deviation across [m] and planarity, (2, M).
        returns: Receives the number of returns, 1 without a surface, (M,).
    """
    for m in range(len(rows)):
        one = surfaces[rows[m]]
        for d in range(3):
            offset[m, d] = -one[d]
            normal[m, d] = one[3 + d]
        facts[0, m] = one[6]
        facts[1, m] = one[8]
        returns[m] = min(max(one[7], 1.0), 65535.0)


@njit(cache=True, nogil=True, error_model="numpy")
def find_strays(
    weight: NDArray[np.float32],
    starts: NDArray[np.int32],
    begin: NDArray[np.int32],
    near: NDArray[np.int32],
    slot_of: NDArray[np.uint8],
    ratio: float,
    sums: NDArray[np.float64],
    stray: NDArray[np.bool_],
) -> None:
    """Mark points on no surface that are few beside the returns of the surfaces around them.

    Args:
        weight: Returns of each point, (N,).
        starts: Of `find_cells`, (C + 1,).
        begin: Of `list_neighbors`, (C + 1,).
        near: Of `list_neighbors`.
        slot_of: Plane of each point, SLOTS = none, (N,).
        ratio: Largest ratio of such returns in the 3 x 3 x 3 cells around.
        sums: Receives the returns of each cell, and those on no surface, (C, 2).
        stray: Receives the marks, (N,).
    """
    count = len(starts) - 1
    for c in range(count):
        sums[c] = 0.0
        for p in range(starts[c], starts[c + 1]):
            sums[c, 0] += weight[p]
            if slot_of[p] == SLOTS:
                sums[c, 1] += weight[p]
    for c in range(count):
        few = False
        if sums[c, 1] > 0.0:
            every = loose = 0.0
            for k in range(begin[c], begin[c + 1]):
                every += sums[near[k], 0]
                loose += sums[near[k], 1]
            few = loose <= ratio * every
        for p in range(starts[c], starts[c + 1]):
            stray[p] = few and slot_of[p] == SLOTS


@njit(cache=True, nogil=True, error_model="numpy")
def edge_sides(planes: NDArray[np.float64], count: int, out: NDArray[np.float64]) -> None:
    """On which side of each plane of a cell the surfaces of the others lie: 1, -1, 0 = both.

    Args:
        planes: Of the cell, (SLOTS, PLANE).
        count: How many there are.
        out: Receives the sides: ``out[a, b]`` = surface a, side of b, (SLOTS, SLOTS).
    """
    for a in range(count):
        middle = planes[a, 7:10]
        for b in range(count):
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
