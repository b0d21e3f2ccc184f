"""Pose graphs whose truth is known: two rounds of a walk, with loops between the rounds."""

import numpy as np

from recon4.geometry.se3 import SE3, so3_exp
from recon4.model.pose_graph import Edge, EdgeKind, PoseGraph, Verdict, known_history

STEP_NS = 500_000_000
ODOMETRY = np.diag(1.0 / np.repeat([0.002, 0.01], 3) ** 2)
LOOP = np.diag(1.0 / np.repeat([0.002, 0.01], 3) ** 2)


def truth(nodes=60):
    """Two rounds on an ellipse, looking ahead."""
    s = np.linspace(0.0, 4.0 * np.pi, nodes)
    t = np.stack([6.0 * np.cos(s), 4.0 * np.sin(s), 0.0 * s], axis=1)
    zero = np.zeros_like(s)
    return SE3(so3_exp(np.stack([zero, zero, s + np.pi / 2], axis=1)), t)


def edge(T, i, j, kind, *, noise=0.0, rng=None, off_m=(0.0, 0.0, 0.0)):
    """A relation that tells the truth, but for noise and what it is off by."""
    rng = rng or np.random.default_rng(0)
    xi = np.concatenate([0.2 * noise * rng.standard_normal(3), noise * rng.standard_normal(3)])
    T_i_j = T[i].inverse() @ T[j] @ SE3.exp(xi)
    T_i_j = SE3(T_i_j.R, T_i_j.t + np.asarray(off_m))
    information = ODOMETRY if kind is EdgeKind.ODOMETRY else LOOP
    return Edge(
        i=i,
        j=j,
        T_i_j=T_i_j,
        kind=kind,
        information=information,
        overlap=0.8,
        error_m=0.01,
        limit_m=0.05,
        degeneracy=0.1,
        judgments=known_history(Verdict.ACCEPTED),
    )


def two_rounds(nodes=60, *, noise=0.002, loops=True, wrong=()):
    """Odometry and, if wanted, loops from each node to the round before.

    ``wrong`` are loops (i, j, off_m) that are off.
    """
    rng = np.random.default_rng(1)
    T = truth(nodes)
    edges = [edge(T, k, k + 1, EdgeKind.ODOMETRY, noise=noise, rng=rng) for k in range(nodes - 1)]
    half = (nodes - 1) // 2
    spoiled = {(i, j) for i, j, _ in wrong}
    if loops:
        pairs = [(i, i + half + more) for i in range(half + 1) for more in (0, 1)]
        pairs = [(i, j) for i, j in pairs if j < nodes and (i, j) not in spoiled]
        edges += [edge(T, i, j, EdgeKind.LOOP, noise=noise, rng=rng) for i, j in pairs]
    edges += [edge(T, i, j, EdgeKind.LOOP, off_m=off_m) for i, j, off_m in wrong]
    frames = np.arange(nodes, dtype=np.int64) * 5 + 2
    t_ns = 1_700_000_000_000_000_000 + np.arange(nodes, dtype=np.int64) * STEP_NS
    return PoseGraph(frames, t_ns, T, tuple(edges))
