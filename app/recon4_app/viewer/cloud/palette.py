"""Numbers to colors."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

from recon4_app.viewer.tuning import PALETTE

Rgb = tuple[int, int, int]
Palette = Literal["viridis", "turbo", "gray"]


@dataclass(frozen=True, slots=True)
class Range:
    """Values at the ends of a palette."""

    low: float
    high: float


@cache
def table(palette: Palette) -> NDArray[np.uint8]:
    """256 colors, (256, 3)."""
    import matplotlib

    rgba = matplotlib.colormaps[palette](np.arange(256), bytes=True)
    return np.ascontiguousarray(rgba[:, :3])


@cache
def sensor_colors() -> NDArray[np.uint8]:
    """One color a sensor, (S, 3)."""
    return np.array(PALETTE.sensor_colors, dtype=np.uint8)


def distinct_colors(numbers: NDArray[Any]) -> NDArray[np.uint8]:
    """Colors of whole numbers such that neighbors differ clearly, (N,) -> (N, 3)."""
    return table("turbo")[(numbers.astype(np.int64) * 97) % 256]


def paint(values: NDArray[Any], span: Range, palette: Palette) -> NDArray[np.uint8]:
    """Colors of values, (N,) -> (N, 3); what is outside the range gets the color of its end."""
    width = max(span.high - span.low, 1e-12)
    scaled = (values.astype(np.float32) - np.float32(span.low)) * np.float32(255.0 / width)
    return table(palette)[np.nan_to_num(scaled).clip(0.0, 255.0).astype(np.uint8)]


def usual_range(values: NDArray[Any]) -> Range:
    """From the 2nd to the 98th percentile, so that a few bright points do not darken the rest."""
    known = values[np.isfinite(values)]
    if len(known) == 0:
        return Range(0.0, 1.0)
    low, high = np.percentile(known[:: max(1, len(known) // 100_000)], [2.0, 98.0])
    return Range(float(low), float(high))
