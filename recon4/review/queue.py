"""The review queue: pairs ordered by their influence on the map."""

from __future__ import annotations

import json
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from recon4.geometry.se3 import SE3, Array
from recon4.kernels.paths import path_medians
from recon4.model.plain import finite_or_none
from recon4.model.pose_graph import Edge, EdgeKind, PoseGraph, Reason
from recon4.pose_graph.alternative_paths import PathIndex
from recon4.pose_graph.tuning import VerificationTuning
from recon4.review.apply import is_measured
from recon4.review.influence import influence_m
from recon4.review.solve import pair_of
from recon4.review.source import Source
from recon4.settings.reads import VerificationReads, part_of
from recon4.settings.tuning import tuned

_GOOD, _WEAK, _PREDICTED_ONLY, _NO_OVERLAP = range(4)
_WEAK_REASONS = (Reason.ERROR, Reason.FEW_MATCHES, Reason.DEGENERATE)
"""Reasons of a rejection that come from the registration itself, not from the graph."""


class QueueRow(NamedTuple):
    """One pair of the queue; figures are None where they are unknown."""

    frame_i: int
    frame_j: int
    t_i_s: float
    """Since the first node [s]."""
    t_j_s: float
    kind: str
    verdict: str
    reason: str
    measured: bool
    """Whether the pair was registered."""
    influence_m: float | None
    overlap: float | None
    error_m: float | None
    limit_m: float | None
    degeneracy: float | None
    verification_m: float | None
    """Path discrepancy [m]."""
    paths: int
    """Number of alternative paths."""
    chi2: float | None


COLUMNS = QueueRow._fields
"""Names of the values of a row in `queue_json`, in this order."""


def queue_json(source: Source) -> bytes:
    """All pairs but odometry as JSON: ``key``, ``columns`` and ``rows``, as `queue_rows` has them.

    Figures are those of the verified graph, before any decision, so that the order is stable during
    a review. The same graph gives the same bytes.

    Raises:
        StoreError: If there is no verified graph.
    """
    graph = source.verified
    rows = queue_rows(graph, settings=part_of(source.settings, VerificationReads))
    record = {
        "key": source.key,
        "began_ns": int(graph.t_ns[0]),
        "limit_m": source.settings.verification.limit_m,
        "columns": COLUMNS,
        "rows": rows,
    }
    return json.dumps(record, separators=(",", ":"), allow_nan=False).encode()


def queue_rows(graph: PoseGraph, *, settings: VerificationReads) -> list[QueueRow]:
    """One row per pair, in the order of the review.

    First pairs with a good registration, accepted or rejected by verification; then pairs with a
    weak registration; both by influence on the map. Then pairs that were never registered, by
    overlap: their pose is predicted only, and a large overlap makes a manual registration likely.
    """
    asked = np.array([edge.kind is not EdgeKind.ODOMETRY for edge in graph.edges], np.bool_)
    rank = np.array([_rank(edge) for edge in graph.edges])
    influence = influence_m(graph, asked & (rank < _PREDICTED_ONLY))
    medians, counts = medians_of_all(graph, settings=settings)
    overlaps = np.nan_to_num([edge.overlap for edge in graph.edges])
    worth = np.where(rank < _PREDICTED_ONLY, np.nan_to_num(influence), overlaps)
    rows = np.flatnonzero(asked)
    order = rows[np.lexsort((rows, -worth[rows], rank[rows]))]
    return [
        _row(
            graph,
            graph.edges[k],
            influence=float(influence[k]),
            median_m=float(medians[k]),
            paths=int(counts[k]),
        )
        for k in order.tolist()
    ]


def _rank(edge: Edge) -> int:
    """Class of a pair by the quality of its registration, the best first."""
    if edge.reason is Reason.OVERLAP:
        return _NO_OVERLAP
    if not is_measured(edge):
        return _PREDICTED_ONLY
    return _WEAK if edge.reason in _WEAK_REASONS else _GOOD


def medians_of_all(
    graph: PoseGraph, *, settings: VerificationReads
) -> tuple[Array, NDArray[np.int64]]:
    """Path discrepancy of every edge, also of edges that are not in the graph.

    Returns:
        Path discrepancies [m], NaN without a path, and numbers of paths, (E,) each.
    """
    index = _index(graph, settings)
    of = index.of
    rows = np.arange(len(of), dtype=np.int64)
    medians, counts = path_medians(
        rows,
        *(of.i, of.j, of.T_i_j.t, index.start, index.neighbor, index.edge),
        *(index.T_slot.R, index.T_slot.t, index.alive, index.max_edges, index.with_itself),
    )
    return medians, counts


@dataclass(frozen=True, slots=True)
class AlternativePath:
    """Another path through the graph between the ends of an edge."""

    frames: tuple[int, ...]
    """Multiframes from one end to the other."""
    residual_m: float
    """Distance between the end of the path and the end of the edge."""
    residual_rad: float


def alternative_paths(
    graph: PoseGraph, i: int, j: int, *, T_i_j: SE3, settings: VerificationReads
) -> list[AlternativePath]:
    """All simple paths between two nodes that the verification uses, worst first.

    Args:
        graph: Paths use its edges that are in the graph.
        i: First node.
        j: Second node.
        T_i_j: Relative pose of the edge.
        settings: Limits the length of the paths.
    """
    index = _index(graph, settings)
    own = {
        row for row, e in enumerate(graph.edges)
        if (e.i, e.j) == (i, j) and e.kind is not EdgeKind.ODOMETRY
    }  # fmt: skip
    found: list[AlternativePath] = []
    stack: list[tuple[tuple[int, ...], SE3]] = [((i,), SE3.identity())]
    while stack:
        nodes, T = stack.pop()
        for slot in range(int(index.start[nodes[-1]]), int(index.start[nodes[-1] + 1])):
            after, row = int(index.neighbor[slot]), int(index.edge[slot])
            if after in nodes or row in own or not index.alive[row]:
                continue
            T_after = T @ index.T_slot[slot]
            if after == j:
                found.append(_path_record(graph, (*nodes, j), T_i_j.inverse() @ T_after))
            elif len(nodes) < index.max_edges:
                stack.append(((*nodes, after), T_after))
    return sorted(found, key=lambda path: (-path.residual_m, path.frames))


def _path_record(graph: PoseGraph, nodes: tuple[int, ...], apart: SE3) -> AlternativePath:
    frames = tuple(int(graph.frame_ids[node]) for node in nodes)
    return AlternativePath(frames, float(np.linalg.norm(apart.t)), float(apart.angle()))


def _index(graph: PoseGraph, settings: VerificationReads) -> PathIndex:
    v = tuned(VerificationTuning, settings.verification)
    cycle = v.variant == "cycle"
    return PathIndex.build(
        graph.relations,
        nodes=len(graph),
        max_edges=2 if cycle else v.max_path_edges,
        with_itself=cycle,
    )


def _row(
    graph: PoseGraph, edge: Edge, *, influence: float, median_m: float, paths: int
) -> QueueRow:
    frame_i, frame_j = pair_of(graph, edge)
    began_ns = int(graph.t_ns[0])
    seconds = [round((int(graph.t_ns[node]) - began_ns) / 1e9, 3) for node in (edge.i, edge.j)]
    return QueueRow(
        frame_i=frame_i,
        frame_j=frame_j,
        t_i_s=seconds[0],
        t_j_s=seconds[1],
        kind=str(edge.kind),
        verdict=str(edge.verdict),
        reason=str(edge.reason),
        measured=is_measured(edge),
        influence_m=finite_or_none(influence, 5),
        overlap=finite_or_none(edge.overlap, 5),
        error_m=finite_or_none(edge.error_m, 5),
        limit_m=finite_or_none(edge.limit_m, 5),
        degeneracy=finite_or_none(edge.degeneracy, 5),
        verification_m=finite_or_none(median_m, 5),
        paths=paths,
        chi2=finite_or_none(edge.chi2, 5),
    )
