"""Candidates for loop closures: which nodes may show a place seen before."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from scipy.sparse import coo_array
from scipy.sparse.csgraph import dijkstra

from recon4.geometry.se3 import Array
from recon4.model.pose_graph import EdgeKind, PoseGraph
from recon4.slam2d.edges import plane_information
from recon4.slam2d.keyframes import Keyframes, Rows
from recon4.slam2d.tuning import Loop2dTuning
from recon4.slam2d.tuning_graph import CANDIDATES_2D


@dataclass(frozen=True, slots=True)
class Candidate2d:
    """Two nodes that may show the same place."""

    target: int
    """Middle of a sub-map."""
    source: int
    """A later node."""
    drift_m: float
    """Uncertainty of the position of one seen from the other [m]."""
    drift_rad: float
    """The same for the rotation [rad]."""


def candidates(
    graph: PoseGraph, keyframes: Keyframes, *, settings: Loop2dTuning, most_m: float
) -> Iterator[Candidate2d]:
    """Pairs whose nodes are close, as certain as ``most_m`` or better.

    The uncertainty grows with the path between the nodes through the graph: loop closures that
    were found before shorten it. Motions with a large covariance count as longer paths.

    Args:
        graph: Current poses, and the edges so far.
        keyframes: Its nodes.
        settings: Distances and drift.
        most_m: Pairs with a larger uncertainty are not returned [m].
    """
    links = _links(graph, settings)
    p_map = graph.T_map_body.t[:, :2]
    targets = np.arange(0, len(graph), settings.target_stride)
    sources = np.arange(0, len(graph), settings.source_stride)
    for first in range(0, len(sources), CANDIDATES_2D.chunk):
        chunk = sources[first : first + CANDIDATES_2D.chunk]
        limit = most_m / settings.drift_ratio
        path_m = dijkstra(links, directed=False, indices=chunk, limit=limit)[:, targets]
        for row, source in enumerate(chunk.tolist()):
            drift_m = settings.drift_ratio * path_m[row]
            apart_m = np.hypot(*(p_map[targets] - p_map[source]).T)
            near = apart_m <= settings.reach_m + drift_m
            near &= drift_m <= most_m
            before = keyframes.path_m[source] - keyframes.path_m[targets]
            near &= (targets < source) & (before >= settings.min_path_m)
            for k in _one_per_visit(np.flatnonzero(near), apart_m, most=settings.revisits):
                drift_rad = settings.drift_rad_m * float(path_m[row, k])
                yield Candidate2d(int(targets[k]), source, float(drift_m[k]), drift_rad)


def _links(graph: PoseGraph, settings: Loop2dTuning) -> coo_array:
    """Edges with their length in meters of path, or more where the motion is uncertain."""
    of = graph.relations
    used = np.flatnonzero(of.in_graph)
    # Height, roll and pitch are independent of the plane: its block can be inverted alone.
    covariance = np.linalg.inv(plane_information(of.information[used]))
    sd_m = np.sqrt(covariance[:, 1, 1] + covariance[:, 2, 2])
    is_walk = np.array([graph.edges[row].kind is EdgeKind.ODOMETRY for row in used.tolist()])
    path_m = np.where(is_walk, np.hypot(*of.T_i_j.t[used, :2].T), 0.0)
    length_m = path_m + np.where(
        sd_m > CANDIDATES_2D.loose_sd_m, CANDIDATES_2D.sigmas * sd_m / settings.drift_ratio, 0.1
    )
    ends = (of.i[used], of.j[used])
    return coo_array((length_m, ends), shape=(len(graph), len(graph))).tocsr()


def _one_per_visit(near: Rows, apart_m: Array, *, most: int) -> list[int]:
    """The closest sub-map of each visit: of each run of consecutive sub-maps; closest first."""
    if not len(near):
        return []
    visits = np.split(near, np.flatnonzero(np.diff(near) > 2) + 1)
    closest = [int(visit[np.argmin(apart_m[visit])]) for visit in visits]
    return sorted(closest, key=lambda k: float(apart_m[k]))[:most]
