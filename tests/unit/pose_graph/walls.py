"""Walls around a place, and straight walks past them."""

import numpy as np

from recon4.geometry.se3 import SE3
from recon4.model.pose_graph import Edge, EdgeKind, PoseGraph, Reason, Verdict, known_history
from recon4.pose_graph.density_images import layers_of, make_density_image

TWO_CUBES = np.array([[0.0, 0.0], [0.0, 4.0], [6.0, 4.0], [6.0, -1.0]])


def walls_of(corners, count=2000):
    """Points along the lines between corners, with noise of 2 cm."""
    rng = np.random.default_rng(4)
    k = rng.integers(0, len(corners) - 1, count)
    part = rng.random(count)[:, None]
    return corners[k] * (1 - part) + corners[k + 1] * part + rng.normal(0, 0.02, (count, 2))


def turned(p, yaw_rad, shift_m):
    c, s = np.cos(yaw_rad), np.sin(yaw_rad)
    return p @ np.array([[c, s], [-s, c]]) + shift_m


def image(walls_m):
    return make_density_image(walls_m, layers_of(np.array([-1.2, 1.4])))


def edge(i, j, *, sd_m=0.1, T_i_j=None, kind=EdgeKind.ODOMETRY, reason=Reason.NONE):
    return Edge(
        i=i,
        j=j,
        T_i_j=SE3(np.eye(3), np.array([float(j - i), 0.0, 0.0])) if T_i_j is None else T_i_j,
        kind=kind,
        information=np.diag([1e8, 1e8, 1e8, *[sd_m**-2.0] * 3]),
        judgments=known_history(Verdict.REJECTED if reason else Verdict.ACCEPTED, reason),
    )


def straight(nodes, *more):
    """A walk along x with a node every meter."""
    t = np.zeros((nodes, 3))
    t[:, 0] = np.arange(nodes)
    T = SE3(np.broadcast_to(np.eye(3), (nodes, 3, 3)).copy(), t)
    chain = tuple(edge(k, k + 1) for k in range(nodes - 1))
    return PoseGraph(np.arange(nodes), np.arange(nodes) * 10**9, T, (*chain, *more))
