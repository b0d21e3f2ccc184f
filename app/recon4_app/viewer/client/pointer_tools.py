"""Pointer tools: picking edges and points, measuring."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np

from recon4.geometry.se3 import Array
from recon4.slam2d.grid_files import TrinaryMap
from recon4_app.viewer.client.captions import (
    Facts,
    cell_facts,
    edge_facts,
    gnss_facts,
    measurement_facts,
    measurements_csv,
    point_facts,
)
from recon4_app.viewer.client.panels import Panel, Update
from recon4_app.viewer.client.show import Screen
from recon4_app.viewer.client.view import Position, ViewState
from recon4_app.viewer.cloud.pick import Ray, pick_cell, pick_edge, pick_gnss, pick_point
from recon4_app.viewer.scene.build import as_position, crosses
from recon4_app.viewer.scene.nodes import LinesNode, Node
from recon4_app.viewer.scene.source import ProjectSource
from recon4_app.viewer.tuning import POINTER_COLORS, SCENE, VIEWS


class PointerTools:
    """Picking and measuring of one client, in its thread."""

    def __init__(
        self,
        source: ProjectSource,
        screen: Screen,
        panel: Panel,
        *,
        project: str,
        change: Callable[[Update], None],
    ) -> None:
        self._source, self._screen, self._panel = source, screen, panel
        self._project, self._change = project, change
        self._measuring = False
        self._first: Position | None = None
        self._last: Position | None = None
        self._edge: Array | None = None
        self._news = False

    def news(self) -> bool:
        """Whether there is something new to draw since the last call."""
        news, self._news = self._news, False
        return news

    def nodes(self) -> list[Node]:
        """Nodes of the picked edge or point, and of the first point of a measurement."""
        nodes: list[Node] = []
        if self._edge is not None:
            nodes.append(_mark("/picked/edge", self._edge[None], POINTER_COLORS.picked_color))
        if self._last is not None:
            nodes.append(
                _mark("/picked/point", crosses(np.array([self._last])), POINTER_COLORS.picked_color)
            )
        if self._first is not None:
            nodes.append(
                _mark("/picked/first", crosses(np.array([self._first])), SCENE.measured_color)
            )
        return nodes

    def report(self, view: ViewState) -> None:
        """List the measurements of a view."""
        facts = [
            measurement_facts(n, points, view.say) for n, points in enumerate(view.measurements, 1)
        ]
        self._panel.show_measured(facts, measuring=self._measuring)

    def click(self, ray: Ray, view: ViewState) -> None:
        """Handle a click or tap on the scene."""
        ray = replace(ray, point_m=view.point_size_m)
        if self._measuring:
            self._measure(ray, view)
        elif not (self._picked_edge(ray, view) or self._picked_gnss(ray, view)):
            self._pick_point(ray, view)
        self._news = True

    def command(self, name: str, view: ViewState) -> None:
        """Handle a button or a key."""
        match name:
            case "measure":
                self._measuring, self._first = not self._measuring, None
            case "stop":
                self._measuring, self._first = False, None
                self._change(lambda view: replace(view, stretch=None))
            case "keep point" if self._last is not None:
                self._keep((self._last,))
            case "undo measure":
                self._change(lambda view: replace(view, measurements=view.measurements[:-1]))
            case "csv":
                self._screen.download("measurements.csv", measurements_csv(view.measurements))
        self._news = True

    def _measure(self, ray: Ray, view: ViewState) -> None:
        point = self._pick_point(ray, view)
        if point is None:
            return
        if self._first is None:
            self._first = point
        else:
            self._keep((self._first, point))
            self._first = None

    def _keep(self, points: tuple[Position, ...]) -> None:
        self._change(
            lambda view: replace(
                view, measurements=(*view.measurements, points)[-VIEWS.max_measurements :]
            )
        )

    def _picked_edge(self, ray: Ray, view: ViewState) -> bool:
        table = self._source.content.edges
        row = None if table is None else pick_edge(table, view, ray)
        if table is None or row is None:
            self._edge = None
            return False
        self._edge, self._last = table.graph.T_map_body.t[table.ends[row]], None
        self._show_facts(edge_facts(table, row, self._project, say=view.say))
        return True

    def _picked_gnss(self, ray: Ray, view: ViewState) -> bool:
        content = self._source.content
        row = None if content.gnss is None else pick_gnss(content.gnss, view, ray)
        if content.gnss is None or row is None:
            return False
        self._last = as_position(content.gnss.p_map[row])
        began_ns = 0 if content.trajectory is None else int(content.trajectory.t_ns[0])
        self._show_facts(gnss_facts(content.gnss, row, began_ns=began_ns, say=view.say))
        return True

    def _pick_point(self, ray: Ray, view: ViewState) -> Position | None:
        """Pick a point of the map, or a place of a 2-D map; returns where it is."""
        content = self._source.content
        if content.cloud is None and content.plan is not None:
            return self._pick_cell(ray, content.plan, view)
        cloud = content.cloud and content.cloud.on(view.surface)
        point = None if cloud is None else pick_point(cloud, ray)
        self._last = None if point is None else point.p_map
        if point is None or content.cloud is None:
            self._panel.show_picked(None)
            return None
        facts = point_facts(
            point,
            content,
            crs=self._source.crs_coordinates(np.array([point.p_map])),
            say=view.say,
        )
        self._show_facts(facts)
        return point.p_map

    def _pick_cell(self, ray: Ray, plan: TrinaryMap, view: ViewState) -> Position | None:
        cell = pick_cell(plan, ray)
        self._last = None if cell is None else cell.p_map
        if cell is None:
            self._panel.show_picked(None)
        else:
            self._show_facts(cell_facts(cell, view.say))
        return self._last

    def _show_facts(self, facts: Facts) -> None:
        """Show facts in the panel; on a phone, where the panel is collapsed, over the map too."""
        self._panel.show_picked(facts)
        if self._screen.phone:
            text = "; ".join(f"{label}: {value}" for label, value in facts.rows)
            self._screen.notify(facts.title, text)


def _mark(path: str, segments_m: Array, rgb: tuple[int, int, int]) -> LinesNode:
    origin = segments_m[0, 0]
    segments = (segments_m - origin).astype(np.float32)
    return LinesNode(path=path, position_m=origin, segments=segments, rgb=rgb, width_px=5.0)
