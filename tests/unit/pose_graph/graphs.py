"""Pose graphs of simple shapes."""

import numpy as np

from recon4.geometry.se3 import SE3
from recon4.model.pose_graph import PoseGraph


def graph_at(t_m, edges=()):
    t_m = np.asarray(t_m, dtype=np.float64)
    rows = np.arange(len(t_m), dtype=np.int64)
    R = np.broadcast_to(np.eye(3), (len(t_m), 3, 3)).copy()
    return PoseGraph(rows, rows * 500_000_000, SE3(R, t_m), tuple(edges))


def line(nodes, step_m=0.5):
    t_m = np.zeros((nodes, 3))
    t_m[:, 0] = step_m * np.arange(nodes)
    return graph_at(t_m)


def laps(count, nodes=40, radius_m=10.0):
    """Round after round on a circle."""
    turn = 2 * np.pi * np.arange(count * nodes) / nodes
    return graph_at(radius_m * np.stack([np.cos(turn), np.sin(turn), 0 * turn], axis=1))


def ends(pairs):
    return [(pair.i, pair.j) for pair in pairs]
