"""Pose graph: nodes with poses, and all edges between them, accepted or not."""

from __future__ import annotations

from abc import abstractmethod
from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass, replace
from enum import StrEnum
from functools import cached_property
from typing import Any

import numpy as np
from msgspec import Struct, field, structs
from numpy.typing import NDArray

from recon4.geometry.se3 import SE3, Array
from recon4.model.trajectory import Times, Trajectory

Rows = NDArray[np.intp]
Flags = NDArray[np.bool_]


class EdgeKind(StrEnum):
    """Where an edge comes from."""

    ODOMETRY = "odometry"
    """Between consecutive nodes: protected, so that the graph stays connected."""
    NEIGHBOR = "neighbor"
    """Between nodes a few steps apart in time."""
    LOOP = "loop"
    """Loop closure: a place seen again."""
    MANUAL = "manual"
    """Made by an operator."""


class Verdict(StrEnum):
    """Whether an edge is used."""

    ACCEPTED = "accepted"
    REJECTED = "rejected"
    UNVERIFIED = "unverified"
    """Accepted by its own error, but no alternative path confirms it: in the graph, shown gray."""


class Reason(StrEnum):
    """Why an edge was rejected; the value is shown to users."""

    NONE = ""
    OVERLAP = "overlap < t_o"
    ERROR = "error > limit"
    NOT_CONVERGED = "not converged"
    FEW_MATCHES = "too few segments match"
    DEGENERATE = "degenerate"
    SEEN_THROUGH = "free space contradicts it"
    UNCONFIRMED = "neighboring places do not confirm it"
    AMBIGUOUS = "ambiguous: places look alike"
    """Another pose fits as well, or it contradicts what the graph states; a person decides."""
    VERIFICATION = "verification median > limit"
    ROBUST = "outlier in the robust solution"
    OPERATOR = "operator"


class Judge(StrEnum):
    """Who gave a verdict on an edge; the value is shown to users."""

    ODOMETRY = "odometry"
    """Consecutive nodes are joined without a test."""
    SEARCH = "search"
    """The registration of the pair."""
    FREE_SPACE = "free space"
    """Whether one visit has points where the other one saw through."""
    PLACES = "neighboring places"
    """The group of recognized places that agree on one correction."""
    VERIFICATION = "verification"
    """The alternative paths."""
    ROBUST = "robust solve"
    GNSS = "GNSS"
    """The robust solve with the fixes."""
    PERSON = "person"


CHECKS_OF_THE_GRAPH = frozenset({Judge.VERIFICATION, Judge.ROBUST, Judge.GNSS})
"""They judge only what the search accepted, and judge again whenever the graph changes."""


class Measure(StrEnum):
    """The figure that a judge compared with its limit; the value is its name in files."""

    NONE = ""
    OVERLAP = "overlap"
    ERROR = "error_m"
    MATCHES = "match_ratio"
    DEGENERACY = "degeneracy"
    SEEN_THROUGH = "seen_through"
    """Fraction of the points of one node in the free space of the other, 0..1."""
    CONFIRMED = "confirmed_nodes"
    """Nodes along the path whose views fit the same correction."""
    CONTRADICTED = "contradicted_nodes"
    PATHS = "verification_m"
    """Median translation difference to the alternative paths [m]."""
    CHI2 = "chi2"
    """Squared Mahalanobis residual."""


AUTOMATIC = "auto"
"""`Edge.decided_by` of automatic verdicts; no user may have this name."""


@dataclass(frozen=True, slots=True)
class Judgment:
    """One verdict on an edge: who gave it, why, and by which figure."""

    by: Judge
    verdict: Verdict
    reason: Reason = Reason.NONE
    measure: Measure = Measure.NONE
    value: float | None = None
    """Of the measure, when the verdict was given; None = not known."""
    limit: float | None = None
    """Of the value; None = not known."""
    person: str = ""
    """Name of the person; empty for every other judge."""
    note: str = ""
    """Reason that the person gave."""

    def __post_init__(self) -> None:
        if (self.by is Judge.PERSON) != bool(self.person):
            raise ValueError(f"a judgment by {self.by} of the person {self.person!r}")

    def repeats(self, other: Judgment) -> bool:
        """Whether the same judge says the same again, whatever its figures."""
        return (self.by, self.verdict, self.reason, self.person) == (
            other.by, other.verdict, other.reason, other.person,
        )  # fmt: skip


class Edge(Struct, frozen=True, eq=False, kw_only=True):
    """A measured relative pose of two nodes, with the history of the verdicts on it."""

    i: int
    """Row of the first node."""
    j: int
    """Row of the second node; ``i < j``."""
    T_i_j: SE3
    """Maps points of the body at node ``j`` into the body frame at node ``i`` (A0 no. 3)."""
    kind: EdgeKind
    judgments: tuple[Judgment, ...]
    """All verdicts in the order in which they were given; the last one counts. At least one."""
    overlap: float = float("nan")
    """Fraction of points of ``j`` inside the view volume of ``i``, 0..1 (V Eq. 2.6)."""
    error_m: float = float("nan")
    """Mean distance of matched lines after the last step [m]."""
    limit_m: float = float("nan")
    """Acceptance limit of the error, ``median_range * t_r + t_a`` [m] (V Eq. 2.7)."""
    information: Array = field(default_factory=lambda: np.eye(6))
    """Inverse covariance of the tangent of ``T_i_j``, rotation first, (6, 6)."""
    degeneracy: float = float("nan")
    """Smallest eigenvalue of the registration's normalized translation information, 0..1/3."""
    converged: bool = True
    iterations: int = 0
    verification_m: float = float("nan")
    """Median translation difference to the alternative paths [m]; NaN = no path (V Eq. 2.12)."""
    paths: int = 0
    """Number of alternative paths of at most three edges."""
    chi2: float = float("nan")
    """Squared Mahalanobis residual in the final graph."""

    def __post_init__(self) -> None:
        if not self.judgments:
            raise ValueError(f"edge {self.i}-{self.j} has no judgment")

    def evolve(self, **changes: Any) -> Edge:
        """The edge with some fields changed; its judgments change by `judged` only."""
        if "judgments" in changes:
            raise TypeError("a verdict is given by Edge.judged, which keeps the earlier ones")
        return structs.replace(self, **changes)

    def judged(self, judgment: Judgment) -> Edge:
        """The edge with another verdict; the earlier ones stay in its history.

        The same verdict by the same judge again only brings its figures up to date.

        Raises:
            ValueError: If the program would overrule a person.
        """
        last = self.judgments[-1]
        if last.by is Judge.PERSON and judgment.by is not Judge.PERSON:
            raise ValueError(f"edge {self.i}-{self.j}: the decision of {last.person} stands")
        earlier = self.judgments[:-1] if judgment.repeats(last) else self.judgments
        return structs.replace(self, judgments=(*earlier, judgment))

    def after(self, earlier: Edge) -> Edge:
        """The edge with the history of its pair before its own.

        Args:
            earlier: The same pair, as it was registered or judged before.
        """
        known = 0
        for one, other in zip(self.judgments, earlier.judgments, strict=False):
            if one != other:
                break
            known += 1
        edge = structs.replace(self, judgments=earlier.judgments)
        for judgment in self.judgments[known:]:
            edge = edge.judged(judgment)
        return edge

    def before(self, judges: frozenset[Judge]) -> Edge:
        """The edge as it was before the last judgments, if some judges gave them.

        Used to judge again; `after` puts the history back.
        """
        count = len(self.judgments)
        while count > 1 and self.judgments[count - 1].by in judges:
            count -= 1
        if count == len(self.judgments):
            return self
        return structs.replace(self, judgments=self.judgments[:count])

    @property
    def verdict(self) -> Verdict:
        """The last one."""
        return self.judgments[-1].verdict

    @property
    def reason(self) -> Reason:
        """Why the last verdict was given; `Reason.NONE` if the edge is accepted."""
        return self.judgments[-1].reason

    @property
    def decided_by(self) -> str:
        """Name of the person who gave the last verdict, or `AUTOMATIC`."""
        return self.judgments[-1].person or AUTOMATIC

    @property
    def in_graph(self) -> bool:
        """Whether the optimizer uses it."""
        return self.judgments[-1].verdict is not Verdict.REJECTED


def accepted_unseen() -> tuple[Judgment, ...]:
    """History of an odometry edge: consecutive nodes are joined without a test."""
    return (Judgment(Judge.ODOMETRY, Verdict.ACCEPTED),)


_JUDGE_OF = {
    Reason.SEEN_THROUGH: Judge.FREE_SPACE,
    Reason.UNCONFIRMED: Judge.PLACES,
    Reason.AMBIGUOUS: Judge.PLACES,
    Reason.VERIFICATION: Judge.VERIFICATION,
    Reason.ROBUST: Judge.ROBUST,
}


def known_judgment(
    verdict: Verdict, reason: Reason = Reason.NONE, decided_by: str = AUTOMATIC
) -> Judgment:
    """The judgment behind a verdict of which only the reason is known.

    Args:
        verdict: Its verdict.
        reason: Its reason; the judge follows from it.
        decided_by: `AUTOMATIC` or the name of a person.
    """
    if decided_by != AUTOMATIC:
        return Judgment(Judge.PERSON, verdict, reason, person=decided_by)
    by = _JUDGE_OF.get(reason, Judge.SEARCH)
    return Judgment(Judge.VERIFICATION if verdict is Verdict.UNVERIFIED else by, verdict, reason)


def known_history(
    verdict: Verdict,
    reason: Reason = Reason.NONE,
    decided_by: str = AUTOMATIC,
    *,
    kind: EdgeKind = EdgeKind.LOOP,
) -> tuple[Judgment, ...]:
    """What is known of the history of an edge from its last verdict alone.

    Verification and the robust solve judge only what was accepted before. Arguments as of
    `known_judgment`, and the kind of the edge.
    """
    last = known_judgment(verdict, reason, decided_by)
    is_odometry = kind is EdgeKind.ODOMETRY
    opening = Judgment(Judge.ODOMETRY if is_odometry else Judge.SEARCH, Verdict.ACCEPTED)
    if last.by in CHECKS_OF_THE_GRAPH:
        return (opening, last)
    return (opening,) if is_odometry and last.verdict is Verdict.ACCEPTED else (last,)


@dataclass(frozen=True, slots=True, eq=False)
class Relations:
    """Edges as arrays, one row per edge, in the order of ``PoseGraph.edges``."""

    i: Rows
    """First node, (E,)."""
    j: Rows
    """Second node, (E,)."""
    T_i_j: SE3
    """Pose of ``j`` in ``i``, a batch of E."""
    information: Array
    """Rotation first, (E, 6, 6)."""
    in_graph: Flags
    """Whether the optimizer uses it, (E,)."""
    protected: Flags
    """Never rejected automatically: odometry, which connects the graph, and decisions, (E,)."""

    def __len__(self) -> int:
        return len(self.i)


class EdgeSource(Sequence[Edge]):
    """Edges that are arrays already."""

    __slots__ = ()

    @property
    @abstractmethod
    def relations(self) -> Relations:
        """The arrays."""


def relations_of(edges: Sequence[Edge]) -> Relations:
    """Convert edges to arrays; for a graph use `PoseGraph.relations`."""
    if isinstance(edges, EdgeSource):
        return edges.relations
    return Relations(
        i=np.array([edge.i for edge in edges], dtype=np.intp),
        j=np.array([edge.j for edge in edges], dtype=np.intp),
        T_i_j=SE3.stack(edge.T_i_j for edge in edges),
        information=np.array([edge.information for edge in edges]).reshape(-1, 6, 6),
        in_graph=np.array([edge.in_graph for edge in edges], dtype=np.bool_),
        protected=np.array([_is_protected(edge) for edge in edges], dtype=np.bool_),
    )


def _is_protected(edge: Edge) -> bool:
    return edge.kind is EdgeKind.ODOMETRY or edge.decided_by != AUTOMATIC


@dataclass(frozen=True, eq=False)
class PoseGraph:
    """Nodes with their poses, and all edges with any verdict.

    >>> graph = api.open_project("walk").graph
    >>> graph.T_map_body.t.shape == (len(graph), 3)
    True
    >>> {str(edge.kind) for edge in graph.edges if edge.j == edge.i + 1} >= {"odometry"}
    True
    """

    frame_ids: Times
    """Multiframe of each node, (N,)."""
    t_ns: Times
    """Time of each node [ns], (N,)."""
    T_map_body: SE3
    """Pose of each node, a batch of N."""
    edges: Sequence[Edge]

    def __len__(self) -> int:
        return len(self.frame_ids)

    @cached_property
    def relations(self) -> Relations:
        """The edges as arrays, created on first access."""
        return relations_of(self.edges)

    @property
    def nodes(self) -> Trajectory:
        """``T_map_body`` of the nodes by their times."""
        return Trajectory(self.t_ns, self.T_map_body)

    def verdict_counts(self) -> dict[str, int]:
        """Number of edges with each verdict."""
        counts = Counter(edge.verdict for edge in self.edges)
        return {str(verdict): counts[verdict] for verdict in Verdict}

    def loop_verdicts(self) -> Counter[Verdict]:
        """Number of loop closures, manual ones included, with each verdict."""
        loops = (EdgeKind.LOOP, EdgeKind.MANUAL)
        return Counter(edge.verdict for edge in self.edges if edge.kind in loops)

    def with_edges(self, edges: Sequence[Edge]) -> PoseGraph:
        """The same nodes with other edges."""
        return replace(self, edges=edges)

    def with_poses(self, T_map_body: SE3) -> PoseGraph:
        """The same graph with other poses."""
        moved = replace(self, T_map_body=T_map_body)
        if "relations" in vars(self):  # of the same edges
            vars(moved)["relations"] = self.relations
        return moved
