"""Registration of pairs of nodes: overlap, registration, acceptance."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass

import numpy as np

from recon4.geometry.lines import Lines
from recon4.geometry.se3 import Array
from recon4.model.events import EdgeTried
from recon4.model.plain import finite_or_none
from recon4.model.pose_graph import Edge, EdgeKind, Judge, Judgment, Measure, Reason, Verdict
from recon4.pose_graph.node_views import NodeRangeImages
from recon4.pose_graph.ordered_pairs import OrderedPairs
from recon4.pose_graph.pair import Pair
from recon4.pose_graph.pair_files import Groups
from recon4.pose_graph.tried_pairs import TriedPairs
from recon4.pose_graph.tuning import RecognitionTuning, graph_tuning
from recon4.pose_graph.tuning_solve import PAIRS
from recon4.progress import Progress
from recon4.registration.collar_lines import LineTarget, register_lines
from recon4.registration.overlap import RangeImage, overlap, seen_through
from recon4.registration.plane_map import PlaneMap
from recon4.registration.planes import register_to_planes
from recon4.registration.result import Registration
from recon4.registration.submap import Ends, Submaps, median_range_m
from recon4.registration.tuning import OVERLAP, OdometryTuning, OverlapTuning
from recon4.settings.reads import GraphReads
from recon4.settings.tuning import tuned
from recon4.store.unfinished import RecordLog, unfinished_file


class PairRegistrar:
    """Registers pairs on several threads, or on workers; the result does not depend on them."""

    def __init__(
        self,
        submaps: Submaps,
        views: NodeRangeImages,
        settings: GraphReads,
        *,
        overlap: OverlapTuning = OVERLAP,
        ordered: OrderedPairs | None = None,
    ) -> None:
        self._submaps, self._ordered = submaps, ordered
        self.views, self.settings = views, settings
        self._overlaps = overlap
        self._tried = TriedPairs(RecordLog(unfinished_file("pairs")))
        self.graph = graph_tuning(settings.graph)
        self.recognition = tuned(RecognitionTuning, settings.recognition)

    def prepare(self, nodes: int, progress: Progress) -> None:
        """Compute segments and range images of all nodes."""
        progress.start("view volumes", nodes, "node")
        chunks = [range(k, min(k + PAIRS.chunk, nodes)) for k in range(0, nodes, PAIRS.chunk)]
        with ThreadPoolExecutor(self.graph.workers) as pool:
            fills = pool.map(lambda chunk: self.views.fill(self._submaps, chunk), chunks)
            for chunk, _ in zip(chunks, fills, strict=True):
                progress.advance(len(chunk))

    def register(self, pairs: Sequence[Pair], progress: Progress) -> list[Edge]:
        """Register pairs; each sends an event. Edges are returned in the order of the pairs."""
        edges = self._tried.known(pairs)
        rows = (k for k in range(len(pairs)) if k not in edges)
        order = sorted(rows, key=lambda k: (pairs[k].i, pairs[k].j, k))
        groups = _by_target(order, pairs)
        parts = [groups[k : k + PAIRS.chunk] for k in range(0, len(groups), PAIRS.chunk)]
        progress.start("pairs", len(pairs), "pair")
        for edge in edges.values():
            progress.event(tried_event(edge))
        progress.advance(len(edges))
        for done in self._done(parts, pairs, progress):
            edges.update(done)
            for k, edge in done.items():
                self._tried.add(pairs[k], edge)
                progress.event(tried_event(edge))
            progress.advance(len(done))
        return [edges[k] for k in range(len(pairs))]

    def try_groups(self, groups: Groups, pairs: Mapping[int, Pair]) -> dict[int, Edge]:
        """Register pairs; row -> what each gave.

        Args:
            groups: Rows of pairs, by target node.
            pairs: Row -> pair.
        """
        planes = PlaneMap()
        tried = (self._try_group(planes, group, pairs=pairs) for group in groups)
        return {k: edge for edges in tried for k, edge in edges}

    def most_overlapping(self, pairs: Sequence[Pair]) -> Pair:
        """The pair whose views overlap most at their predicted poses."""
        return max(pairs, key=self._overlap)

    def seen_through(self, edge: Edge) -> float:
        """Fraction of the points of one node that lie in the free space of the other, 0..1."""
        i, j = self._view(edge.i), self._view(edge.j)
        return seen_through(i, j, edge.T_i_j, settings=self._overlaps)

    def _done(
        self, parts: Sequence[Groups], pairs: Sequence[Pair], progress: Progress
    ) -> Iterator[dict[int, Edge]]:
        """What each part gave, in their order."""
        by_row = dict(enumerate(pairs))

        def here(groups: Groups) -> dict[int, Edge]:
            return self.try_groups(groups, by_row)

        if self._ordered is not None and parts:
            yield from self._ordered.tried(parts, pairs, here=here, progress=progress)
            return
        with ThreadPoolExecutor(self.graph.workers) as pool:
            yield from pool.map(here, parts)

    def _try_group(
        self, planes: PlaneMap, group: list[int], *, pairs: Mapping[int, Pair]
    ) -> list[tuple[int, Edge]]:
        """Register all pairs of one target node; its map is built once, if a pair needs it."""
        target: PlaneMap | LineTarget | None = None
        out, limit_m = [], float("nan")
        reach = self.graph.target_reach
        for k in group:
            pair = pairs[k]
            ends = self.views.ends(pair.j)
            overlap_ratio = self._overlap(pair)
            if overlap_ratio < self._overlaps.threshold:
                out.append((k, self._apart(pair, overlap_ratio)))
                continue
            if target is None:
                target = self._target(self._submaps.around(pair.i, reach), planes)
                limit_m = self._limit_m(pair.i)
            found = self._solve(target, ends, pair, overlap_ratio=overlap_ratio)
            out.append((k, self._judge(pair, overlap_ratio, found, limit_m=limit_m)))
        return out

    def _overlap(self, pair: Pair) -> float:
        source, target = (self._view(node) for node in (pair.i, pair.j))
        return overlap(source, target, pair.T_i_j, settings=self._overlaps)

    def _view(self, node: int) -> RangeImage:
        return RangeImage(self.views.ends(node).reshape(-1, 3), self.views.nearest_m(node))

    def _target(self, ends: Ends, planes: PlaneMap) -> PlaneMap | LineTarget:
        if self.settings.registration.solver != "planes":
            return LineTarget(Lines.through(ends[:, 0], ends[:, 1]))
        planes.clear()
        planes.add(np.ascontiguousarray(ends.reshape(-1, 3)))
        return planes

    def _solve(
        self, target: PlaneMap | LineTarget, ends: Ends, pair: Pair, *, overlap_ratio: float
    ) -> Registration:
        settings = self.settings.registration
        if isinstance(target, LineTarget):
            source = Lines.through(ends[:, 0], ends[:, 1])
            return register_lines(
                target, source, initial=pair.T_i_j, portion=overlap_ratio, settings=settings
            )
        return register_to_planes(
            target, ends.reshape(-1, 3), initial=pair.T_i_j,
            settings=settings, normal_noise_rad=self.graph.normal_noise_rad,
        )  # fmt: skip

    def _limit_m(self, target: int) -> float:
        """Largest error of a pair of a target node [m] (A0 no. 12)."""
        range_m = median_range_m(self.views.ends(target))
        return range_m * self.graph.error_relative + self.graph.error_absolute_m

    def _judge(
        self, pair: Pair, overlap_ratio: float, found: Registration, *, limit_m: float
    ) -> Edge:
        """Accept or reject (V Algorithm 2.1 line 8; A0 no. 12)."""
        g = self.graph
        limits = RegistrationLimits(limit_m, g.min_match_ratio, g.min_degeneracy)
        edge = Edge(
            i=pair.i,
            j=pair.j,
            T_i_j=found.T_target_source,
            kind=pair.kind,
            judgments=(registration_judgment(found, limits),),
            overlap=overlap_ratio,
            error_m=found.error_m,
            limit_m=limit_m,
            degeneracy=found.degeneracy,
            converged=found.converged,
            iterations=found.iterations,
            information=_information(found, self.settings),
        )
        of = self.recognition if pair.recognized else g
        is_loop = edge.in_graph and edge.kind is EdgeKind.LOOP
        return self._in_free_space(edge, limit=of.max_seen_through) if is_loop else edge

    def _in_free_space(self, edge: Edge, *, limit: float) -> Edge:
        through = self.seen_through(edge)
        verdict, reason = Verdict.ACCEPTED, Reason.NONE
        if through > limit:
            verdict, reason = Verdict.REJECTED, Reason.SEEN_THROUGH
        return edge.judged(
            Judgment(Judge.FREE_SPACE, verdict, reason, Measure.SEEN_THROUGH, through, limit)
        )

    def _apart(self, pair: Pair, overlap_ratio: float) -> Edge:
        """A pair that overlaps too little to be registered."""
        limit = self._overlaps.threshold
        return Edge(
            i=pair.i, j=pair.j, T_i_j=pair.T_i_j, kind=pair.kind, overlap=overlap_ratio,
            judgments=(too_little_overlap(overlap_ratio, limit),),
        )  # fmt: skip


@dataclass(frozen=True, slots=True)
class RegistrationLimits:
    """What a registration must keep to be accepted (V Algorithm 2.1 line 8; A0 no. 12)."""

    error_m: float
    match_ratio: float
    degeneracy: float


def registration_judgment(found: Registration, limits: RegistrationLimits) -> Judgment:
    """Accept or reject a registration, with the figure that decided."""
    by, rejected = Judge.SEARCH, Verdict.REJECTED
    if not found.converged:
        return Judgment(by, rejected, Reason.NOT_CONVERGED)
    if not found.error_m <= limits.error_m:
        error_m = finite_or_none(found.error_m)
        return Judgment(by, rejected, Reason.ERROR, Measure.ERROR, error_m, limits.error_m)
    if found.match_ratio < limits.match_ratio:
        measured = (Measure.MATCHES, found.match_ratio, limits.match_ratio)
        return Judgment(by, rejected, Reason.FEW_MATCHES, *measured)
    if found.degeneracy < limits.degeneracy:
        measured = (Measure.DEGENERACY, found.degeneracy, limits.degeneracy)
        return Judgment(by, rejected, Reason.DEGENERATE, *measured)
    accepted = (Verdict.ACCEPTED, Reason.NONE)
    return Judgment(by, *accepted, Measure.ERROR, found.error_m, limits.error_m)


def too_little_overlap(ratio: float, limit: float | None = None) -> Judgment:
    """The search rejects a pair whose views hardly overlap."""
    rejected = (Verdict.REJECTED, Reason.OVERLAP)
    return Judgment(Judge.SEARCH, *rejected, Measure.OVERLAP, ratio, limit)


def tried_event(edge: Edge) -> EdgeTried:
    """The event about a registered pair; figures are rounded to five digits for display."""
    return EdgeTried(
        i=edge.i,
        j=edge.j,
        edge_kind=edge.kind,
        verdict=edge.verdict,
        reason=edge.reason,
        overlap=finite_or_none(edge.overlap, 5),
        error_m=finite_or_none(edge.error_m, 5),
        limit_m=finite_or_none(edge.limit_m, 5),
    )


def _information(found: Registration, settings: GraphReads) -> Array:
    """Inverse covariance of the tangent of ``T_i_j`` by the matches, with a smallest covariance.

    A correction (omega, v) on the left about the source's origin is (R^T omega, R^T v) on the
    right, so the normal equations are rotated into the source's axes.
    """
    g = graph_tuning(settings.graph)
    floor = np.diag(np.repeat([g.loop_sd_rad, g.loop_sd_m], 3) ** 2)
    if settings.registration.solver != "planes" or not found.converged:
        return np.linalg.inv(floor)
    A = np.kron(np.eye(2), found.T_target_source.R)
    H = A.T @ found.information @ A * tuned(OdometryTuning, settings.odometry).information_scale
    covariance = np.linalg.inv(H + 1e-3 * np.eye(6)) + floor
    information = np.linalg.inv(covariance)
    return 0.5 * (information + information.T)


def _by_target(order: list[int], pairs: Sequence[Pair]) -> Groups:
    groups: Groups = []
    for k in order:
        if not groups or pairs[groups[-1][0]].i != pairs[k].i:
            groups.append([])
        groups[-1].append(k)
    return groups
