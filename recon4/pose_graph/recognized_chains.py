"""Recognized places are followed along the path: how far does their correction fit?"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from recon4.geometry.se3 import SE3
from recon4.model.edge_columns import EdgeColumns
from recon4.model.pose_graph import (
    Edge,
    EdgeKind,
    Judge,
    Judgment,
    PoseGraph,
    Reason,
    Rows,
    Verdict,
)
from recon4.pose_graph.pair import Pair
from recon4.pose_graph.pairs import PairRegistrar
from recon4.pose_graph.places import Places
from recon4.pose_graph.recognized_groups import RecognizedChain, contradicts
from recon4.pose_graph.tuning_places import DENSITY, FOLLOW
from recon4.progress import Progress


@dataclass(frozen=True, slots=True, eq=False)
class _ChainEnd:
    """Where a chain is followed on."""

    chain: RecognizedChain
    edge: Edge
    """Its last edge in this direction."""
    direction: int
    """1: along the walk, -1: back."""
    stuck: int = 0
    """Number of nodes in a row that contradict it."""


class ChainFollower:
    """Registers further nodes before and after recognized places.

    A true revisit ends where the two paths part. A place that only looks alike ends where the views
    contradict each other.
    """

    def __init__(self, places: Places, registrar: PairRegistrar, progress: Progress) -> None:
        self._places, self._registrar, self._progress = places, registrar, progress
        self._sd = registrar.recognition.bound_sd
        self._taken = taken_pairs(places.graph)

    def follow(self, chains: Sequence[RecognizedChain]) -> None:
        """Add edges to the chains, both ways, as long as the views fit."""
        self._taken |= {(edge.i, edge.j) for chain in chains for edge in chain.edges}
        ends = [
            _ChainEnd(chain, chain.edges[0], direction)
            for chain in chains
            if chain.edges[0].in_graph
            for direction in (-1, 1)
        ]
        for _ in range(FOLLOW.max_steps):
            ends = self._step(ends)
            if not ends:
                return

    def _step(self, ends: Sequence[_ChainEnd]) -> list[_ChainEnd]:
        """Follow every chain by a step; those that go on are returned."""
        pairs, kept, choices = [], [], []
        for end in ends:
            choice = self._next_pairs(end)
            pair = self._registrar.most_overlapping(choice) if choice else None
            if pair is not None and (pair.i, pair.j) not in self._taken:
                self._taken.add((pair.i, pair.j))
                pairs.append(pair)
                kept.append(end)
                choices.append(choice)
        edges = self._register(pairs)
        others = self._other_pairs(edges, choices)
        for row, edge in zip(others, self._register([*others.values()]), strict=True):
            kept[row].chain.edges.append(edges[row] if edge.in_graph else edge)
            if edge.in_graph:
                pairs[row], edges[row] = others[row], edge
        further = []
        for pair, end, edge in zip(pairs, kept, edges, strict=True):
            end.chain.edges.append(edge)
            stuck = end.stuck + 1 if contradicts(edge) else 0
            if stuck <= FOLLOW.max_stuck:
                # Without a fit the correction is carried on from its prediction.
                last = edge if edge.in_graph else edge.evolve(T_i_j=pair.T_i_j)
                further.append(_ChainEnd(end.chain, last, end.direction, stuck))
        return further

    def _other_pairs(
        self, edges: Sequence[Edge], choices: Sequence[Sequence[Pair]]
    ) -> dict[int, Pair]:
        """By row, for edges that contradict the correction, another earlier node that may fit."""
        others = {}
        for row, (edge, choice) in enumerate(zip(edges, choices, strict=True)):
            if not contradicts(edge):
                continue
            if free := [pair for pair in choice if (pair.i, pair.j) not in self._taken]:
                others[row] = self._registrar.most_overlapping(free)
                self._taken.add((others[row].i, others[row].j))
        return others

    def _register(self, pairs: Sequence[Pair]) -> list[Edge]:
        edges = register_recognized(pairs, self._registrar, self._progress)
        return [self._checked(pair, edge) for pair, edge in zip(pairs, edges, strict=True)]

    def _checked(self, pair: Pair, edge: Edge) -> Edge:
        """Reject an edge that moved far from where the neighboring one predicted it."""
        T_map_i = self._places.graph.T_map_body[edge.i]
        drift = self._places.drift_of_meter(edge.j).times(self._sd * FOLLOW.step_m)
        if not edge.in_graph or drift.explains(
            T_map_i @ pair.T_i_j, T_map_i @ edge.T_i_j, beside=(FOLLOW.change_m, FOLLOW.change_rad)
        ):
            return edge
        return edge.judged(Judgment(Judge.PLACES, Verdict.REJECTED, Reason.UNCONFIRMED))

    def _next_pairs(self, end: _ChainEnd) -> list[Pair]:
        """The same correction a step along the path; none where the paths part."""
        graph, path_m, edge = self._places.graph, self._places.path_m, end.edge
        drift_m = self._sd * self._places.drift_of_meter(edge.j).across_m
        step_m = min(FOLLOW.step_m, 0.5 * FOLLOW.change_m / max(drift_m, 1e-9))
        ahead = np.flatnonzero(end.direction * (path_m - path_m[edge.j]) >= step_m)
        if not len(ahead):
            return []
        j = int(ahead[0] if end.direction > 0 else ahead[-1])
        T_corrected = graph.T_map_body[edge.i] @ edge.T_i_j
        T_map_body = T_corrected @ graph.T_map_body[edge.j].inverse() @ graph.T_map_body[j]
        near = np.flatnonzero(np.abs(path_m - path_m[edge.i]) <= DENSITY.max_shift_m)
        near = near[path_m[near] < path_m[j] - DENSITY.max_shift_m]
        return loop_pairs(graph, near, j=j, T_map_body=T_map_body, within_m=FOLLOW.parted_m)


def loop_pairs(
    graph: PoseGraph, earlier: Rows, *, j: int, T_map_body: SE3, within_m: float = np.inf
) -> list[Pair]:
    """Pairs of a node, if it had that pose, with the nearest of some earlier nodes."""
    T = graph.T_map_body
    away_m = np.linalg.norm(T.t[earlier] - T_map_body.t, axis=1)
    nearest = np.argsort(away_m, kind="stable")[: FOLLOW.nearest]
    chosen = earlier[nearest[away_m[nearest] <= within_m]].tolist()
    return [_recognized(i, j, T[i].inverse() @ T_map_body) for i in chosen]


def _recognized(i: int, j: int, T_i_j: SE3) -> Pair:
    return Pair(i, j, EdgeKind.LOOP, T_i_j, recognized=True)


def taken_pairs(graph: PoseGraph) -> set[tuple[int, int]]:
    """Pairs that are not registered again; better poses may decide what was not clear before."""
    unclear, of = (Reason.AMBIGUOUS, Reason.UNCONFIRMED), graph.relations
    clear = EdgeColumns.of(graph.edges).histories.where_last(
        lambda words: words.reason not in unclear
    )
    taken = of.in_graph | clear
    return set(zip(of.i[taken].tolist(), of.j[taken].tolist(), strict=True))


def register_recognized(
    pairs: Sequence[Pair], registrar: PairRegistrar, progress: Progress
) -> list[Edge]:
    """Register pairs; those that ran out of rounds close to a fit continue from there."""
    if not pairs:
        return []
    edges = registrar.register(pairs, progress)
    again = [k for k, edge in enumerate(edges) if _is_close(edge)]
    further = [_recognized(e.i, e.j, e.T_i_j) for e in (edges[k] for k in again)]
    for k, edge in zip(again, registrar.register(further, progress) if again else [], strict=True):
        edges[k] = edge.after(edges[k])
    return edges


def _is_close(edge: Edge) -> bool:
    return edge.reason is Reason.NOT_CONVERGED and edge.error_m <= edge.limit_m
