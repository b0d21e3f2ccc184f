"""Verifies and solves the graph with the decisions of a review, and reports the changes.

The stage ``review`` and the preview after each decision use the same function.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from itertools import islice
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from recon4.geometry.se3 import SE3
from recon4.model.edge_columns import EdgeColumns
from recon4.model.figures import ReviewFigures
from recon4.model.plain import finite_or_none, to_plain
from recon4.model.pose_graph import AUTOMATIC, Edge, PoseGraph, Relations
from recon4.pose_graph.files import load_graph, save_graph
from recon4.pose_graph.relations import squared_residuals
from recon4.pose_graph.robust import outlier_limit
from recon4.pose_graph.solve import optimize
from recon4.pose_graph.tuning import VerificationTuning
from recon4.pose_graph.verification import verify
from recon4.progress import Progress, Silent
from recon4.review.apply import apply_decisions
from recon4.review.decisions import Pair, Standing
from recon4.review.tuning import REVIEW_SOLVE
from recon4.settings.reads import VerificationReads
from recon4.settings.tuning import tuned
from recon4.store.atomic import write_json

UNVERIFIED_MODES = ("10", "overlap")
"""Modes of V Table 3.2 without verification."""


@dataclass(frozen=True, slots=True)
class EdgeConflict:
    """An edge accepted by a reviewer that does not fit the graph; it stays in the graph."""

    pair: Pair
    chi2: float
    """Chi-square contribution."""
    limit: float
    """Chi-square limit of an outlier."""
    residual_m: float
    residual_rad: float
    who: str


@dataclass(frozen=True, slots=True)
class Move:
    """Displacement of a node."""

    node: int
    frame_id: int
    t_ns: int
    moved_m: float


@dataclass(frozen=True, slots=True)
class ReviewProblems:
    """What the operator should check after a review."""

    conflicts: tuple[EdgeConflict, ...]
    """Worst first."""
    missing: tuple[Pair, ...]
    """Pairs of decisions without effect."""
    changed: tuple[Pair, ...]
    """Pairs whose measurement has changed since the decision."""


@dataclass(frozen=True, slots=True, eq=False)
class Reviewed:
    """The solved graph with the decisions applied."""

    graph: PoseGraph
    conflicts: tuple[EdgeConflict, ...]
    """Worst first."""
    missing: tuple[Standing, ...]
    """Decisions without effect: their pair is not in this graph, or was never registered."""
    changed: tuple[Standing, ...]
    """Decisions about edges that differ from the pose the reviewer saw."""

    @property
    def chi2(self) -> float:
        """Sum of the chi-square contributions of the edges in the graph."""
        return chi2_of(self.graph)[0]

    @property
    def problems(self) -> ReviewProblems:
        """Conflicts, ineffective and outdated decisions."""
        return ReviewProblems(
            conflicts=self.conflicts,
            missing=tuple(one.pair for one in self.missing),
            changed=tuple(one.pair for one in self.changed),
        )


@dataclass(frozen=True, slots=True)
class Difference:
    """Difference between two solved graphs with the same nodes."""

    chi2_before: float
    chi2_after: float
    edges_before: int
    """In the graph."""
    edges_after: int
    moves: tuple[Move, ...]
    """The largest displacements, one per place, largest first."""
    rejected_automatically: tuple[Pair, ...]
    """Pairs that verification now rejects."""
    accepted_automatically: tuple[Pair, ...]
    """Pairs that verification now accepts."""


def run_review(
    graph: Path,
    decisions: Sequence[Standing],
    out: Path,
    *,
    settings: VerificationReads,
    progress: Progress,
) -> ReviewFigures:
    """Run the stage ``review``: apply decisions to the verified graph and solve it.

    Args:
        graph: Folder of the verified graph.
        decisions: The decisions in force.
        out: Receives ``graph.npz``, ``edges.json`` and ``review.json``.
        settings: Uses verification and graph.
        progress: Counts the steps.
    """
    verified = load_graph(graph)
    reviewed = review(verified, decisions, settings=settings, progress=progress)
    save_graph(out, reviewed.graph)
    changed = difference(verified, reviewed.graph)
    record = to_plain(changed) | {"decisions": decisions} | to_plain(reviewed.problems)
    write_json(out / "review.json", to_plain(record))
    return review_figures(reviewed, len(decisions), chi2_before=changed.chi2_before)


def review_figures(
    reviewed: Reviewed, decisions: int, *, chi2_before: float | None
) -> ReviewFigures:
    """Counts of a review, with the first pairs of each problem."""
    problems = reviewed.problems
    return ReviewFigures(
        edges=reviewed.graph.verdict_counts(),
        decisions=decisions,
        conflicts=len(problems.conflicts),
        conflict_pairs=_first(one.pair for one in problems.conflicts),
        missing=len(problems.missing),
        missing_pairs=_first(problems.missing),
        changed=len(problems.changed),
        changed_pairs=_first(problems.changed),
        chi2_before=chi2_before,
        chi2_after=finite_or_none(reviewed.chi2),
    )


def review(
    verified: PoseGraph,
    decisions: Sequence[Standing],
    *,
    settings: VerificationReads,
    progress: Progress | None = None,
) -> Reviewed:
    """Apply the decisions, then verify and solve the graph again.

    Edges accepted by a reviewer always stay in the graph (protected, like odometry). All other
    pairs are verified again, because their verdict may depend on a pair that is now rejected.
    Accepted edges that do not fit are reported as `EdgeConflict`.

    Raises:
        GraphError: If the graph cannot be solved.
    """
    applied = apply_decisions(verified, decisions)
    if settings.graph.mode in UNVERIFIED_MODES:
        graph = _solved(applied.graph)
    else:
        graph = verify(
            applied.graph, settings=settings.verification, progress=progress or Silent()
        ).graph
        graph = graph.with_poses(_poses_by_edges(verified, graph))
    found = conflicts(
        graph, probability=tuned(VerificationTuning, settings.verification).inlier_probability
    )
    return Reviewed(graph, found, applied.missing, applied.changed)


def _poses_by_edges(verified: PoseGraph, graph: PoseGraph) -> SE3:
    """Poses that depend on the edges in use alone, not on how the robust solve came to them.

    A decision that leaves the edges in use as they are, such as a confirmed verdict, so changes no
    bit of the poses, and later stages have nothing to do.

    Args:
        verified: Before any decision.
        graph: Verified and solved with the decisions.
    """
    if _has_same_factors(verified.relations, graph.relations):
        return verified.T_map_body
    again = optimize(graph.with_poses(verified.T_map_body), kernel="none")
    is_same_minimum = again.chi2 <= chi2_of(graph)[0] * (1.0 + REVIEW_SOLVE.same_chi2)
    return again.T_map_body if is_same_minimum else graph.T_map_body


def _has_same_factors(before: Relations, after: Relations) -> bool:
    """Whether the same edges are in use, with the same measurements."""

    def used(of: Relations) -> tuple[NDArray[Any], ...]:
        T = of.T_i_j
        columns = (of.i, of.j, T.R, T.t, of.information)
        return tuple(column[of.in_graph] for column in columns)

    return all(map(np.array_equal, used(before), used(after)))


def _solved(graph: PoseGraph) -> PoseGraph:
    solution = optimize(graph, kernel="cauchy")
    edges = EdgeColumns.of(graph.edges).with_columns(chi2=solution.edge_chi2)
    return graph.with_poses(solution.T_map_body).with_edges(edges)


def conflicts(graph: PoseGraph, *, probability: float) -> tuple[EdgeConflict, ...]:
    """Edges accepted by reviewers that do not fit the graph, worst first."""
    of = graph.relations
    chi2 = squared_residuals(graph.T_map_body, of)
    free = of.in_graph & ~of.protected
    limit = outlier_limit(chi2[free], probability=probability)
    found = []
    for row, edge in enumerate(graph.edges):
        if edge.in_graph and edge.decided_by != AUTOMATIC and chi2[row] > limit:
            apart = _residual(graph, edge)
            found.append(
                EdgeConflict(
                    pair=pair_of(graph, edge),
                    chi2=float(chi2[row]),
                    limit=limit,
                    residual_m=float(np.linalg.norm(apart.t)),
                    residual_rad=float(apart.angle()),
                    who=edge.decided_by,
                )
            )
    return tuple(sorted(found, key=lambda one: (-one.chi2, one.pair)))


def difference(before: PoseGraph, after: PoseGraph) -> Difference:
    """Changes from one graph to the other; ``after`` may have more edges at its end."""
    chi2_before, edges_before = chi2_of(before)
    chi2_after, edges_after = chi2_of(after)
    rejected_automatically: list[Pair] = []
    accepted_automatically: list[Pair] = []
    for old, new in zip(before.edges, after.edges, strict=False):
        if new.decided_by == AUTOMATIC and old.in_graph != new.in_graph:
            (accepted_automatically if new.in_graph else rejected_automatically).append(
                pair_of(after, new)
            )
    return Difference(
        chi2_before=chi2_before,
        chi2_after=chi2_after,
        edges_before=edges_before,
        edges_after=edges_after,
        moves=_largest_moves(before, after),
        rejected_automatically=tuple(rejected_automatically),
        accepted_automatically=tuple(accepted_automatically),
    )


def chi2_of(graph: PoseGraph) -> tuple[float, int]:
    """Sum of the chi-square contributions of the edges in the graph, and their number."""
    of = graph.relations
    used: NDArray[np.float64] = squared_residuals(graph.T_map_body, of)[of.in_graph]
    return float(used.sum()), len(used)


def pair_of(graph: PoseGraph, edge: Edge) -> Pair:
    """Ids of the two multiframes of an edge."""
    return int(graph.frame_ids[edge.i]), int(graph.frame_ids[edge.j])


def _largest_moves(before: PoseGraph, after: PoseGraph) -> tuple[Move, ...]:
    moved_m = np.linalg.norm(after.T_map_body.t - before.T_map_body.t, axis=1)
    taken: list[int] = []
    for node in np.argsort(-moved_m, kind="stable").tolist():
        if len(taken) == REVIEW_SOLVE.max_moves or moved_m[node] < REVIEW_SOLVE.min_move_m:
            break
        if all(abs(node - other) >= REVIEW_SOLVE.apart_nodes for other in taken):
            taken.append(node)
    return tuple(
        Move(node, int(after.frame_ids[node]), int(after.t_ns[node]), float(moved_m[node]))
        for node in taken
    )


def _residual(graph: PoseGraph, edge: Edge) -> SE3:
    predicted = graph.T_map_body[edge.i].inverse() @ graph.T_map_body[edge.j]
    return edge.T_i_j.inverse() @ predicted


def _first(pairs: Iterable[Pair]) -> tuple[str, ...]:
    return tuple(f"multiframes {i} and {j}" for i, j in islice(pairs, REVIEW_SOLVE.named_pairs))
