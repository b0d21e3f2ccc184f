"""Sends the parts of the map that a camera needs to one screen, coarse ones first."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace

from recon4_app.viewer.client.show import Screen
from recon4_app.viewer.client.view import ColorBy, ViewState
from recon4_app.viewer.cloud.lod import Chunk, choose
from recon4_app.viewer.cloud.palette import Palette, Range
from recon4_app.viewer.cloud.parts import Cloud
from recon4_app.viewer.scene.nodes import PointsNode
from recon4_app.viewer.tuning import DETAIL


@dataclass(frozen=True, slots=True)
class Style:
    """How points are drawn; compared instead of a million colors."""

    color_by: ColorBy
    palette: Palette
    span: Range
    size_m: float


class Detail:
    """The map on one screen."""

    def __init__(
        self, screen: Screen, *, newer: Callable[[], bool], over: Callable[[float], bool]
    ) -> None:
        """Begin with nothing.

        Args:
            screen: Where to draw.
            newer: Whether something newer is wanted.
            over: Waits for the given seconds; whether the client has left.
        """
        self._screen = screen
        self._newer, self._over = newer, over
        self._cloud: Cloud | None = None
        self.points = 0
        """Points on screen, or being sent."""

    def refine(self, cloud: Cloud | None, view: ViewState, span: Range, *, budget: int) -> bool:
        """Send the missing parts; whether all were sent (not if a newer request came)."""
        if cloud is not self._cloud:
            self._screen.forget_map()
            self._cloud, self.points = cloud, 0
        if cloud is None:
            return True
        self._screen.set_map_visible(view.points != "multiframe")
        chosen = choose(cloud.boxes, self._screen.camera, budget - len(cloud.base))
        wanted = {_path(cloud, chunk) for chunk in (None, *chosen)}
        self._screen.hide_points_except(wanted, budget)
        self.points = len(cloud.base) + sum(int(cloud.boxes.sizes[t][k]) for t, k in chosen)
        style = Style(view.color_by, view.palette, span, view.point_size_m)
        for batch in self._batches(cloud, [None, *chosen], style):
            while self._screen.behind > DETAIL.max_behind:
                if self._over(0.002):
                    return False
            self._screen.show_points(batch, style)
            if self._newer():
                return False
        return True

    def _batches(
        self, cloud: Cloud, chunks: list[Chunk | None], style: Style
    ) -> Iterator[list[PointsNode]]:
        """Parts not yet on screen in this style, some at a time."""
        weight, batch = 0.0, []
        for chunk in chunks:
            path = _path(cloud, chunk)
            if self._screen.has(path, style):
                continue
            before = self._screen.points_at(path)
            node = _node(cloud, chunk, style, before=before)
            weight += len(node.p_node) / (
                DETAIL.color_batch_points if before else DETAIL.batch_points
            )
            batch.append(node)
            if weight >= 1.0:
                yield batch
                weight, batch = 0.0, []
        if batch:
            yield batch


def _node(
    cloud: Cloud, chunk: Chunk | None, style: Style, *, before: PointsNode | None
) -> PointsNode:
    rgb = cloud.painted(chunk, style.color_by, span=style.span, palette=style.palette)
    if before is not None:
        return replace(before, rgb=rgb, size_m=style.size_m)
    part = cloud.base if chunk is None else cloud.part(chunk)
    return PointsNode(
        path=_path(cloud, chunk),
        position_m=part.origin_m,
        p_node=part.p_part,
        rgb=rgb,
        size_m=style.size_m,
    )


def _path(cloud: Cloud, chunk: Chunk | None) -> str:
    return f"/map/{cloud.name(chunk)}"
