"""Validity checks of a graph before it is optimized.

For a graph with a NaN, or one that is not connected, gtsam returns the initial poses and no error.
"""

from __future__ import annotations

import numpy as np

from recon4.errors import GraphError
from recon4.geometry.se3 import SE3, Array
from recon4.locales.coded import CodedText
from recon4.model.pose_graph import Flags, Relations
from recon4.pose_graph.tuning_solve import GRAPH_CHECKS


def check_relations(T_map_body: SE3, of: Relations) -> list[tuple[int, int]]:
    """Check that a graph can be solved.

    Returns:
        Pairs of nodes joined by more than one edge of the graph: allowed, but reported.

    Raises:
        GraphError: Names the node or the edge and its defect.
    """
    if len(T_map_body) == 0:
        raise GraphError(CodedText("graph-no-node"))
    bad_nodes = ~_is_motion(T_map_body)
    if bad_nodes.any():
        raise GraphError(CodedText("graph-pose", node=int(np.argmax(bad_nodes))))
    _check_ends(of, nodes=len(T_map_body))
    _refuse(of, ~_is_motion(of.T_i_j), "its transformation is not a finite rigid motion")
    finite = np.isfinite(of.information.reshape(len(of), 36).sum(1))
    _refuse(of, ~finite, "its information is not finite")
    _refuse(of, ~_is_positive(of), "its information is not symmetric positive definite")
    _check_connected(of, nodes=len(T_map_body))
    return _duplicates(of)


def _is_motion(T_a_b: SE3) -> Flags:
    R = T_a_b.R
    defect = np.abs(R @ np.swapaxes(R, -1, -2) - np.eye(3)).max((-1, -2), initial=0.0)
    proper = np.linalg.det(np.nan_to_num(R)) > 0.0
    return np.isfinite(T_a_b.t).all(-1) & (defect < GRAPH_CHECKS.rotation_tolerance) & proper


def _is_positive(of: Relations) -> Flags:
    used: Array = np.where(of.in_graph[:, None, None], of.information, np.eye(6))
    size = np.abs(used).max((1, 2), initial=0.0)
    symmetric = np.abs(used - np.swapaxes(used, 1, 2)).max((1, 2), initial=0.0) <= 1e-9 * size
    try:
        np.linalg.cholesky(used)
    except np.linalg.LinAlgError:
        return symmetric & (np.linalg.eigvalsh(used)[:, 0] > 0.0)
    return symmetric


def _check_ends(of: Relations, *, nodes: int) -> None:
    outside = (np.minimum(of.i, of.j) < 0) | (np.maximum(of.i, of.j) >= nodes)
    if outside.any():
        row = int(np.argmax(outside))
        raise GraphError(
            CodedText(
                "graph-edge-nodes", row=row, i=str(of.i[row]), j=str(of.j[row]), nodes=nodes - 1
            )
        )
    _refuse(of, of.i == of.j, "it joins a node with itself")


def _refuse(of: Relations, bad: Flags, what: str) -> None:
    bad = bad & of.in_graph
    if bad.any():
        row = int(np.argmax(bad))
        raise GraphError(
            CodedText("graph-edge", row=row, i=str(of.i[row]), j=str(of.j[row]), what=what)
        )


def _check_connected(of: Relations, *, nodes: int) -> None:
    from scipy.sparse import coo_array  # slow to import, and the server checks no graph
    from scipy.sparse.csgraph import connected_components

    i, j = of.i[of.in_graph], of.j[of.in_graph]
    links = coo_array((np.ones(len(i), dtype=np.int8), (i, j)), shape=(nodes, nodes))
    parts, label = connected_components(links, directed=False)
    if parts > 1:
        cut_off = np.flatnonzero(label != label[0])
        raise GraphError(
            CodedText(
                "graph-not-connected", count=len(cut_off), nodes=nodes, cut_off=str(cut_off[0])
            )
        )


def _duplicates(of: Relations) -> list[tuple[int, int]]:
    ends = np.sort(np.stack([of.i, of.j], 1)[of.in_graph], axis=1)
    pairs, count = np.unique(ends, axis=0, return_counts=True)
    return [(int(i), int(j)) for i, j in pairs[count > 1]]
