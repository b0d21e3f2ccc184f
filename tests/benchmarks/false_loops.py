"""False loops injected into pose graphs: how many are found, how many good edges are lost.

Run ``python -m tests.benchmarks.false_loops`` from the project's root for the table.
"""

from __future__ import annotations

import os
import time
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from recon4.geometry.se3 import SE3
from recon4.model.pose_graph import Edge, EdgeKind, PoseGraph, Verdict, known_history
from recon4.pose_graph.verification import verify
from recon4.settings import VerificationSettings
from tests.g2o_reader import read_g2o

SD = np.array([0.002, 0.002, 0.002, 0.01, 0.01, 0.01])
"""Stated standard deviations of the edges: rotation [rad], translation [m]."""


def office_graph(
    rng: np.random.Generator, *, nodes: int = 360, noise: float = 1.0
) -> tuple[PoseGraph, SE3]:
    """A walk through offices that comes by many places again, and its true poses.

    Edges as the progressive search makes them: odometry, four neighbors, up to six revisits, with
    ``noise`` times the standard deviations they promise. The graph's poses are integrated odometry.
    """
    T_map_body = _walk(nodes)
    pairs = [(k, k + 1) for k in range(nodes - 1)]
    pairs += [(k, k + d) for d in (2, 3, 5, 8) for k in range(nodes - d)]
    pairs += _revisits(rng, T_map_body)
    edges = tuple(_edge(T_map_body, i, j, noise * SD * rng.normal(size=6)) for i, j in pairs)
    chain = [SE3.identity()]
    for edge in edges[: nodes - 1]:
        chain.append(chain[-1] @ edge.T_i_j)
    t_ns = np.arange(nodes, dtype=np.int64) * 500_000_000
    start = T_map_body[0] @ SE3.stack(chain)
    return PoseGraph(np.arange(nodes) * 5, t_ns, start, edges), T_map_body


def _walk(nodes: int) -> SE3:
    """Rounds through a floor of 24 m x 10 m, shifted a little from round to round."""
    s = np.linspace(0.0, 2.0 * np.pi * nodes / 110.0, nodes)
    x, y = 12.0 * np.sin(s) + 0.3 * np.sin(0.2 * s), 5.0 * np.sin(2.0 * s + 0.1)
    z = 0.04 * np.sin(7.0 * s)
    yaw = np.unwrap(np.arctan2(np.gradient(y), np.gradient(x)))
    return SE3.stack(
        SE3.from_rpy(0.03 * np.sin(3 * a), 0.05 * np.cos(2 * a), b, t=[c, d, e])
        for a, b, c, d, e in zip(s, yaw, x, y, z, strict=True)
    )


def _revisits(rng: np.random.Generator, T_map_body: SE3) -> list[tuple[int, int]]:
    pairs = []
    for j in range(len(T_map_body)):
        distance = np.linalg.norm(T_map_body.t[: max(j - 20, 0)] - T_map_body.t[j], axis=1)
        near = np.flatnonzero(distance < 3.0)
        pairs += [(int(i), j) for i in rng.permutation(near)[:6]]
    return pairs


def _edge(T_map_body: SE3, i: int, j: int, xi: np.ndarray) -> Edge:
    T_i_j = T_map_body[i].inverse() @ T_map_body[j] @ SE3.exp(xi)
    kind = EdgeKind.ODOMETRY if j == i + 1 else EdgeKind.NEIGHBOR if j - i < 20 else EdgeKind.LOOP
    return Edge(
        i=i,
        j=j,
        T_i_j=T_i_j,
        kind=kind,
        information=np.diag(1.0 / SD**2),
        judgments=known_history(Verdict.ACCEPTED),
    )


def inject_random(graph: PoseGraph, rng: np.random.Generator, count: int = 20) -> PoseGraph:
    """Loops between any two nodes that claim they see the same place."""
    models, false = _loops(graph), []
    for k in range(count):
        i, j = sorted(rng.choice(len(graph), 2, replace=False).tolist())
        T_i_j = SE3.from_rpy(
            0.0, 0.0, rng.uniform(-np.pi, np.pi), t=rng.normal(size=3) * [1, 1, 0.1]
        )
        j = max(j, i + 2) if i + 2 < len(graph) else j
        false.append(_false(models[k % len(models)], i, j, T_i_j))
    return graph.with_edges((*graph.edges, *false))


def inject_shifted(graph: PoseGraph, rng: np.random.Generator, count: int = 20) -> PoseGraph:
    """True loops registered 0.3 to 1.5 m wrong, as along a corridor or a row of equal tables."""
    loops, false = _loops(graph), []
    for row in rng.choice(len(loops), count, replace=len(loops) < count):
        angle, length = rng.uniform(0, 2 * np.pi), rng.uniform(0.3, 1.5)
        shift = [0, 0, 0, length * np.cos(angle), length * np.sin(angle), 0.0]
        true = loops[row]
        false.append(_false(true, true.i, true.j, true.T_i_j @ SE3.exp(shift)))
    return graph.with_edges((*graph.edges, *false))


def inject_clusters(
    graph: PoseGraph, rng: np.random.Generator, count: int = 20, size: int = 5
) -> PoseGraph:
    """Groups of ``size`` loops that agree with each other: two places that look the same."""
    models, false = _loops(graph), []
    for group in range(count // size):
        a, b = sorted(rng.choice(len(graph) - size, 2, replace=False).tolist())
        b = min(max(b, a + 30), len(graph) - size)
        T_start = SE3.from_rpy(0.0, 0.0, rng.uniform(-np.pi, np.pi), t=rng.normal(size=3))
        for k in range(size):
            T_a_i = graph.T_map_body[a].inverse() @ graph.T_map_body[a + k]
            T_b_j = graph.T_map_body[b].inverse() @ graph.T_map_body[b + k]
            noisy = T_a_i.inverse() @ T_start @ T_b_j @ SE3.exp(SD * rng.normal(size=6))
            model = models[(group * size + k) % len(models)]
            false.append(_false(model, a + k, b + k, noisy))
    return graph.with_edges((*graph.edges, *false))


def _loops(graph: PoseGraph) -> list[Edge]:
    """Those that were registered and accepted; a false loop promises as much as one of them."""
    return [edge for edge in graph.edges if edge.kind is EdgeKind.LOOP and edge.in_graph]


def _false(model: Edge, i: int, j: int, T_i_j: SE3) -> Edge:
    return Edge(
        i=i,
        j=j,
        T_i_j=T_i_j,
        kind=EdgeKind.LOOP,
        information=model.information,
        judgments=known_history(Verdict.ACCEPTED),
    )


@dataclass(frozen=True, slots=True)
class Score:
    """Verdicts of the injected edges, and of the correct edges that are not odometry."""

    false_rejected: int
    false_total: int
    good_lost: int
    good_total: int
    seconds: float
    largest_error_m: float
    """Of a node, against the true poses (NaN if there are none)."""


def score(
    graph: PoseGraph,
    false: int,
    *,
    settings: VerificationSettings | None = None,
    truth: SE3 | None = None,
) -> Score:
    """Verify a graph whose last ``false`` edges are wrong."""
    begun = time.perf_counter()
    verified = verify(graph, settings=settings or VerificationSettings()).graph
    seconds = time.perf_counter() - begun
    lost = [not edge.in_graph for edge in verified.edges]
    free = [edge.kind is not EdgeKind.ODOMETRY for edge in graph.edges[:-false]]
    error = np.nan
    if truth is not None:
        error = float(np.linalg.norm(verified.T_map_body.t - truth.t, axis=1).max())
    return Score(sum(lost[-false:]), false, sum(lost[:-false]), sum(free), seconds, error)


ATTACKS: dict[str, Callable[[PoseGraph, np.random.Generator], PoseGraph]] = {
    "random": inject_random,
    "shifted": inject_shifted,
    "clusters": inject_clusters,
}


def main() -> None:
    root = Path(__file__).parents[2]
    data = Path(os.environ.get("RECON4_DATA", root.parent / "shared" / "data")) / "posegraphs"
    settings = {
        "paths only": VerificationSettings(robust="none"),
        "paths + cauchy": VerificationSettings(robust="cauchy"),
        "paths + gnc": VerificationSettings(robust="gnc"),
    }
    print("graph, attack, method: false rejected, good lost, worst node [m], seconds")
    for seed in range(3):
        for noise in (1.0, 2.0):
            clean, truth = office_graph(np.random.default_rng(seed), noise=noise)
            for attack, inject in ATTACKS.items():
                graph = inject(clean, np.random.default_rng(100 + seed))
                for method, chosen in settings.items():
                    _row(
                        f"office seed {seed} noise {noise}, {attack}, {method}",
                        score(graph, 20, settings=chosen, truth=truth),
                    )
    ring = read_g2o(data / "vertigo-ring" / "originalDataset" / "ring.g2o")
    truth = read_g2o(data / "vertigo-ring" / "groundTruth" / "ring.g2o").T_map_body
    for seed in range(3):
        for attack in ("random", "clusters"):
            graph = ATTACKS[attack](ring, np.random.default_rng(seed))
            for method, chosen in settings.items():
                _row(
                    f"ring seed {seed}, {attack}, {method}",
                    score(graph, 20, settings=chosen, truth=truth),
                )


def _row(name: str, got: Score) -> None:
    print(
        f"{name}: {got.false_rejected}/{got.false_total}, {got.good_lost}/{got.good_total}, "
        f"{got.largest_error_m:.3f}, {got.seconds:.2f}",
        flush=True,
    )


if __name__ == "__main__":
    main()
