"""Kernels of fitted surfaces: points moved onto the planes of their cells."""

from __future__ import annotations

import numpy as np
from numba import njit
from numpy.typing import NDArray

from recon4.kernels.surface_cells import SLOTS, distance_in_front, neighbor

_ONE_SIDE_M = 0.012
"""A surface whose middle is nearer to a plane than this lies on both sides of it [m]."""


@njit(cache=True, nogil=True, error_model="numpy")
def onto_planes(
    xyz: NDArray[np.float32],
    to_sensor: NDArray[np.float32],
    starts: NDArray[np.int32],
    slots: NDArray[np.float64],
    gate: float,
    slot_of: NDArray[np.uint8],
    shift: NDArray[np.float32],
) -> None:
    """Move every point along the normal onto the nearest plane of its cell.

    Args:
        xyz: Points [m], (N, 3).
        to_sensor: Vectors to the sensor [m], (N, 3).
        starts: Of `find_cells`, (C + 1,).
        slots: Planes of each cell, (C, SLOTS, PLANE).
        gate: Farther points keep their place [standard deviations].
        slot_of: Receives the plane of each point, SLOTS = none, (N,).
        shift: Receives the shift of each point [m], (N, 3).
    """
    side_of = np.zeros((SLOTS, SLOTS))
    for c in range(len(starts) - 1):
        count = 0
        while count < SLOTS and slots[c, count, 4] > 0.0:
            count += 1
        if count > 1:
            edge_sides(slots[c], count, side_of)
        for p in range(starts[c], starts[c + 1]):
            slot_of[p] = SLOTS
            shift[p, :] = 0.0
            best = gate
            for s in range(count):
                away = distance_in_front(slots[c, s], xyz, to_sensor, p)
                if abs(away) < best * slots[c, s, 4]:
                    best = abs(away) / slots[c, s, 4]
                    slot_of[p] = s
            if slot_of[p] == SLOTS:
                continue
            plane = slots[c, slot_of[p]]
            away = plane[0] * xyz[p, 0] + plane[1] * xyz[p, 1] + plane[2] * xyz[p, 2] - plane[3]
            for d in range(3):
                shift[p, d] = -away * plane[d]
            if count > 1:
                keep_inside(xyz, p, slots[c], count, slot_of[p], side_of, shift)


@njit(cache=True, nogil=True, error_model="numpy")
def facts_of_points(
    starts: NDArray[np.int32],
    slots: NDArray[np.float64],
    slot_of: NDArray[np.uint8],
    normal: NDArray[np.float32],
    facts: NDArray[np.float32],
) -> None:
    """Normal of each point's plane, and what is known of it.

    Args:
        starts: Of `find_cells`, (C + 1,).
        slots: Planes of each cell, (C, SLOTS, PLANE).
        slot_of: Plane of each point, SLOTS = none, (N,).
        normal: Normals [unit], kept where there is no plane, (N, 3).
        facts: Receives standard deviation across [m], returns and planarity; NaN, 0, 0 without a
            plane, (3, N).
    """
    for c in range(len(slots)):
        for p in range(starts[c], starts[c + 1]):
            facts[0, p], facts[1, p], facts[2, p] = np.nan, 0.0, 0.0
            if slot_of[p] < SLOTS:
                plane = slots[c, slot_of[p]]
                for d in range(3):
                    normal[p, d] = plane[d]
                for k in range(3):
                    facts[k, p] = plane[4 + k]


@njit(cache=True, nogil=True, error_model="numpy")
def find_strays(
    weight: NDArray[np.float32],
    starts: NDArray[np.int32],
    cells: NDArray[np.int32],
    where: NDArray[np.int32],
    side: int,
    slot_of: NDArray[np.uint8],
    ratio: float,
    stray: NDArray[np.bool_],
) -> None:
    """Mark points on no surface that are few beside the returns of the surfaces around them.

    Args:
        weight: Returns of each point, (N,).
        starts: Of `find_cells`, (C + 1,).
        cells: Of `find_cells`, (C,).
        where: Of `find_cells`.
        side: Cells along tile and halo.
        slot_of: Plane of each point, SLOTS = none, (N,).
        ratio: Largest ratio of such returns in the 3 x 3 x 3 cells around.
        stray: Receives the marks, (N,).
    """
    sums = np.zeros((len(cells), 2))
    for c in range(len(cells)):
        for p in range(starts[c], starts[c + 1]):
            sums[c, 0] += weight[p]
            if slot_of[p] == SLOTS:
                sums[c, 1] += weight[p]
    for c in range(len(cells)):
        few = False
        if sums[c, 1] > 0.0:
            every = loose = 0.0
            for k in range(27):
                o = neighbor(cells[c], k, side, where)
                if o >= 0:
                    every += sums[o, 0]
                    loose += sums[o, 1]
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
    shift: NDArray[np.float32],
) -> None:
    """Move a point that its plane puts beyond an edge onto the edge."""
    a = planes[mine]
    for b in range(count):
        q = planes[b]
        if b == mine or side_of[mine, b] == 0.0:
            continue
        away = -q[3]
        for d in range(3):
            away += q[d] * (xyz[p, d] + shift[p, d])
        if away * side_of[mine, b] >= 0.0:
            continue
        dot = a[0] * q[0] + a[1] * q[1] + a[2] * q[2]
        if abs(dot) > 0.9 or abs(away) > 3.0 * q[4]:
            continue
        # Within plane a, against the part of b's normal that lies in it.
        scale = away / (1.0 - dot * dot)
        for d in range(3):
            shift[p, d] -= scale * (q[d] - dot * a[d])
