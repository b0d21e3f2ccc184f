"""Judgment of recognized places: which corrections agree, which compete, which are plausible."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components

from recon4.geometry.se3 import SE3
from recon4.model.pose_graph import Edge, Judge, Judgment, Measure, PoseGraph, Reason, Verdict
from recon4.pose_graph.places import Places
from recon4.pose_graph.tuning import RecognitionTuning
from recon4.pose_graph.tuning_places import GROUPS

_NEUTRAL = (Reason.OVERLAP, Reason.DEGENERATE)
"""Reasons that say nothing against a hypothesis."""


@dataclass(frozen=True, slots=True, eq=False)
class RecognizedChain:
    """A hypothesis, registered at a place and followed along the path."""

    place: int
    """Row of the place."""
    earlier: int
    """Row of the earlier place it was laid onto."""
    edges: list[Edge]
    """At the place first, then at nodes before and after it."""

    @property
    def confirmed(self) -> list[Edge]:
        """Edges whose views fit."""
        return [edge for edge in self.edges if edge.in_graph]


@dataclass(frozen=True, eq=False)
class _ChainGroup:
    """Chains that agree on one correction."""

    chains: list[RecognizedChain]
    span_m: tuple[float, float]
    """Path length from the start to its first and last node whose views fit [m]."""
    is_within: bool
    """Whether it moves the nodes by no more than the graph's uncertainty."""

    @cached_property
    def nodes(self) -> set[int]:
        """Nodes whose views fit."""
        return {edge.j for chain in self.chains for edge in chain.confirmed}

    @property
    def contradicted(self) -> int:
        """Number of nodes whose views contradict it."""
        return len({
            edge.j for chain in self.chains for edge in chain.edges
            if contradicts(edge)
        } - self.nodes)  # fmt: skip


def contradicts(edge: Edge) -> bool:
    """Whether the two views of an edge overlap but do not fit."""
    ran_out = edge.reason is Reason.NOT_CONVERGED and edge.error_m <= edge.limit_m
    return not edge.in_graph and edge.reason not in _NEUTRAL and not ran_out


def judge_chains(
    places: Places, chains: Sequence[RecognizedChain], *, settings: RecognitionTuning
) -> list[Edge]:
    """Decide which recognized places become loop closures.

    Args:
        places: Places of the graph so far.
        chains: Registered hypotheses; edges that were rejected stay as they are.
        settings: Limits.

    Returns:
        All edges of the chains.
    """
    groups = _groups(places, [chain for chain in chains if chain.confirmed], settings)
    judgments: dict[int, Judgment] = {}
    for group in groups:
        judgment = _judgment(group, groups, settings)
        judgments |= {id(edge): judgment for chain in group.chains for edge in chain.confirmed}
    return [_judged(edge, judgments.get(id(edge))) for chain in chains for edge in chain.edges]


def _judged(edge: Edge, judgment: Judgment | None) -> Edge:
    return edge.judged(judgment) if judgment else edge


def _judgment(
    group: _ChainGroup, groups: Sequence[_ChainGroup], settings: RecognitionTuning
) -> Judgment:
    """Whether a group is accepted."""
    support, by, rejected = len(group.nodes), Judge.PLACES, Verdict.REJECTED
    confirmed = (Measure.CONFIRMED, float(support), float(settings.min_places))
    most = GROUPS.max_contradicted * support
    if support < settings.min_places:
        return Judgment(by, rejected, Reason.UNCONFIRMED, *confirmed)
    if group.contradicted > most:
        contradicted = (Measure.CONTRADICTED, float(group.contradicted), most)
        return Judgment(by, rejected, Reason.UNCONFIRMED, *contradicted)
    if not group.is_within or _has_rival(group, groups, settings):
        return Judgment(by, rejected, Reason.AMBIGUOUS, *confirmed)
    return Judgment(by, Verdict.ACCEPTED, Reason.NONE, *confirmed)


def _has_rival(
    group: _ChainGroup, groups: Sequence[_ChainGroup], settings: RecognitionTuning
) -> bool:
    """Whether another correction of the same nodes is nearly as well confirmed."""
    least = settings.rival_ratio * len(group.nodes)
    return any(
        other is not group and other.is_within and len(other.nodes) >= least
        and _compete(group, other)
        for other in groups
    )  # fmt: skip


def _compete(a: _ChainGroup, b: _ChainGroup) -> bool:
    """Whether two groups, which do not agree, correct nodes close to each other."""
    return a.span_m[0] <= b.span_m[1] + GROUPS.link_m and b.span_m[0] <= a.span_m[1] + GROUPS.link_m


def _groups(
    places: Places, chains: Sequence[RecognizedChain], settings: RecognitionTuning
) -> list[_ChainGroup]:
    """Chains that agree with each other directly or through others."""
    agree = [
        (a, b)
        for a, b in _neighboring(places, chains)
        if _chains_agree(places, chains[a], chains[b], sd=settings.bound_sd)
    ]
    rows = np.array(agree, np.intp).reshape(-1, 2)
    joined = coo_array((np.ones(len(rows)), (rows[:, 0], rows[:, 1])), shape=(len(chains),) * 2)
    count, label = connected_components(joined, directed=False)
    members: list[list[RecognizedChain]] = [[] for _ in range(count)]
    for chain, group in zip(chains, label, strict=True):
        members[group].append(chain)
    return [
        _ChainGroup(some, _span_m(places, some), _is_within(places, some, settings))
        for some in members
    ]


def _neighboring(places: Places, chains: Sequence[RecognizedChain]) -> Iterator[tuple[int, int]]:
    """Chains with so little path in between that they could agree."""
    spans = [(*_span_m(places, [chain]), k) for k, chain in enumerate(chains)]
    near: list[tuple[float, float, int]] = []
    for start_m, end_m, k in sorted(spans):
        near = [span for span in near if span[1] >= start_m - GROUPS.link_m]
        yield from ((span[2], k) for span in near)
        near.append((start_m, end_m, k))


def _span_m(places: Places, chains: Sequence[RecognizedChain]) -> tuple[float, float]:
    """Path length from the start to the first and the last node whose views fit [m]."""
    path_m = places.path_m[[edge.j for chain in chains for edge in chain.confirmed]]
    return float(path_m.min()), float(path_m.max())


def _chains_agree(places: Places, a: RecognizedChain, b: RecognizedChain, *, sd: float) -> bool:
    """Whether the motion between corrected poses of two chains is that of the odometry."""
    return any(_agree(places, one, other, sd=sd) for one in a.confirmed for other in b.confirmed)


def _agree(places: Places, a: Edge, b: Edge, *, sd: float) -> bool:
    graph = places.graph
    path_m = abs(float(places.path_m[a.j] - places.path_m[b.j]))
    if path_m > GROUPS.link_m:
        return False
    T_a_b = graph.T_map_body[a.j].inverse() @ graph.T_map_body[b.j]
    return places.drift_between(a.j, b.j).times(sd).explains(
        _corrected(graph, a) @ T_a_b, _corrected(graph, b),
        beside=(GROUPS.agree_m + GROUPS.agree_ratio * path_m, GROUPS.agree_rad),
    )  # fmt: skip


def _corrected(graph: PoseGraph, edge: Edge) -> SE3:
    """Pose of the later node in the map by an edge."""
    return graph.T_map_body[edge.i] @ edge.T_i_j


def _is_within(
    places: Places, chains: Sequence[RecognizedChain], settings: RecognitionTuning
) -> bool:
    """Whether most edges move their nodes by no more than the graph's uncertainty."""
    moves = [within for chain in chains for within in _moves_within(places, chain, settings)]
    return sum(moves) * 2 > len(moves)


def _moves_within(
    places: Places, chain: RecognizedChain, settings: RecognitionTuning
) -> Iterator[bool]:
    """For each confirmed edge, whether it moves its node within the bounds."""
    graph = places.graph
    at = (chain.earlier, chain.place)
    far_m, height_m = (
        settings.bound_sd * float(sd[at])
        for sd in (places.bounds.horizontal_m, places.bounds.vertical_m)
    )
    for edge in chain.confirmed:
        move = _corrected(graph, edge).t - graph.T_map_body.t[edge.j]
        walked_m = float(places.path_m[edge.j] - places.path_m[edge.i])
        slack_m = settings.bound_m + settings.bound_ratio * walked_m
        across = np.linalg.norm(move[:2]) <= far_m + slack_m
        yield bool(across and abs(move[2]) <= height_m + min(slack_m, GROUPS.max_height_slack_m))
