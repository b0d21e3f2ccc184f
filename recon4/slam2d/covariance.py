"""Covariance of every node of a solved 2-D graph, relative to the first node."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from scipy.sparse import csc_array

from recon4.geometry.se2 import between, from_se3
from recon4.geometry.se3 import Array
from recon4.model.pose_graph import PoseGraph, Rows
from recon4.pose_graph.inverses import inverted
from recon4.slam2d.edges import plane_information
from recon4.slam2d.tuning_graph import COVARIANCE_2D


def node_covariances(graph: PoseGraph) -> Array:
    """Marginal covariances for yaw, x, y in the axes of each node, (K, 3, 3).

    The sparse inverse is computed only at the nonzero entries of the factor (Takahashi 1973).
    """
    nodes, of = len(graph), graph.relations
    used = np.flatnonzero(of.in_graph)
    i, j = of.i[used], of.j[used]
    W = plane_information(of.information[used])
    pose = from_se3(graph.T_map_body)
    A = -_adjoint(between(pose[j], pose[i]))
    left = np.swapaxes(A, 1, 2) @ W
    every, first = np.arange(nodes), np.zeros(1, np.intp)
    blocks = [
        (i, i, left @ A),
        (i, j, left),
        (j, i, W @ A),
        (j, j, W),
        (
            every,
            every,
            np.full((nodes, 3, 3), COVARIANCE_2D.nothing * float(np.abs(W).max(initial=1.0))),
        ),
        (first, first, COVARIANCE_2D.gauge * np.eye(3)[None]),
    ]
    return inverted(_assembled(blocks, nodes), axes=3).blocks(every, every)


def _assembled(blocks: Sequence[tuple[Rows, Rows, Array]], nodes: int) -> csc_array:
    row, column = np.meshgrid(np.arange(3), np.arange(3), indexing="ij")
    at_row = np.concatenate([(3 * a[:, None, None] + row).ravel() for a, _, _ in blocks])
    at_column = np.concatenate([(3 * b[:, None, None] + column).ravel() for _, b, _ in blocks])
    values = np.concatenate([np.asarray(block).ravel() for _, _, block in blocks])
    return csc_array((values, (at_row, at_column)), shape=(3 * nodes, 3 * nodes))


def _adjoint(T_a_b: Array) -> Array:
    """Adjoint matrices for yaw, x, y that map twists of ``b`` to ``a``, (..., 3, 3)."""
    c, s = np.cos(T_a_b[..., 2]), np.sin(T_a_b[..., 2])
    out = np.zeros((*T_a_b.shape[:-1], 3, 3))
    out[..., 0, 0] = 1.0
    out[..., 1, 0], out[..., 2, 0] = T_a_b[..., 1], -T_a_b[..., 0]
    out[..., 1, 1], out[..., 1, 2] = c, -s
    out[..., 2, 1], out[..., 2, 2] = s, c
    return out
