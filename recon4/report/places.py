"""Findings about places: pieces of the walk that nothing joins, and places that look alike."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from recon4.model.pose_graph import PoseGraph, Reason
from recon4.model.trajectory import Times
from recon4.pose_graph.pieces import joined_pieces
from recon4.report.artifacts import Results

_SAME_PLACE_S = 10.0
"""Ambiguous pairs with less time in between are one place."""


@dataclass(frozen=True, slots=True)
class SeparatePiece:
    """A stretch of the walk whose pose relative to the rest is not known."""

    start_s: float
    """After the first multiframe [s]."""
    end_s: float
    multiframes: int


@dataclass(frozen=True, slots=True)
class AmbiguousPlace:
    """A place that looks like an earlier one which it may be or not."""

    start_s: float
    """After the first node [s]."""
    end_s: float
    like_s: float
    """When the earlier place was visited."""
    pairs: int


def separate_pieces(results: Results) -> list[SeparatePiece]:
    """Pieces that no edge of the graph joins to the largest one, in order of time."""
    piece, t_ns = results.steps.get("piece"), results.steps.get("t_mid_ns")
    if piece is None or t_ns is None or not piece.any():
        return []
    label = _joined(results.graph, piece, t_ns)
    main = int(np.argmax(np.bincount(label)))
    out = []
    for other in np.unique(label[label != main]):
        seconds = (t_ns[label == other] - t_ns[0]) / 1e9
        out.append(SeparatePiece(float(seconds[0]), float(seconds[-1]), len(seconds)))
    return sorted(out, key=lambda one: one.start_s)


def _joined(graph: PoseGraph | None, piece: Times, t_ns: Times) -> Times:
    """Number of the joined piece of each multiframe, (M,)."""
    if graph is None:
        return piece
    row = np.clip(np.searchsorted(t_ns, graph.t_ns), 0, len(piece) - 1)
    of_node, joined = piece[row], joined_pieces(graph, piece[row])
    label = piece.copy()
    for old, node in zip(*np.unique(of_node, return_index=True), strict=True):
        label[piece == old] = joined[node]
    return label


def ambiguous_places(graph: PoseGraph | None) -> list[AmbiguousPlace]:
    """Places of the pairs that wait for a decision because places look alike, in order of time."""
    edges = [e for e in graph.edges if e.reason is Reason.AMBIGUOUS] if graph else []
    if graph is None or not edges:
        return []
    t_s = (graph.t_ns - graph.t_ns[0]) / 1e9
    edges.sort(key=lambda edge: edge.j)
    later_s = np.array([t_s[edge.j] for edge in edges])
    runs = np.split(np.arange(len(edges)), np.flatnonzero(np.diff(later_s) > _SAME_PLACE_S) + 1)
    return [
        AmbiguousPlace(
            start_s=float(later_s[run[0]]),
            end_s=float(later_s[run[-1]]),
            like_s=float(np.median([t_s[edges[k].i] for k in run])),
            pairs=len(run),
        )
        for run in runs
    ]
