"""How far two nodes may be off relative to each other: a bound along the edges between them."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from recon4.model.pose_graph import PoseGraph, Rows
from recon4.pose_graph.best_paths import PathSums, links_of
from recon4.pose_graph.relations import in_map_axes

_YAW = 2
"""Row of the rotation about the vertical among the tangents of an edge in map axes."""


@dataclass(frozen=True, slots=True, eq=False)
class RelativeBounds:
    """Standard deviations of the relative pose of some nodes, by the best connected edges.

    Errors along a path are taken as fully correlated: standard deviations add up, as they do for a
    drift that grows evenly. Heights of a leveled walk do not drift like that: variances add up.
    """

    horizontal_m: PathSums
    """[m], (K, K)."""
    vertical_m: PathSums | HeightSums
    """[m], (K, K)."""
    yaw_rad: PathSums
    """[rad], (K, K)."""


@dataclass(frozen=True, slots=True, eq=False)
class HeightSums:
    """Standard deviations of which the variances add up."""

    variance: PathSums

    def __getitem__(self, at: tuple[Any, Any]) -> Any:
        """From some places to others, as of an array (K, K)."""
        return np.sqrt(self.variance[at])


def relative_bounds(graph: PoseGraph, nodes: Rows, *, leveled: bool) -> RelativeBounds:
    """Bounds between all pairs of ``nodes`` (K,), along the edges in the graph.

    A rotation error moves what follows by the error times half the extent of the walk.

    Args:
        graph: Its poses turn the covariances of the edges into map axes.
        nodes: Rows of nodes.
        leveled: The vertical is known (by an IMU), so tilts do not add up to heights.
    """
    of = graph.relations
    used = np.flatnonzero(of.in_graph)
    cov_j = np.asarray(np.linalg.inv(of.information[used]), np.float64)
    cov = in_map_axes(graph.T_map_body[of.j[used]], cov_j)
    sd = np.sqrt(np.maximum(np.einsum("eaa->ea", cov), 0.0))
    t_m = graph.T_map_body.t
    arm_m = 0.5 * float(np.linalg.norm(np.ptp(t_m[:, :2], axis=0)))
    tilt = np.linalg.norm(sd[:, :2], axis=1)
    horizontal = sd[:, 3:5].max(axis=1) + arm_m * sd[:, _YAW]
    vertical = sd[:, 5] ** 2 if leveled else sd[:, 5] + arm_m * tilt
    i, j, count = of.i[used], of.j[used], len(graph)
    far_m, height, turn_rad = (
        PathSums.of(links_of(i, j, weight, count=count), nodes)
        for weight in (horizontal, vertical, sd[:, _YAW])
    )
    return RelativeBounds(far_m, HeightSums(height) if leveled else height, turn_rad)
