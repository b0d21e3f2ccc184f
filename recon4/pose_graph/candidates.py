"""Which pairs of nodes are worth a try (V §2.7, Algorithm 2.1)."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from functools import partial

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree

from recon4.geometry.se3 import SE3, Array
from recon4.model.pose_graph import EdgeKind, PoseGraph
from recon4.pose_graph.pairs import Pair
from recon4.settings import GraphSettings

_RUN_GAP = 2
"""Nodes on either side of a chosen one that add nothing new."""
_ARM_M = 5.0
"""A rotation moves points at this distance [m]."""

Ends = tuple[int, int]
"""Nodes ``(i, j)`` of a pair."""
Selection = Callable[[PoseGraph], list[Pair]]


def rounds(nodes: int, settings: GraphSettings) -> list[Selection]:
    """What each round tries, given the graph so far."""
    if settings.exhaustive and settings.mode != "10":
        farthest = nodes // 2 if settings.closed_trajectory else nodes - 1
        schedule = distance_schedule(farthest)
        return [partial(pairs_at_distances, distances=d, settings=settings) for d in schedule]
    selections: list[Selection] = [partial(neighbor_pairs, settings=settings)]
    if settings.mode != "10":
        selections += [partial(revisit_pairs, settings=settings, limit=2)]
        selections += [partial(revisit_pairs, settings=settings, limit=settings.revisits)]
    return selections


def neighbor_pairs(graph: PoseGraph, settings: GraphSettings) -> list[Pair]:
    """Each node with the few after it; in mode ``10`` those within one second."""
    within_second = max(10 // settings.node_stride, 1)
    farthest = within_second if settings.mode == "10" else settings.neighbors
    distances = range(1, farthest + 1)
    return pairs_at_distances(graph, distances=distances, settings=settings)


def pairs_at_distances(
    graph: PoseGraph, *, distances: Iterable[int], settings: GraphSettings
) -> list[Pair]:
    """All pairs ``d`` nodes apart (Algorithm 2.1 with 0-based nodes, A0 no. 5)."""
    count = len(graph)
    tried = {(e.i, e.j) for e in graph.edges if e.kind is not EdgeKind.ODOMETRY}
    pairs = []
    for d in distances:
        last = count if settings.closed_trajectory else count - d
        for start in range(max(last, 0)):
            i, j = sorted((start, (start + d) % count))
            if i != j and (i, j) not in tried:
                tried.add((i, j))
                pairs.append(_pair(graph, i, j, settings))
    return pairs


def distance_schedule(farthest: int) -> list[range]:
    """Distances 1 to the farthest in growing batches, the graph being optimized after each.

    N/2 is enough where pairs wrap around (Algorithm 2.1); an open walk of N nodes needs N - 1, or
    its start would never be compared with its end.
    """
    batches, d = [], 1
    while d <= farthest:
        end = min(max(d + 1, d * 5 // 4), farthest + 1)
        batches.append(range(d, end))
        d = end
    return batches


def revisit_pairs(graph: PoseGraph, *, settings: GraphSettings, limit: int) -> list[Pair]:
    """Each node with at most ``limit`` earlier nodes of the same place, spread over its visits.

    Only nodes close by are looked at, so the work grows with the walk and not with its square.
    How far off the poses may be is allowed for by the distance walked in between.
    """
    t = graph.T_map_body.t
    walked_m = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(t, axis=0), axis=1))])
    tried = {(e.i, e.j) for e in graph.edges}
    pairs = []
    reach_m = settings.revisit_radius_m + settings.drift_ratio * walked_m
    near = cKDTree(t).query_ball_point(t, r=reach_m)
    for j, found in enumerate(near):
        earlier = np.sort([i for i in found if i < j - settings.neighbors])
        if len(earlier) == 0:
            continue
        distance_m = np.linalg.norm(t[earlier] - t[j], axis=1)
        allowed_m = settings.revisit_radius_m + settings.drift_ratio * (
            walked_m[j] - walked_m[earlier]
        )
        inside = distance_m < allowed_m
        chosen = _spread(earlier[inside], distance_m[inside], limit)
        pairs += [_pair(graph, i, j, settings) for i in chosen if (i, j) not in tried]
    return pairs


def _spread(nodes: NDArray[np.int64], distance_m: Array, limit: int) -> list[int]:
    """The nearest node of each visit (a run of nodes), then the nearest of halves of the runs."""
    runs = np.split(np.arange(len(nodes)), np.flatnonzero(np.diff(nodes) > 1) + 1)
    chosen: list[int] = []
    while runs and len(chosen) < limit:
        runs.sort(key=lambda run: float(distance_m[run].min()) if len(run) else np.inf)
        halves = []
        for run in runs:
            if len(run) == 0 or len(chosen) == limit:
                continue
            best = int(run[np.argmin(distance_m[run])])
            chosen.append(int(nodes[best]))
            at = int(np.searchsorted(run, best))
            halves += [run[: max(at - _RUN_GAP, 0)], run[at + 1 + _RUN_GAP :]]
        runs = [run for run in halves if len(run)]
    return sorted(chosen)


def retry_pairs(graph: PoseGraph, expected: Mapping[Ends, SE3], *, move_m: float) -> list[Pair]:
    """Pairs turned down whose expected pose is no longer the one they were tried from.

    Args:
        graph: With its poses of now.
        expected: ``T_i_j`` each pair was tried from last.
        move_m: Moves up to this do not count [m, rotation as at 5 m].
    """
    refused = [e for e in graph.edges if not e.in_graph and (e.i, e.j) in expected]
    pairs = []
    for edge in refused:
        T_i_j = graph.T_map_body[edge.i].inverse() @ graph.T_map_body[edge.j]
        moved = expected[edge.i, edge.j].inverse() @ T_i_j
        if np.linalg.norm(moved.t) + _ARM_M * moved.angle() > move_m:
            pairs.append(Pair(edge.i, edge.j, edge.kind, T_i_j))
    return pairs


def _pair(graph: PoseGraph, i: int, j: int, settings: GraphSettings) -> Pair:
    kind = EdgeKind.NEIGHBOR if j - i <= settings.neighbors else EdgeKind.LOOP
    return Pair(i, j, kind, graph.T_map_body[i].inverse() @ graph.T_map_body[j])
