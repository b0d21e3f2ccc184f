"""Points and poses of a pair, and its registration from a predicted pose.

Only nodes of the graph can be joined; a time between two nodes selects the nearer one.
"""

from __future__ import annotations

import struct
from dataclasses import dataclass
from pathlib import Path
from tempfile import gettempdir

import numpy as np
from msgspec import structs
from numpy.typing import NDArray

from recon4.errors import ConfigError
from recon4.geometry.se2 import from_se3
from recon4.geometry.se3 import SE3, Array, align_points
from recon4.locales.coded import CodedText
from recon4.mapping.undistort import place
from recon4.model.pose_graph import Edge, EdgeKind, Judgment, PoseGraph
from recon4.pose_graph.node_views import NodeRangeImages
from recon4.pose_graph.pair import Pair as TriedPair
from recon4.pose_graph.pairs import PairRegistrar, too_little_overlap
from recon4.pose_graph.tuning import graph_tuning
from recon4.profiler.tuning import LineTuning
from recon4.progress import Silent
from recon4.registration.overlap import RangeImage, overlap
from recon4.registration.submap import Submaps, TrackedFrames
from recon4.registration.tuning import OVERLAP
from recon4.review.apply import is_measured, rows_by_pair
from recon4.review.decisions import Pair
from recon4.review.queue import AlternativePath, alternative_paths
from recon4.review.row_contents import Measurement, numbers_of, pose_of
from recon4.review.source import Source
from recon4.review.tuning import QUEUE, REVIEW_PAIRS
from recon4.settings.reads import GraphReads, LineGraphReads, VerificationReads, part_of
from recon4.settings.tuning import tuned
from recon4.slam2d.tuning import Loop2dTuning, Slam2dTuning
from recon4.store.arrays import load_arrays, load_trajectory

MAGIC = b"R4PP"
LAYOUT = struct.Struct("<4sIII")
"""Header of the point data: magic, version 1, numbers of points of i and of j. Then float32 x y z
of each point in the body frame of its multiframe [m], little-endian."""


@dataclass(frozen=True, slots=True)
class Alignment:
    """Result of a registration from an operator's predicted pose."""

    measurement: Measurement
    converged: bool
    reason: str
    """Why the pair would be rejected automatically; empty = it would be accepted."""


@dataclass(frozen=True, slots=True)
class PairFacts:
    """Poses of a pair, x y z [m] and quaternion x y z w, and its alternative paths."""

    pair: Pair
    t_ns: tuple[int, int]
    """Times of the two nodes [ns]."""
    predicted: tuple[float, ...]
    """``T_i_j`` of the solved graph."""
    odometry: tuple[float, ...]
    """``T_i_j`` of the odometry; as ``predicted`` if there is none."""
    measured: tuple[float, ...] | None
    """``T_i_j`` of the registration; None = not registered."""
    upright: tuple[float, ...]
    """Rotation of the body at i in a leveled frame, quaternion x y z w."""
    apart_m: float
    """Prediction offset: distance between predicted and measured pose [m]."""
    apart_rad: float
    paths: tuple[AlternativePath, ...]
    """Worst first; at most `QUEUE.max_paths`."""
    path_count: int
    """Number of all alternative paths."""
    history: tuple[Judgment, ...]
    """Verdicts in the latest map, oldest first; empty where the graph does not have the pair."""


@dataclass(frozen=True, slots=True)
class TrajectoryNodes:
    """The nodes along the trajectory, one entry per node."""

    frames: list[int]
    """Multiframes."""
    t_s: list[float]
    """Since the first node [s]."""
    xyz_m: list[list[float]]
    """Positions in the map [m]."""


def pair_points(source: Source, pair: Pair, reach: int) -> bytes:
    """Points of two nodes, each with ``reach`` multiframes before and after, as `LAYOUT`.

    Raises:
        ConfigError: If one of them is no node of the graph, or the reach is too large.
        StoreError: If artifacts are missing or damaged.
    """
    if not 0 <= reach <= REVIEW_PAIRS.max_reach:
        raise ConfigError(CodedText("pair-reach", max_reach=REVIEW_PAIRS.max_reach, reach=reach))
    nodes = nodes_of(source.verified, pair)
    points = keyframe_points if source.is_2d else _points
    clouds = [_thinned(points(source, node, reach)) for node in nodes]
    head = LAYOUT.pack(MAGIC, 1, len(clouds[0]), len(clouds[1]))
    return head + b"".join(np.ascontiguousarray(cloud, "<f4").tobytes() for cloud in clouds)


def pair_facts(source: Source, pair: Pair) -> PairFacts:
    """Poses and alternative paths of a pair, registered or not.

    Raises:
        ConfigError: If one of them is no node of the graph.
        StoreError: If there is no verified graph.
    """
    graph = source.verified
    i, j = nodes_of(graph, pair)
    row = rows_by_pair(graph).get(pair)
    edge = graph.edges[row] if row is not None else None
    predicted = graph.T_map_body[i].inverse() @ graph.T_map_body[j]
    measured = edge is not None and is_measured(edge)
    T_i_j = edge.T_i_j if edge is not None and measured else predicted
    settings = part_of(source.settings, VerificationReads)
    paths = alternative_paths(graph, i, j, T_i_j=T_i_j, settings=settings)
    return PairFacts(
        pair=pair,
        t_ns=(int(graph.t_ns[i]), int(graph.t_ns[j])),
        predicted=numbers_of(predicted),
        odometry=numbers_of(_by_odometry(source, i, j) or predicted),
        measured=numbers_of(T_i_j) if measured else None,
        upright=_upright(source, graph, i),
        apart_m=float(np.linalg.norm((predicted.inverse() @ T_i_j).t)),
        apart_rad=float((predicted.inverse() @ T_i_j).angle()),
        paths=tuple(paths[: QUEUE.max_paths]),
        path_count=len(paths),
        history=source.history(pair),
    )


def align(source: Source, pair: Pair, predicted: tuple[float, ...]) -> Alignment:
    """Register two nodes like the loop closure search, from an operator's predicted pose.

    Args:
        source: The project's latest graph.
        pair: Two multiframes that are nodes.
        predicted: Initial ``T_i_j``, x y z [m] and quaternion x y z w.

    Raises:
        ConfigError: If one of them is no node, or ``predicted`` is no pose.
        StoreError: If artifacts are missing or damaged.
    """
    T_predicted = _checked(predicted)
    nodes = nodes_of(source.verified, pair)
    if source.is_2d:
        edge = align_keyframes(source, nodes, T_predicted)
    elif has_sweeps(source):
        edge = align_sweeps(source, nodes, T_predicted)
    else:
        edge = _align_multiframes(source, pair, T_predicted)
    return Alignment(_measurement(edge), edge.converged, str(edge.reason))


def _align_multiframes(source: Source, pair: Pair, T_predicted: SE3) -> Edge:
    # An operator's pair is registered at any overlap.
    settings = part_of(source.settings, GraphReads)
    rows = np.array(pair, dtype=np.intp)
    scratch = Path(gettempdir())
    views = NodeRangeImages(2, graph_tuning(settings.graph), scratch=scratch)
    tracked = TrackedFrames(source.frames, source.odometry, _lost(source))
    submaps = Submaps(tracked, rows, scratch=scratch)
    registrar = PairRegistrar(
        submaps, views, settings, overlap=structs.replace(OVERLAP, threshold=0.0)
    )
    registrar.prepare(2, Silent())
    tried = registrar.register([TriedPair(0, 1, EdgeKind.MANUAL, T_predicted)], Silent())[0]
    ends = [RangeImage(views.ends(k).reshape(-1, 3), views.nearest_m(k)) for k in (0, 1)]
    ratio = overlap(ends[0], ends[1], tried.T_i_j)
    if not tried.reason and ratio < OVERLAP.threshold:
        tried = tried.judged(too_little_overlap(ratio, OVERLAP.threshold))
    return tried.evolve(overlap=ratio)


def _measurement(edge: Edge) -> Measurement:
    return Measurement(
        T_i_j=numbers_of(edge.T_i_j),
        information=tuple(edge.information.ravel().tolist()),
        overlap=edge.overlap,
        error_m=edge.error_m,
        limit_m=edge.limit_m,
        degeneracy=edge.degeneracy,
        iterations=edge.iterations,
    )


def fit_points(p_i: Array, p_j: Array) -> tuple[float, ...]:
    """``T_i_j`` from three or more corresponding points, as `numbers_of`.

    Args:
        p_i: Points in the body frame at i [m], (N, 3).
        p_j: The same points in the body frame at j [m], (N, 3).

    Raises:
        ConfigError: If there are fewer than three, or they lie on a line.
    """
    if len(p_i) < 3 or len(p_i) != len(p_j):
        raise ConfigError(CodedText("pair-three", count=min(len(p_i), len(p_j))))
    for name, points in (("first", p_i), ("second", p_j)):
        spread = np.linalg.svd(points - points.mean(axis=0), compute_uv=False)
        if spread[1] < REVIEW_PAIRS.min_spread_m:
            raise ConfigError(CodedText("pair-line", name=name))
    return numbers_of(align_points(p_i, p_j))


def trajectory_nodes(source: Source) -> TrajectoryNodes:
    """The nodes along the trajectory, rounded to 1 ms and 1 mm.

    Raises:
        StoreError: If there is no verified graph.
    """
    graph = source.verified
    seconds = (graph.t_ns - graph.t_ns[0]) / 1e9
    return TrajectoryNodes(
        frames=graph.frame_ids.tolist(),
        t_s=np.round(seconds, 3).tolist(),
        xyz_m=np.round(graph.T_map_body.t, 3).tolist(),
    )


def nodes_of(graph: PoseGraph, pair: Pair) -> tuple[int, int]:
    """Rows of the two nodes.

    Raises:
        ConfigError: If there is no such node.
    """
    rows = np.searchsorted(graph.frame_ids, pair)
    for frame, row in zip(pair, rows, strict=True):
        if row == len(graph) or graph.frame_ids[row] != frame:
            raise ConfigError(CodedText("pair-no-node", frame=frame))
    return int(rows[0]), int(rows[1])


def _around(source: Source, node: int, reach: int) -> range:
    """Multiframes that are shown of a node: its own, or those of its turn, and some around them."""
    frame = int(source.verified.frame_ids[node])
    own = multiframes_of(source, node) if has_sweeps(source) else range(frame, frame + 1)
    return range(max(own.start - reach, 0), min(own.stop + reach, len(source.frames)))


def _points(source: Source, node: int, reach: int) -> Array:
    """Points of a node and the multiframes around it, in its body frame [m], (N, 3)."""
    frames, odometry = source.frames, source.odometry
    frame = int(source.verified.frame_ids[node])
    near = _around(source, node, reach)
    parts = [place(frames[k], odometry, frames.rig) for k in near]
    T_odom_body = odometry.at(frames.t_mid_ns[frame : frame + 1])[0]
    p_body = T_odom_body.inverse() @ np.concatenate(parts)
    return np.asarray(p_body[np.linalg.norm(p_body, axis=1) < REVIEW_PAIRS.max_range_m])


def _thinned(p_body: Array) -> Array:
    """One point per voxel, then an even sample of at most `REVIEW_PAIRS.max_points`."""
    keys = np.floor(p_body / REVIEW_PAIRS.voxel_m).astype(np.int64) + (1 << 20)
    packed = (keys[:, 0] << 42) | (keys[:, 1] << 21) | keys[:, 2]
    rows = np.sort(np.unique(packed, return_index=True)[1])
    if len(rows) > REVIEW_PAIRS.max_points:
        rows = rows[np.linspace(0, len(rows) - 1, REVIEW_PAIRS.max_points).astype(np.intp)]
    return p_body[rows]


def _upright(source: Source, graph: PoseGraph, node: int) -> tuple[float, ...]:
    """Rotation of the body of a node in a leveled frame, as a quaternion x y z w."""
    folder = source.artifacts.get("level")
    if folder is not None:
        leveled = load_trajectory(folder / "trajectory.npz")
        at = int(np.clip(graph.t_ns[node], leveled.t_ns[0], leveled.t_ns[-1]))
        quat = leveled.at(np.array([at]))[0].quat_xyzw()
    else:
        quat = graph.T_map_body[node].quat_xyzw()
    return tuple(quat.tolist())


def _by_odometry(source: Source, i: int, j: int) -> SE3 | None:
    if not source.artifacts.keys() & {"odometry", "odometry_2d"}:
        return None
    T = source.odometry.at(source.verified.t_ns[[i, j]])
    return T[0].inverse() @ T[1]


def _lost(source: Source) -> NDArray[np.bool_]:
    steps = load_arrays(source.artifacts["odometry"] / "steps.npz", ["lost"])
    lost: NDArray[np.bool_] = steps["lost"]
    return lost


def _checked(predicted: tuple[float, ...]) -> SE3:
    numbers = np.asarray(predicted, dtype=np.float64)
    if numbers.shape != (7,) or not np.isfinite(numbers).all() or not numbers[3:].any():
        raise ConfigError(CodedText("pair-predicted", predicted=str(list(predicted)[:7])))
    return pose_of(numbers.tolist())


def keyframe_points(source: Source, node: int, reach: int) -> Array:
    """Returns of a node and of ``reach`` nodes before and after, in its frame [m], (N, 3)."""
    points, _ = source.keyframes.around(node, reach)
    return np.column_stack([points, np.zeros(len(points))])


def align_keyframes(source: Source, nodes: tuple[int, int], predicted: SE3) -> Edge:
    """Register two nodes as the search does, from an operator's predicted pose.

    Args:
        source: The project's latest graph.
        nodes: Rows of the graph.
        predicted: Initial ``T_i_j``; its height, roll and pitch are left out.
    """
    from recon4.slam2d.submaps import SubmapRegistrar

    settings = source.settings
    registrar = SubmapRegistrar(
        source.keyframes,
        settings=tuned(Slam2dTuning, settings.slam2d),
        loops=tuned(Loop2dTuning, settings.loops2d),
    )
    return registrar.register_at(nodes, from_se3(predicted))


def has_sweeps(source: Source) -> bool:
    """Whether the nodes of the graph are sweeps of a head."""
    return source.frames.rig.row_of("profiler") is not None


def multiframes_of(source: Source, node: int) -> range:
    """Multiframes with points of a node's sweep."""
    return source.sweeps.multiframes(source.frames, node)


def align_sweeps(source: Source, nodes: tuple[int, int], predicted: SE3) -> Edge:
    """Register two sweeps as the search does, from an operator's predicted pose.

    Args:
        source: The project's latest graph.
        nodes: Rows of the graph.
        predicted: Initial ``T_i_j``.

    Returns:
        The edge with the reason for which the search would reject it, if there is one.
    """
    from recon4.profiler.sweep_graph import Link, register_pair
    from recon4.profiler.sweeps import unwind_sweep

    settings, sweeps = source.settings, source.sweeps
    first, second = (
        unwind_sweep(
            source.frames,
            sweeps,
            node,
            trajectory=source.odometry,
            settings=tuned(LineTuning, settings.lines),
        )
        for node in nodes
    )
    link = Link(*nodes, initial=predicted, overlap=0.0)
    reads = part_of(settings, LineGraphReads)
    edge, close_points = register_pair((first, second), link, settings=reads)
    if not edge.reason and close_points < tuned(LineTuning, settings.lines).link_pairs:
        return edge.judged(too_little_overlap(edge.overlap))
    return edge
