"""Axes of charts: what spans them, where their ticks are and where a value is drawn."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from recon4.geometry.se3 import Array

_MARGIN = 0.05
"""Of the span of the values, to each side."""
_STEPS = (1.0, 2.0, 5.0, 10.0)
_FINEST = 1e-9
"""Ratio of span and value below which values count as equal."""


@dataclass(frozen=True, slots=True)
class AxisSpan:
    """Values from one end of an axis to the other; ``first`` may be the larger."""

    first: float
    last: float
    log: bool = False

    def ratio(self, values: Array) -> Array:
        """Where values lie: 0 at the first end, 1 at the last one."""
        if self.log:
            first, last = np.log(self.first), np.log(self.last)
            return (np.log(values) - first) / (last - first)
        return (values - self.first) / (self.last - self.first)


@dataclass(frozen=True, slots=True)
class AxisTick:
    """A mark on an axis."""

    value: float
    text: str


def span_of(drawn: Sequence[Array]) -> AxisSpan:
    """The span of the finite values of arrays, with a margin; 0 to 1 if there are none."""
    values = np.concatenate([np.empty(0), *drawn])
    values = values[np.isfinite(values)]
    if not len(values):
        return AxisSpan(0.0, 1.0)
    low, high = float(values.min()), float(values.max())
    margin = _MARGIN * (high - low)
    if high - low <= _FINEST * max(abs(low), abs(high)):
        margin = 0.05 * abs(low) or 0.05
    return AxisSpan(low - margin, high + margin)


def at_same_scale(x: AxisSpan, y: AxisSpan, aspect: float) -> tuple[AxisSpan, AxisSpan]:
    """Widen one of two spans, so that a unit of both is equally long.

    Args:
        x: Of the horizontal axis.
        y: Of the vertical axis.
        aspect: Width of the axes over their height.
    """
    width, height = x.last - x.first, y.last - y.first
    more_x = max(aspect * height - width, 0.0) / 2.0
    more_y = max(width / aspect - height, 0.0) / 2.0
    return AxisSpan(x.first - more_x, x.last + more_x), AxisSpan(y.first - more_y, y.last + more_y)


def ticks_of(span: AxisSpan, most: int, *, integer: bool = False) -> list[AxisTick]:
    """Round values within a span, each with its text.

    Args:
        span: Of the axis.
        most: Largest number of ticks of a linear axis.
        integer: Whole numbers only.
    """
    low, high = sorted((span.first, span.last))
    if span.log:
        powers = range(int(np.ceil(np.log10(low) - 1e-9)), int(np.floor(np.log10(high) + 1e-9)) + 1)
        return [AxisTick(10.0**power, f"{10.0**power:g}") for power in powers]
    least = (high - low) / most
    step = _round_step(max(least, 1.0) if integer else least)
    first, last = int(np.ceil(low / step - 1e-6)), int(np.floor(high / step + 1e-6))
    return [AxisTick(k * step, _text(k * step, step)) for k in range(first, last + 1)]


def _round_step(least: float) -> float:
    """The smallest round number that is not below one."""
    power = 10.0 ** np.floor(np.log10(least))
    return float(next(s * power for s in _STEPS if s * power >= least * (1.0 - 1e-9)))


def _text(value: float, step: float) -> str:
    """A tick's value with as many digits as its neighbors differ in."""
    if step < 1e-6 or abs(value) >= 1e9:
        text = f"{value:.6g}"
    else:
        digits = next(n for n in range(9) if abs(step * 10**n - round(step * 10**n)) < 1e-6)
        text = f"{value:.{digits}f}"
    return "0" if float(text) == 0.0 else text.replace("-", "−")
