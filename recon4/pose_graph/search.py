"""The progressive search for pairs that see the same place (V §2.7, Algorithm 2.1).

Pairs are tried near ones first; after each round the graph is optimized, so that later, farther
pairs start from better poses. Every pair tried is kept with its verdict.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from functools import partial
from itertools import pairwise
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree

from recon4.geometry.se3 import SE3, Array
from recon4.model.pose_graph import Edge, EdgeKind, PoseGraph, Verdict
from recon4.model.trajectory import Trajectory
from recon4.pose_graph.files import save_graph
from recon4.pose_graph.pairs import Pair, PairRegistrar
from recon4.pose_graph.solve import optimize
from recon4.progress import Progress
from recon4.registration.submap import NodeViews, Submaps, node_rows
from recon4.settings import GraphSettings, Settings
from recon4.store.arrays import load_arrays, load_trajectory
from recon4.store.frames import FrameStore

_RUN_GAP = 2
"""Nodes on either side of a chosen one that add nothing new."""
_LOST_SD_FACTOR = 200.0
"""How much less an odometry edge across a lost multiframe is worth."""


def build_graph(
    frames: FrameStore, odometry: Path, out: Path, *, settings: Settings, progress: Progress
) -> dict[str, object]:
    """The stage ``graph``: nodes, odometry edges and every pair tried.

    Args:
        frames: The multiframes.
        odometry: Folder of the stage ``odometry``.
        out: Receives ``graph.npz`` and ``edges.json``.
        settings: Uses nearly all groups of registration.
        progress: Counts pairs; each edge is an event.
    """
    steps = load_arrays(odometry / "steps.npz", ["lost", "motion_cov"])
    graph = search(
        frames,
        load_trajectory(odometry / "trajectory.npz"),
        steps["lost"],
        motion_cov=steps["motion_cov"],
        settings=settings,
        progress=progress,
    )
    save_graph(out, graph)
    return {
        "nodes": len(graph),
        "edges": len(graph.edges),
        "accepted": sum(e.in_graph for e in graph.edges),
    }


def search(
    frames: FrameStore,
    trajectory: Trajectory,
    lost: NDArray[np.bool_],
    *,
    motion_cov: Array,
    settings: Settings,
    progress: Progress,
) -> PoseGraph:
    """The graph after all rounds, poses optimized (Cauchy kernel), not yet verified.

    Args:
        frames: The multiframes.
        trajectory: ``T_odom_body``, dense.
        lost: Multiframes where odometry was lost, (number of multiframes,).
        motion_cov: `OdometryStep.motion_cov` of each, (number of multiframes, 6, 6).
        settings: Uses segments, overlap, registration, planes, graph.
        progress: Counts pairs; each edge is an event.
    """
    g = settings.graph
    rows = node_rows(frames.t_mid_ns, g.node_stride, lost)
    t_ns = frames.t_mid_ns[rows]
    T_odom_body = trajectory.at(t_ns)
    edges = odometry_edges(T_odom_body, rows, lost, motion_cov=motion_cov, settings=g)
    graph = PoseGraph(rows.astype(np.int64), t_ns, T_odom_body, edges)
    views = NodeViews(len(rows), settings)
    registrar = PairRegistrar(
        lambda: Submaps(frames, trajectory, rows, settings, skip=lost), views, settings
    )
    registrar.prepare(len(rows), progress)
    for select in rounds(len(rows), g):
        graph = _try(graph, select(graph), registrar, progress)
    return graph


Selection = Callable[[PoseGraph], list[Pair]]


def rounds(nodes: int, settings: GraphSettings) -> list[Selection]:
    """What each round tries, given the graph so far."""
    if settings.exhaustive:
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
    reach_m = settings.revisit_radius_m + settings.drift_share * walked_m
    near = cKDTree(t).query_ball_point(t, r=reach_m)
    for j, found in enumerate(near):
        earlier = np.sort([i for i in found if i < j - settings.neighbors])
        if len(earlier) == 0:
            continue
        distance_m = np.linalg.norm(t[earlier] - t[j], axis=1)
        allowed_m = settings.revisit_radius_m + settings.drift_share * (
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


def odometry_edges(
    T_odom_body: SE3,
    rows: NDArray[np.intp],
    lost: NDArray[np.bool_],
    *,
    motion_cov: Array,
    settings: GraphSettings,
) -> tuple[Edge, ...]:
    """Edges between consecutive nodes, as certain as odometry itself was of the motion between.

    The errors of consecutive multiframes are alike, so their deviations add up, not their
    variances. Across multiframes where tracking was lost an edge is weak.
    """
    T_i_j = T_odom_body[:-1].inverse() @ T_odom_body[1:]
    floor = np.diag(np.repeat([settings.odometry_sd_rad, settings.odometry_sd_m], 3) ** 2)
    edges = []
    for k, (first, last) in enumerate(pairwise(rows)):
        between = slice(first + 1, last + 1)
        into_j = np.kron(np.eye(2), T_odom_body.R[k + 1])
        cov = into_j.T @ ((last - first) * motion_cov[between].sum(axis=0)) @ into_j + floor
        if lost[first : last + 1].any():
            cov = cov * _LOST_SD_FACTOR**2
        information = np.linalg.inv(cov)
        edges.append(
            Edge(
                i=k,
                j=k + 1,
                T_i_j=T_i_j[k],
                kind=EdgeKind.ODOMETRY,
                verdict=Verdict.ACCEPTED,
                information=0.5 * (information + information.T),
            )
        )
    return tuple(edges)


def _pair(graph: PoseGraph, i: int, j: int, settings: GraphSettings) -> Pair:
    kind = EdgeKind.NEIGHBOR if j - i <= settings.neighbors else EdgeKind.LOOP
    return Pair(i, j, kind, graph.T_map_body[i].inverse() @ graph.T_map_body[j])


def _try(
    graph: PoseGraph, pairs: list[Pair], registrar: PairRegistrar, progress: Progress
) -> PoseGraph:
    if not pairs:
        return graph
    edges = registrar.register(pairs, progress)
    for edge in edges:
        progress.event("edge", **edge_facts(edge))
    graph = graph.with_edges(graph.edges + tuple(edges))
    solution = optimize(graph, kernel="cauchy")
    return graph.with_poses(solution.T_map_body)


def edge_facts(edge: Edge) -> dict[str, object]:
    """What a watcher is told of an edge, as plain JSON values."""
    return {
        "i": edge.i,
        "j": edge.j,
        "edge_kind": edge.kind.value,
        "verdict": edge.verdict.value,
        "reason": edge.reason.value,
        "overlap": edge.overlap,
        # Without a registration there is no error, and JSON has no word for NaN.
        "error_m": edge.error_m if np.isfinite(edge.error_m) else None,
    }
