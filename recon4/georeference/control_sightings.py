"""Which nodes saw a target: a place in the map becomes places in the bodies of nodes."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from recon4.geometry.se3 import Array
from recon4.georeference.tuning_control import SIGHTINGS
from recon4.mapping.undistort import place
from recon4.model.pose_graph import PoseGraph, Rows
from recon4.model.trajectory import Times, Trajectory
from recon4.store.frames import FrameStore


@dataclass(frozen=True, slots=True, eq=False)
class PickedTarget:
    """A target that a person picked in a map."""

    p_map: Array
    """Its place [m], (3,)."""
    along: Array
    """Measured directions, orthonormal rows, (1..3, 3)."""
    radius_m: float = 0.0
    """Of a sphere, whose middle is the place [m]."""


@dataclass(frozen=True, slots=True, eq=False)
class Sighting:
    """A picked target in the body frames of the multiframes that saw it."""

    t_ns: Times
    """(M,); M = 0: none did, it is not in the map."""
    p_body: Array
    """[m], (M, 3)."""
    directions_body: Array
    """Measured directions, (M, 1..3, 3)."""


def sightings(
    picked: Mapping[str, PickedTarget],
    frames: FrameStore,
    graph: PoseGraph,
    *,
    trajectory: Trajectory,
) -> dict[str, Sighting]:
    """Find the nodes that saw picked targets, at most `SIGHTINGS.per_visit` of each visit.

    Args:
        picked: Id -> place in the map.
        frames: Multiframes of the walk.
        graph: Its nodes.
        trajectory: Of the map that was picked in.
    """
    names = list(picked)
    places = np.array([picked[name].p_map for name in names]).reshape(-1, 3)
    around = np.array([SIGHTINGS.around_m + picked[name].radius_m for name in names])
    counts = np.zeros((len(names), len(graph)), dtype=np.intp)
    row_of = {int(one): row for row, one in enumerate(frames.index["frame_id"])}
    inside = (graph.t_ns >= trajectory.t_ns[0]) & (graph.t_ns <= trajectory.t_ns[-1])
    for node in np.flatnonzero(inside).tolist():
        at = trajectory.at(graph.t_ns[[node]]).t[0]
        near = np.flatnonzero(np.linalg.norm(places - at, axis=1) < SIGHTINGS.range_m)
        row = row_of.get(int(graph.frame_ids[node]))
        if len(near) and row is not None:
            xyz = place(frames[row], trajectory, frames.rig)
            counts[near, node] = _near(xyz, places[near], around[near])
    return {
        name: _sighting(picked[name], graph.t_ns[_chosen(counts[k], graph.t_ns)], trajectory)
        for k, name in enumerate(names)
    }


def _near(xyz: Array, places: Array, around_m: Array) -> Rows:
    """How many points lie around each place, (K,)."""
    return np.array(
        [
            np.count_nonzero(np.abs(xyz - p).max(axis=1) < r)
            for p, r in zip(places, around_m, strict=True)
        ]
    )


def _chosen(counts: Rows, t_ns: Times) -> Rows:
    """Nodes that saw a target, those with the most points of each visit."""
    rows = np.flatnonzero(counts >= SIGHTINGS.points)
    if not len(rows):
        return rows
    visits = np.split(rows, np.flatnonzero(np.diff(t_ns[rows]) > 1e9 * SIGHTINGS.visit_s) + 1)
    best = [one[np.argsort(-counts[one], kind="stable")[: SIGHTINGS.per_visit]] for one in visits]
    return np.sort(np.concatenate(best))


def _sighting(picked: PickedTarget, t_ns: Times, trajectory: Trajectory) -> Sighting:
    if not len(t_ns):
        return Sighting(t_ns, np.zeros((0, 3)), np.zeros((0, *picked.along.shape)))
    T_body_map = trajectory.at(t_ns).inverse()
    p_body = T_body_map @ np.tile(picked.p_map, (len(t_ns), 1))
    directions = np.einsum("dj,nij->ndi", picked.along, T_body_map.R)
    return Sighting(t_ns, p_body, directions)
