"""What charts draw: curves, dots, areas and notes, as SVG."""

from __future__ import annotations

from dataclasses import dataclass
from html import escape
from typing import Protocol

import numpy as np

from recon4.geometry.se3 import Array
from recon4.report.chart_axes import AxisSpan

_DASHES = ' stroke-dasharray="5 3"'


@dataclass(frozen=True, slots=True)
class DrawingArea:
    """The rectangle between the axes, in units of the SVG."""

    x: AxisSpan
    y: AxisSpan
    width: float
    height: float

    def of(self, x: Array, y: Array) -> Array:
        """Where points are drawn, (N, 2); infinite values lie at the end of their axis."""
        with np.errstate(invalid="ignore", divide="ignore"):
            right = self.width * np.clip(self.x.ratio(x), -1.0, 2.0)
            up = self.height * np.clip(self.y.ratio(y), -1.0, 2.0)
        return np.stack([right, self.height - up], axis=-1)


class ChartShape(Protocol):
    """Something that is drawn."""

    def svg(self, area: DrawingArea) -> str:
        """Its SVG elements."""


@dataclass(frozen=True, slots=True, eq=False)
class CurveShape:
    """A line through points, interrupted where one is not a number."""

    x: Array
    y: Array
    color: str
    width: float
    dashed: bool = False

    def svg(self, area: DrawingArea) -> str:
        """One path; a point without neighbors is a dot."""
        points = area.of(self.x, self.y)
        whole = np.isfinite(points).all(axis=1)
        breaks = np.flatnonzero(np.diff(whole.astype(np.int8))) + 1
        pieces = [piece for piece in np.split(points, breaks) if np.isfinite(piece).all()]
        path = "".join(_path(piece) for piece in pieces if len(piece))
        dashes = _DASHES if self.dashed else ""
        return (
            f'<path d="{path}" fill="none" stroke="{self.color}" stroke-width="{self.width:g}" '
            f'stroke-linejoin="round" stroke-linecap="round"{dashes}/>'
        )


@dataclass(frozen=True, slots=True, eq=False)
class DotsShape:
    """Separate points; of those that cover each other one is drawn."""

    x: Array
    y: Array
    color: str
    width: float

    def svg(self, area: DrawingArea) -> str:
        """One path of lines without a length."""
        points = area.of(self.x, self.y)
        points = points[np.isfinite(points).all(axis=1)]
        seen = np.unique(np.round(2.0 * points), axis=0) / 2.0 if len(points) > 500 else points
        path = "".join(f"M{x:.1f} {y:.1f}h0" for x, y in seen.tolist())
        return (
            f'<path d="{path}" stroke="{self.color}" stroke-width="{self.width:g}" '
            'stroke-linecap="round"/>'
        )


@dataclass(frozen=True, slots=True, eq=False)
class AreaShape:
    """What a line through points encloses, shown through."""

    x: Array
    y: Array
    color: str

    def svg(self, area: DrawingArea) -> str:
        """One filled path."""
        path = _path(area.of(self.x, self.y))
        return f'<path d="{path}Z" fill="{self.color}" fill-opacity="0.6"/>'


@dataclass(frozen=True, slots=True)
class NoteShape:
    """A text to the lower right of a point."""

    x: float
    y: float
    text: str

    def svg(self, area: DrawingArea) -> str:
        """One text."""
        ((x, y),) = area.of(np.array([self.x]), np.array([self.y]))
        return f'<text x="{x + 4.0:.1f}" y="{y + 12.0:.1f}">{escape(self.text)}</text>'


def _path(points: Array) -> str:
    if len(points) == 1:
        return f"M{points[0, 0]:.1f} {points[0, 1]:.1f}h0"
    return "M" + "L".join(f"{x:.1f} {y:.1f}" for x, y in points.tolist())
