"""Kernels of mirrors: planes that map points onto surfaces, and beams that cross a mirror."""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import numpy as np
from numba import njit
from numpy.typing import NDArray


class Beams(NamedTuple):
    """Beams from a sensor to a point."""

    point_m: NDArray[np.float64]
    """(N, 3)."""
    origin_m: NDArray[np.float64]
    """(N, 3)."""


class Faces(NamedTuple):
    """Points on surfaces, with the normal to the side that was seen."""

    point_m: NDArray[np.float64]
    """(N, 3)."""
    normal: NDArray[np.float64]
    """(N, 3)."""


class ReflectionRules(NamedTuple):
    """When a plane reflects a point onto a surface."""

    facing: float
    """Cosine between normal and plane."""
    aside_m: float
    lift_m: float
    """From the point of the surface, along the plane and in height."""
    before_m: float
    behind_m: float
    """Sensor and point are this far from the plane."""


@njit(cache=True, nogil=True, error_model="numpy")
def propose_planes(
    shown: Faces,
    origin_m: NDArray[np.float64],
    room: Faces,
    rules: ReflectionRules,
    votes: NDArray[np.float64],
) -> int:
    """Propose for each point the upright planes in which it would be a surface of the room.

    The normals of both give the direction of the plane, the distance its offset.

    Args:
        shown: Points that are perhaps reflections, N.
        origin_m: From where they were seen, (N, 3).
        room: Surfaces, by ascending height, M.
        rules: Limits.
        votes: Receives the row of the point, the normal of the plane to the sensor (x, y), its
            offset, and where the beam crosses it, along it and in height, (V, 6).

    Returns:
        How many there are; what has no place is left out.
    """
    found: Any = 0
    for n in range(len(shown.point_m)):
        px, py, pz = shown.point_m[n]
        first = np.searchsorted(room.point_m[:, 2], pz - rules.lift_m)
        last = np.searchsorted(room.point_m[:, 2], pz + rules.lift_m)
        for m in range(first, last):
            x = shown.normal[n, 0] - room.normal[m, 0]
            y = shown.normal[n, 1] - room.normal[m, 1]
            length = math.sqrt(x * x + y * y)
            tilted = abs(shown.normal[n, 2] - room.normal[m, 2])
            if length < 2.0 * rules.facing or tilted > rules.lift_m:
                continue
            x, y = x / length, y / length
            dx, dy, dz = room.point_m[m, 0] - px, room.point_m[m, 1] - py, room.point_m[m, 2] - pz
            if abs(dx * y - dy * x) > rules.aside_m:
                continue
            facing = x * room.normal[m, 0] + y * room.normal[m, 1]
            across = dx * room.normal[m, 0] + dy * room.normal[m, 1] + dz * room.normal[m, 2]
            behind = 0.5 * across / facing
            offset = px * x + py * y + behind
            before = origin_m[n, 0] * x + origin_m[n, 1] * y - offset
            if before < rules.before_m or behind < rules.behind_m or found == len(votes):
                continue
            part = before / (before + behind)
            at_x = origin_m[n, 0] + part * (px - origin_m[n, 0])
            at_y = origin_m[n, 1] + part * (py - origin_m[n, 1])
            votes[found, 0], votes[found, 1], votes[found, 2] = n, x, y
            votes[found, 3], votes[found, 4] = offset, at_y * x - at_x * y
            votes[found, 5] = origin_m[n, 2] + part * (pz - origin_m[n, 2])
            found += 1
    return int(found)


@njit(cache=True, nogil=True, error_model="numpy")
def find_reflections(
    beams: Beams,
    plane: tuple[float, float, float],
    reflected_m: float,
    cells: NDArray[np.bool_],
    grid: tuple[int, int, float],
    found: NDArray[np.bool_],
) -> None:
    """Find points whose beams cross an upright mirror.

    Args:
        beams: To the points, N.
        plane: Normal to the side of the carrier (x, y), and offset [m].
        reflected_m: A reflection lies at least this far behind it [m].
        cells: Which cells of the plane are of the mirror, along it and in height, (I, J).
        grid: Numbers of the first cell, and the edge of a cell [m].
        found: Set where a beam does, (N,).
    """
    x, y, offset_m = plane
    first_i, first_j, edge = grid
    for n in range(len(found)):
        p, o = beams.point_m[n], beams.origin_m[n]
        behind = offset_m - (p[0] * x + p[1] * y)
        if behind <= reflected_m:
            continue
        before = o[0] * x + o[1] * y - offset_m
        if before <= 0.0:
            continue
        part = before / (before + behind)
        along = (o[1] + part * (p[1] - o[1])) * x - (o[0] + part * (p[0] - o[0])) * y
        i = math.floor(along / edge) - first_i
        j = math.floor((o[2] + part * (p[2] - o[2])) / edge) - first_j
        if 0 <= i < cells.shape[0] and 0 <= j < cells.shape[1] and cells[i, j]:
            found[n] = True
