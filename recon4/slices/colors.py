"""Color scales of slices, for white paper and for a dark screen."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from recon4.geometry.se3 import Array
from recon4.slices.tuning_files import SLICE_COLORS

ColorBy = Literal["height", "intensity", "normalized", "time", "sensor", "distance"]
Ground = Literal["light", "dark"]


UNITS: dict[ColorBy, str] = {
    "height": "m",
    "intensity": "",
    "normalized": "",
    "time": "s",
    "sensor": "",
    "distance": "m",
}
LABELS: dict[ColorBy, str] = {
    "height": "Height",
    "intensity": "Intensity",
    "normalized": "Normalized intensity",
    "time": "Time since start",
    "sensor": "Sensor",
    "distance": "Distance to reference",
}


@dataclass(frozen=True, slots=True)
class Span:
    """Values at the two ends of the color scale."""

    low: float
    high: float


@cache
def table(color: ColorBy, ground: Ground) -> NDArray[np.uint8]:
    """256 colors from low to high, (256, 3).

    On a dark screen also the lowest contrasts with it by 3 : 1, as WCAG 2.2 asks for graphics:
    floors are the thin dark lines of a profile.
    """
    steps = np.linspace(0.0, 1.0, 256)
    if color == "distance":
        at = np.linspace(0.0, 1.0, len(SLICE_COLORS.distance_stops))
        stops = np.array(SLICE_COLORS.distance_stops, dtype=np.float64)
        channels = [np.interp(steps, at, stops[:, c]) for c in range(3)]
        return np.stack(channels, axis=1).round().astype(np.uint8)
    import matplotlib

    name, darkest = ("turbo", 0.18) if color == "time" else ("viridis", 0.38)
    first, last = (0.0, 0.90) if ground == "light" else (darkest, 1.0)
    rgba = matplotlib.colormaps[name](first + steps * (last - first), bytes=True)
    return np.ascontiguousarray(rgba[:, :3])


def paint(values: Array, span: Span, *, color: ColorBy, ground: Ground) -> NDArray[np.uint8]:
    """Colors of values, (…) -> (…, 3); beyond the ends the color of the end, NaN = the low end."""
    if color == "sensor":
        sensors = np.array(SLICE_COLORS.sensor_colors, dtype=np.uint8)
        return sensors[np.nan_to_num(values).astype(np.int64) % len(sensors)]
    width = max(span.high - span.low, 1e-12)
    scaled = np.nan_to_num((values - span.low) * (255.0 / width)).clip(0.0, 255.0)
    return table(color, ground)[scaled.astype(np.uint8)]


def usual_span(values: Array, *, color: ColorBy) -> Span:
    """Fixed for distances; else from the 2nd to the 98th percentile of the values."""
    if color == "distance":
        return Span(*SLICE_COLORS.distance_range_m)
    known = values[np.isfinite(values)]
    if not len(known):
        return Span(0.0, 1.0)
    low, high = np.percentile(known[:: max(1, len(known) // 100_000)], [2.0, 98.0])
    return Span(float(low), float(max(high, low + 1e-6)))
