"""Pairs of scans of a 2-D laser: a node stands for its scan, and for those around it."""

from __future__ import annotations

import numpy as np

from recon4.geometry.se2 import from_se3
from recon4.geometry.se3 import SE3, Array
from recon4.model.pose_graph import Edge
from recon4.review.source import Source
from recon4.settings.tuning import tuned
from recon4.slam2d.tuning import Loop2dTuning, Slam2dTuning


def keyframe_points(source: Source, node: int, reach: int) -> Array:
    """Returns of a node and of ``reach`` nodes before and after, in its frame [m], (N, 3)."""
    points, _ = source.keyframes.around(node, reach)
    return np.column_stack([points, np.zeros(len(points))])


def align_keyframes(source: Source, nodes: tuple[int, int], predicted: SE3) -> Edge:
    """Register two nodes as the search does, from an operator's predicted pose.

    Args:
        source: The project's latest graph.
        nodes: Rows of the graph.
        predicted: Initial ``T_i_j``; its height, roll and pitch are left out.
    """
    from recon4.slam2d.submaps import SubmapRegistrar

    settings = source.settings
    registrar = SubmapRegistrar(
        source.keyframes,
        settings=tuned(Slam2dTuning, settings.slam2d),
        loops=tuned(Loop2dTuning, settings.loops2d),
    )
    return registrar.register_at(nodes, from_se3(predicted))
