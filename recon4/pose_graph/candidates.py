"""Candidate pairs of nodes for registration (V §2.7, Algorithm 2.1)."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from functools import partial

import numpy as np
from numpy.typing import NDArray

from recon4.geometry.se3 import ARM_M, SE3, Array
from recon4.model.pose_graph import EdgeKind, PoseGraph
from recon4.pose_graph.pair import Pair
from recon4.pose_graph.tuning import GraphTuning
from recon4.pose_graph.tuning_places import CANDIDATES

Ends = tuple[int, int]
"""Nodes ``(i, j)`` of a pair."""
Selection = Callable[[PoseGraph], list[Pair]]


def rounds(nodes: int, settings: GraphTuning) -> list[Selection]:
    """Selections of pairs, one per round; each is applied to the graph so far."""
    if settings.exhaustive and settings.mode != "10":
        farthest = nodes // 2 if settings.closed_trajectory else nodes - 1
        schedule = distance_schedule(farthest)
        return [partial(pairs_at_distances, distances=d, settings=settings) for d in schedule]
    selections: list[Selection] = [partial(neighbor_pairs, settings=settings)]
    if settings.mode != "10":
        selections += [partial(revisit_pairs, settings=settings, limit=min(2, settings.revisits))]
        selections += [partial(revisit_pairs, settings=settings, limit=settings.revisits)]
    return selections


def neighbor_pairs(graph: PoseGraph, settings: GraphTuning) -> list[Pair]:
    """Pairs of each node with the next few; in mode ``10`` with those within one second."""
    within_second = max(10 // settings.node_stride, 1)
    farthest = within_second if settings.mode == "10" else settings.neighbors
    distances = range(1, farthest + 1)
    return pairs_at_distances(graph, distances=distances, settings=settings)


def pairs_at_distances(
    graph: PoseGraph, *, distances: Iterable[int], settings: GraphTuning
) -> list[Pair]:
    """All pairs ``d`` nodes apart (Algorithm 2.1 with 0-based nodes, A0 no. 5)."""
    count = len(graph)
    tried = {(e.i, e.j) for e in graph.edges if e.kind is not EdgeKind.ODOMETRY}
    ends = []
    for d in distances:
        last = count if settings.closed_trajectory else count - d
        for start in range(max(last, 0)):
            i, j = sorted((start, (start + d) % count))
            if i != j and (i, j) not in tried:
                tried.add((i, j))
                ends.append((i, j))
    return _pairs(graph, ends, settings=settings)


def distance_schedule(farthest: int) -> list[range]:
    """Distances 1 to the farthest in growing batches; the graph is optimized after each.

    N/2 is enough if pairs wrap around (Algorithm 2.1). An open walk of N nodes needs N - 1, so that
    its start is compared with its end.
    """
    batches, d = [], 1
    while d <= farthest:
        end = min(max(d + 1, d * 5 // 4), farthest + 1)
        batches.append(range(d, end))
        d = end
    return batches


def revisit_pairs(graph: PoseGraph, *, settings: GraphTuning, limit: int) -> list[Pair]:
    """Pairs of each node with at most ``limit`` earlier nodes of the place, spread over visits.

    The search radius grows with the path length in between, to allow for drift. At the end of a
    walk of hours it is most of a building, so all earlier nodes are compared in one step: a tree
    would find and list a good part of them one by one.
    """
    t = graph.T_map_body.t
    walked_m = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(t, axis=0), axis=1))])
    of = graph.relations
    tried = set(zip(of.i.tolist(), of.j.tolist(), strict=True))
    ends: list[Ends] = []
    for j in range(settings.neighbors + 1, len(t)):
        earlier = slice(0, j - settings.neighbors)
        distance_m = np.linalg.norm(t[earlier] - t[j], axis=1)
        allowed_m = settings.revisit_radius_m + settings.drift_ratio * (
            walked_m[j] - walked_m[earlier]
        )
        inside = np.flatnonzero(distance_m < allowed_m)
        chosen = _spread(inside, distance_m[inside], limit)
        ends += [(i, j) for i in chosen if (i, j) not in tried]
    return _pairs(graph, ends, settings=settings)


def _spread(nodes: NDArray[np.int64], distance_m: Array, limit: int) -> list[int]:
    """The nearest node of each visit (a run of nodes), then the nearest of the split runs."""
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
            halves += [run[: max(at - CANDIDATES.run_gap, 0)], run[at + 1 + CANDIDATES.run_gap :]]
        runs = [run for run in halves if len(run)]
    return sorted(chosen)


def retry_pairs(graph: PoseGraph, expected: Mapping[Ends, SE3], *, move_m: float) -> list[Pair]:
    """Rejected pairs whose predicted pose has moved since their last registration.

    Args:
        graph: The graph with its current poses.
        expected: Initial ``T_i_j`` of the last registration of each rejected pair.
        move_m: Smaller moves are ignored [m, rotation as at 5 m].
    """
    rejected = [e for e in graph.edges if not e.in_graph and (e.i, e.j) in expected]
    if not rejected:
        return []
    ends = np.array([(e.i, e.j) for e in rejected])
    T_i_j = graph.T_map_body[ends[:, 0]].inverse() @ graph.T_map_body[ends[:, 1]]
    moved = SE3.stack(expected[e.i, e.j] for e in rejected).inverse() @ T_i_j
    size_m = np.linalg.norm(moved.t, axis=1) + ARM_M * moved.angle()
    return [
        Pair(rejected[k].i, rejected[k].j, rejected[k].kind, T_i_j[k])
        for k in np.flatnonzero(size_m > move_m).tolist()
    ]


def _pairs(graph: PoseGraph, ends: Sequence[Ends], *, settings: GraphTuning) -> list[Pair]:
    i, j = np.array(ends, np.intp).reshape(-1, 2).T
    T_i_j = graph.T_map_body[i].inverse() @ graph.T_map_body[j]
    near, loop = EdgeKind.NEIGHBOR, EdgeKind.LOOP
    return [
        Pair(a, b, near if b - a <= settings.neighbors else loop, T_i_j[row])
        for row, (a, b) in enumerate(ends)
    ]
