"""6D SLAM of sweeps: links by counts of closest pairs, registration, pose graph (A12 L-3)."""

from __future__ import annotations

from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from msgspec import structs
from numpy.typing import NDArray
from scipy.spatial import cKDTree

from recon4.geometry.se3 import SE3, Array
from recon4.model.events import NodesPlaced, positions_of
from recon4.model.figures import GraphFigures
from recon4.model.pose_graph import (
    Edge,
    EdgeKind,
    Judge,
    Judgment,
    Measure,
    PoseGraph,
    Verdict,
    accepted_unseen,
)
from recon4.model.trajectory import Trajectory
from recon4.pose_graph.files import save_graph
from recon4.pose_graph.pairs import RegistrationLimits, registration_judgment, tried_event
from recon4.pose_graph.solve import optimize
from recon4.pose_graph.tuning import graph_tuning
from recon4.profiler.global_icp import preregister, register_all
from recon4.profiler.sweeps import Sweeps, relative, unwind_sweeps
from recon4.profiler.tuning import LineTuning
from recon4.profiler.tuning_solve import SWEEP_GRAPH
from recon4.progress import Progress
from recon4.registration.plane_map import PlaneMap
from recon4.registration.planes import register_to_planes
from recon4.registration.result import Registration
from recon4.registration.tuning import PLANES, OdometryTuning
from recon4.settings.reads import LineGraphReads
from recon4.settings.tuning import tuned
from recon4.store.arrays import load_arrays, load_trajectory
from recon4.store.frames import FrameStore
from recon4.store.line_store import load_lines

Points = NDArray[np.float32]

_PLANES = structs.replace(PLANES, max_sd_m=0.05)
"""A sweep is bent by the errors of its poses."""


def build_sweep_graph(
    frames: FrameStore, odometry: Path, out: Path, *, settings: LineGraphReads, progress: Progress
) -> GraphFigures:
    """Run the stage ``graph`` of a rig with a profiler.

    Args:
        frames: The points, with ``lines.npz`` beside them.
        odometry: Folder of the stage ``odometry``.
        out: Receives ``graph.npz`` and ``edges.json``.
        settings: Uses lines, graph, registration and odometry.
        progress: Counts multiframes and pairs.
    """
    trajectory = load_trajectory(odometry / "trajectory.npz")
    lost = load_arrays(odometry / "steps.npz", ["lost"])["lost"]
    lines = load_lines(frames.folder)
    sweeps = unwind_sweeps(
        frames, lines, trajectory, settings=tuned(LineTuning, settings.lines), progress=progress
    )
    make = published_graph if settings.lines.method == "published" else sweep_graph
    graph = make(sweeps, trajectory, lost, settings=settings, progress=progress)
    save_graph(out, graph)
    return GraphFigures(
        nodes=len(graph),
        edges=len(graph.edges),
        accepted=sum(edge.in_graph for edge in graph.edges),
    )


def sweep_graph(
    sweeps: Sweeps,
    trajectory: Trajectory,
    lost: NDArray[np.bool_],
    *,
    settings: LineGraphReads,
    progress: Progress,
) -> PoseGraph:
    """Nodes at the sweeps, edges between those that see the same."""
    T = trajectory.at(sweeps.t_ns)
    edges = _chain(sweeps, T, lost, settings=settings)
    graph = PoseGraph(sweeps.frame_rows, sweeps.t_ns, T, edges)
    progress.event(NodesPlaced(t_ns=tuple(sweeps.t_ns.tolist()), t_m=positions_of(T.t)))
    links = linked(sweeps, T, settings)
    progress.start("pairs", len(links), "pair")
    found = list(edges)
    target, target_of = PlaneMap(_PLANES), -1
    for i, j, overlap in links:
        if i != target_of:
            target.clear()
            target.add(sweeps.sweeps[i].points.astype(np.float64))
            target_of = i
        edge = _register(
            target,
            (sweeps.sweeps[i].points, sweeps.sweeps[j].points),
            Link(i, j, relative(T, i, j), overlap),
            settings=settings,
        )
        progress.event(tried_event(edge))
        progress.advance()
        found.append(edge)
    graph = graph.with_edges(tuple(found))
    if len(graph) < 2:
        return graph
    solution = optimize(graph, kernel="cauchy")
    progress.event(NodesPlaced(t_m=positions_of(solution.T_map_body.t)))
    return graph.with_poses(solution.T_map_body)


def published_graph(
    sweeps: Sweeps,
    trajectory: Trajectory,
    lost: NDArray[np.bool_],
    *,
    settings: LineGraphReads,
    progress: Progress,
) -> PoseGraph:
    """Sweeps registered as published: to the one before if requested, then all at once (L §4.2).

    The edges are the relations of the solution; those of links have the counts of pairs.
    """
    first = trajectory.at(sweeps.t_ns)
    s = tuned(LineTuning, settings.lines)
    T = preregister(sweeps, first, s) if s.preregister else first
    progress.event(NodesPlaced(t_ns=tuple(sweeps.t_ns.tolist()), t_m=positions_of(T.t)))
    links = linked(sweeps, T, settings)
    T = register_all(sweeps, T, links, settings=s)
    progress.event(NodesPlaced(t_m=positions_of(T.t)))
    edges = list(_chain(sweeps, T, lost, settings=settings))
    information = np.diag(np.repeat([s.turn_sd_rad, s.turn_sd_m], 3) ** -2.0)
    for i, j, overlap in links:
        kind = (
            EdgeKind.NEIGHBOR if j - i <= graph_tuning(settings.graph).neighbors else EdgeKind.LOOP
        )
        linked_as = Judgment(Judge.SEARCH, Verdict.ACCEPTED, measure=Measure.OVERLAP, value=overlap)
        edge = Edge(
            i=i,
            j=j,
            T_i_j=relative(T, i, j),
            kind=kind,
            judgments=(linked_as,),
            overlap=overlap,
            information=information,
        )
        progress.event(tried_event(edge))
        edges.append(edge)
    return PoseGraph(sweeps.frame_rows, sweeps.t_ns, T, tuple(edges))


def linked(sweeps: Sweeps, T: SE3, settings: LineGraphReads) -> list[tuple[int, int, float]]:
    """Pairs of sweeps with enough closest pairs, and which part of the points has one.

    Neighbors first; of earlier visits those with the most pairs (requirements A12 L-3).
    """
    g, s = graph_tuning(settings.graph), tuned(LineTuning, settings.lines)
    some = [_spread(sweep.points, SWEEP_GRAPH.counted) for sweep in sweeps.sweeps]
    trees = [cKDTree(points, balanced_tree=False, compact_nodes=False) for points in some]
    out = []
    for j in range(1, len(sweeps)):
        near = [i for i in range(j) if np.linalg.norm(T.t[i] - T.t[j]) < s.link_reach_m]
        ratios = [
            (_close_ratio(trees[i], some[j], relative(T, i, j), reach_m=s.link_distance_m), i)
            for i in near
        ]
        linked_to = [(ratio, i) for ratio, i in ratios if ratio * len(some[j]) >= s.link_pairs]
        close = [pair for pair in linked_to if j - pair[1] <= g.neighbors]
        far = sorted((p for p in linked_to if j - p[1] > g.neighbors), reverse=True)
        out += [(i, j, ratio) for ratio, i in [*close, *far[: g.revisits]]]
    return sorted(out)


@dataclass(frozen=True, slots=True)
class Link:
    """Two sweeps to register."""

    i: int
    j: int
    initial: SE3
    """Predicted ``T_i_j``."""
    overlap: float
    """Ratio of the points of j with a close point of i."""


def register_pair(
    points: tuple[Points, Points], link: Link, *, settings: LineGraphReads
) -> tuple[Edge, float]:
    """Register two sweeps from a predicted pose, whatever their overlap.

    Args:
        points: Of both sweeps, in the body at their nodes [m], (N, 3) each.
        link: Its overlap is not used.
        settings: Uses lines, graph and registration.

    Returns:
        The edge, with the overlap at the registered pose; and how many points that is, as counted
        for a link.
    """
    target = PlaneMap(_PLANES)
    target.add(points[0].astype(np.float64))
    edge = _register(target, points, replace(link, overlap=0.0), settings=settings)
    some = [_spread(one, SWEEP_GRAPH.counted) for one in points]
    tree = cKDTree(some[0], balanced_tree=False, compact_nodes=False)
    overlap = _close_ratio(
        tree, some[1], edge.T_i_j, reach_m=tuned(LineTuning, settings.lines).link_distance_m
    )
    return edge.evolve(overlap=overlap), overlap * len(some[1])


def _register(
    target: PlaneMap, points: tuple[Points, Points], link: Link, *, settings: LineGraphReads
) -> Edge:
    """Register sweep ``j`` to the planes of sweep ``i`` and judge the result."""
    g = graph_tuning(settings.graph)
    found = register_to_planes(
        target,
        _spread(points[1], g.source_segments).astype(np.float64),
        initial=link.initial,
        settings=settings.registration,
        normal_noise_rad=g.normal_noise_rad,
    )
    range_m = float(np.median(np.linalg.norm(points[0], axis=1)))
    limit_m = range_m * g.error_relative + g.error_absolute_m
    least_matches = g.min_match_ratio * min(link.overlap, 1.0)
    limits = RegistrationLimits(limit_m, least_matches, g.min_degeneracy)
    return Edge(
        i=link.i,
        j=link.j,
        T_i_j=found.T_target_source,
        kind=EdgeKind.NEIGHBOR if link.j - link.i <= g.neighbors else EdgeKind.LOOP,
        judgments=(registration_judgment(found, limits),),
        overlap=link.overlap,
        error_m=found.error_m,
        limit_m=limit_m,
        degeneracy=found.degeneracy,
        converged=found.converged,
        iterations=found.iterations,
        information=_information(found, settings),
    )


def _close_ratio(tree: cKDTree, points: Points, T_i_j: SE3, *, reach_m: float) -> float:
    p_i = T_i_j @ points.astype(np.float64)
    distance = tree.query(p_i, distance_upper_bound=reach_m)[0]
    return float(np.mean(np.isfinite(distance)))


def _information(found: Registration, settings: LineGraphReads) -> Array:
    """Inverse covariance of the tangent of ``T_i_j``; a sweep is bent by the error of its poses."""
    s = tuned(LineTuning, settings.lines)
    floor = np.diag(np.repeat([s.turn_sd_rad, s.turn_sd_m], 3) ** 2)
    if not found.converged:
        return np.linalg.inv(floor)
    A = np.kron(np.eye(2), found.T_target_source.R)
    H = A.T @ found.information @ A * tuned(OdometryTuning, settings.odometry).information_scale
    information = np.linalg.inv(np.linalg.inv(H + 1e-3 * np.eye(6)) + floor)
    return 0.5 * (information + information.T)


def _chain(
    sweeps: Sweeps, T: SE3, lost: NDArray[np.bool_], *, settings: LineGraphReads
) -> tuple[Edge, ...]:
    """Edges between consecutive sweeps by the first trajectory."""
    s = tuned(LineTuning, settings.lines)
    edges = []
    for k in range(len(sweeps) - 1):
        sd = np.repeat([s.chain_sd_rad, s.chain_sd_m], 3)
        if lost[sweeps.frame_rows[k] : sweeps.frame_rows[k + 1] + 1].any():
            sd = sd * SWEEP_GRAPH.lost_factor
        edges.append(
            Edge(
                i=k,
                j=k + 1,
                T_i_j=relative(T, k, k + 1),
                kind=EdgeKind.ODOMETRY,
                judgments=accepted_unseen(),
                information=np.diag(sd**-2.0),
            )
        )
    return tuple(edges)


def _spread(points: Points, limit: int) -> Points:
    if len(points) <= limit:
        return points
    return points[np.linspace(0, len(points) - 1, limit).astype(np.intp)]
