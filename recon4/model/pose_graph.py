"""Pose graph: nodes with poses, and all edges between them, accepted or not."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from enum import StrEnum
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from recon4.geometry.se3 import SE3, Array
from recon4.model.trajectory import Times

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


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Edge:
    """A measured relative pose of two nodes."""

    i: int
    """Row of the first node."""
    j: int
    """Row of the second node; ``i < j``."""
    T_i_j: SE3
    """Maps points of the body at node ``j`` into the body frame at node ``i`` (A0 no. 3)."""
    kind: EdgeKind
    verdict: Verdict
    reason: Reason = Reason.NONE
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
    decided_by: str = "auto"
    """``auto`` or the name of the person."""

    def evolve(self, **changes: Any) -> Edge:
        """The edge with some fields changed."""
        return replace(self, **changes)

    @property
    def in_graph(self) -> bool:
        """Whether the optimizer uses it."""
        return self.verdict is not Verdict.REJECTED


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


def relations_of(edges: Sequence[Edge]) -> Relations:
    """Convert edges to arrays; for a graph use `PoseGraph.relations`."""
    return Relations(
        i=np.array([edge.i for edge in edges], dtype=np.intp),
        j=np.array([edge.j for edge in edges], dtype=np.intp),
        T_i_j=SE3.stack(edge.T_i_j for edge in edges),
        information=np.array([edge.information for edge in edges]).reshape(-1, 6, 6),
        in_graph=np.array([edge.in_graph for edge in edges], dtype=np.bool_),
        protected=np.array([_is_protected(edge) for edge in edges], dtype=np.bool_),
    )


def _is_protected(edge: Edge) -> bool:
    return edge.kind is EdgeKind.ODOMETRY or edge.decided_by != "auto"


@dataclass(frozen=True, eq=False)
class PoseGraph:
    """Nodes with their poses, and all edges with any verdict."""

    frame_ids: Times
    """Multiframe of each node, (N,)."""
    t_ns: Times
    """Time of each node [ns], (N,)."""
    T_map_body: SE3
    """Pose of each node, a batch of N."""
    edges: tuple[Edge, ...]

    def __len__(self) -> int:
        return len(self.frame_ids)

    @cached_property
    def relations(self) -> Relations:
        """The edges as arrays, created on first access."""
        return relations_of(self.edges)

    def verdict_counts(self) -> dict[str, int]:
        """Number of edges with each verdict."""
        return {str(v): sum(edge.verdict is v for edge in self.edges) for v in Verdict}

    def loop_verdicts(self) -> Counter[Verdict]:
        """Number of loop closures, manual ones included, with each verdict."""
        loops = (EdgeKind.LOOP, EdgeKind.MANUAL)
        return Counter(edge.verdict for edge in self.edges if edge.kind in loops)

    def with_edges(self, edges: tuple[Edge, ...]) -> PoseGraph:
        """The same nodes with other edges."""
        return replace(self, edges=edges)

    def with_poses(self, T_map_body: SE3) -> PoseGraph:
        """The same graph with other poses."""
        return replace(self, T_map_body=T_map_body)
