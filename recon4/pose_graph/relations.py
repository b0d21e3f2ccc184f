"""Residuals of edges at given poses, covariances in axes of the map, reversal of edges."""

from __future__ import annotations

import numpy as np

from recon4.geometry.se3 import ROTATION, SE3, TRANSLATION, Array, pose_blocks, skew
from recon4.model.edge_columns import EdgeColumns
from recon4.model.pose_graph import EdgeKind, PoseGraph, Relations, Rows


def squared_residuals(T_map_body: SE3, of: Relations) -> Array:
    """Squared Mahalanobis length of ``log(T_i_j^-1 T_map_i^-1 T_map_j)`` of each edge, (E,)."""
    chi2 = np.empty(len(of))
    for rows in pose_blocks(len(of)):
        predicted = T_map_body[of.i[rows]].inverse() @ T_map_body[of.j[rows]]
        xi = (of.T_i_j[rows].inverse() @ predicted).log()
        chi2[rows] = np.einsum("ea,eab,eb->e", xi, of.information[rows], xi)
    return chi2


def with_residuals(graph: PoseGraph) -> PoseGraph:
    """The graph with ``chi2`` of every edge at its current poses, also of those not used."""
    chi2 = squared_residuals(graph.T_map_body, graph.relations)
    return graph.with_edges(EdgeColumns.of(graph.edges).with_columns(chi2=chi2))


def adjoint(T_a_b: SE3) -> Array:
    """Adjoint matrices that map twists of ``b`` to ``a``, rotation first, (..., 6, 6)."""
    out = np.zeros((*T_a_b.t.shape[:-1], 6, 6))
    out[..., ROTATION, ROTATION] = out[..., TRANSLATION, TRANSLATION] = T_a_b.R
    out[..., TRANSLATION, ROTATION] = skew(T_a_b.t) @ T_a_b.R
    return out


def in_map_axes(T_map_body: SE3, cov: Array) -> Array:
    """Covariances, or information, of tangents at some nodes with the axes of the map, (E, 6, 6).

    Args:
        T_map_body: Poses of the nodes, a batch of E.
        cov: In the axes of each, (E, 6, 6).
    """
    A = np.zeros((len(T_map_body), 6, 6))
    A[:, ROTATION, ROTATION] = A[:, TRANSLATION, TRANSLATION] = T_map_body.R
    turned: Array = A @ cov @ np.swapaxes(A, 1, 2)
    return turned


def odometry_steps(graph: PoseGraph) -> Rows:
    """Rows of the odometry edges from each node to the next."""
    of = graph.relations
    is_walk = EdgeColumns.of(graph.edges).are(EdgeKind.ODOMETRY)
    return np.flatnonzero(is_walk & (of.j == of.i + 1))


def reverse(T_i_j: SE3, information: Array) -> tuple[SE3, Array]:
    """Reverse a relation: ``T_j_i`` and its information.

    The squared residual stays exactly the same: the two tangents differ by ``-Ad(T_i_j)``.
    """
    back = adjoint(T_i_j.inverse())
    turned = np.swapaxes(back, -1, -2) @ information @ back
    return T_i_j.inverse(), (turned + np.swapaxes(turned, -1, -2)) / 2.0
