"""Pieces of a walk: the relative pose of two is not known until a loop closure joins them."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from recon4.geometry.se3 import SE3, Array
from recon4.model.pose_graph import Edge, EdgeKind, PoseGraph
from recon4.model.trajectory import Times
from recon4.pose_graph.tuning_solve import PIECES

Pieces = NDArray[np.int64]
"""Number of the piece of each node, (N,)."""


def weakened(edges: tuple[Edge, ...], pieces: Pieces, t_ns: Times) -> tuple[Edge, ...]:
    """Odometry edges; those between two pieces keep the graph connected but state nothing.

    Args:
        edges: Odometry edges.
        pieces: Piece of each node.
        t_ns: Time of each node [ns].
    """
    return tuple(
        edge if pieces[edge.i] == pieces[edge.j]
        else edge.evolve(information=_gap_information(int(t_ns[edge.j] - t_ns[edge.i]) * 1e-9))
        for edge in edges
    )  # fmt: skip


def _gap_information(gap_s: float) -> Array:
    far_m = PIECES.unknown_m + PIECES.walk_m_s * gap_s
    sd = np.array([PIECES.tilt_rad, PIECES.tilt_rad, np.pi, far_m, far_m, far_m])
    return np.diag(sd**-2.0)


def joined_pieces(graph: PoseGraph, pieces: Pieces) -> Pieces:
    """Pieces after those that an edge of the graph joins have become one, (N,).

    Every edge but odometry joins; the number of a joined piece is the smallest of its parts.
    """
    if not pieces.any():  # there is one
        return pieces
    label = np.arange(int(pieces.max(initial=0)) + 1)
    for edge in graph.edges:
        if edge.in_graph and edge.kind is not EdgeKind.ODOMETRY:
            a, b = label[pieces[edge.i]], label[pieces[edge.j]]
            label[label == max(a, b)] = min(a, b)
    return np.asarray(label[pieces], np.int64)


def placed(graph: PoseGraph, pieces: Pieces, recognized: list[Edge]) -> PoseGraph:
    """Move whole pieces to where recognized places put them, as a start for the optimization.

    Args:
        graph: Without the recognized edges.
        pieces: Joined pieces of its nodes.
        recognized: Edges; those in the graph between two pieces move the later one.
    """
    T_map_body, label = graph.T_map_body, pieces.copy()
    for edge in recognized:
        if not edge.in_graph or label[edge.i] == label[edge.j]:
            continue
        T_new_old = T_map_body[edge.i] @ edge.T_i_j @ T_map_body[edge.j].inverse()
        moved = label == label[edge.j]
        T_map_body = SE3(
            np.where(moved[:, None, None], T_new_old.R @ T_map_body.R, T_map_body.R),
            np.where(moved[:, None], T_new_old @ T_map_body.t, T_map_body.t),
        )
        label[moved] = label[edge.i]
    return graph.with_poses(T_map_body)
