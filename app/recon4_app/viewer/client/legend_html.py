"""Legend, facts and measurements as HTML. viser does not escape it: all text is escaped here."""

from __future__ import annotations

import html
from collections.abc import Iterable

from recon4.locales.texts import Texts
from recon4_app.viewer.client.captions import Facts
from recon4_app.viewer.client.legend import Legend
from recon4_app.viewer.client.view import CATEGORIES
from recon4_app.viewer.cloud.palette import Palette, Range, Rgb, table
from recon4_app.viewer.cloud.preview import HEIGHTS
from recon4_app.viewer.words import word_of, words

BLOCK = "padding:0.6em 1em;font-size:0.85em;line-height:1.5"


def legend_html(legend: Legend) -> str:
    """The legend as HTML."""
    say = words(legend.language)
    heading = f"<b>{html.escape(say('legend-lines'))}</b>"
    if legend.edge_color == "verdict":
        lines = "".join(_swatch(row.label(say), row.rgb, line=True) for row in legend.layers)
    else:
        by = word_of("edges", legend.edge_color, say)
        bar = _bar("turbo", legend.edge_span, "", say=say)
        lines = f"{_line(say('legend-edges', value=by))}{bar}"
    cell = _line(say("grid-cell", cell=legend.grid_cell_m))
    return f'<div style="{BLOCK}">{_points(legend, say)}{heading}{lines}{cell}</div>'


def _points(legend: Legend, say: Texts) -> str:
    """What the points on screen are."""
    points = ""
    if legend.color_by is not None:
        title = say("legend-points", value=word_of("paint", legend.color_by, say))
        points = f"<b>{html.escape(title)}</b>{_scale(legend, say)}"
        points += _line(say("points-of-map", shown=legend.points, count=legend.points_in_map))
    if legend.color_by is not None and legend.surface:
        points += _line(legend.surface)
    if legend.preview:
        bar = _bar(legend.palette, HEIGHTS, say("above-backpack"), say=say)
        points += f"<b>{html.escape(say('legend-preview'))}</b>{bar}{_line(say('one-per-second'))}"
    return points + (_line(legend.multiframes) if legend.multiframes else "")


def _line(text: str) -> str:
    return f"<div>{html.escape(text)}</div>"


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


def _scale(legend: Legend, say: Texts) -> str:
    if legend.color_by == "sensor":
        return "".join(_swatch(name, rgb, line=False) for name, rgb in legend.sensors)
    if legend.color_by in CATEGORIES:
        return _line(legend.unit)
    return _bar(legend.palette, legend.span, legend.unit, say=say)


def _bar(palette: Palette, span: Range, unit: str, *, say: Texts) -> str:
    stops = ",".join(_css(tuple(rgb)) for rgb in table(palette)[::15].tolist())
    bar = f"height:10px;border-radius:2px;background:linear-gradient(to right,{stops})"
    ends = "display:flex;justify-content:space-between;gap:1em"
    low, high = (html.escape(say("figure", value=end)) for end in (span.low, span.high))
    return (
        f'<div style="{bar}"></div><div style="{ends}"><span>{low}</span>'
        f"<span>{html.escape(unit)}</span><span>{high}</span></div>"
    )


def _swatch(text: str, rgb: Rgb, *, line: bool) -> str:
    size = "width:18px;height:3px" if line else "width:10px;height:10px"
    mark = f"display:inline-block;vertical-align:middle;margin-right:8px;{size}"
    return f'<div><span style="{mark};background:{_css(rgb)}"></span>{html.escape(text)}</div>'


def _css(rgb: tuple[int, ...]) -> str:
    return f"rgb({rgb[0]},{rgb[1]},{rgb[2]})"
