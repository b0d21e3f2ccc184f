"""Place recognition: loop closures beyond the search radius of revisits.

Every few meters the walls around the body are drawn from above (`places`). A place is compared
with all earlier ones by its descriptor; the most similar are laid onto each other
(`density_images`). The poses that fit best are registered like any pair and must pass more tests:

- the points of one visit do not lie where the other one saw through (free space);
- several places in a row agree on the same correction;
- no other correction is as well supported (repeated columns, doors, rooms);
- the correction lies within what the graph states of its own uncertainty. Storeys that look alike
  differ by a height that odometry cannot have missed.

What fails only the last two is *ambiguous*: it is kept out of the graph and announced.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from recon4.geometry.se3 import SE3, so3_exp
from recon4.model.edge_columns import EdgeColumns
from recon4.model.pose_graph import Edge, EdgeKind, Judge, Judgment, PoseGraph, Reason, Verdict
from recon4.pose_graph.density_images import Overlay, yaws_within
from recon4.pose_graph.pair import Pair
from recon4.pose_graph.pairs import PairRegistrar
from recon4.pose_graph.places import PlaceDrawer, Places
from recon4.pose_graph.recognized_chains import (
    ChainFollower,
    loop_pairs,
    register_recognized,
    taken_pairs,
)
from recon4.pose_graph.recognized_groups import RecognizedChain, judge_chains
from recon4.pose_graph.tuning import RecognitionTuning
from recon4.pose_graph.tuning_places import DENSITY, RECOGNITION
from recon4.progress import Progress


@dataclass(frozen=True, slots=True, eq=False)
class _PlaceHypothesis:
    """A possible correction of a place."""

    place: int
    T_map_body: SE3
    """Pose of its node in the map if it is right."""
    score: float
    """Cosine of the images, 0..1."""
    earlier: int
    """The earlier place it was laid onto."""
    unlikely: float
    """How far it moves the node, as a ratio of what is likely."""

    @property
    def is_far(self) -> bool:
        """Whether it can only be announced."""
        return self.unlikely > RECOGNITION.far

    @property
    def rank(self) -> float:
        """Larger is better."""
        return self.score - RECOGNITION.unlikely * min(self.unlikely, 2.0)


def recognize(
    graph: PoseGraph, registrar: PairRegistrar, drawer: PlaceDrawer, *, progress: Progress
) -> list[Edge]:
    """Find loop closures between places that the graph does not join yet.

    Args:
        graph: The graph so far; z of its map is vertical.
        registrar: Registers pairs of nodes; has their segments and the settings.
        drawer: Draws the places of this walk.
        progress: Receives an event for each registered pair.

    Returns:
        An edge for every registered pair, accepted or rejected with its reason.
    """
    settings = registrar.recognition
    # Where a pair was degenerate, as in a bare corridor, no other pose would be better determined.
    is_open = ~_closed_nodes(graph)
    if not is_open[drawer.nodes(graph)].any():
        return []  # no place has to be drawn
    places = drawer.draw(graph, turned=is_open)
    hypotheses = [
        one
        for place in np.flatnonzero(is_open[places.node]).tolist()
        for one in _hypotheses(places, place, settings)
    ]
    pairs, kept = _pairs(places, hypotheses, registrar)
    if not pairs:
        return []
    edges = register_recognized(pairs, registrar, progress)
    chains = [
        RecognizedChain(place=one.place, earlier=one.earlier, edges=[edge])
        for one, edge in zip(kept, edges, strict=True)
    ]
    ChainFollower(places, registrar, progress).follow(chains)
    return judge_chains(places, chains, settings=settings)


def without_settled(graph: PoseGraph) -> PoseGraph:
    """The graph whose ambiguous edges are those of places that are still open.

    Where a loop closure was accepted later, the other hypotheses were wrong.
    """
    closed = _closed_nodes(graph)
    settled = Judgment(Judge.PLACES, Verdict.REJECTED, Reason.UNCONFIRMED)
    edges = EdgeColumns.of(graph.edges)
    ambiguous = edges.histories.where_last(lambda words: words.reason is Reason.AMBIGUOUS)
    rows = np.flatnonzero(ambiguous & closed[edges.relations.j]).tolist()
    return graph.with_edges(edges.replaced({row: edges[row].judged(settled) for row in rows}))


def _closed_nodes(graph: PoseGraph) -> NDArray[np.bool_]:
    """Nodes at the later end of a loop closure, with their neighbors, (N,)."""
    closed, edges = np.zeros(len(graph), np.bool_), EdgeColumns.of(graph.edges)
    known = edges.histories.where_last(
        lambda words: words.verdict is not Verdict.REJECTED or words.reason is Reason.DEGENERATE
    )
    for j in edges.relations.j[edges.are(EdgeKind.LOOP) & known].tolist():
        closed[max(j - RECOGNITION.closed_nodes, 0) : j + RECOGNITION.closed_nodes + 1] = True
    return closed


def _hypotheses(places: Places, place: int, settings: RecognitionTuning) -> list[_PlaceHypothesis]:
    """The best distinct corrections of a place, by laying it onto similar earlier places."""
    T_map_place = places.graph.T_map_body[places.node]
    found, laid = [], places.images.laid_from(place, most=settings.hypotheses)
    for k in _candidates(places, place, settings):
        yaws = yaws_within(
            settings.bound_sd * float(places.bounds.yaw_rad[k, place]) + RECOGNITION.yaw_rad
        )
        likely_m = settings.bound_sd * float(places.bounds.horizontal_m[k, place])
        height_m = settings.bound_sd * float(places.bounds.vertical_m[k, place])
        fit = [one for one in laid.onto(k, yaws) if one.score >= settings.min_score]
        T = _moved(T_map_place[place], T_map_place[k], fit, height_m=height_m)
        move_m = T.t - T_map_place.t[place]
        across = np.linalg.norm(move_m[:, :2], axis=1) / (likely_m + settings.bound_m)
        up = np.abs(move_m[:, 2]) / (height_m + RECOGNITION.height_m)
        unlikely = np.maximum(across, up).tolist()
        found += [
            _PlaceHypothesis(place, T[row], one.score, k, unlikely[row])
            for row, one in enumerate(fit)
        ]
    return _distinct(sorted(found, key=lambda one: -one.rank), settings.hypotheses)


def _distinct(ranked: Sequence[_PlaceHypothesis], most: int) -> list[_PlaceHypothesis]:
    """The first of those that are the same; only a few that are far."""
    chosen: list[_PlaceHypothesis] = []
    for one in ranked:
        too_many = one.is_far and sum(other.is_far for other in chosen) >= RECOGNITION.max_far
        if len(chosen) < most and not too_many and not any(_same(one, o) for o in chosen):
            chosen.append(one)
    return chosen


def _candidates(places: Places, place: int, settings: RecognitionTuning) -> list[int]:
    """The earlier places within reach with the most similar descriptors."""
    path_m, t_m = places.path_m[places.node], places.graph.T_map_body.t[places.node]
    walked_m = path_m[place] - path_m[:place]
    bounds, ratio = places.bounds, settings.search_ratio * walked_m
    offset = t_m[:place] - t_m[place]
    across = (
        bounds.horizontal_m[:place, place] * settings.bound_sd + ratio + 0.5 * DENSITY.max_shift_m
    )
    height = bounds.vertical_m[:place, place] * settings.bound_sd + ratio + RECOGNITION.height_m
    # Parts of a walk whose relative pose is unknown are compared however short the path is.
    apart = (walked_m >= settings.min_path_m) | (bounds.horizontal_m[:place, place] > walked_m)
    near = (np.linalg.norm(offset[:, :2], axis=1) <= across) & (np.abs(offset[:, 2]) <= height)
    rows = np.flatnonzero(near & apart)
    alike = places.descriptors[rows] @ places.descriptors[place]
    chosen: list[int] = rows[np.argsort(-alike, kind="stable")[: settings.candidates]].tolist()
    return chosen


def _moved(T_map_body: SE3, T_map_earlier: SE3, laid: Sequence[Overlay], *, height_m: float) -> SE3:
    """Poses of a place in the map if it is laid onto an earlier one, a batch of L.

    Images from above show no heights: on stairs one place lies above another. A height difference
    that the graph knows (``height_m`` is its drift) stays; else the visits have the same height.
    """
    above_m = float(T_map_body.t[2] - T_map_earlier.t[2])
    above_m = (
        above_m if height_m < RECOGNITION.known_m and abs(above_m) < RECOGNITION.flight_m else 0.0
    )
    turns = so3_exp(np.array([(0.0, 0.0, one.yaw_rad) for one in laid]).reshape(-1, 3))
    shifts_m = np.array([(*one.shift_m, above_m) for one in laid]).reshape(-1, 3)
    return SE3(turns @ T_map_body.R, T_map_earlier.t + shifts_m)


def _same(a: _PlaceHypothesis, b: _PlaceHypothesis) -> bool:
    apart = a.T_map_body.inverse() @ b.T_map_body
    return bool(
        np.linalg.norm(apart.t) < RECOGNITION.near_m and apart.angle() < RECOGNITION.near_rad
    )


def _pairs(
    places: Places, hypotheses: Sequence[_PlaceHypothesis], registrar: PairRegistrar
) -> tuple[list[Pair], list[_PlaceHypothesis]]:
    """One pair for each hypothesis: the place and an earlier node near where it moves."""
    graph = places.graph
    taken = taken_pairs(graph)
    pairs, kept = [], []
    for one in hypotheses:
        j, k = int(places.node[one.place]), int(places.node[one.earlier])
        around = np.flatnonzero(np.abs(places.path_m - places.path_m[k]) <= DENSITY.max_shift_m)
        near = np.array([i for i in around[around < j] if (i, j) not in taken], np.intp)
        if not len(near):
            continue
        choice = loop_pairs(graph, near, j=j, T_map_body=one.T_map_body)
        pairs.append(registrar.most_overlapping(choice))
        taken.add((pairs[-1].i, j))
        kept.append(one)
    return pairs, kept
