"""One client: a thread of its own that keeps the client's screen equal to what it asked for.

Whatever happens (the camera moves, a switch is thrown, a stage ends) only wakes the thread, which
then looks at the newest of everything: the latest wish wins, and none piles up.
"""

from __future__ import annotations

import logging
import threading
from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np

from app.viewer.client.legend import legend, shows_preview, span_of
from app.viewer.client.panels import Panel, PanelCallbacks
from app.viewer.client.point_budget import HOLD_S, PHONE_POINTS, PointBudget
from app.viewer.client.pointer_tools import PointerTools
from app.viewer.client.show import Screen
from app.viewer.client.view import ViewState, view_from_json
from app.viewer.cloud.detail import Detail
from app.viewer.scene.build import Content, bounds, describe
from app.viewer.scene.nodes import Node, PointsNode
from app.viewer.scene.source import ProjectSource
from recon4.errors import Recon4Error

log = logging.getLogger(__name__)

GREETING_S = 1.0
"""So long the browser is given to say which view it kept [s]."""
PLAY_S = 0.2
"""While it plays a multiframe is shown so long [s]."""


class ClientSession:
    """One client of the viewer."""

    def __init__(self, client: Any, source: ProjectSource, project: str, *, points: int) -> None:
        self._source, self._project = source, project
        self._screen = Screen(client, project, begins_at=bounds(source.content))
        self._most = min(points, PHONE_POINTS) if self._screen.phone else points
        self._pace = PointBudget(self._most)
        self._lock = threading.Lock()
        self._wake, self._over = threading.Event(), threading.Event()
        self._view, self._shown, self._kept = ViewState(), ViewState(), ViewState()
        self._content = Content()
        self._playing = False
        self._thread = threading.Thread(target=self._run, daemon=True)
        self._thread.start()

    def refresh(self) -> None:
        """Look at the newest of everything."""
        self._wake.set()

    def leave(self) -> None:
        """The client is gone."""
        self._over.set()
        self._wake.set()

    def _run(self) -> None:
        kept, answer_s = self._screen.kept_view(GREETING_S)
        self._pace.began(answer_s)
        self._view = self._kept = view_from_json(kept) or ViewState()
        self._panel = Panel(self._screen.gui, PanelCallbacks(self._change, self._command))
        self._hand = PointerTools(
            self._source, self._screen, self._panel, project=self._project, change=self._change
        )
        self._detail = Detail(self._screen, newer=self._wake.is_set, over=self._over.wait)
        self._screen.on_camera(self._wake.set)
        self._screen.on_click(lambda ray: self._hand.click(ray, self._view))
        self._wake.set()
        while not self._over.is_set():
            self._wake.wait(PLAY_S if self._playing else None)
            if self._playing and not self._wake.is_set():
                self._next_multiframe()
            self._wake.clear()
            try:
                self._pass()
            except Recon4Error as error:
                log.warning("%s", error)
            except Exception:  # a screen that shows nothing new any more would tell nobody why
                log.exception("a pass failed; the next one tries again")

    def _pass(self) -> None:
        view, content = self._view, self._source.content
        changed = view is not self._shown or content is not self._content or self._hand.news()
        if changed:
            self._show(content, view)
        span = span_of(content, view)
        self._pace.allow(min(view.detail or self._most, self._most))
        budget = self._pace.points if view.adapt else view.detail or self._most
        done = self._detail.refine(content.cloud, view, span, budget=min(budget, self._most))
        self._panel.explain(legend(content, view, points=self._detail.points))
        if view != self._kept:
            self._kept = view
            self._screen.keep_view(view.to_json())
        if done and view.adapt and content.cloud is not None and not self._pace.settled:
            self._try_more()

    def _try_more(self) -> None:
        """Ask the browser how it is; more points, or fewer, if that is the answer."""
        before = self._pace.points
        self._pace.record(self._screen.answers_within_s(HOLD_S))
        if self._pace.points != before:
            self._wake.set()

    def _show(self, content: Content, view: ViewState) -> None:
        if content is not self._content:
            self._panel.offer(content, view, self._most)
            if content.cloud is not None or content.trajectory is not None:
                self._screen.follow(bounds(content))
        self._shown, self._content = view, content
        points = [*_preview(content, view), *_window(content, view)]
        self._screen.show([*describe(content, view), *self._hand.nodes(), *points])
        self._panel.show(view, span_of(content, view))
        self._hand.report(view)

    def _change(self, update: Callable[[ViewState], ViewState]) -> None:
        with self._lock:
            self._view = update(self._view)
        self._wake.set()

    def _next_multiframe(self) -> None:
        frames = self._content.multiframes
        if frames is not None:
            self._change(lambda view: replace(view, moment=(view.moment + 1) % len(frames)))

    def _command(self, name: str) -> None:
        match name:
            case "normalized":
                self._change(lambda view: replace(view, color_by=_other_intensity(view)))
            case "whole range":
                self._change(lambda view: view.with_range(None))
            case "play":
                self._playing = not self._playing
                if self._playing and self._view.points == "map":
                    self._change(lambda view: replace(view, points="map and multiframe"))
                self._wake.set()
            case "fit" | "above" | "south" | "east":
                self._screen.look_at(bounds(self._content), DIRECTIONS[name])
            case "narrow":
                self._screen.toggle_narrow()
            case _:
                self._hand.command(name, self._view)
                self._wake.set()


DIRECTIONS = {
    "fit": np.array([0.0, -0.75, 0.75]),
    "above": np.array([0.0, -0.001, 1.1]),
    "south": np.array([0.0, -1.1, 0.0]),
    "east": np.array([1.1, 0.0, 0.0]),
}
"""From where the map is looked at, times its size."""


def _other_intensity(view: ViewState) -> Any:
    raw = view.color_by == "normalized intensity"
    return "raw intensity" if raw else "normalized intensity"


def _preview(content: Content, view: ViewState) -> list[PointsNode]:
    """The walk so far, while there is no map."""
    line = content.trajectory
    if content.preview is None or line is None or not shows_preview(content, view):
        return []
    return content.preview.nodes(line, palette=view.palette, size_m=view.point_size_m)


def _window(content: Content, view: ViewState) -> list[Node]:
    """The multiframes under the scrubber: over the map in one color, alone in the view's colors."""
    frames, line = content.multiframes, content.trajectory
    if view.points == "map" or frames is None or line is None:
        return []
    window = frames.read(view.moment, view.window_s, line)
    if window is None:
        return []
    color_by = view.color_by if view.points == "multiframe" else None
    span = view.range_of(view.color_by)
    return [window.node(color_by, palette=view.palette, span=span, size_m=1.5 * view.point_size_m)]
