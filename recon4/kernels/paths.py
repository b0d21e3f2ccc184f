"""Kernels of verification: alternative paths through a pose graph."""

from __future__ import annotations

import numpy as np
from numba import njit
from numpy.typing import NDArray


@njit(cache=True, nogil=True, error_model="numpy")
def _grown(values: NDArray[np.float64]) -> NDArray[np.float64]:
    out = np.empty(2 * len(values), dtype=values.dtype)
    out[: len(values)] = values
    return out


@njit(cache=True, nogil=True, error_model="numpy")
def path_medians(
    rows: NDArray[np.int64],
    edge_i: NDArray[np.int64],
    edge_j: NDArray[np.int64],
    edge_t: NDArray[np.float64],
    start: NDArray[np.int64],
    neighbor: NDArray[np.int64],
    edge: NDArray[np.int64],
    slot_rotation: NDArray[np.float64],
    slot_translation: NDArray[np.float64],
    alive: NDArray[np.bool_],
    max_edges: int,
    with_itself: bool,
) -> tuple[NDArray[np.float64], NDArray[np.int64]]:
    """Path discrepancy: median translation difference of edges to their alternative simple paths.

    Args:
        rows: Requested edges, (Q,) int64.
        edge_i: First nodes of all edges, (E,) int64.
        edge_j: Second nodes, (E,).
        edge_t: Translations of all edges [m], (E, 3).
        start: Slots of node n are ``start[n]:start[n + 1]``, (N + 1,) int64; sorted by neighbor.
        neighbor: Node at the other end of each slot, (2 E,) int64.
        edge: Edge of each slot, (2 E,) int64.
        slot_rotation: Rotation of the edge, directed away from the slot's node, (2 E, 3, 3).
        slot_translation: Translation of the same [m], (2 E, 3).
        alive: Edges that paths may use, (E,) bool.
        max_edges: Longest path, 1 to 3.
        with_itself: Count the edge as one path without error, as the author's code does.

    Returns:
        Medians [m], NaN without a path, (Q,), and numbers of paths, (Q,).

    V Eq. 2.9-2.12. ``|trans(T_ij^-1 T_e)| = |t_e - t_ij|``, so only translations are composed.
    """
    medians = np.full(len(rows), np.nan)
    counts = np.zeros(len(rows), dtype=np.int64)
    first_slot = np.full(len(start) - 1, -1, dtype=np.int64)  # first slot of b towards that node
    found = np.empty(64)
    for q in range(len(rows)):
        e = rows[q]
        a, b = edge_i[e], edge_j[e]
        for slot in range(start[b + 1] - 1, start[b] - 1, -1):
            first_slot[neighbor[slot]] = slot
        n = 0
        for s1 in range(start[a], start[a + 1]):
            x, e1 = neighbor[s1], edge[s1]
            if e1 == e or not alive[e1]:
                continue
            if x == b:
                if n == len(found):
                    found = _grown(found)
                found[n] = np.sqrt(np.sum((slot_translation[s1] - edge_t[e]) ** 2))
                n += 1
                continue
            if max_edges < 2:
                continue
            for s2 in range(start[x], start[x + 1]):
                y, e2 = neighbor[s2], edge[s2]
                if y == a or not alive[e2]:
                    continue
                tx = slot_translation[s2, 0]
                ty = slot_translation[s2, 1]
                tz = slot_translation[s2, 2]
                if y == b:
                    if n == len(found):
                        found = _grown(found)
                    found[n] = _difference(
                        slot_rotation[s1], slot_translation[s1], tx, ty, tz, edge_t[e]
                    )
                    n += 1
                    continue
                if max_edges < 3 or first_slot[y] < 0:
                    continue
                s3 = first_slot[y]
                while s3 < start[b + 1] and neighbor[s3] == y:
                    if alive[edge[s3]]:
                        # Slot s3 leads from b to y; the path walks it from y to b.
                        rotation2, rotation3, t3 = (
                            slot_rotation[s2],
                            slot_rotation[s3],
                            slot_translation[s3],
                        )
                        vx = -(
                            rotation3[0, 0] * t3[0]
                            + rotation3[1, 0] * t3[1]
                            + rotation3[2, 0] * t3[2]
                        )
                        vy = -(
                            rotation3[0, 1] * t3[0]
                            + rotation3[1, 1] * t3[1]
                            + rotation3[2, 1] * t3[2]
                        )
                        vz = -(
                            rotation3[0, 2] * t3[0]
                            + rotation3[1, 2] * t3[1]
                            + rotation3[2, 2] * t3[2]
                        )
                        wx = tx + rotation2[0, 0] * vx + rotation2[0, 1] * vy + rotation2[0, 2] * vz
                        wy = ty + rotation2[1, 0] * vx + rotation2[1, 1] * vy + rotation2[1, 2] * vz
                        wz = tz + rotation2[2, 0] * vx + rotation2[2, 1] * vy + rotation2[2, 2] * vz
                        if n == len(found):
                            found = _grown(found)
                        found[n] = _difference(
                            slot_rotation[s1], slot_translation[s1], wx, wy, wz, edge_t[e]
                        )
                        n += 1
                    s3 += 1
        for slot in range(start[b], start[b + 1]):
            first_slot[neighbor[slot]] = -1
        counts[q] = n
        if n > 0 and with_itself:
            if n == len(found):
                found = _grown(found)
            found[n] = 0.0
            n += 1
        if n > 0:
            medians[q] = np.median(found[:n])
    return medians, counts


@njit(cache=True, nogil=True, error_model="numpy")
def _difference(
    R: NDArray[np.float64],
    t: NDArray[np.float64],
    x: float,
    y: float,
    z: float,
    expected: NDArray[np.float64],
) -> float:
    """``|R (x, y, z) + t - expected|``."""
    dx = R[0, 0] * x + R[0, 1] * y + R[0, 2] * z + t[0] - expected[0]
    dy = R[1, 0] * x + R[1, 1] * y + R[1, 2] * z + t[1] - expected[1]
    dz = R[2, 0] * x + R[2, 1] * y + R[2, 2] * z + t[2] - expected[2]
    return np.sqrt(dx * dx + dy * dy + dz * dz)


@njit(cache=True, nogil=True, error_model="numpy")
def mark_affected(
    e: int,
    edge_i: NDArray[np.int64],
    edge_j: NDArray[np.int64],
    start: NDArray[np.int64],
    neighbor: NDArray[np.int64],
    edge: NDArray[np.int64],
    alive: NDArray[np.bool_],
    hops: NDArray[np.int64],
    max_edges: int,
    marked: NDArray[np.bool_],
) -> None:
    """Mark every edge with an alternative path of at most ``max_edges`` edges through edge ``e``.

    For a path from a to b through e = (u, v), ``hops(a) + hops(b) <= max_edges - 1``, where hops
    is the distance to u or v. All edges that satisfy this are marked (possibly too many, never too
    few).

    Args:
        e: The edge.
        edge_i: First nodes of all edges, (E,).
        edge_j: Second nodes, (E,).
        start: As in `path_medians`.
        neighbor: As in `path_medians`.
        edge: As in `path_medians`.
        alive: As in `path_medians`.
        hops: Scratch, (N,) int64, all -1 before and after.
        max_edges: As in `path_medians`.
        marked: Result, (E,) bool; entries are set, never cleared.
    """
    ball = [edge_i[e], edge_j[e]]
    hops[edge_i[e]] = 0
    hops[edge_j[e]] = 0
    k = 0
    while k < len(ball):
        node = ball[k]
        k += 1
        if hops[node] == max_edges - 1:
            continue
        for slot in range(start[node], start[node + 1]):
            other = neighbor[slot]
            if alive[edge[slot]] and hops[other] < 0:
                hops[other] = hops[node] + 1
                ball.append(other)
    for node in ball:
        for slot in range(start[node], start[node + 1]):
            other = neighbor[slot]
            if hops[other] >= 0 and hops[node] + hops[other] <= max_edges - 1:
                marked[edge[slot]] = True
    for node in ball:
        hops[node] = -1
