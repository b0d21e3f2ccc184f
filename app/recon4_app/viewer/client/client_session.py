"""One client: a thread that keeps the client's screen up to date.

Every event (the camera moves, a setting changes, a stage ends) only wakes the thread, which then
reads the newest state: the latest request wins, and requests do not queue up. Clicks and keys are
kept in order, the newest few: a client that sends thousands delays nobody else, because viser's own
threads, which all clients have in common, only take notice of them.

Its capacity is not known beforehand: without a graphics card it draws some 400 000 points a second,
with one it draws millions at once. So the budget begins small, and doubles as long as the browser
responds quickly.
"""

from __future__ import annotations

import logging
import threading
from collections import deque
from collections.abc import Callable
from dataclasses import replace
from typing import Any, get_args

import numpy as np

from recon4.errors import Recon4Error
from recon4.mapping.tiles import Surface
from recon4_app.viewer.client.legend import legend, shows_preview, span_of
from recon4_app.viewer.client.panels import Panel, PanelCallbacks
from recon4_app.viewer.client.pointer_tools import PointerTools
from recon4_app.viewer.client.show import Screen
from recon4_app.viewer.client.view import ViewState, stretch_from_text, view_from_json
from recon4_app.viewer.cloud.detail import Detail
from recon4_app.viewer.cloud.pick import Ray
from recon4_app.viewer.scene.build import Content, bounds, describe
from recon4_app.viewer.scene.mark import stretch_bounds, stretch_nodes, stretch_positions
from recon4_app.viewer.scene.nodes import Node, PointsNode
from recon4_app.viewer.scene.source import ProjectSource
from recon4_app.viewer.tuning import CLIENTS, POINT_BUDGET
from recon4_app.viewer.words import known_language, words

log = logging.getLogger(__name__)


class ClientSession:
    """One client of the viewer."""

    def __init__(self, client: Any, source: ProjectSource, project: str, *, points: int) -> None:
        self._source, self._project = source, project
        self._screen = Screen(client, project, begins_at=bounds(source.content))
        self._most = min(points, POINT_BUDGET.phone_points) if self._screen.phone else points
        self._budget = PointBudget(self._most)
        self._lock = threading.Lock()
        self._wake, self._over = threading.Event(), threading.Event()
        self._view, self._shown, self._kept = ViewState(), ViewState(), ViewState()
        self._content = Content()
        self._playing = False
        self._actions: deque[Callable[[], None]] = deque(maxlen=CLIENTS.kept_actions)
        self._thread = threading.Thread(target=self._run, daemon=True)
        self._thread.start()

    def refresh(self) -> None:
        """Wake the thread: something may have changed."""
        self._wake.set()

    def leave(self) -> None:
        """End the session: the client has disconnected."""
        self._over.set()
        self._wake.set()

    def _run(self) -> None:
        kept, answer_s = self._screen.kept_view(CLIENTS.kept_view_timeout_s)
        self._budget.began(answer_s)
        language = known_language(self._screen.language(CLIENTS.kept_view_timeout_s))
        self._kept = view_from_json(kept) or ViewState()
        self._view = self._kept = replace(self._kept, language=language)
        callbacks = PanelCallbacks(self._change, self._press)
        self._panel = Panel(self._screen.gui, callbacks, words(language))
        self._pointer = PointerTools(
            self._source, self._screen, self._panel, project=self._project, change=self._change
        )
        self._detail = Detail(self._screen, newer=self._wake.is_set, over=self._over.wait)
        self._screen.on_camera(self._wake.set)
        self._screen.on_click(self._click)
        self._wake.set()
        while not self._over.is_set():
            self._wake.wait(CLIENTS.play_s if self._playing else None)
            if self._playing and not self._wake.is_set():
                self._next_multiframe()
            self._wake.clear()
            try:
                while self._actions:
                    self._actions.popleft()()
                self._pass()
            except Recon4Error as error:
                log.warning("%s", error)
            except Exception:  # without a log entry nothing would explain a frozen screen
                log.exception("a pass failed; the next one tries again")

    def _pass(self) -> None:
        view, content = self._view, self._source.content
        changed = view is not self._shown or content is not self._content or self._pointer.news()
        if changed:
            self._show(content, view)
        span = span_of(content, view)
        self._budget.allow(min(view.detail or self._most, self._most))
        budget = self._budget.points if view.adapt else view.detail or self._most
        cloud = content.cloud and content.cloud.on(view.surface)
        done = self._detail.refine(cloud, view, span, budget=min(budget, self._most))
        self._panel.explain(legend(content, view, points=self._detail.points))
        if view != self._kept:
            self._kept = view
            self._screen.keep_view(view.to_json())
        if done and view.adapt and content.cloud is not None and not self._budget.settled:
            self._try_more()

    def _try_more(self) -> None:
        """Measure the response time of the browser; adapt the number of points."""
        before = self._budget.points
        self._budget.record(self._screen.answers_within_s(POINT_BUDGET.hold_s))
        if self._budget.points != before:
            self._wake.set()

    def _show(self, content: Content, view: ViewState) -> None:
        is_new = content is not self._content
        if is_new or view.stretch != self._shown.stretch:
            self._panel.offer(content, view, self._most)
        if is_new and (content.cloud is not None or content.trajectory is not None):
            self._screen.follow(bounds(content))
        self._shown, self._content = view, content
        points = [*_preview(content, view), *_window(content, view)]
        marked = stretch_nodes(content, view)
        self._screen.show_nodes(
            [*describe(content, view), *marked, *self._pointer.nodes(), *points]
        )
        with self._lock:
            if view is self._view:  # else the next pass shows what a person set meanwhile
                self._panel.show(view, span_of(content, view))
        self._pointer.report(view)

    def _change(self, update: Callable[[ViewState], ViewState]) -> None:
        with self._lock:
            self._view = update(self._view)
        self._wake.set()

    def _click(self, ray: Ray) -> None:
        self._actions.append(lambda: self._pointer.click(ray, self._view))
        self._wake.set()

    def _press(self, name: str) -> None:
        self._actions.append(lambda: self._command(name))
        self._wake.set()

    def _next_multiframe(self) -> None:
        frames = self._content.multiframes
        if frames is not None:
            self._change(lambda view: replace(view, moment=(view.moment + 1) % len(frames)))

    def _command(self, name: str) -> None:
        match name:
            case "normalized":
                self._change(lambda view: replace(view, color_by=_other_intensity(view)))
            case "surface":
                self._change(lambda view: replace(view, surface=_other_surface(view)))
            case "whole range":
                self._change(lambda view: view.with_range(None))
            case "play":
                self._playing = not self._playing
                if self._playing and self._view.points == "map":
                    self._change(lambda view: replace(view, points="map and multiframe"))
            case "fit" | "above" | "south" | "east":
                self._screen.look_at(bounds(self._content), DIRECTIONS[name])
            case "narrow":
                self._screen.toggle_narrow()
            case "stretch":
                self._go_to_stretch()
            case _:
                self._pointer.command(name, self._view)

    def _go_to_stretch(self) -> None:
        """Mark the stretch that the page was asked for, or the marked one again, and fly there."""
        asked = stretch_from_text(self._screen.take_asked_stretch(CLIENTS.kept_view_timeout_s))
        stretch, content = asked or self._view.stretch, self._source.content
        if stretch is None:
            return
        p_map = stretch_positions(content, stretch)
        if not len(p_map):
            say = self._view.say
            self._screen.notify(
                say("not-in-this-map"), say("no-position", stretch=stretch.text(say))
            )
            return
        frames, moment = content.multiframes, self._view.moment
        if frames is not None and stretch.span_s is not None:
            moment = frames.at_time(stretch.span_s[0])
        self._change(lambda view: replace(view, stretch=stretch, moment=moment))
        self._screen.look_at(stretch_bounds(p_map))


DIRECTIONS = {
    "fit": np.array([0.0, -0.75, 0.75]),
    "above": np.array([0.0, -0.001, 1.1]),
    "south": np.array([0.0, -1.1, 0.0]),
    "east": np.array([1.1, 0.0, 0.0]),
}
"""Camera positions relative to the center of the map, in units of its size."""


def _other_intensity(view: ViewState) -> Any:
    raw = view.color_by == "normalized intensity"
    return "raw intensity" if raw else "normalized intensity"


def _other_surface(view: ViewState) -> Surface:
    every: tuple[Surface, ...] = get_args(Surface)
    return every[(every.index(view.surface) + 1) % len(every)]


def _preview(content: Content, view: ViewState) -> list[PointsNode]:
    """The preview of the walk, while there is no map."""
    line = content.trajectory
    if content.preview is None or line is None or not shows_preview(content, view):
        return []
    return content.preview.nodes(line, palette=view.palette, size_m=view.point_size_m)


def _window(content: Content, view: ViewState) -> list[Node]:
    """The selected multiframes: over the map in one color, alone in the view's colors."""
    frames, line = content.multiframes, content.trajectory
    if view.points == "map" or frames is None or line is None:
        return []
    window = frames.read(view.moment, view.window_s, line)
    if window is None:
        return []
    color_by = view.color_by if view.points == "multiframe" else None
    span = view.range_of(view.color_by)
    return [window.node(color_by, palette=view.palette, span=span, size_m=1.5 * view.point_size_m)]


class PointBudget:
    """Adapts the number of points of one browser to its response time."""

    def __init__(self, most: int) -> None:
        self._calm_s = 0.0
        self._most = -1
        self.allow(most)

    def began(self, answer_s: float | None) -> None:
        """Set the response time when there is nothing to draw (the round trip)."""
        self._calm_s = answer_s or 0.0

    def allow(self, most: int) -> None:
        """Set the limit of the person or the server; a new limit resets the adaptation."""
        if most != self._most:
            self._most = self._ceiling = most
            self.points = min(POINT_BUDGET.first_points, most)
            self.settled = self.points == most

    def record(self, answer_s: float | None) -> None:
        """Adapt to a response time (None = too long) measured with `points` on screen."""
        before = self.points
        if answer_s is None:
            self.points = max(before // 2, min(POINT_BUDGET.fewest_points, self._most))
        elif answer_s - self._calm_s > POINT_BUDGET.slow_s:
            self._ceiling = max(before // 2, min(POINT_BUDGET.fewest_points, self._most))
            self.points = self._ceiling
        elif answer_s - self._calm_s < POINT_BUDGET.quick_s:
            self.points = min(before * 2, self._ceiling)
        self.settled = self.points == before
