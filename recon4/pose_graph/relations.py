"""The edges of a graph as arrays, and what they say about poses."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from recon4.geometry.se3 import SE3, Array, skew
from recon4.model.pose_graph import Edge, EdgeKind, PoseGraph

Rows = NDArray[np.intp]
Flags = NDArray[np.bool_]


@dataclass(frozen=True, slots=True, eq=False)
class Relations:
    """One row an edge, in the order of ``PoseGraph.edges``."""

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
    """Never turned down: odometry holds the graph together; what a person decided stays, (E,)."""

    def __len__(self) -> int:
        return len(self.i)


def relations(edges: Sequence[Edge]) -> Relations:
    """The edges as arrays."""
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


def squared_residuals(T_map_body: SE3, of: Relations) -> Array:
    """Squared Mahalanobis length of ``log(T_i_j^-1 T_map_i^-1 T_map_j)`` of each edge, (E,)."""
    predicted = T_map_body[of.i].inverse() @ T_map_body[of.j]
    xi = (of.T_i_j.inverse() @ predicted).log()
    return np.einsum("ea,eab,eb->e", xi, of.information, xi)


def with_residuals(graph: PoseGraph) -> PoseGraph:
    """The graph with ``chi2`` of every edge at the poses it has now, also of those not used."""
    chi2 = squared_residuals(graph.T_map_body, relations(graph.edges)).tolist()
    edges = (edge.evolve(chi2=value) for edge, value in zip(graph.edges, chi2, strict=True))
    return graph.with_edges(tuple(edges))


def adjoint(T_a_b: SE3) -> Array:
    """Matrices that carry twists of ``b`` over to ``a``, rotation first, (..., 6, 6)."""
    out = np.zeros((*T_a_b.t.shape[:-1], 6, 6))
    out[..., :3, :3] = out[..., 3:, 3:] = T_a_b.R
    out[..., 3:, :3] = skew(T_a_b.t) @ T_a_b.R
    return out


def reverse(T_i_j: SE3, information: Array) -> tuple[SE3, Array]:
    """The same relation seen from the other end: ``T_j_i`` and its information.

    The squared residual stays exactly the same: the two tangents differ by ``-Ad(T_i_j)``.
    """
    back = adjoint(T_i_j.inverse())
    turned = np.swapaxes(back, -1, -2) @ information @ back
    return T_i_j.inverse(), (turned + np.swapaxes(turned, -1, -2)) / 2.0
