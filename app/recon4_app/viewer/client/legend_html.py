"""Legend, facts and measurements as HTML. viser does not escape it: all text is escaped here."""

from __future__ import annotations

import html
from collections.abc import Iterable

from recon4_app.viewer.client.captions import Facts
from recon4_app.viewer.client.legend import Legend
from recon4_app.viewer.client.view import CATEGORIES
from recon4_app.viewer.cloud.palette import Palette, Range, Rgb, table
from recon4_app.viewer.cloud.preview import HEIGHTS
from recon4_app.viewer.scene.layers import Layer

BLOCK = "padding:0.6em 1em;font-size:0.85em;line-height:1.5"


def legend_html(legend: Legend) -> str:
    """The legend as HTML."""
    points = ""
    if legend.color_by is not None:
        points = f"<b>Points by {html.escape(legend.color_by)}</b>{_scale(legend)}"
        points += f"<div>{count(legend.points)} of {count(legend.points_in_map)} points</div>"
        if legend.surface:
            points += f"<div>{html.escape(legend.surface)}</div>"
    if legend.preview:
        points += f"<b>Preview by height</b>{_bar(legend.palette, HEIGHTS, 'm above the backpack')}"
        points += "<div>One multiframe per second, until there is a map</div>"
    if legend.multiframes:
        points += f"<div>{html.escape(legend.multiframes)}</div>"
    if legend.edge_color == "verdict":
        lines = "".join(_swatch(counted(row), row.rgb, line=True) for row in legend.layers)
    else:
        bar = _bar("turbo", legend.edge_span, "")
        lines = f"<div>Edges by {html.escape(legend.edge_color)}, gray = not known</div>{bar}"
    cell = f"<div>Grid cell {legend.grid_cell_m:g} m, map frame, z up</div>"
    return f'<div style="{BLOCK}">{points}<b>Lines</b>{lines}{cell}</div>'


def facts_html(facts: Iterable[Facts]) -> str:
    """Tables of facts as HTML, one below the other; empty without any."""
    blocks = []
    for one in facts:
        cells = "".join(
            f"<tr><td style='padding-right:1em;opacity:0.75'>{html.escape(label)}</td>"
            f"<td style='user-select:all'>{html.escape(value)}</td></tr>"
            for label, value in one.rows
        )
        link = ""
        if one.link is not None:
            text, path = map(html.escape, one.link)
            style = "display:inline-block;padding:0.7em 0"
            link = f'<a href="{path}" target="_top" style="{style}">{text}</a>'
        blocks.append(f"<b>{html.escape(one.title)}</b><table>{cells}</table>{link}")
    return f'<div style="{BLOCK}">{"".join(blocks)}</div>' if blocks else ""


def _scale(legend: Legend) -> str:
    if legend.color_by == "sensor":
        return "".join(_swatch(name, rgb, line=False) for name, rgb in legend.sensors)
    if legend.color_by in CATEGORIES:
        return f"<div>{html.escape(legend.unit)}</div>"
    return _bar(legend.palette, legend.span, legend.unit)


def _bar(palette: Palette, span: Range, unit: str) -> str:
    stops = ",".join(_css(tuple(rgb)) for rgb in table(palette)[::15].tolist())
    bar = f"height:10px;border-radius:2px;background:linear-gradient(to right,{stops})"
    ends = "display:flex;justify-content:space-between;gap:1em"
    return (
        f'<div style="{bar}"></div><div style="{ends}"><span>{span.low:.4g}</span>'
        f"<span>{html.escape(unit)}</span><span>{span.high:.4g}</span></div>"
    )


def _swatch(text: str, rgb: Rgb, *, line: bool) -> str:
    size = "width:18px;height:3px" if line else "width:10px;height:10px"
    mark = f"display:inline-block;vertical-align:middle;margin-right:8px;{size}"
    return f'<div><span style="{mark};background:{_css(rgb)}"></span>{html.escape(text)}</div>'


def _css(rgb: tuple[int, ...]) -> str:
    return f"rgb({rgb[0]},{rgb[1]},{rgb[2]})"


def counted(layer: Layer) -> str:
    """The label of a layer with its number of objects."""
    return f"{layer.label} ({count(layer.count)})" if layer.count else layer.label


def count(number: int) -> str:
    """A number with thousands separators."""
    return f"{number:,}".replace(",", "\u202f")
