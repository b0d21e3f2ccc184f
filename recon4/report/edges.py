"""Verdicts of the registered pairs."""

from __future__ import annotations

from collections import Counter, defaultdict
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from recon4.geometry.se3 import Array
from recon4.model.pose_graph import Edge, EdgeKind, PoseGraph, Reason, Verdict
from recon4.report.plan import PlanPath
from recon4.report.tuning import EDGE_CHARTS

_REASONS = {
    Reason.ERROR: "error > acceptance limit",
    Reason.NOT_CONVERGED: "no convergence",
    Reason.FEW_MATCHES: "too few matches",
    Reason.ROBUST: "outlier of the robust solve",
    Reason.OPERATOR: "decision of the operator",
}
"""Text of each reason; others are shown as they are."""
_MARKS = {Verdict.ACCEPTED: "\u2713", Verdict.REJECTED: "\u2715", Verdict.UNVERIFIED: "\u25cc"}


@dataclass(frozen=True, slots=True)
class EdgeRow:
    """A row of the table: a verdict with its reason and history, and the edges of each kind."""

    verdict: str
    reason: str
    history: str
    """Who judged these edges, in order, and how, as in ``search ✓ → verification ✕``."""
    counts: tuple[int, ...]
    """In the order of `EdgeKind`."""

    @property
    def total(self) -> int:
        """Edges of all kinds."""
        return sum(self.counts)


def edge_rows(graph: PoseGraph, *, limit_m: float) -> list[EdgeRow]:
    """Edges by verdict, reason and history; the most frequent history of a reason first.

    Args:
        graph: Its edges are counted.
        limit_m: Largest path discrepancy that verification accepts [m].
    """
    count: dict[tuple[Verdict, Reason, str], Counter[EdgeKind]] = defaultdict(Counter)
    for edge in graph.edges:
        count[edge.verdict, edge.reason, history_text(edge)][edge.kind] += 1
    order = {word: k for words in (Verdict, Reason) for k, word in enumerate(words)}
    rows = sorted(
        count.items(),
        key=lambda row: (order[row[0][0]], order[row[0][1]], -row[1].total(), row[0][2]),
    )
    return [
        EdgeRow(
            _verdict_text(verdict, reason),
            _reason_text(reason, limit_m),
            history,
            tuple(kinds[kind] for kind in EdgeKind),
        )
        for (verdict, reason, history), kinds in rows
    ]


def history_text(edge: Edge) -> str:
    """Who judged an edge, in order, and how; people without their names."""
    return " \u2192 ".join(f"{one.by} {_MARKS[one.verdict]}" for one in edge.judgments)


def _verdict_text(verdict: Verdict, reason: Reason) -> str:
    automatic = verdict is Verdict.REJECTED and reason is not Reason.OPERATOR
    return "rejected automatically" if automatic else str(verdict)


def _reason_text(reason: Reason, limit_m: float) -> str:
    if reason is Reason.VERIFICATION:
        return f"path discrepancy > {100.0 * limit_m:g} cm"
    return _REASONS.get(reason, str(reason))


def edge_paths(graph: PoseGraph) -> tuple[PlanPath, ...]:
    """Lines between the nodes: rejected ones below, accepted ones above."""
    place = graph.T_map_body.t
    tests: tuple[tuple[str, Callable[[Edge], bool]], ...] = (
        ("edge-rejected", lambda e: e.verdict is Verdict.REJECTED and not _verified_away(e)),
        ("edge-unverified", lambda e: e.verdict is Verdict.UNVERIFIED),
        (
            "edge-accepted",
            lambda e: e.verdict is Verdict.ACCEPTED and e.kind is not EdgeKind.ODOMETRY,
        ),
        ("edge-verification", _verified_away),
    )
    return tuple(
        PlanPath(css, tuple(place[[edge.i, edge.j]] for edge in _some(graph, test)))
        for css, test in tests
    )


def spanning(graph: PoseGraph) -> NDArray[np.int64]:
    """Number of edges in the graph that span each step between consecutive nodes, (N - 1,).

    1 = the step depends on the odometry only.
    """
    change = np.zeros(len(graph) + 1, dtype=np.int64)
    for edge in graph.edges:
        if edge.in_graph:
            change[edge.i] += 1
            change[edge.j] -= 1
    return np.cumsum(change)[: max(len(graph) - 1, 0)]


def by_verdict(graph: PoseGraph, value: Callable[[Edge], float]) -> dict[Verdict, Array]:
    """A value of each edge, grouped by verdict."""
    return {
        verdict: np.array([value(e) for e in graph.edges if e.verdict is verdict], dtype=np.float64)
        for verdict in Verdict
    }


def _verified_away(edge: Edge) -> bool:
    return edge.verdict is Verdict.REJECTED and edge.reason in {Reason.VERIFICATION, Reason.ROBUST}


def _some(graph: PoseGraph, test: Callable[[Edge], bool]) -> list[Edge]:
    edges = [edge for edge in graph.edges if test(edge)]
    return edges[:: max(1, -(-len(edges) // EDGE_CHARTS.max_drawn))]
