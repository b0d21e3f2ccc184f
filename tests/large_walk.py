"""A walk of hours on the corridors of an office with several storeys: nodes, odometry, registrar.

Crossings lie on a grid, corridors between neighboring ones; stairs join the storeys at some of
them. The walk goes on from crossing to crossing at random, so it comes past each several times. No
points are measured: pairs are "registered" by the truth, with noise, and some of them falsely.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from tempfile import gettempdir

import numpy as np
from msgspec import structs
from scipy.spatial import cKDTree

from recon4.geometry.se3 import SE3, Array
from recon4.model.pose_graph import (
    Edge,
    Judge,
    Judgment,
    PoseGraph,
    Reason,
    Verdict,
    accepted_unseen,
)
from recon4.model.pose_graph import EdgeKind as Kind
from recon4.pose_graph.pair import Pair
from recon4.pose_graph.tuning import GraphTuning, RecognitionTuning
from recon4.progress import Progress

BLOCK_M, STOREY_M, STEP_M = 8.0, 3.5, 0.65
"""Corridor between two crossings, height of a storey, path from node to node [m]."""
STEP_SD = (2e-4, 2e-4, 4e-4, 2e-3, 2e-3, 1e-3)
"""Error of odometry from node to node: turn [rad], shift [m]."""
PAIR_SD = (6e-4, 6e-4, 6e-4, 4e-3, 4e-3, 4e-3)
"""Error of a registered pair."""
STATED_SD = (1e-3, 1e-3, 1e-3, 8e-3, 8e-3, 8e-3)
"""What a registered pair states."""
FALSE_PAIRS = 0.004
"""Fraction of the pairs that are registered with an error of up to a meter."""
BARE_NODES, BARE_EVERY = 15, 150
"""This number of nodes in a row, of this many, see too little to be registered."""
SIGHT_M, CONVERGES_M, CONVERGES_RAD = 7.0, 1.2, 0.3


@dataclass(frozen=True, slots=True)
class Building:
    """Size of the building."""

    crossings: int = 10
    """Along each side."""
    storeys: int = 4
    stairs: int = 3
    """Crossings of the diagonal from one staircase to the next."""


def true_poses(nodes: int, *, seed: int = 1, building: Building = Building()) -> SE3:
    """``T_map_body`` of the nodes: a random walk on the corridors, heading forward."""
    rng = np.random.default_rng(seed)
    corners = _corners(int(nodes * STEP_M / STOREY_M) + 2, rng, building)
    legs_m = np.linalg.norm(np.diff(corners, axis=0), axis=1)
    at_m = np.concatenate([[0.0], np.cumsum(legs_m)])
    path_m = STEP_M * np.arange(nodes)
    t_m = np.stack([np.interp(path_m, at_m, column) for column in corners.T], axis=1)
    ahead = np.stack([np.interp(path_m + 0.5, at_m, column) for column in corners.T], axis=1)
    heading = np.arctan2(*(ahead - t_m)[:, [1, 0]].T)
    return SE3.stack(SE3.from_rpy(0.0, 0.0, yaw, t=t) for yaw, t in zip(heading, t_m, strict=True))


def _corners(count: int, rng: np.random.Generator, building: Building) -> Array:
    """Crossings that the walk passes [m], (count, 3)."""
    at, last = np.zeros(3, np.int64), np.array([1, 0, 0])
    passed = [at]
    sides = np.array([[1, 0, 0], [-1, 0, 0], [0, 1, 0], [0, -1, 0]])
    for _ in range(count - 1):
        steps = [*sides]
        if at[0] == at[1] and at[0] % building.stairs == 0:
            # A flight leads up while it leads ahead, and its landing is the next crossing.
            steps += [np.array([1, 0, 1]), np.array([-1, 0, -1])]
        inside = [s for s in steps if _is_inside(at + s, building) and (s != -last).any()]
        weights = np.array([3.0 if (s == last).all() else 1.0 for s in inside])
        last = inside[rng.choice(len(inside), p=weights / weights.sum())]
        at = at + last
        passed.append(at)
    return np.array(passed) * [BLOCK_M, BLOCK_M, STOREY_M]


def _is_inside(at: Array, building: Building) -> bool:
    limits = np.array([building.crossings, building.crossings, building.storeys])
    return bool((at >= 0).all() and (at < limits).all())


def odometry_graph(truth: SE3, *, seed: int = 1) -> PoseGraph:
    """Nodes where odometry has them, joined by its edges; half a second from node to node."""
    rng, count = np.random.default_rng([seed, 1]), len(truth)
    steps = truth[:-1].inverse() @ truth[1:]
    steps = steps @ SE3.exp(rng.normal(size=(count - 1, 6)) * STEP_SD)
    T, poses = truth[0], [truth[0]]
    for k in range(count - 1):
        T = T @ steps[k]
        poses.append(T)
    information = np.diag(np.array(STEP_SD) ** -2.0)
    edges = tuple(
        Edge(i=k, j=k + 1, T_i_j=steps[k], kind=Kind.ODOMETRY, judgments=accepted_unseen(),
             information=information)
        for k in range(count - 1)
    )  # fmt: skip
    rows = np.arange(count, dtype=np.int64)
    return PoseGraph(5 * rows, 500_000_000 * rows, SE3.stack(poses), edges)


class TrueRegistrar:
    """Registers pairs by the truth, in place of `recon4.pose_graph.pairs.PairRegistrar`."""

    def __init__(self, truth: SE3, *, seed: int = 1) -> None:
        self._truth, self._rng = truth, np.random.default_rng([seed, 2])
        self.graph, self.recognition = GraphTuning(), RecognitionTuning()
        self.views = WallViews(truth, seed=seed)
        self.registered = 0

    def prepare(self, nodes: int, progress: Progress) -> None:
        """Nothing has to be prepared."""

    def most_overlapping(self, pairs: Sequence[Pair]) -> Pair:
        """The pair whose nodes are predicted to be nearest."""
        return min(pairs, key=lambda pair: float(np.linalg.norm(pair.T_i_j.t)))

    def register(self, pairs: Sequence[Pair], progress: Progress) -> list[Edge]:
        """Edges of the pairs, in their order."""
        self.registered += len(pairs)
        return [self._edge(pair) for pair in pairs]

    def _edge(self, pair: Pair) -> Edge:
        T_true = self._truth[pair.i].inverse() @ self._truth[pair.j]
        apart_m = self._truth.t[pair.j] - self._truth.t[pair.i]
        off = pair.T_i_j.inverse() @ T_true
        edge = Edge(i=pair.i, j=pair.j, T_i_j=pair.T_i_j, kind=pair.kind, error_m=0.2,
                    limit_m=0.1, judgments=(_rejected(Reason.OVERLAP),), overlap=0.1)  # fmt: skip
        across_m = np.sort(np.abs(apart_m))
        if across_m[2] > SIGHT_M or across_m[1] > 0.5:
            return edge
        if np.linalg.norm(off.t) > CONVERGES_M or off.angle() > CONVERGES_RAD:
            return structs.replace(edge, judgments=(_rejected(Reason.NOT_CONVERGED),))
        if pair.j % BARE_EVERY < BARE_NODES:
            return structs.replace(edge, judgments=(_rejected(Reason.FEW_MATCHES),))
        sd = np.array(PAIR_SD)
        if self._rng.random() < FALSE_PAIRS:
            sd = sd + np.array([0.0, 0.0, 0.02, 0.4, 0.4, 0.1])
        noise = SE3.exp(self._rng.normal(size=6) * sd)
        return structs.replace(
            edge, T_i_j=T_true @ noise, overlap=0.8, error_m=0.02, degeneracy=0.1,
            information=np.diag(np.array(STATED_SD) ** -2.0),
            judgments=(Judgment(Judge.SEARCH, Verdict.ACCEPTED),),
        )  # fmt: skip


def _rejected(reason: Reason) -> Judgment:
    return Judgment(Judge.SEARCH, Verdict.REJECTED, reason)


class WallViews:
    """Segments on the walls of the corridors around each node."""

    scratch = Path(gettempdir())

    def __init__(self, truth: SE3, *, seed: int) -> None:
        self._truth, self._rng = truth, np.random.default_rng([seed, 3])
        walls = np.concatenate([self._walls(axis) for axis in (0, 1)])
        # Doors and niches: a third of the wall is not there, so that crossings differ.
        cells = np.floor(walls / 1.2).astype(np.int64)
        drawn = (cells @ [73856093, 19349663, 83492791] & 0xFFFF) % 3 > 0
        self._walls_m = walls[drawn]
        self._near = cKDTree(self._walls_m)

    def _walls(self, axis: int) -> Array:
        """Points on both walls of all corridors along an axis, (N, 3)."""
        low, high = self._truth.t.min(axis=0), self._truth.t.max(axis=0) + 1e-6
        along = np.arange(low[axis] - 4.0, high[axis] + 4.0, 0.35)
        lines = np.arange(low[1 - axis], high[1 - axis] + BLOCK_M, BLOCK_M)
        sides = np.concatenate([lines - 1.2, lines + 1.2])
        storeys = np.arange(low[2], high[2] + STOREY_M, STOREY_M)
        grid = np.stack(np.meshgrid(along, sides, storeys, [-0.5, 0.0, 0.5], indexing="ij"), -1)
        flat = grid.reshape(-1, 4)
        points = np.empty((len(flat), 3))
        points[:, axis], points[:, 1 - axis] = flat[:, 0], flat[:, 1]
        points[:, 2] = flat[:, 2] + flat[:, 3]
        return points

    def ends(self, node: int) -> Array:
        """Both ends of the segments [m], (M, 2, 3)."""
        T_map_body = self._truth[node]
        rows = self._near.query_ball_point(T_map_body.t, SIGHT_M + 3.0)
        p_body = T_map_body.inverse() @ self._walls_m[rows]
        return np.stack([p_body, p_body + np.array([0.0, 0.0, 0.05])], axis=1)
