"""Verification of a pose graph by alternative paths, and the robust solve after it (V §2.8)."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import asdict, dataclass, replace

import numpy as np

from recon4.geometry.se3 import Array
from recon4.model.edge_columns import EdgeColumns
from recon4.model.events import VerdictsChanged
from recon4.model.plain import finite_or_none
from recon4.model.pose_graph import (
    AUTOMATIC,
    CHECKS_OF_THE_GRAPH,
    Edge,
    Judge,
    Judgment,
    Measure,
    PoseGraph,
    Reason,
    Relations,
    Verdict,
)
from recon4.pose_graph.alternative_paths import PathIndex, reject_worst_first
from recon4.pose_graph.checks import check_relations
from recon4.pose_graph.relations import squared_residuals
from recon4.pose_graph.robust import optimize_gnc, outlier_limit
from recon4.pose_graph.solve import Solution, optimize
from recon4.pose_graph.tuning import VerificationTuning
from recon4.progress import Progress, Silent
from recon4.settings import VerificationSettings
from recon4.settings.tuning import tuned


@dataclass(frozen=True, slots=True, kw_only=True)
class JudgedEdge:
    """An edge in ``verification.json``; the fields are its keys."""

    edge: int
    """Its row in the graph."""
    nodes: tuple[int, int]
    kind: str
    verification_m: float | None
    """None = it has no alternative path."""
    paths: int
    chi2: float | None


@dataclass(frozen=True, slots=True, kw_only=True)
class VerificationRecord:
    """``verification.json``; the fields are its keys, see `Verification`."""

    edges: Mapping[str, int]
    """Number of edges by verdict."""
    rounds: list[list[JudgedEdge]]
    flagged: list[JudgedEdge]
    outliers: list[JudgedEdge]
    duplicates: tuple[tuple[int, int], ...]
    chi2_before: float
    chi2_after: float


@dataclass(frozen=True, slots=True, eq=False)
class Verification:
    """A verified graph and the rejected edges; edges are rows of ``graph.edges``."""

    graph: PoseGraph
    """Optimized poses; edges with verdict, ``verification_m``, ``paths`` and ``chi2``."""
    rounds: tuple[tuple[int, ...], ...]
    """Edges rejected by their alternative paths, round by round, worst first."""
    flagged: tuple[int, ...]
    """Protected edges with a path discrepancy above the limit: kept, but to be reviewed."""
    outliers: tuple[int, ...]
    """Edges rejected by the robust solve."""
    duplicates: tuple[tuple[int, int], ...]
    """Pairs of nodes joined by more than one edge."""
    chi2_before: float
    """Of all input edges, at the input poses."""
    chi2_after: float
    """Of the edges kept, at the optimized poses."""

    def to_json(self) -> dict[str, object]:
        """Plain JSON values for ``verification.json``."""
        edges = self.graph.edges
        record = VerificationRecord(
            edges=self.graph.verdict_counts(),
            rounds=[[_judged(edges[row], row) for row in rows] for rows in self.rounds],
            flagged=[_judged(edges[row], row) for row in self.flagged],
            outliers=[_judged(edges[row], row) for row in self.outliers],
            duplicates=self.duplicates,
            chi2_before=self.chi2_before,
            chi2_after=self.chi2_after,
        )
        return {**asdict(record)}


def verify(
    graph: PoseGraph, *, settings: VerificationSettings, progress: Progress | None = None
) -> Verification:
    """Reject edges that contradict the rest of the graph, and solve for the poses.

    First each edge is compared with all simple paths of at most three other edges between its
    nodes. While the path discrepancy of any edge is above the limit, the worst edge is rejected
    (and in the same round others that have no path in common with it). Then the robust solve of
    the whole graph finds outliers that no path reaches.

    Odometry and decisions of a person are never changed. Automatic decisions of an earlier
    verification do not count, so that verifying twice is the same as verifying once; they stay in
    the history of the edge.

    Raises:
        GraphError: If the graph cannot be solved.
        Cancelled: If the caller requested to stop.
    """
    watcher, given = progress or Silent(), EdgeColumns.of(graph.edges)
    graph = graph.with_edges(replace(given, histories=given.histories.before(CHECKS_OF_THE_GRAPH)))
    of = graph.relations
    duplicates = check_relations(graph.T_map_body, of)
    chi2_before = float(squared_residuals(graph.T_map_body, of)[of.in_graph].sum())
    watcher.start("Verification", 3, "steps")
    paths = _index(of, nodes=len(graph), settings=settings)
    watcher.advance()
    rounds = reject_worst_first(paths, free=~of.protected, limit_m=settings.limit_m)
    rejected = [row for rows in rounds for row in rows]
    graph = _contradicted(graph, paths, rejected, limit_m=settings.limit_m)
    _report_verdicts(graph.edges, rejected, watcher)
    watcher.advance()
    graph, solution, outliers = _solve(graph, settings)
    paths.remove(outliers)
    watcher.advance()
    over = of.protected & paths.alive & (paths.median_m > settings.limit_m)
    edges = EdgeColumns.of(
        _with_figures(graph.edges, paths, solution.edge_chi2, limit_m=settings.limit_m)
    )
    is_open = edges.histories.where_last(lambda words: words.verdict is Verdict.UNVERIFIED)
    unconfirmed = np.flatnonzero(is_open).tolist()
    _report_verdicts(edges, [*outliers, *unconfirmed], watcher)
    return Verification(
        graph=graph.with_edges(_after(edges, given)),
        rounds=tuple(tuple(rows) for rows in rounds),
        flagged=tuple(np.flatnonzero(over).tolist()),
        outliers=tuple(outliers),
        duplicates=tuple(duplicates),
        chi2_before=chi2_before,
        chi2_after=solution.chi2,
    )


def confirmed_again(graph: PoseGraph, *, settings: VerificationSettings) -> PoseGraph:
    """Update the alternative paths of a verified graph after further edges were rejected.

    Paths through rejected edges do not count. An edge without any path left stays in the graph and
    becomes unverified. Odometry and decisions of a person are treated as in `verify`.
    """
    paths = _index(graph.relations, nodes=len(graph), settings=settings)
    changed = {}
    for row, edge in enumerate(graph.edges):
        if not edge.in_graph or edge.paths == 0:  # it was not confirmed before either
            continue
        changed[row] = edge.evolve(
            verification_m=float(paths.median_m[row]), paths=int(paths.count[row])
        )
        if edge.decided_by == AUTOMATIC and paths.count[row] == 0:
            unverified = _by_paths(paths, row, Verdict.UNVERIFIED, limit_m=settings.limit_m)
            changed[row] = changed[row].judged(unverified)
    return graph.with_edges(EdgeColumns.of(graph.edges).replaced(changed))


def _index(of: Relations, *, nodes: int, settings: VerificationSettings) -> PathIndex:
    if settings.variant == "cycle":
        return PathIndex.build(of, nodes=nodes, max_edges=2, with_itself=True)
    return PathIndex.build(
        of, nodes=nodes, max_edges=tuned(VerificationTuning, settings).max_path_edges
    )


def with_judgments(graph: PoseGraph, judgments: Mapping[int, Judgment]) -> PoseGraph:
    """The graph with further verdicts on some edges, by their row."""
    edges = EdgeColumns.of(graph.edges)
    judged = {row: edges[row].judged(judgment) for row, judgment in judgments.items()}
    return graph.with_edges(edges.replaced(judged))


def outlier_judgments(solution: Solution, rows: Iterable[int], *, by: Judge) -> dict[int, Judgment]:
    """Judgments on the outliers of a robust solve.

    Args:
        solution: Has their squared residuals.
        rows: Their rows in the graph.
        by: Which robust solve.
    """
    rejected = (by, Verdict.REJECTED, Reason.ROBUST, Measure.CHI2)
    chi2, limit = solution.edge_chi2, solution.outlier_limit
    return {row: Judgment(*rejected, finite_or_none(float(chi2[row])), limit) for row in rows}


def _contradicted(
    graph: PoseGraph, paths: PathIndex, rows: Sequence[int], *, limit_m: float
) -> PoseGraph:
    """The graph without the edges that their alternative paths contradict."""
    rejected = Verdict.REJECTED
    return with_judgments(
        graph, {row: _by_paths(paths, row, rejected, limit_m=limit_m) for row in rows}
    )


def _by_paths(paths: PathIndex, row: int, verdict: Verdict, *, limit_m: float) -> Judgment:
    """Judgment on an edge by its alternative paths."""
    reason = Reason.VERIFICATION if verdict is Verdict.REJECTED else Reason.NONE
    median_m = finite_or_none(float(paths.median_m[row]))
    return Judgment(Judge.VERIFICATION, verdict, reason, Measure.PATHS, median_m, limit_m)


def _solve(
    graph: PoseGraph, settings: VerificationSettings
) -> tuple[PoseGraph, Solution, list[int]]:
    """The graph with its final poses and without its outliers, the solution, their rows."""
    probability = tuned(VerificationTuning, settings).inlier_probability
    if settings.robust == "none":
        solution = optimize(graph, kernel="none")
        return graph.with_poses(solution.T_map_body), solution, []
    of = graph.relations
    free = of.in_graph & ~of.protected
    if settings.robust == "gnc":
        solution = optimize_gnc(graph, probability=probability)
        outliers = np.flatnonzero(free & (solution.weights == 0.0)).tolist()
        judgments = outlier_judgments(solution, outliers, by=Judge.ROBUST)
        return with_judgments(graph.with_poses(solution.T_map_body), judgments), solution, outliers
    start = optimize(graph, kernel="cauchy")
    limit = outlier_limit(start.edge_chi2[free], probability=probability)
    outliers = np.flatnonzero(free & (start.edge_chi2 > limit)).tolist()
    judgments = outlier_judgments(replace(start, outlier_limit=limit), outliers, by=Judge.ROBUST)
    kept = with_judgments(graph.with_poses(start.T_map_body), judgments)
    solution = optimize(kept, kernel="none")
    return kept.with_poses(solution.T_map_body), solution, outliers


def _with_figures(
    edges: Sequence[Edge], paths: PathIndex, edge_chi2: Array, *, limit_m: float
) -> Iterator[Edge]:
    """Edges with path discrepancy, path count and chi-square; unconfirmed ones are unverified."""
    found = EdgeColumns.of(edges).with_columns(
        verification_m=paths.median_m, paths=paths.count, chi2=edge_chi2
    )
    for row, edge in enumerate(found):
        if edge.in_graph and edge.decided_by == AUTOMATIC:
            verdict = Verdict.ACCEPTED if paths.count[row] else Verdict.UNVERIFIED
            yield edge.judged(_by_paths(paths, row, verdict, limit_m=limit_m))
        else:
            yield edge


def _after(edges: EdgeColumns, given: EdgeColumns) -> EdgeColumns:
    """The edges with the history that they had before they were verified again."""
    again = given.histories.before(CHECKS_OF_THE_GRAPH).count < given.histories.count
    rows = np.flatnonzero(again).tolist()
    return edges.replaced({row: edges[row].after(given[row]) for row in rows})


def _report_verdicts(edges: Sequence[Edge], rows: list[int], watcher: Progress) -> None:
    """Report the verdicts of some edges as an event, for the display of a running job."""
    if rows:
        judged = tuple(edges[row] for row in rows)
        watcher.event(
            VerdictsChanged(edges=tuple((e.i, e.j, e.kind, e.verdict, e.reason) for e in judged))
        )


def _judged(edge: Edge, row: int) -> JudgedEdge:
    return JudgedEdge(
        edge=row,
        nodes=(edge.i, edge.j),
        kind=str(edge.kind),
        verification_m=finite_or_none(edge.verification_m),
        paths=edge.paths,
        chi2=finite_or_none(edge.chi2),
    )
