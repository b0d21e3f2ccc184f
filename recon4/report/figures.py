"""Charts as inline SVG: drawn by matplotlib, colored by the page (light, dark or paper)."""

from __future__ import annotations

import re
from collections.abc import Sequence
from io import StringIO
from typing import Any

import numpy as np

from recon4.geometry.se3 import Array
from recon4.report.tuning import CHARTS

BLUE, ORANGE, GREEN, GRAY, PINK = "#0072b2", "#d55e00", "#009e73", "#999999", "#cc79a7"
SKY, AMBER = "#56b4e9", "#e69f00"
"""Okabe & Ito 2008: distinguishable for color-blind readers."""
INK = "#010203"
"""Placeholder of the page's text color until the SVG is written."""
_STYLE: dict[Any, Any] = {
    "svg.fonttype": "none",
    "font.family": ["sans-serif"],
    "font.sans-serif": ["DejaVu Sans"],
    "font.size": 9.0,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.labelcolor": INK,
    "axes.edgecolor": INK,
    "text.color": INK,
    "xtick.color": INK,
    "ytick.color": INK,
    "axes.grid": True,
    "grid.color": "#808080",
    "grid.alpha": 0.25,
    "grid.linewidth": 0.6,
    "legend.frameon": False,
    "figure.subplot.left": 0.15,
    "figure.subplot.right": 0.97,
    "figure.subplot.bottom": 0.19,
    "figure.subplot.top": 0.95,
    "figure.facecolor": "none",
    "figure.edgecolor": "none",
    "axes.facecolor": "none",
}


class Chart:
    """One pair of axes; `svg` returns the finished chart."""

    def __init__(self, name: str, *, height: float = 2.7, numbers: bool = False) -> None:
        """Empty axes.

        Args:
            name: Unique in the page.
            height: [in].
            numbers: The ticks are numbers and fit into fixed margins. Else the margins are fitted
                to the ticks, which takes as long as the rest of a chart.
        """
        import matplotlib
        from matplotlib.backends.backend_svg import FigureCanvasSVG
        from matplotlib.figure import Figure

        self._name = name
        self._context = matplotlib.rc_context({**_STYLE, "svg.hashsalt": f"recon4 {name}"})
        with self._context:
            self.figure = Figure(figsize=(5.4, height), layout=None if numbers else "constrained")
            FigureCanvasSVG(self.figure)
            self.axes: Any = self.figure.subplots()

    def svg(self, *, legend: bool = True, above: bool = False) -> str:
        """The chart as SVG, with its text in the page's color.

        Args:
            legend: Whether the labels are shown.
            above: In rows above the axes, where many values fill the chart; not with ``numbers``.
        """
        import matplotlib

        with matplotlib.rc_context({**_STYLE, "svg.hashsalt": f"recon4 {self._name}"}):
            if above:
                self.figure.legend(loc="outside upper center", ncols=4, fontsize=8)
            elif legend and self.axes.get_legend_handles_labels()[0]:
                self.axes.legend(fontsize=8)
            buffer = StringIO()
            # `savefig` draws twice, first for a layout that drawing makes anyway.
            canvas: Any = self.figure.canvas
            canvas.print_svg(buffer, metadata={"Date": None, "Creator": None})
        text = buffer.getvalue()
        text = text[text.index("<svg") :].replace(INK, "currentColor")
        text = re.sub(r'(<svg[^>]*?) width="[^"]*"', r"\1", text, count=1)
        text = re.sub(r'(<svg[^>]*?) height="[^"]*"', r"\1", text, count=1)
        text = re.sub(r' xmlns(:xlink)?="[^"]*"', "", text)
        return text.replace("<svg", f'<svg role="img" class="chart" data-name="{self._name}"', 1)


def lines(
    name: str,
    series: Sequence[tuple[str, Array, Array, str]],
    *,
    labels: tuple[str, str],
    least: float = 0.0,
    shaded: Sequence[tuple[float, float, str]] = (),
) -> str:
    """Curves ``(label, x, y, color)`` with axes named ``labels``.

    The vertical axis spans at least ``least``, so that negligible values look small. Parts of the
    horizontal axis ``(from, to, color)`` are shaded.
    """
    chart = Chart(name, numbers=True)
    for begin, end, color in shaded:
        chart.axes.axvspan(begin, end, color=color, alpha=0.25, lw=0, zorder=0)
    for label, x, y, color in series:
        few = thinned(len(x))
        at, shown = broken_at_holes(x[few], y[few])
        chart.axes.plot(at, shown, color=color, lw=1.3, label=label)
        _add_dots(chart, at, shown, color=color)
    chart.axes.set(xlabel=labels[0], ylabel=labels[1])
    low, high = chart.axes.get_ylim()
    low = min(0.0, low)
    if high - low < least:
        middle = 0.5 * (low + high)
        low, high = (0.0, least) if low == 0.0 else (middle - 0.5 * least, middle + 0.5 * least)
    chart.axes.set_ylim(low, high)
    return chart.svg()


def bars(
    name: str,
    rows: Sequence[tuple[str, Sequence[tuple[float, float, str]]]],
    *,
    label: str,
    until: float,
) -> str:
    """Rows of bars ``(caption, [(from, to, color), …])`` over an axis named ``label`` from 0 on."""
    chart = Chart(name, height=0.7 + 0.25 * len(rows))
    for at, (_, parts) in enumerate(rows):
        spans = [(begin, end - begin) for begin, end, _ in parts]
        chart.axes.broken_barh(spans, (at - 0.35, 0.7), color=[color for *_, color in parts])
    chart.axes.set_yticks(range(len(rows)), [caption for caption, _ in rows], fontsize=7)
    chart.axes.set(xlabel=label, xlim=(0.0, until), ylim=(len(rows) - 0.5, -0.5))
    return chart.svg(legend=False)


def histogram(
    name: str,
    groups: Sequence[tuple[str, Array, str]],
    *,
    labels: tuple[str, str],
    limit: tuple[float, str] | None = None,
    log: bool = False,
) -> str:
    """Histograms of groups ``(label, values, color)`` over each other, with a line at a limit.

    Args:
        name: Unique in the page.
        groups: What to count; values that are not finite are left out.
        labels: Names of the axes.
        limit: Where to draw a line, and its name.
        log: Classes grow by a factor; values below a thousandth of the largest are in the first.
    """
    finite = [(label, values[np.isfinite(values)], color) for label, values, color in groups]
    finite = [group for group in finite if len(group[1])]
    high = max([values.max() for _, values, _ in finite] + [limit[0] if limit else 0.0, 1e-9])
    low = 1e-3 * high if log else 0.0
    bins = np.geomspace(low, 1.001 * high, 46) if log else np.linspace(0.0, 1.001 * high, 41)
    chart = Chart(name, numbers=True)
    for label, values, color in finite:
        chart.axes.hist(
            np.maximum(values, low),
            bins=bins.tolist(),
            histtype="stepfilled",
            color=color,
            alpha=0.6,
            label=f"{label} ({len(values)})",
        )
    if limit is not None:
        chart.axes.axvline(limit[0], color=INK, lw=1.2, ls="--", label=limit[1])
    if log:
        chart.axes.set_xscale("log")
        chart.axes.xaxis.set_major_formatter(lambda value, _: f"{value:g}")
    chart.axes.yaxis.get_major_locator().set_params(integer=True)
    chart.axes.set(xlabel=labels[0], ylabel=labels[1], xlim=(low, 1.05 * high))
    return chart.svg()


def cumulative(name: str, distance_m: Array, counts: Array, *, marks_m: Sequence[float]) -> str:
    """Cumulative ratio of points within a distance (V Fig. 3.2)."""
    chart = Chart(name, numbers=True)
    ratio = 100.0 * np.cumsum(counts) / max(counts.sum(), 1)
    chart.axes.plot(100.0 * distance_m, ratio, color=BLUE, lw=1.6)
    for mark in marks_m:
        at = float(np.interp(mark, distance_m, ratio))
        chart.axes.plot([100 * mark] * 2, [0, at], color=ORANGE, lw=1.0, ls="--")
        chart.axes.annotate(
            f"{at:.1f} %", (100 * mark, at), xytext=(4, -12), textcoords="offset points"
        )
    chart.axes.set(
        xlabel="distance to the model [cm]", ylabel="points nearer [%]", ylim=(0, 101), xlim=(0, 10)
    )
    return chart.svg(legend=False)


def broken_at_holes(x: Array, y: Array) -> tuple[Array, Array]:
    """Insert NaN into gaps of three times the usual step, so that no line bridges them."""
    if len(x) < 3:
        return x, y
    step = np.diff(x)
    after = np.flatnonzero(step > 3.0 * np.median(step)) + 1
    return np.insert(x, after, np.nan), np.insert(y.astype(np.float64), after, np.nan)


def add_bars(chart: Chart, middle: Array, half: Array, *, color: str, label: str = "") -> None:
    """Draw values as dots with bars to both sides; any number of them is two paths of the page.

    Args:
        chart: Its limits grow with the bars.
        middle: The values, (N, 2).
        half: Half of each bar, (N, 2).
        color: Of dots and bars.
        label: Their name in the legend; empty = none.
    """
    bar, dot = (1.3, 4.0) if len(middle) <= CHARTS.many_bars else (0.6, 2.4)
    _add_strokes(chart, middle - half, middle + half, color=color, width=bar)
    _add_strokes(chart, middle, middle, color=color, width=dot)
    if label:
        chart.axes.plot([], [], "o", ms=4.0, color=color, label=label)
    chart.axes.update_datalim(np.concatenate([middle - half, middle + half]))
    chart.axes.autoscale_view()


def _add_dots(chart: Chart, x: Array, y: Array, *, color: str) -> None:
    """Draw the values without a neighbor on either side, which no line shows."""
    known = np.pad(np.isfinite(y), 1)
    alone = known[1:-1] & ~known[:-2] & ~known[2:]
    if alone.any():
        points = np.stack([x[alone], y[alone]], axis=1)
        _add_strokes(chart, points, points, color=color, width=2.25)


def _add_strokes(chart: Chart, begin: Array, end: Array, *, color: str, width: float) -> None:
    """Draw lines from ``begin`` to ``end``, (N, 2), as one path; one without length is a dot.

    A marker or bar of matplotlib would be an element of the page for each, of which an old computer
    and the judgement of accessibility bear a few thousand.
    """
    from matplotlib.patches import PathPatch
    from matplotlib.path import Path

    ends = np.stack([begin, end], axis=1).reshape(-1, 2)
    path = Path(ends, np.tile([Path.MOVETO, Path.LINETO], len(begin)))
    path.should_simplify = False  # it would leave out lines without length
    chart.axes.add_patch(PathPatch(path, fill=False, ec=color, lw=width, capstyle="round"))


def thinned(count: int, most: int = 1500) -> Any:
    """Rows of an even sample of a long curve, including the last one."""
    return np.unique(np.linspace(0, count - 1, min(count, most)).round().astype(int))
