"""Places along a walk: sub-maps of odometry every few meters, as images from above."""

from __future__ import annotations

from collections.abc import Collection
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from recon4.geometry.se3 import SE3, Array
from recon4.model.pose_graph import Flags, PoseGraph, Rows
from recon4.pose_graph.bounds import RelativeBounds, relative_bounds
from recon4.pose_graph.density_images import (
    DensityImage,
    Layers,
    layers_of,
    make_density_image,
)
from recon4.pose_graph.node_views import NodeRangeImages
from recon4.pose_graph.relations import odometry_steps
from recon4.pose_graph.stored_images import ChosenImages, StoredImages
from recon4.pose_graph.tuning import RecognitionTuning
from recon4.pose_graph.tuning_places import DENSITY, PLACES


class StatedDrift(NamedTuple):
    """How far odometry may be off, as the graph states it."""

    across_m: float
    height_m: float
    yaw_rad: float

    def times(self, factor: float) -> StatedDrift:
        """Of a longer path, or a number of standard deviations."""
        return StatedDrift(*(factor * one for one in self))

    def explains(self, expected: SE3, found: SE3, *, beside: tuple[float, float]) -> bool:
        """Whether two poses in the map differ by no more than this and ``beside`` [m], [rad]."""
        apart_m = found.t - expected.t
        beside_m, beside_rad = beside
        return bool(
            np.linalg.norm(apart_m[:2]) < self.across_m + beside_m
            and abs(apart_m[2]) < self.height_m + beside_m
            and (expected.inverse() @ found).angle() < self.yaw_rad + beside_rad
        )


@dataclass(frozen=True, slots=True, eq=False)
class Places:
    """Nodes a few meters apart, each with the walls around it."""

    graph: PoseGraph
    """The graph with the poses they were drawn with."""
    node: Rows
    """Node of each place, in the order of the walk, (K,)."""
    path_m: Array
    """Path length from the start to every node of the graph [m], (N,)."""
    images: ChosenImages
    descriptors: Array
    """Unit vectors, (K, D)."""
    bounds: RelativeBounds
    """Standard deviations between all pairs of places."""

    def __len__(self) -> int:
        return len(self.node)

    def drift_between(self, a: int, b: int) -> StatedDrift:
        """Standard deviations between two nodes."""
        at = tuple(np.minimum(np.searchsorted(self.node, (a, b)), len(self.node) - 1))
        of = self.bounds
        return StatedDrift(
            float(of.horizontal_m[at]), float(of.vertical_m[at]), float(of.yaw_rad[at])
        )

    def drift_of_meter(self, node: int) -> StatedDrift:
        """Standard deviations of a meter of path at a node."""
        at = max(1, min(int(np.searchsorted(self.node, node)), len(self.node) - 1))
        before, after = self.node[at - 1], self.node[at]
        walked_m = max(float(self.path_m[after] - self.path_m[before]), 0.1)  # parts may meet
        return self.drift_between(before, after).times(1.0 / walked_m)


@dataclass(frozen=True, slots=True, eq=False)
class _Drawing:
    """What a place was drawn with."""

    row: int
    """Of its image."""
    T_map_body: SE3
    """Of all nodes."""
    has_walls: bool
    """Whether it can be laid onto others."""


class PlaceDrawer:
    """Draws the places of a walk; for another search only those whose walls have moved."""

    def __init__(
        self, views: NodeRangeImages, settings: RecognitionTuning, *, leveled: bool
    ) -> None:
        """Nothing is drawn yet.

        Args:
            views: Segments of every node.
            settings: Spacing and extent of the places.
            leveled: The vertical is known by an IMU.
        """
        self._views, self._settings, self._leveled = views, settings, leveled
        self._images = StoredImages(views.scratch)
        self._members: dict[int, Rows] = {}
        self._drawings: dict[int, _Drawing] = {}

    def nodes(self, graph: PoseGraph) -> Rows:
        """Node of each place, the same for every search, (K,)."""
        return np.array([*self._members_of(graph)], np.intp)

    def draw(self, graph: PoseGraph, *, turned: Flags | None = None) -> Places:
        """The places with the current poses of the graph.

        Args:
            graph: Poses with a vertical z axis.
            turned: Nodes whose images are laid onto others, (N,); images of other places have no
                walls. None = all.
        """
        walls: dict[int, _NodeWalls] = {}
        for node, members in self._members_of(graph).items():
            has_walls = turned is None or bool(turned[node])
            if self._is_drawn(graph, node, has_walls=has_walls):
                continue
            # A node belongs to several places in a row.
            walls = {k: walls.get(k) or _walls_of(graph, self._views, k) for k in members.tolist()}
            image = _image_of(walls.values(), graph.T_map_body.t[node])
            self._images.append(image if has_walls else image.without_walls())
            self._drawings[node] = _Drawing(len(self._images) - 1, graph.T_map_body, has_walls)
        nodes = self.nodes(graph)
        images = ChosenImages(self._images, [self._drawings[node].row for node in nodes.tolist()])
        return Places(
            graph=graph,
            node=nodes,
            path_m=_path_m(graph),
            images=images,
            descriptors=images.descriptors,
            bounds=relative_bounds(graph, nodes, leveled=self._leveled),
        )

    def _members_of(self, graph: PoseGraph) -> dict[int, Rows]:
        """Node of each place -> nodes whose walls it shows; found along the path of one graph."""
        if not self._members:
            path_m, part = _path_m(graph), _unbroken_parts(graph)
            for node in _every(path_m, part, self._settings.spacing_m).tolist():
                reach_m = path_m[node] + np.array([-1.0, 1.0]) * self._settings.reach_m
                near = np.arange(*np.searchsorted(path_m, reach_m))
                self._members[node] = near[part[near] == part[node]]
        return self._members

    def _is_drawn(self, graph: PoseGraph, node: int, *, has_walls: bool) -> bool:
        """Whether an image shows the place as it is by the current poses."""
        drawn, rows = self._drawings.get(node), self._members[node]
        if drawn is None or (has_walls and not drawn.has_walls):
            return False
        before, now = drawn.T_map_body, graph.T_map_body
        shift_m = (now.t[rows] - now.t[node]) - (before.t[rows] - before.t[node])
        # Of a small turn, which moves what is seen by it times its distance.
        turn_rad = np.linalg.norm(now.R[rows] - before.R[rows], axis=(1, 2)) / np.sqrt(2.0)
        moved_m = np.linalg.norm(shift_m, axis=1) + DENSITY.radius_m * turn_rad
        return bool(moved_m.max() <= PLACES.redrawn_m)


def _path_m(graph: PoseGraph) -> Array:
    """Path length from the start to every node [m], (N,)."""
    steps = np.linalg.norm(np.diff(graph.T_map_body.t, axis=0), axis=1)
    return np.concatenate([[0.0], np.cumsum(steps)])


def _unbroken_parts(graph: PoseGraph) -> NDArray[np.int64]:
    """Number of the stretch of certain odometry that each node belongs to, (N,)."""
    breaks = np.zeros(len(graph), np.int64)
    of, steps = graph.relations, odometry_steps(graph)
    cov = np.linalg.inv(of.information[steps])
    breaks[of.j[steps]] = np.sqrt(np.einsum("eaa->e", cov[:, 3:, 3:])) > PLACES.broken_sd_m
    return np.cumsum(breaks)


def _every(path_m: Array, part: NDArray[np.int64], spacing_m: float) -> Rows:
    """Nodes at least ``spacing_m`` of path apart; every part has one."""
    chosen = [0]
    for node in range(1, len(path_m)):
        far = path_m[node] - path_m[chosen[-1]] >= spacing_m
        if far or part[node] != part[chosen[-1]]:
            chosen.append(node)
    return np.array(chosen, np.intp)


class _NodeWalls(NamedTuple):
    """What a node sees."""

    walls_m: Array
    """Horizontal positions of the points on walls in the map, axis by axis [m], (2, N)."""
    layers: Layers
    """Of all points."""


def _walls_of(graph: PoseGraph, views: NodeRangeImages, node: int) -> _NodeWalls:
    """The walls that a node sees, thinned."""
    p_body = views.ends(node).reshape(-1, 3)
    p_body = p_body[:: max(1, len(p_body) // PLACES.points)]
    T_map_body = graph.T_map_body[node]
    p_map = T_map_body @ p_body
    height = p_map[:, 2] - T_map_body.t[2]
    is_wall = (height > -PLACES.below_m) & (height < PLACES.above_m)
    return _NodeWalls(np.compress(is_wall, p_map.T[:2], axis=1), layers_of(height))


def _image_of(seen: Collection[_NodeWalls], t_m: Array) -> DensityImage:
    """The image of a place at ``t_m`` in the map, (3,)."""
    walls_m = np.concatenate([one.walls_m for one in seen], axis=1)
    layers = np.sum([one.layers for one in seen], axis=0)
    return make_density_image((walls_m - t_m[:2, None]).T, layers)
