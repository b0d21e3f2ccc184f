"""The marked stretch of the walk: where it lies, and how it is drawn."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from recon4.findings.walk_record import positions_along
from recon4.geometry.se3 import Array
from recon4_app.viewer.client.view import Stretch, ViewState
from recon4_app.viewer.scene.build import Bounds, Content, crosses
from recon4_app.viewer.scene.nodes import LabelNode, LinesNode, Node
from recon4_app.viewer.tuning import MARK, SCENE


def stretch_positions(content: Content, stretch: Stretch) -> Array:
    """Positions along a stretch in the map [m], (N, 3); none if the walk does not have it.

    They are those of the newest trajectory; without one, or without a time, the stated places.
    """
    line = content.trajectory
    if stretch.span_s is None or line is None or not len(line):
        return np.array(stretch.places).reshape(-1, 3)
    return positions_along(line, stretch.span_s, most=SCENE.max_poses)


def stretch_nodes(content: Content, view: ViewState) -> Iterator[Node]:
    """A thick line along the stretch, crosses at its ends, and its times."""
    stretch = view.stretch
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
        rgb=MARK.mark_color,
        width_px=MARK.mark_width_px,
    )
    middle = p_map[len(p_map) // 2]
    yield LabelNode(path="/labels/stretch", position_m=middle, text=stretch.text(view.say))


def stretch_marks(content: Content, view: ViewState) -> tuple[tuple[int, str], ...]:
    """Multiframes at both ends of a stretch, with their captions: the marks of the slider."""
    stretch, frames = view.stretch, content.multiframes
    if stretch is None or stretch.span_s is None or frames is None:
        return ()
    start_s, end_s = stretch.span_s
    duration_s = (frames.t_mid_ns[-1] - frames.t_mid_ns[0]) / 1e9
    if start_s > duration_s:
        return ()
    first, last = (frames.at_time(min(max(s, 0.0), duration_s)) for s in (start_s, end_s))
    text = stretch.text(view.say)
    return ((first, text),) if first == last else ((first, text), (last, ""))


def stretch_bounds(p_map: Array) -> Bounds:
    """The box around the positions of a stretch, (N, 3) with N > 0 [m]."""
    return Bounds(p_map.min(axis=0), p_map.max(axis=0))
