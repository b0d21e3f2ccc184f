"""Loop closure of 2-D graphs: sub-maps are registered, the most certain pairs first."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np

from recon4.geometry.se3 import Array
from recon4.model.pose_graph import Edge, EdgeKind, PoseGraph
from recon4.pose_graph.solve import optimize
from recon4.progress import Progress
from recon4.slam2d.candidates import Candidate2d, candidates
from recon4.slam2d.edges import odometry_graph
from recon4.slam2d.keyframes import Keyframes
from recon4.slam2d.submaps import Pair, SubmapRegistrar, predicted_pose
from recon4.slam2d.tuning import Loop2dTuning, Slam2dTuning
from recon4.slam2d.tuning_graph import LOOP_RETRIES


def close_loops(
    keyframes: Keyframes,
    *,
    settings: Slam2dTuning,
    loops: Loop2dTuning,
    progress: Progress,
) -> PoseGraph:
    """Build the graph of all keyframes with loop closures, and solve it after each round.

    Args:
        keyframes: Nodes.
        settings: How points are registered.
        loops: Which pairs are tried, and which are accepted.
        progress: Counts pairs.

    Raises:
        GraphError: If the graph cannot be solved.
        Cancelled: If the caller requested to stop.
    """
    graph = odometry_graph(keyframes, sd_m=loops.odometry_sd_m, sd_rad=loops.odometry_sd_rad)
    if not loops.enabled or len(graph) < 2:
        return graph
    registrar = SubmapRegistrar(keyframes, settings=settings, loops=loops)
    tried: dict[Pair, Array] = {}
    most_m = loops.first_search_m
    while most_m <= loops.last_search_m:
        found = candidates(graph, keyframes, settings=loops, most_m=most_m)
        closed = {(edge.i, edge.j) for edge in graph.edges if edge.in_graph}
        new = [
            pair
            for pair in found
            if (pair.target, pair.source) not in closed and _is_new(pair, graph, tried)
        ]
        edges = list(registrar.register(new, graph, progress=progress)) if new else []
        for pair in new:
            tried[pair.target, pair.source] = predicted_pose(graph, pair)
        graph = _with_latest(graph, edges)
        if any(edge.in_graph for edge in edges):
            # The same limit again: loop closures make further pairs certain enough.
            graph = graph.with_poses(optimize(graph, kernel="cauchy").T_map_body)
        else:
            most_m *= 2.0
    return graph


def _is_new(pair: Candidate2d, graph: PoseGraph, tried: dict[Pair, Array]) -> bool:
    """Whether a pair was not tried yet, or from another predicted pose."""
    before = tried.get((pair.target, pair.source))
    if before is None:
        return True
    moved = np.hypot(*(predicted_pose(graph, pair) - before)[:2])
    return bool(moved > LOOP_RETRIES.retry_move_m)


def _with_latest(graph: PoseGraph, edges: Iterable[Edge]) -> PoseGraph:
    """The graph with more edges; a pair tried again replaces its earlier edge."""
    added = {(edge.i, edge.j): edge for edge in edges}
    kept = [
        edge
        for edge in graph.edges
        if edge.kind is EdgeKind.ODOMETRY or (edge.i, edge.j) not in added
    ]
    return graph.with_edges((*kept, *added.values()))
