"""Influence on the map: how far it moves if an edge is removed or added; orders the queue.

Linearized about the poses found. An edge has the residual ``r = log(T_ij^-1 T_i^-1 T_j)`` and the
information ``W``; ``J = [-Ad(T_j^-1 T_i), I]`` is its derivative by right twists of the poses of
``i`` and ``j``; ``S = J H^-1 J^T`` is the covariance of that relative pose
(``H`` = sum of ``J^T W J`` over the edges in it). Then, by the matrix inversion lemma,

    in the graph, removed:      d = (I - S W)^-1 S W r
    not in it, added:           d = -S (S + W^-1)^-1 r

is the change of the relative pose of the two. Its size, ``|v| + 5 m |omega|``, is the influence.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from recon4.geometry.se3 import ARM_M, Array
from recon4.model.pose_graph import PoseGraph, Relations
from recon4.pose_graph.inverses import inverted
from recon4.pose_graph.relations import adjoint
from recon4.review.tuning import INFLUENCE


def influence_m(graph: PoseGraph, asked: NDArray[np.bool_]) -> Array:
    """Influence of edges [m].

    Args:
        graph: Solved.
        asked: Mask of the edges to evaluate, (E,).

    Returns:
        (E,), NaN outside the mask.
    """
    of = graph.relations
    out = np.full(len(of), np.nan)
    rows = np.flatnonzero(asked)
    if len(rows) == 0:
        return out
    T_j_i = (graph.T_map_body[of.i].inverse() @ graph.T_map_body[of.j]).inverse()
    A = -adjoint(T_j_i)
    S = _relative_covariance(of, A, rows, nodes=len(graph))
    r = (of.T_i_j[rows].inverse() @ T_j_i[rows].inverse()).log()
    out[rows] = _size(_changes(S, of.information[rows], r, in_graph=of.in_graph[rows]))
    return out


def _changes(S: Array, W: Array, r: Array, *, in_graph: NDArray[np.bool_]) -> Array:
    """Change of the relative pose of each edge's ends, (M, 6)."""
    out = np.empty_like(r)
    eye = np.eye(6)
    gain = S @ W
    pull = gain @ r[..., None]
    used, free = in_graph, ~in_graph
    # 1 + 1e-6: an edge that is the only one of its node would divide by zero.
    out[used] = np.linalg.solve((1.0 + 1e-6) * eye - gain[used], pull[used])[..., 0]
    # S (S + W^-1)^-1 r = (S W + I)^-1 S W r: no inverse of W is needed.
    out[free] = -np.linalg.solve(gain[free] + eye, pull[free])[..., 0]
    return out


def _size(change: Array) -> Array:
    turn, shift = (np.linalg.norm(half, axis=1) for half in (change[:, :3], change[:, 3:]))
    size: Array = shift + ARM_M * turn
    return size


def _relative_covariance(of: Relations, A: Array, rows: NDArray[np.intp], *, nodes: int) -> Array:
    """``S`` of some edges, (M, 6, 6), from the entries of ``H^-1`` at their nodes."""
    inverse = inverted(_hessian(of, A, rows, nodes=nodes), axes=6)
    i, j = of.i[rows], of.j[rows]
    A = A[rows]
    cross = A @ inverse.blocks(i, j)
    both: Array = inverse.blocks(j, j) + cross + np.swapaxes(cross, 1, 2)
    return both + A @ inverse.blocks(i, i) @ np.swapaxes(A, 1, 2)


def _hessian(of: Relations, A: Array, asked: NDArray[np.intp], *, nodes: int) -> Any:
    """``H`` of the edges in the graph, the first node fixed, (6 N, 6 N).

    The sparse factor has entries only where ``H`` is not zero, so the blocks of all evaluated edges
    and of all nodes get at least the tiny weight `INFLUENCE.nothing`.
    """
    from scipy.sparse import csc_array

    used = np.flatnonzero(of.in_graph)
    i, j, W, A = of.i[used], of.j[used], of.information[used], A[used]
    left = np.swapaxes(A, 1, 2) @ W
    blocks = [(i, i, left @ A), (i, j, left), (j, i, W @ A), (j, j, W)]
    every = np.arange(nodes)
    a = np.concatenate([of.i[asked], of.j[asked], every])
    b = np.concatenate([of.j[asked], of.i[asked], every])
    blocks.append(
        (a, b, np.full((len(a), 6, 6), INFLUENCE.nothing * float(np.abs(W).max(initial=1.0))))
    )
    first = np.zeros(1, np.intp)
    blocks.append((first, first, INFLUENCE.gauge * np.eye(6)[None]))
    row, column = np.meshgrid(np.arange(6), np.arange(6), indexing="ij")
    at_row = np.concatenate([(6 * a[:, None, None] + row).ravel() for a, _, _ in blocks])
    at_column = np.concatenate([(6 * b[:, None, None] + column).ravel() for _, b, _ in blocks])
    values = np.concatenate([block.ravel() for _, _, block in blocks])
    return csc_array((values, (at_row, at_column)), shape=(6 * nodes, 6 * nodes))
