"""The kinds of charts of the report: curves, histograms, cumulative ratios."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from recon4.geometry.se3 import Array
from recon4.report.chart import BLUE, INK, ORANGE, Chart

_ENDLESS = np.array([-np.inf, np.inf])


def lines(
    name: str,
    series: Sequence[tuple[str, Array, Array, str]],
    *,
    labels: tuple[str, str],
    least: float = 0.0,
) -> str:
    """Curves ``(label, x, y, color)`` with axes named ``labels``.

    The vertical axis spans at least ``least``, so that negligible values look small. It begins at 0
    unless a value is negative.
    """
    chart = Chart(name, labels=labels)
    for label, x, y, color in series:
        few = thinned(len(x))
        at, shown = broken_at_holes(x[few], y[few])
        chart.curve(at, shown, color=color, name=label)
    span = chart.span_y
    low, high = span.first, span.last
    if all(np.nanmin(y, initial=0.0) >= 0.0 for _, _, y, _ in series):
        low, high = 0.0, max(high, least)
    elif high - low < least:
        middle = 0.5 * (low + high)
        low, high = middle - 0.5 * least, middle + 0.5 * least
    chart.limit_y(low, high)
    return chart.svg()


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
    chart = Chart(name, labels=labels)
    most = 1
    for label, values, color in finite:
        counts, _ = np.histogram(np.maximum(values, low), bins=bins)
        chart.area(bins, counts, color=color, name=f"{label} ({len(values)})")
        most = max(most, int(counts.max()))
    if limit is not None:
        chart.dashes(np.full(2, limit[0]), _ENDLESS, color=INK, name=limit[1])
    chart.limit_x(low, 1.05 * high, log=log)
    chart.limit_y(0.0, 1.05 * most, integer=True)
    return chart.svg()


def cumulative(name: str, distance_m: Array, counts: Array, *, marks_m: Sequence[float]) -> str:
    """Cumulative ratio of points within a distance (V Fig. 3.2)."""
    chart = Chart(name, labels=("distance to the model [cm]", "points nearer [%]"))
    ratio = 100.0 * np.cumsum(counts) / max(counts.sum(), 1)
    chart.curve(100.0 * distance_m, ratio, color=BLUE)
    for mark in marks_m:
        at = float(np.interp(mark, distance_m, ratio))
        chart.dashes(np.full(2, 100.0 * mark), np.array([0.0, at]), color=ORANGE)
        chart.note(100.0 * mark, at, f"{at:.1f} %")
    chart.limit_x(0.0, 10.0)
    chart.limit_y(0.0, 101.0)
    return chart.svg()


def broken_at_holes(x: Array, y: Array) -> tuple[Array, Array]:
    """Insert NaN into gaps of three times the usual step, so that no line bridges them."""
    if len(x) < 3:
        return x, y
    step = np.diff(x)
    after = np.flatnonzero(step > 3.0 * np.median(step)) + 1
    return np.insert(x, after, np.nan), np.insert(y.astype(np.float64), after, np.nan)


def thinned(count: int, most: int = 1500) -> Any:
    """Rows of an even sample of a long curve, including the last one."""
    return np.unique(np.linspace(0, count - 1, min(count, most)).round().astype(int))
