"""Edges of 2-D graphs: plane motions as edges of the project's pose graph."""

from __future__ import annotations

import numpy as np

from recon4.geometry.se2 import between, to_se3
from recon4.geometry.se3 import Array
from recon4.model.pose_graph import Edge, EdgeKind, PoseGraph, accepted_unseen
from recon4.slam2d.keyframes import Keyframes
from recon4.slam2d.tuning_graph import EDGES_2D

_PLANE = np.array([2, 3, 4])
"""Rows of yaw, x and y in a tangent of SE(3), rotation first."""


def space_information(information: Array, *, sd_m: float, sd_rad: float) -> Array:
    """Information for yaw, x, y as that of a tangent of SE(3), (6, 6).

    Args:
        information: (3, 3), may be singular.
        sd_m: Smallest standard deviation of x and y [m].
        sd_rad: Smallest standard deviation of the yaw [rad].
    """
    covariance = np.linalg.inv(information + 1e-6 * np.eye(3))
    covariance = covariance + np.diag([sd_rad**2, sd_m**2, sd_m**2])
    out = np.eye(6) / EDGES_2D.fixed_sd**2
    plane = np.linalg.inv(covariance)
    out[np.ix_(_PLANE, _PLANE)] = (plane + plane.T) / 2.0
    return out


def plane_information(information: Array) -> Array:
    """The part for yaw, x, y of information matrices (..., 6, 6), (..., 3, 3)."""
    return np.asarray(information[..., _PLANE[:, None], _PLANE])


def in_source_axes(H: Array, yaw_rad: float) -> Array:
    """Information for yaw, x, y along the axes of the source, from that along the target's."""
    c, s = np.cos(yaw_rad), np.sin(yaw_rad)
    turn = np.array([[1.0, 0.0, 0.0], [0.0, c, -s], [0.0, s, c]])
    return np.asarray(turn.T @ H @ turn)


def odometry_graph(keyframes: Keyframes, *, sd_m: float, sd_rad: float) -> PoseGraph:
    """The graph of the keyframes with the edges between consecutive ones."""
    motions = to_se3(between(keyframes.pose[:-1], keyframes.pose[1:]))
    edges = tuple(
        Edge(
            i=k,
            j=k + 1,
            T_i_j=motions[k],
            kind=EdgeKind.ODOMETRY,
            judgments=accepted_unseen(),
            information=space_information(keyframes.information[k + 1], sd_m=sd_m, sd_rad=sd_rad),
        )
        for k in range(len(keyframes) - 1)
    )
    return PoseGraph(
        frame_ids=keyframes.rows.astype(np.int64),
        t_ns=keyframes.t_ns,
        T_map_body=to_se3(keyframes.pose),
        edges=edges,
    )
