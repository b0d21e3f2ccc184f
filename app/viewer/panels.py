"""Widgets in, one immutable `View` out; and the legend. With `show` the only viser module."""

from __future__ import annotations

import html
from collections.abc import Callable
from dataclasses import replace
from typing import get_args

import viser

from app.viewer.layers import Layer
from app.viewer.palette import Palette, Rgb, table
from app.viewer.scene import Content, Legend, View


class Panel:
    """The controls of one client."""

    def __init__(
        self, gui: viser.GuiApi, content: Content, *, on_change: Callable[[View], None]
    ) -> None:
        self._gui = gui
        self._on_change = on_change
        self._legend = gui.add_html("", order=0.0)
        self._folders: list[viser.GuiFolderHandle] = []
        self._chosen: dict[str, bool] = {}
        self.view = View()
        self.offer(content)

    def offer(self, content: Content) -> None:
        """Offer what the content has; what was chosen before stays chosen."""
        for folder in self._folders:
            folder.remove()
        for layer in content.layers:
            self._chosen.setdefault(layer.key, layer.shown)
        if content.colors and self.view.color_by not in content.colors:
            self.view = replace(self.view, color_by=content.colors[0])
        self.view = replace(self.view, layers=self._on())
        self._folders = [self._layer_folder(content.layers)]
        if content.colors:
            self._folders.insert(0, self._color_folder(content))

    def explain(self, legend: Legend) -> None:
        """Show what the colors mean."""
        self._legend.content = legend_html(legend)

    def _color_folder(self, content: Content) -> viser.GuiFolderHandle:
        folder = self._gui.add_folder("Points", order=1.0)
        with folder:
            color = self._gui.add_dropdown(
                "Color by", content.colors, initial_value=self.view.color_by
            )
            palette = self._gui.add_dropdown(
                "Palette", get_args(Palette), initial_value=self.view.palette
            )
            size = self._gui.add_slider(
                "Point size, m",
                min=0.005,
                max=0.2,
                step=0.005,
                initial_value=self.view.point_size_m,
            )

        def publish(_: object) -> None:
            self._change(
                color_by=color.value, palette=palette.value, point_size_m=float(size.value)
            )

        color.on_update(publish)
        palette.on_update(publish)
        size.on_update(publish)
        return folder

    def _layer_folder(self, layers: tuple[Layer, ...]) -> viser.GuiFolderHandle:
        folder = self._gui.add_folder("Layers", order=2.0)
        with folder:
            for layer in layers:
                self._add_box(layer)
        return folder

    def _add_box(self, layer: Layer) -> None:
        box = self._gui.add_checkbox(_counted(layer), self._chosen[layer.key])

        def publish(_: object) -> None:
            self._chosen[layer.key] = box.value
            self._change(layers=self._on())

        box.on_update(publish)

    def _on(self) -> frozenset[str]:
        return frozenset(key for key, on in self._chosen.items() if on)

    def _change(self, **changes: object) -> None:
        self.view = replace(self.view, **changes)  # type: ignore[arg-type]
        self._on_change(self.view)


def legend_html(legend: Legend) -> str:
    """The legend as HTML; viser does not escape it, so every word is escaped here."""
    rows = [_swatch(_counted(layer), layer.rgb, line=True) for layer in legend.layers]
    points = ""
    if legend.color_by is not None:
        points = f"<b>Points by {html.escape(legend.color_by)}</b>{_scale(legend)}"
        points += f"<div>{_count(legend.points)} of {_count(legend.points_in_map)} points</div>"
    cell = f"<div>Grid cell {legend.grid_cell_m:g} m, map frame, z up</div>"
    style = "padding:0.6em 1em;font-size:0.85em;line-height:1.5"
    return f'<div style="{style}">{points}<b>Lines</b>{"".join(rows)}{cell}</div>'


def _scale(legend: Legend) -> str:
    if legend.color_by == "sensor":
        return "".join(_swatch(name, rgb, line=False) for name, rgb in legend.sensors)
    stops = ",".join(_css(tuple(rgb)) for rgb in table(legend.palette)[::15].tolist())
    bar = f"height:10px;border-radius:2px;background:linear-gradient(to right,{stops})"
    ends = "display:flex;justify-content:space-between;gap:1em"
    return (
        f'<div style="{bar}"></div><div style="{ends}"><span>{legend.span.low:.4g}</span>'
        f"<span>{html.escape(legend.unit)}</span><span>{legend.span.high:.4g}</span></div>"
    )


def _swatch(words: str, rgb: Rgb, *, line: bool) -> str:
    size = "width:18px;height:3px" if line else "width:10px;height:10px"
    mark = f"display:inline-block;vertical-align:middle;margin-right:8px;{size}"
    return f'<div><span style="{mark};background:{_css(rgb)}"></span>{html.escape(words)}</div>'


def _css(rgb: tuple[int, ...]) -> str:
    return f"rgb({rgb[0]},{rgb[1]},{rgb[2]})"


def _counted(layer: Layer) -> str:
    return f"{layer.words} ({_count(layer.count)})" if layer.count else layer.words


def _count(number: int) -> str:
    return f"{number:,}".replace(",", "\u202f")
