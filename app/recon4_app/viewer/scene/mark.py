"""The marked stretch of the walk: where it lies, and how it is drawn."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from recon4.geometry.se3 import Array
from recon4_app.viewer.client.view import Stretch
from recon4_app.viewer.cloud.palette import Rgb
from recon4_app.viewer.scene.build import MAX_POSES, Bounds, Content, crosses
from recon4_app.viewer.scene.nodes import LabelNode, LinesNode, Node

MARK_COLOR: Rgb = (255, 64, 160)
MARK_WIDTH_PX = 7.0
"""Of the stretch, over the line of the trajectory."""
_MAX_S = 1e9
"""Later times are not in nanoseconds of 64 bits [s]."""


def stretch_positions(content: Content, stretch: Stretch) -> Array:
    """Positions along a stretch in the map [m], (N, 3); none if the walk does not have it.

    They are those of the newest trajectory; without one, or without a time, the stated places.
    """
    line = content.trajectory
    if stretch.span_s is None or line is None or not len(line):
        return np.array(stretch.places).reshape(-1, 3)
    offsets_s = np.clip(stretch.span_s, 0.0, _MAX_S)
    ends_ns = line.t_ns[0] + np.rint(1e9 * offsets_s).astype(np.int64)
    if ends_ns[0] > line.t_ns[-1]:
        return np.empty((0, 3))
    ends_ns = np.minimum(ends_ns, line.t_ns[-1])
    between = line.T_a_b.t[(line.t_ns > ends_ns[0]) & (line.t_ns < ends_ns[1])]
    first, last = line.at(ends_ns).t
    return np.concatenate([[first], between[:: max(1, -(-len(between) // MAX_POSES))], [last]])


def stretch_nodes(content: Content, stretch: Stretch | None) -> Iterator[Node]:
    """A thick line along the stretch, crosses at its ends, and its times."""
    if stretch is None:
        return
    p_map = stretch_positions(content, stretch)
    if not len(p_map):
        return
    marks = [crosses(p_map[[0, -1]])]
    if stretch.span_s is not None:
        marks.append(np.stack([p_map[:-1], p_map[1:]], axis=1))
    yield LinesNode(
        path="/stretch",
        position_m=p_map[0],
        segments=(np.concatenate(marks) - p_map[0]).astype(np.float32),
        rgb=MARK_COLOR,
        width_px=MARK_WIDTH_PX,
    )
    middle = p_map[len(p_map) // 2]
    yield LabelNode(path="/labels/stretch", position_m=middle, text=stretch.text)


def stretch_bounds(p_map: Array) -> Bounds:
    """The box around the positions of a stretch, (N, 3) with N > 0 [m]."""
    return Bounds(p_map.min(axis=0), p_map.max(axis=0))
