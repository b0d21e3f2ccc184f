"""Findings about places: pieces of the walk that nothing joins, and places that look alike."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from recon4.findings.walk_record import WalkRecord
from recon4.findings.witnesses.base import Witness, finding
from recon4.findings.witnesses.tuning import PLACE_WITNESS
from recon4.model.finding import Finding, Level
from recon4.model.finding_kinds import FindingKind
from recon4.model.pose_graph import PoseGraph, Reason
from recon4.model.trajectory import Times
from recon4.pose_graph.pieces import joined_pieces


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


def separate_pieces(walk: WalkRecord) -> list[SeparatePiece]:
    """Pieces that no edge of the graph joins to the largest one, in order of time."""
    piece, t_ns = walk.steps.get("piece"), walk.steps.get("t_mid_ns")
    if piece is None or t_ns is None or not piece.any():
        return []
    label = _joined(walk.graph, piece, t_ns)
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
    runs = np.split(
        np.arange(len(edges)), np.flatnonzero(np.diff(later_s) > PLACE_WITNESS.same_place_s) + 1
    )
    return [
        AmbiguousPlace(
            start_s=float(later_s[run[0]]),
            end_s=float(later_s[run[-1]]),
            like_s=float(np.median([t_s[edges[k].i] for k in run])),
            pairs=len(run),
        )
        for run in runs
    ]


class Pieces(Witness):
    """Parts of the walk that nothing joins."""

    def check(self, walk: WalkRecord) -> Iterator[Finding]:
        """Each piece but the largest."""
        for piece in separate_pieces(walk):
            yield finding(
                FindingKind.SEPARATE_PIECE,
                Level.DO_NOT_USE,
                {"multiframes": piece.multiframes},
                span_s=(piece.start_s, piece.end_s),
            )


class LookAlike(Witness):
    """Places that look like others."""

    def check(self, walk: WalkRecord) -> Iterator[Finding]:
        """Each place whose pairs wait for a decision."""
        for place in ambiguous_places(walk.graph):
            yield finding(
                FindingKind.PLACE_AMBIGUOUS,
                Level.CHECK,
                {"like_s": place.like_s, "pairs": place.pairs},
                span_s=(place.start_s, place.end_s),
            )
