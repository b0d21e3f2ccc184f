"""Registers the surroundings of keyframes to sub-maps around other ones."""

from __future__ import annotations

from collections.abc import Iterable
from itertools import groupby

import numpy as np

from recon4.geometry.se2 import between, from_se3, to_se3
from recon4.geometry.se3 import Array
from recon4.model.plain import finite_or_none
from recon4.model.pose_graph import (
    Edge,
    EdgeKind,
    Judge,
    Judgment,
    Measure,
    PoseGraph,
    Reason,
    Verdict,
)
from recon4.progress import Progress, track
from recon4.slam2d.candidates import Candidate2d
from recon4.slam2d.correlative import LikelihoodField
from recon4.slam2d.edges import in_source_axes, space_information
from recon4.slam2d.keyframes import Keyframes
from recon4.slam2d.line_map import LineMap, Match2d
from recon4.slam2d.observability import observed
from recon4.slam2d.tuning import Loop2dTuning, Slam2dTuning
from recon4.slam2d.tuning_graph import SUBMAPS_2D

Pair = tuple[int, int]


def predicted_pose(graph: PoseGraph, pair: Candidate2d) -> Array:
    """Pose of the source in the frame of the target by the graph: x [m], y [m], yaw [rad], (3,)."""
    T = graph.T_map_body
    return from_se3(T[pair.target].inverse() @ T[pair.source])


class SubmapRegistrar:
    """Registers the surroundings of a node to sub-maps around other nodes."""

    def __init__(
        self, keyframes: Keyframes, *, settings: Slam2dTuning, loops: Loop2dTuning
    ) -> None:
        """Prepare an empty map, which all sub-maps use one after the other."""
        self._keyframes, self._settings, self._loops = keyframes, settings, loops
        reach_m = 2.0 * settings.keyframe_m * (loops.target_reach + 2)
        extent_m = 2.0 * settings.max_range_m + 2.0 * reach_m
        self._map = LineMap(cell_m=settings.cell_m, extent_m=extent_m)

    def register(
        self, pairs: Iterable[Candidate2d], graph: PoseGraph, *, progress: Progress
    ) -> Iterable[Edge]:
        """An edge for each pair, with its verdict."""
        ordered = sorted(pairs, key=lambda pair: (pair.target, pair.source))
        watched = track(ordered, progress, what="Loop closures", unit="pairs")
        for target, group in groupby(watched, key=lambda pair: pair.target):
            points, _ = self._keyframes.around(target, self._loops.target_reach)
            field = LikelihoodField.of(points) if len(points) else None
            self._map.add(points)
            for pair in group:
                yield self._edge(pair, field, predicted_pose(graph, pair))
            self._map.remove(points)

    def register_at(self, pair: Pair, predicted: Array) -> Edge:
        """Register two nodes from a pose that a person predicted: x [m], y [m], yaw [rad], (3,)."""
        return self.register_pair(
            Candidate2d(*pair, SUBMAPS_2D.given_m, SUBMAPS_2D.given_rad), predicted
        )

    def register_pair(self, pair: Candidate2d, predicted: Array) -> Edge:
        """Register two nodes from a predicted pose: x [m], y [m], yaw [rad], (3,)."""
        points, _ = self._keyframes.around(pair.target, self._loops.target_reach)
        field = LikelihoodField.of(points) if len(points) else None
        self._map.add(points)
        try:
            return self._edge(pair, field, predicted)
        finally:
            self._map.remove(points)

    def _edge(self, pair: Candidate2d, field: LikelihoodField | None, predicted: Array) -> Edge:
        points, weights = self._keyframes.around(pair.source, self._loops.source_reach)
        points, weights = _sampled(points, weights)
        if field is None:
            return _rejected(pair, predicted, Reason.OVERLAP)
        found = field.search(
            points,
            initial_pose=predicted,
            half_window_m=0.3 + pair.drift_m,
            half_window_rad=min(0.05 + pair.drift_rad, np.pi),
            min_score=self._loops.min_score,
        )
        if found is None:
            return _rejected(pair, predicted, Reason.OVERLAP)
        match = self._map.register(
            points, weights, start=found.pose, sd_m=self._settings.noise_sd_m
        )
        return self._judged(pair, match, moved=between(found.pose, match.pose), score=found.score)

    def _judged(self, pair: Candidate2d, match: Match2d, *, moved: Array, score: float) -> Edge:
        # Returns of several scans repeat the same surfaces: they count as those of one scan.
        repeated = float(2 * self._loops.source_reach + 1)
        seen = observed(match.H / repeated, self._settings.normal_noise_rad)
        error_m = float(np.sqrt(match.variance_ratio) * self._settings.noise_sd_m)
        return Edge(
            i=pair.target,
            j=pair.source,
            T_i_j=to_se3(match.pose),
            kind=EdgeKind.LOOP,
            judgments=(self._judgment(match, seen.degeneracy, moved=moved, error_m=error_m),),
            overlap=score,
            error_m=error_m,
            information=space_information(
                in_source_axes(seen.information, float(match.pose[2])),
                sd_m=self._loops.loop_sd_m,
                sd_rad=self._loops.loop_sd_rad,
            ),
            degeneracy=seen.degeneracy,
            converged=match.converged,
            iterations=match.iterations,
        )

    def _judgment(
        self, match: Match2d, degeneracy: float, *, moved: Array, error_m: float
    ) -> Judgment:
        by, rejected, loops = Judge.SEARCH, Verdict.REJECTED, self._loops
        if not match.converged or np.hypot(moved[0], moved[1]) > SUBMAPS_2D.moved_m:
            return Judgment(by, rejected, Reason.NOT_CONVERGED)
        if match.match_ratio < loops.min_match_ratio:
            measured = (Measure.MATCHES, float(match.match_ratio), loops.min_match_ratio)
            return Judgment(by, rejected, Reason.FEW_MATCHES, *measured)
        if degeneracy < loops.min_degeneracy:
            measured = (Measure.DEGENERACY, float(degeneracy), loops.min_degeneracy)
            return Judgment(by, rejected, Reason.DEGENERATE, *measured)
        value = finite_or_none(error_m)
        return Judgment(by, Verdict.ACCEPTED, measure=Measure.ERROR, value=value)


def _rejected(pair: Candidate2d, predicted: Array, reason: Reason) -> Edge:
    return Edge(
        i=pair.target,
        j=pair.source,
        T_i_j=to_se3(predicted),
        kind=EdgeKind.LOOP,
        judgments=(Judgment(Judge.SEARCH, Verdict.REJECTED, reason),),
        converged=False,
    )


def _sampled(points: Array, weights: Array) -> tuple[Array, Array]:
    step = max(1, len(points) // SUBMAPS_2D.most_points)
    return points[::step], weights[::step]
