"""The progressive search for pairs of nodes at the same place (V §2.7, Algorithm 2.1).

Near pairs are registered first. The graph is optimized after each round, so that farther pairs
start from better poses. At the end, rejected pairs whose predicted pose has moved are registered
again. Every pair is kept with the verdict of its last registration.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import pairwise
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from recon4.geometry.se3 import SE3, Array
from recon4.model.edge_columns import EdgeColumns
from recon4.model.events import NodesPlaced, positions_of
from recon4.model.figures import GraphFigures
from recon4.model.pose_graph import (
    Edge,
    EdgeKind,
    PoseGraph,
    accepted_unseen,
    relations_of,
)
from recon4.model.trajectory import Trajectory
from recon4.pose_graph.candidates import Ends, retry_pairs, rounds
from recon4.pose_graph.files import save_graph
from recon4.pose_graph.node_views import NodeRangeImages
from recon4.pose_graph.ordered_pairs import OrderedPairs
from recon4.pose_graph.pair import Pair
from recon4.pose_graph.pair_files import VIEWS
from recon4.pose_graph.pairs import PairRegistrar
from recon4.pose_graph.pieces import Pieces, joined_pieces, placed, weakened
from recon4.pose_graph.places import PlaceDrawer
from recon4.pose_graph.priors import Kernel
from recon4.pose_graph.recognition import recognize, without_settled
from recon4.pose_graph.relations import squared_residuals
from recon4.pose_graph.solve import optimize
from recon4.pose_graph.tuning import GraphTuning, graph_tuning
from recon4.pose_graph.tuning_solve import COARSE, NEAR, SEARCH, SOLVE, SolveTuning
from recon4.progress import Progress
from recon4.registration.submap import Submaps, TrackedFrames, node_rows
from recon4.settings.reads import GraphReads
from recon4.store.arrays import load_arrays, load_trajectory
from recon4.store.frames import FrameStore
from recon4.store.unfinished import unfinished_file


@dataclass(frozen=True, slots=True, eq=False)
class OdometryTrack:
    """Result of the stage ``odometry``."""

    trajectory: Trajectory
    """``T_odom_body``, dense."""
    lost: NDArray[np.bool_]
    """Multiframes where odometry was lost, (number of multiframes,)."""
    motion_cov: Array
    """`OdometryStep.motion_cov` of each, (number of multiframes, 6, 6)."""
    piece: Pieces
    """`OdometryStep.piece` of each, (number of multiframes,)."""

    @staticmethod
    def load(folder: Path) -> OdometryTrack:
        """Read the artifact of the stage.

        Raises:
            StoreError: If a file is missing or damaged.
        """
        steps = load_arrays(folder / "steps.npz", ["lost", "motion_cov", "piece"])
        trajectory = load_trajectory(folder / "trajectory.npz")
        return OdometryTrack(trajectory, steps["lost"], steps["motion_cov"], steps["piece"])


@dataclass(frozen=True, slots=True)
class SearchMeans:
    """What a search is made with; its result does not depend on it."""

    folder: Path
    """Holds unnamed temporary files of 0.2 MB per node."""
    ordered: OrderedPairs | None = None
    """Workers that register pairs; None = threads of this process."""
    views: Path | None = None
    """File of what the nodes see, which stays; None = an unnamed one."""


def build_graph(
    frames: FrameStore,
    odometry: Path,
    means: SearchMeans,
    *,
    settings: GraphReads,
    progress: Progress,
) -> GraphFigures:
    """Run the stage ``graph``: create nodes and odometry edges, search for loop closures.

    Args:
        frames: The multiframes.
        odometry: Folder of the stage ``odometry``.
        means: Its folder receives ``graph.npz`` and ``edges.json``.
        settings: Uses nearly all groups of registration.
        progress: Counts pairs and receives an event for each edge.
    """
    track = OdometryTrack.load(odometry)
    graph = search(frames, track, settings=settings, progress=progress, means=means)
    save_graph(means.folder, graph)
    return GraphFigures(
        nodes=len(graph),
        edges=len(graph.edges),
        accepted=int(graph.relations.in_graph.sum()),
    )


def search(
    frames: FrameStore,
    odometry: OdometryTrack,
    *,
    settings: GraphReads,
    progress: Progress,
    means: SearchMeans,
) -> PoseGraph:
    """Create nodes and odometry edges, search for loop closures in all rounds.

    Poses are optimized (Cauchy kernel), not verified.

    Args:
        frames: The multiframes.
        odometry: Of the same multiframes.
        settings: Uses segments, overlap, registration, planes, graph.
        progress: Counts pairs and receives an event for each registration.
        means: Files and workers.
    """
    start = start_graph(frames, odometry, settings=graph_tuning(settings.graph))
    rows = start.frame_ids.astype(np.intp)
    registrar = make_registrar(
        TrackedFrames(frames, odometry.trajectory, odometry.lost),
        rows,
        settings=settings,
        means=replace(means, views=unfinished_file(VIEWS)),
    )
    return close_loops(
        start,
        registrar,
        pieces=odometry.piece[rows],
        leveled=frames.imu is not None and settings.odometry.use_imu,
        progress=progress,
    )


def start_graph(frames: FrameStore, odometry: OdometryTrack, *, settings: GraphTuning) -> PoseGraph:
    """Nodes with their poses by odometry, and the odometry edges between them."""
    lost = odometry.lost
    rows = node_rows(frames.t_mid_ns, settings.node_stride, lost)
    t_ns = frames.t_mid_ns[rows]
    T_odom_body = odometry.trajectory.at(t_ns)
    edges = odometry_edges(
        T_odom_body, rows, lost, motion_cov=odometry.motion_cov, settings=settings
    )
    edges = weakened(edges, odometry.piece[rows], t_ns)
    return PoseGraph(rows.astype(np.int64), t_ns, T_odom_body, EdgeColumns.of(edges))


def make_registrar(
    tracked: TrackedFrames,
    rows: NDArray[np.intp],
    *,
    settings: GraphReads,
    means: SearchMeans,
) -> PairRegistrar:
    """Make what registers pairs of nodes.

    Args:
        tracked: The multiframes.
        rows: Those that are nodes, (N,).
        settings: As of `search`.
        means: Files and workers.
    """
    submaps = Submaps(tracked, rows, scratch=means.folder)
    g = graph_tuning(settings.graph)
    views = NodeRangeImages(len(rows), g, scratch=means.folder, kept=means.views)
    return PairRegistrar(submaps, views, settings, ordered=means.ordered)


def close_loops(
    graph: PoseGraph,
    registrar: PairRegistrar,
    *,
    pieces: Pieces,
    leveled: bool,
    progress: Progress,
) -> PoseGraph:
    """Register pairs of nodes in all rounds.

    Args:
        graph: As of `start_graph`.
        registrar: Registers pairs of these nodes, not prepared yet.
        pieces: Piece of the walk of each node, (N,).
        leveled: The vertical is known by an IMU.
        progress: Counts pairs and receives an event for each registration.
    """
    g, recognition = registrar.graph, registrar.recognition
    progress.event(
        NodesPlaced(t_ns=tuple(graph.t_ns.tolist()), t_m=positions_of(graph.T_map_body.t))
    )
    registrar.prepare(len(graph), progress)
    attempts = _Attempts(registrar, pieces, progress)
    selections = rounds(len(graph), g)
    for select in selections[: SEARCH.before_recognition]:
        graph = attempts.run(graph, select(graph))
    if recognition.enabled and len(selections) > SEARCH.before_recognition and not g.exhaustive:
        drawer = PlaceDrawer(registrar.views, recognition, leveled=leveled)
        for _ in range(recognition.passes):
            edges = recognize(graph, registrar, drawer, progress=progress)
            graph = attempts.add(graph, edges)
            if not any(edge.in_graph for edge in edges):
                break
    for select in selections[SEARCH.before_recognition :]:
        graph = attempts.run(graph, select(graph))
    for _ in range(g.retry_rounds):
        again = retry_pairs(graph, attempts.expected, move_m=g.retry_move_m)
        graph = attempts.run(graph, again, tuning=NEAR)
    return without_settled(attempts.settled(graph))


def odometry_edges(
    T_odom_body: SE3,
    rows: NDArray[np.intp],
    lost: NDArray[np.bool_],
    *,
    motion_cov: Array,
    settings: GraphTuning,
) -> tuple[Edge, ...]:
    """Edges between consecutive nodes with the covariance of the odometry in between.

    The errors of consecutive multiframes are correlated, so their standard deviations add up, not
    their variances. An edge across multiframes with lost tracking is weak.
    """
    T_i_j = T_odom_body[:-1].inverse() @ T_odom_body[1:]
    floor = np.diag(np.repeat([settings.odometry_sd_rad, settings.odometry_sd_m], 3) ** 2)
    edges = []
    for k, (first, last) in enumerate(pairwise(rows)):
        between = slice(first + 1, last + 1)
        into_j = np.kron(np.eye(2), T_odom_body.R[k + 1])
        cov = into_j.T @ ((last - first) * motion_cov[between].sum(axis=0)) @ into_j + floor
        if lost[first : last + 1].any():
            cov = cov * SEARCH.lost_sd_factor**2
        information = np.linalg.inv(cov)
        edges.append(
            Edge(
                i=k,
                j=k + 1,
                T_i_j=T_i_j[k],
                kind=EdgeKind.ODOMETRY,
                judgments=accepted_unseen(),
                information=0.5 * (information + information.T),
            )
        )
    return tuple(edges)


class _Attempts:
    """Registers pairs and optimizes the graph after each round, coarsely but for the last ones."""

    def __init__(self, registrar: PairRegistrar, pieces: Pieces, progress: Progress) -> None:
        self._registrar, self._pieces, self._progress = registrar, pieces, progress
        self.expected: dict[Ends, SE3] = {}
        """Initial ``T_i_j`` of the last registration of each pair that it rejected."""
        self._is_coarse = False

    def run(
        self, graph: PoseGraph, pairs: list[Pair], *, tuning: SolveTuning = COARSE
    ) -> PoseGraph:
        """Register pairs and optimize; pairs of pieces that nothing joins yet are left out."""
        joined = joined_pieces(graph, self._pieces)
        pairs = [pair for pair in pairs if joined[pair.i] == joined[pair.j]]
        if not pairs:
            return graph
        edges = self._registrar.register(pairs, self._progress)
        tried = zip(pairs, edges, strict=True)
        self.expected.update({(p.i, p.j): p.T_i_j for p, edge in tried if not edge.in_graph})
        graph = graph.with_edges(_newest(graph.edges, edges))
        # Without further edges in use the poses are those of the last solve.
        is_more = any(edge.in_graph for edge in edges)
        return self._solved(graph, "cauchy", tuning) if is_more else graph

    def add(self, graph: PoseGraph, recognized: list[Edge]) -> PoseGraph:
        """Add recognized places and optimize.

        Without a kernel first, unless they fit as the graph is: a kernel would ignore loop closures
        that move the map by meters.
        """
        graph = placed(graph, joined_pieces(graph, self._pieces), recognized)
        graph = graph.with_edges(_newest(graph.edges, recognized))
        used = relations_of([edge for edge in recognized if edge.in_graph])
        if not len(used):
            return graph
        if squared_residuals(graph.T_map_body, used).max() > SOLVE.cauchy_sd**2:
            graph = self._solved(graph, "none", COARSE)
        return self._solved(graph, "cauchy", COARSE)

    def settled(self, graph: PoseGraph) -> PoseGraph:
        """The graph with its final poses."""
        return self._solved(graph, "cauchy", NEAR) if self._is_coarse else graph

    def _solved(self, graph: PoseGraph, kernel: Kernel, tuning: SolveTuning) -> PoseGraph:
        self._is_coarse = tuning is COARSE
        solution = optimize(graph, kernel=kernel, tuning=tuning)
        self._progress.event(NodesPlaced(t_m=positions_of(solution.T_map_body.t)))
        return graph.with_poses(solution.T_map_body)


def _newest(edges: Sequence[Edge], tried: list[Edge]) -> EdgeColumns:
    """One edge per pair: a new registration replaces the one before, and keeps its history."""
    newest, known = {(edge.i, edge.j): edge for edge in tried}, EdgeColumns.of(edges)
    rows = np.flatnonzero(~known.are(EdgeKind.ODOMETRY)).tolist()
    of, again = known.relations, {}
    for row, i, j in zip(rows, of.i[rows].tolist(), of.j[rows].tolist(), strict=True):
        if (edge := newest.pop((i, j), None)) is not None:
            again[row] = edge.after(known[row])
    return known.replaced(again, newest.values())
