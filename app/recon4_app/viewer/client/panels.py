"""The control panel: widgets change an immutable `ViewState`.

With `show` and `widget_values` the only viser modules.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass, replace
from typing import Any, get_args

import viser

from recon4.locales.texts import Texts
from recon4_app.viewer.client.captions import Facts
from recon4_app.viewer.client.legend import Legend
from recon4_app.viewer.client.legend_html import facts_html, legend_html
from recon4_app.viewer.client.view import EdgeColor, Points, ViewState
from recon4_app.viewer.client.widget_values import only_fitting_values
from recon4_app.viewer.cloud.palette import Palette, Range
from recon4_app.viewer.hotkeys import HOTKEYS
from recon4_app.viewer.scene.build import Content
from recon4_app.viewer.scene.layers import Layer
from recon4_app.viewer.scene.mark import stretch_marks
from recon4_app.viewer.words import word_of

Update = Callable[[ViewState], ViewState]


@dataclass(frozen=True, slots=True)
class PanelCallbacks:
    """Callbacks of the controls."""

    change: Callable[[Update], None]
    command: Callable[[str], None]


@dataclass(frozen=True, slots=True)
class WordList:
    """A closed list of values, each with its word in the language of the panel."""

    label: str
    pairs: tuple[tuple[str, str], ...]
    """Value and word."""

    @property
    def texts(self) -> tuple[str, ...]:
        """The words, in order."""
        return tuple(text for _, text in self.pairs)

    def text(self, value: object) -> str:
        """The word for a value."""
        return next(text for one, text in self.pairs if one == value)

    def value(self, text: object) -> str:
        """The value that a word stands for."""
        return next(one for one, word in self.pairs if word == text)


class Panel:
    """The controls of one client."""

    def __init__(self, gui: viser.GuiApi, callbacks: PanelCallbacks, say: Texts) -> None:
        self._gui, self._callbacks, self._say = gui, callbacks, say
        gui.set_panel_label(say("controls"))
        only_fitting_values(gui)
        self._legend = gui.add_html("", order=0.0)
        self._picked = gui.add_html("", order=0.5)
        self._widgets: dict[str, Any] = {}
        self._folders: dict[str, tuple[object, viser.GuiFolderHandle]] = {}
        self._shown: dict[str, object] = {}
        self._choices: dict[str, WordList] = {}
        self._given: dict[str, object] = {}
        """Values of widgets that the view has, by widget."""
        for key, name in HOTKEYS:
            gui.add_command(say(f"hotkey-{name}"), hotkey=key).on_trigger(self._commanding(name))
        self._measure_folder()

    def offer(self, content: Content, view: ViewState, max_points: int) -> None:
        """Create the folders of controls for the content; unchanged folders stay as they are."""
        if content.cloud is not None:
            offered = (content.colors, content.cloud.tiles.surface, max_points)
            self._fold("points", offered, lambda: self._point_folder(content, view, max_points))
        if content.multiframes is not None:
            frames = len(content.multiframes)
            marks = stretch_marks(content, view)
            self._fold("time", (frames, marks), lambda: self._time_folder(frames, view, marks))
        layers = content.layers
        keys = tuple(layer.key for layer in layers)
        self._fold("layers", keys, lambda: self._layer_folder(layers, view))
        for layer in layers:
            self._set(f"layer {layer.key}", view.shows(layer), layer.label(self._say))

    def show(self, view: ViewState, span: Range) -> None:
        """Set the widgets to a view that was changed by a key or a click.

        A widget whose value the view has already is left alone: what a person has just set there
        may not have reached the view yet.
        """
        values = {
            "color": view.color_by, "palette": view.palette, "size": view.point_size_m,
            "adapt": view.adapt, "low": span.low, "high": span.high, "points": view.points,
            "surface": view.surface, "moment": view.moment, "window": view.window_s,
            "edges": view.edge_color,
        }  # fmt: skip
        for name, value in values.items():
            if self._given.get(name) != value:  # else the browser may have sent a newer one
                self._given[name] = value
                self._set(name, value)

    def explain(self, legend: Legend) -> None:
        """Show the legend."""
        if self._shown.get("legend") != legend:
            self._shown["legend"] = legend
            self._legend.content = legend_html(legend)

    def show_picked(self, facts: Facts | None) -> None:
        """Show the facts of the picked object."""
        self._picked.content = facts_html([facts] if facts else [])

    def show_measured(self, facts: list[Facts], *, measuring: bool) -> None:
        """List the measurements."""
        record = (tuple(facts), measuring)
        if self._shown.get("measured") != record:
            self._shown["measured"] = record
            self._widgets["measured"].content = facts_html(facts)
            name = "stop-measuring" if measuring else "measure-distance"
            self._widgets["measure"].label = self._say(name)

    def _fold(self, name: str, key: object, make: Callable[[], viser.GuiFolderHandle]) -> None:
        before = self._folders.get(name)
        if before is not None:
            if before[0] == key:
                return
            before[1].remove()
        self._folders[name] = (key, make())

    def _set(self, name: str, value: object, label: str | None = None) -> None:
        widget = self._widgets.get(name)
        if widget is None:
            return
        if name in self._choices:
            value = self._choices[name].text(value)
        if widget.value != value:
            widget.value = value
        if label is not None and widget.label != label:
            widget.label = label

    def _bind(self, name: str, widget: Any, update: Callable[[ViewState, Any], ViewState]) -> None:
        """Bind a widget to the view; changes made by the program itself are ignored."""
        self._widgets[name] = widget
        self._given.pop(name, None)
        self._choices.pop(name, None)

        def given(view: ViewState) -> ViewState:
            self._given[name] = self._value(name)
            return update(view, self._given[name])

        @widget.on_update
        def record(event: Any) -> None:
            if event.client_id is not None:
                self._callbacks.change(given)

    def _value(self, name: str) -> Any:
        value = self._widgets[name].value
        return self._choices[name].value(value) if name in self._choices else value

    def _dropdown(
        self,
        name: str,
        choice: WordList,
        *,
        chosen: object,
        update: Callable[[ViewState, Any], ViewState],
    ) -> None:
        """A dropdown of values of the view, which are shown as their words."""
        widget = self._gui.add_dropdown(
            choice.label, choice.texts, initial_value=choice.text(chosen)
        )
        self._bind(name, widget, update)
        self._choices[name] = choice

    def _choice(self, label: str, prefix: str, values: Iterable[str]) -> WordList:
        shown = tuple((value, word_of(prefix, value, self._say)) for value in values)
        return WordList(self._say(label), shown)

    def _button(self, label: str, command: str) -> None:
        button = self._gui.add_button(self._say(label))
        self._widgets[command] = button
        button.on_click(self._commanding(command))

    def _commanding(self, name: str) -> Callable[[Any], None]:
        return lambda _: self._callbacks.command(name)

    def _point_folder(
        self, content: Content, view: ViewState, max_points: int
    ) -> viser.GuiFolderHandle:
        gui, say = self._gui, self._say
        folder = gui.add_folder(say("folder-points"), order=1.0)
        mine = view.color_by if view.color_by in content.colors else content.colors[0]
        with folder:
            self._dropdown(
                "color",
                self._choice("paint-by", "paint", content.colors),
                chosen=mine,
                update=lambda view, value: replace(view, color_by=value),
            )
            self._button("raw-or-normalized", "normalized")
            if content.cloud is not None and content.cloud.tiles.surface == "fitted":
                self._dropdown(
                    "surface",
                    self._choice("points-lie", "lie", ("fitted", "raw", "strays")),
                    chosen=view.surface,
                    update=lambda view, value: replace(view, surface=value),
                )
            self._dropdown(
                "palette",
                self._choice("palette", "palette", get_args(Palette)),
                chosen=view.palette,
                update=lambda view, value: replace(view, palette=value),
            )
            self._bind("low", gui.add_number(say("range-from"), 0.0, step=0.01), self._low)
            self._bind("high", gui.add_number(say("range-to"), 1.0, step=0.01), self._high)
            self._button("range-of-map", "whole range")
            self._bind(
                "size",
                gui.add_slider(say("point-size-m"), 0.005, 0.2, 0.005, view.point_size_m),
                lambda view, value: replace(view, point_size_m=float(value)),
            )
            self._detail_widgets(view, max_points)
        return folder

    def _detail_widgets(self, view: ViewState, max_points: int) -> None:
        thousands = max(max_points // 1000, 100)
        start = min(view.detail // 1000 or thousands, thousands)
        label = self._say("most-points")
        slider = self._gui.add_slider(label, 50, thousands, 50, max(start, 50))
        self._bind("detail", slider, lambda view, value: replace(view, detail=int(value) * 1000))
        self._bind(
            "adapt",
            self._gui.add_checkbox(self._say("fewer-if-slow"), view.adapt),
            lambda view, value: replace(view, adapt=bool(value)),
        )

    def _low(self, view: ViewState, value: float) -> ViewState:
        return view.with_range(Range(float(value), float(self._widgets["high"].value)))

    def _high(self, view: ViewState, value: float) -> ViewState:
        return view.with_range(Range(float(self._widgets["low"].value), float(value)))

    def _time_folder(
        self, multiframes: int, view: ViewState, marks: tuple[tuple[int, str], ...]
    ) -> viser.GuiFolderHandle:
        gui, say, last = self._gui, self._say, max(multiframes - 1, 1)
        folder = gui.add_folder(say("folder-multiframes"), order=2.0)
        with folder:
            self._dropdown(
                "points",
                self._choice("show-points", "points", get_args(Points)),
                chosen=view.points,
                update=lambda view, value: replace(view, points=value),
            )
            self._bind(
                "moment",
                gui.add_slider(
                    say("one-multiframe"), 0, last, 1, min(view.moment, last), marks=marks or None
                ),
                lambda view, value: replace(view, moment=int(value)),
            )
            self._bind(
                "window",
                gui.add_slider(say("window-s"), 0.0, 30.0, 0.5, min(view.window_s, 30.0)),
                lambda view, value: replace(view, window_s=float(value)),
            )
            self._button("play-or-stop", "play")
        return folder

    def _layer_folder(self, layers: tuple[Layer, ...], view: ViewState) -> viser.GuiFolderHandle:
        folder = self._gui.add_folder(self._say("folder-layers"), order=3.0)
        with folder:
            self._dropdown(
                "edges",
                self._choice("edges-by", "edges", get_args(EdgeColor)),
                chosen=view.edge_color,
                update=lambda view, value: replace(view, edge_color=value),
            )
            for layer in layers:
                box = self._gui.add_checkbox(layer.label(self._say), view.shows(layer))
                self._bind(f"layer {layer.key}", box, self._switching(layer.key))
        return folder

    def _switching(self, key: str) -> Callable[[ViewState, Any], ViewState]:
        return lambda view, value: view.with_layer(key, on=bool(value))

    def _measure_folder(self) -> None:
        with self._gui.add_folder(self._say("folder-measure"), order=4.0):
            self._button("measure-distance", "measure")
            self._button("keep-picked", "keep point")
            self._widgets["measured"] = self._gui.add_html("")
            self._button("graph-csv", "csv")
            self._button("undo-last", "undo measure")
