"""One chart as inline SVG, colored by the page (light, dark or paper)."""

from __future__ import annotations

from collections.abc import Sequence
from html import escape

import numpy as np

from recon4.geometry.se3 import Array
from recon4.report.chart_axes import AxisSpan, AxisTick, at_same_scale, span_of, ticks_of
from recon4.report.chart_shapes import (
    AreaShape,
    ChartShape,
    CurveShape,
    DotsShape,
    DrawingArea,
    NoteShape,
)

BLUE, ORANGE, GREEN, GRAY, PINK = "#0072b2", "#d55e00", "#009e73", "#999999", "#cc79a7"
"""Okabe & Ito 2008: distinguishable for color-blind readers."""
INK = "currentColor"
WIDTH, HEIGHT = 389.0, 194.0
"""In units of the SVG; text is nine of them high."""
LINE = 13.0
"""From one line of text to the next."""
_LETTER = 5.0
"""Width of a letter or digit, the mean of usual fonts."""
_ABOVE, _BESIDE, _BELOW = 8.0, 12.0, 2.0 * LINE + 6.0
"""Space around the axes; the half of a tick's text reaches beyond them."""
_KEY = 22.0
"""Space of a line of the legend without its text."""
_FEW = 60
"""Points of a curve up to which each of them is shown."""


class Chart:
    """What is drawn on one pair of axes; `svg` returns the finished chart.

    Without `limit_x` and `limit_y` the axes span all points that are drawn.
    """

    def __init__(self, name: str, *, labels: tuple[str, str], height: float = HEIGHT) -> None:
        self._name, self._labels, self._height = name, labels, height
        self._x: AxisSpan | None = None
        self._y: AxisSpan | None = None
        self._integer = False
        self._equal = False
        self._rows: tuple[str, ...] = ()
        self._points: list[tuple[Array, Array]] = []
        self._shapes: list[ChartShape] = []
        self._keys: list[tuple[str, str]] = []

    def limit_x(self, first: float, last: float, *, log: bool = False) -> None:
        """Let the horizontal axis go from one value to another."""
        self._x = AxisSpan(first, last, log)

    def limit_y(self, first: float, last: float, *, integer: bool = False) -> None:
        """Let the vertical axis go up from one value to another."""
        self._y, self._integer = AxisSpan(first, last), integer

    def list_rows(self, rows: Sequence[str]) -> None:
        """Make the vertical axis a list from above; row k is at the value k."""
        self._rows = tuple(rows)
        self._y = AxisSpan(len(rows) - 0.5, -0.5)

    def keep_aspect(self) -> None:
        """Give both axes the same scale."""
        self._equal = True

    @property
    def span_y(self) -> AxisSpan:
        """Of the vertical axis."""
        return self._y or span_of([y for _, y in self._points])

    def curve(self, x: Array, y: Array, *, color: str, name: str = "") -> None:
        """A line through points (N,), interrupted where one is not a number."""
        self._add(CurveShape(x, y, color, 1.3), name, color)
        self._points.append((x, y))
        if len(x) <= _FEW:
            self._add(DotsShape(x, y, color, 3.0))

    def dots(self, x: Array, y: Array, *, color: str, width: float, name: str = "") -> None:
        """Separate points (N,)."""
        self._add(DotsShape(x, y, color, width), name, color)
        self._points.append((x, y))

    def bars(self, start: tuple[Array, Array], end: tuple[Array, Array], *, color: str) -> None:
        """A straight line from each point ``(x, y)``, (N,) each, to another."""
        for x0, y0, x1, y1 in zip(*start, *end, strict=True):
            self._add(CurveShape(np.array([x0, x1]), np.array([y0, y1]), color, 1.4))
        self._points += [start, end]

    def area(self, edges: Array, heights: Array, *, color: str, name: str = "") -> None:
        """Columns side by side: heights (N,) between edges (N + 1,)."""
        x, top = np.repeat(edges, 2), np.repeat(heights.astype(np.float64), 2)
        y = np.concatenate([[0.0], top, [0.0]])
        self._add(AreaShape(x, y, color), name, color)
        self._points.append((x, y))

    def dashes(self, x: Array, y: Array, *, color: str, name: str = "") -> None:
        """A dashed line that does not widen the axes; infinite = to their ends."""
        self._add(CurveShape(x, y, color, 1.2, dashed=True), name, color)

    def note(self, x: float, y: float, text: str) -> None:
        """A text to the lower right of a point."""
        self._add(NoteShape(x, y, text))

    def svg(self) -> str:
        """The chart as SVG, with its text in the page's color."""
        span_x, span_y = self._x or span_of([x for x, _ in self._points]), self.span_y
        rows = self._y_ticks(span_y)
        left = LINE + 8.0 + _LETTER * max((len(row.text) for row in rows), default=0)
        keys = self._legend(left)
        above = _ABOVE + LINE * len(keys)
        width, height = WIDTH - left - _BESIDE, self._height - above - _BELOW
        if self._equal:
            span_x, span_y = at_same_scale(span_x, span_y, width / height)
            rows = self._y_ticks(span_y)
        area = DrawingArea(span_x, span_y, width, height)
        drawn = "".join(shape.svg(area) for shape in self._shapes)
        return (
            f'<svg role="img" class="chart" data-name="{escape(self._name)}" font-size="9" '
            f'viewBox="0 0 {WIDTH:g} {self._height:g}" fill="currentColor">{"".join(keys)}'
            f'<g transform="translate({LINE - 3.0:.1f} {above + height / 2.0:.1f}) rotate(-90)">'
            f"{_text(0.0, 0.0, self._labels[1], anchor='middle')}</g>"
            f'<g transform="translate({left:.1f} {above:.1f})">{self._axes(area, rows)}'
            f'<svg width="{width:.1f}" height="{height:.1f}">{drawn}</svg></g></svg>'
        )

    def _add(self, shape: ChartShape, name: str = "", color: str = "") -> None:
        self._shapes.append(shape)
        if name:
            self._keys.append((name, color))

    def _y_ticks(self, span: AxisSpan) -> list[AxisTick]:
        if self._rows:
            return [AxisTick(float(k), row) for k, row in enumerate(self._rows)]
        return ticks_of(span, int(self._height / 32.0), integer=self._integer)

    def _legend(self, left: float) -> list[str]:
        """Lines with the name and color of what has a name."""
        lines: list[str] = []
        x = WIDTH
        for name, color in self._keys:
            need = _KEY + _LETTER * len(name)
            if x + need > WIDTH:
                x = left
                lines.append("")
            y = LINE * len(lines)
            lines[-1] += (
                f'<path d="M{x:.1f} {y - 3.0:.1f}h12" stroke="{color}" stroke-width="4"/>'
                f'<text x="{x + 15.0:.1f}" y="{y:.1f}">{escape(name)}</text>'
            )
            x += need
        return lines

    def _axes(self, area: DrawingArea, rows: list[AxisTick]) -> str:
        """Grid, ticks and names of both axes."""
        width, height = area.width, area.height
        grid, texts = [], []
        for tick in ticks_of(area.x, int(width / 45.0)):
            x = width * area.x.ratio(np.array([tick.value]))[0]
            grid.append(f"M{x:.1f} 0V{height:.1f}")
            texts.append(_text(x, height + LINE, tick.text, anchor="middle"))
        for tick in rows:
            y = height * (1.0 - area.y.ratio(np.array([tick.value]))[0])
            grid.append(f"M0 {y:.1f}H{width:.1f}")
            texts.append(_text(-5.0, y + 3.2, tick.text, anchor="end"))
        texts.append(
            _text(width / 2.0, height + 2.0 * LINE + 2.0, self._labels[0], anchor="middle")
        )
        return (
            f'<path d="{"".join(grid)}" stroke="#808080" stroke-opacity="0.25" stroke-width="0.6"/>'
            f'<path d="M0 0V{height:.1f}H{width:.1f}" fill="none" stroke="{INK}" '
            f'stroke-width="0.8"/>{"".join(texts)}'
        )


def _text(x: float, y: float, text: str, *, anchor: str) -> str:
    return f'<text x="{x:.1f}" y="{y:.1f}" text-anchor="{anchor}">{escape(text)}</text>'
