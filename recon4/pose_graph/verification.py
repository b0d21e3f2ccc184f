"""Verification of a pose graph by alternative paths, and the robust solve after it (V §2.8)."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from recon4.geometry.se3 import Array
from recon4.model.pose_graph import Edge, PoseGraph, Reason, Relations, Verdict
from recon4.pose_graph.checks import check_relations
from recon4.pose_graph.paths import PathIndex, reject_worst_first
from recon4.pose_graph.relations import squared_residuals
from recon4.pose_graph.robust import optimize_gnc, outlier_limit
from recon4.pose_graph.solve import Solution, optimize
from recon4.progress import Progress, Silent
from recon4.settings import VerificationSettings

_REVISED = (Reason.VERIFICATION, Reason.ROBUST)


@dataclass(frozen=True, slots=True, eq=False)
class Verification:
    """A verified graph and how it came about; edges are rows of ``graph.edges``."""

    graph: PoseGraph
    """Poses solved again; verdicts, ``verification_m``, ``paths`` and ``chi2`` filled in."""
    rounds: tuple[tuple[int, ...], ...]
    """Edges rejected by their alternative paths, round by round, worst first."""
    flagged: tuple[int, ...]
    """Protected edges that disagree with their paths: kept, but worth a look."""
    outliers: tuple[int, ...]
    """Edges rejected by the robust solve."""
    duplicates: tuple[tuple[int, int], ...]
    """Pairs of nodes joined by more than one edge."""
    chi2_before: float
    """Of all edges that came in, at the poses that came in."""
    chi2_after: float
    """Of the edges that stayed, at the poses found."""

    def to_json(self) -> dict[str, Any]:
        """Plain JSON values for ``verification.json``."""
        edges = self.graph.edges
        counts = {
            str(verdict): sum(edge.verdict is verdict for edge in edges) for verdict in Verdict
        }
        return {
            "edges": counts,
            "rounds": [[_edge_record(edges[row], row) for row in rows] for rows in self.rounds],
            "flagged": [_edge_record(edges[row], row) for row in self.flagged],
            "outliers": [_edge_record(edges[row], row) for row in self.outliers],
            "duplicates": [list(pair) for pair in self.duplicates],
            "chi2_before": self.chi2_before,
            "chi2_after": self.chi2_after,
        }


def verify(
    graph: PoseGraph, *, settings: VerificationSettings, progress: Progress | None = None
) -> Verification:
    """Reject edges that contradict the rest of the graph, and solve for the poses.

    First each edge is compared with all simple paths of at most three other edges between its
    nodes; while the median difference of any edge is above the limit, the worst goes (and in the
    same round others that share no path with it). Then the robust solve looks at the whole graph:
    it finds what no path reached.

    Odometry and what a person decided stays as it is. Automatic decisions of an earlier
    verification are taken back first, so that verifying twice is the same as verifying once.

    Raises:
        GraphError: If the graph cannot be solved.
        Cancelled: If the watcher asked to stop.
    """
    watcher = progress or Silent()
    graph = graph.with_edges(tuple(_as_before(edge) for edge in graph.edges))
    of = graph.relations
    duplicates = check_relations(graph.T_map_body, of)
    chi2_before = float(squared_residuals(graph.T_map_body, of)[of.in_graph].sum())
    watcher.start("Verification", 3, "steps")
    paths = _index(of, nodes=len(graph), settings=settings)
    watcher.advance()
    rounds = reject_worst_first(paths, free=~of.protected, limit_m=settings.limit_m)
    graph = _with_rejected(graph, [row for rows in rounds for row in rows], Reason.VERIFICATION)
    _report_verdicts(graph.edges, [row for rows in rounds for row in rows], watcher)
    watcher.advance()
    solution, outliers = _solve(graph, settings)
    graph = _with_rejected(graph.with_poses(solution.T_map_body), outliers, Reason.ROBUST)
    paths.remove(outliers)
    watcher.advance()
    over = of.protected & paths.alive & (paths.median_m > settings.limit_m)
    edges = _with_figures(graph.edges, paths, solution.edge_chi2)
    unconfirmed = [row for row, edge in enumerate(edges) if edge.verdict is Verdict.UNVERIFIED]
    _report_verdicts(edges, [*outliers, *unconfirmed], watcher)
    return Verification(
        graph=graph.with_edges(edges),
        rounds=tuple(tuple(rows) for rows in rounds),
        flagged=tuple(np.flatnonzero(over).tolist()),
        outliers=tuple(outliers),
        duplicates=tuple(duplicates),
        chi2_before=chi2_before,
        chi2_after=solution.chi2,
    )


def confirmed_again(graph: PoseGraph, *, settings: VerificationSettings) -> PoseGraph:
    """A verified graph some edges of which were turned down since: who is still confirmed?

    Paths through these edges are gone. An edge whose last path went with them stays in the graph
    and is unverified from now on; odometry and what a person decided are treated as in `verify`.
    """
    paths = _index(graph.relations, nodes=len(graph), settings=settings)
    edges = list(graph.edges)
    for row, edge in enumerate(edges):
        if not edge.in_graph or edge.paths == 0:  # it was not confirmed before either
            continue
        alone = edge.decided_by == "auto" and paths.count[row] == 0
        edges[row] = edge.evolve(
            verdict=Verdict.UNVERIFIED if alone else edge.verdict,
            verification_m=float(paths.median_m[row]),
            paths=int(paths.count[row]),
        )
    return graph.with_edges(tuple(edges))


def _as_before(edge: Edge) -> Edge:
    """The edge as it was before any verification."""
    if edge.decided_by != "auto":
        return edge
    if edge.verdict is Verdict.UNVERIFIED or edge.reason in _REVISED:
        return edge.evolve(verdict=Verdict.ACCEPTED, reason=Reason.NONE)
    return edge


def _index(of: Relations, *, nodes: int, settings: VerificationSettings) -> PathIndex:
    if settings.variant == "cycle":
        return PathIndex.build(of, nodes=nodes, max_edges=2, with_itself=True)
    return PathIndex.build(of, nodes=nodes, max_edges=settings.max_path_edges)


def _with_rejected(graph: PoseGraph, rows: list[int], reason: Reason) -> PoseGraph:
    edges = list(graph.edges)
    for row in rows:
        edges[row] = edges[row].evolve(verdict=Verdict.REJECTED, reason=reason)
    return graph.with_edges(tuple(edges))


def _solve(graph: PoseGraph, settings: VerificationSettings) -> tuple[Solution, list[int]]:
    """The final poses, and the edges that do not fit them."""
    if settings.robust == "none":
        return optimize(graph, kernel="none"), []
    of = graph.relations
    free = of.in_graph & ~of.protected
    if settings.robust == "gnc":
        solution = optimize_gnc(graph, probability=settings.inlier_probability)
        return solution, np.flatnonzero(free & (solution.weights == 0.0)).tolist()
    start = optimize(graph, kernel="cauchy")
    limit = outlier_limit(start.edge_chi2[free], probability=settings.inlier_probability)
    outliers = np.flatnonzero(free & (start.edge_chi2 > limit)).tolist()
    kept = _with_rejected(graph.with_poses(start.T_map_body), outliers, Reason.ROBUST)
    return optimize(kept, kernel="none"), outliers


def _with_figures(edges: tuple[Edge, ...], paths: PathIndex, edge_chi2: Array) -> tuple[Edge, ...]:
    """Edges with what was measured on them; the unconfirmed ones named as such."""
    out = []
    for row, edge in enumerate(edges):
        verdict = edge.verdict
        if edge.in_graph and edge.decided_by == "auto":
            verdict = Verdict.ACCEPTED if paths.count[row] else Verdict.UNVERIFIED
        out.append(
            edge.evolve(
                verdict=verdict,
                verification_m=float(paths.median_m[row]),
                paths=int(paths.count[row]),
                chi2=float(edge_chi2[row]),
            )
        )
    return tuple(out)


def _report_verdicts(edges: tuple[Edge, ...], rows: list[int], watcher: Progress) -> None:
    """What became of some edges, for whoever watches them while the job runs."""
    if rows:
        record = [
            [e.i, e.j, e.kind.value, e.verdict.value, e.reason.value]
            for e in (edges[row] for row in rows)
        ]
        watcher.event("verdicts", edges=record)


def _edge_record(edge: Edge, row: int) -> dict[str, Any]:
    return {
        "edge": row,
        "nodes": [edge.i, edge.j],
        "kind": str(edge.kind),
        "verification_m": _or_null(edge.verification_m),
        "paths": edge.paths,
        "chi2": _or_null(edge.chi2),
    }


def _or_null(number: float) -> float | None:
    return number if np.isfinite(number) else None
