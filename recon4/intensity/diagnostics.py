"""Dependency of intensity on channel, range and incidence, before and after normalization.

V Fig. 2.13.
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from recon4.geometry.se3 import Array
from recon4.intensity.surfaces import Observations, Surfaces
from recon4.model.intensity_table import IntensityTable
from recon4.store.arrays import load_record, save_record


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Diagnostics:
    """Count, mean and deviation of intensity by channel, by range and by incidence angle.

    Channel ``c`` is beam ``c % rings`` of sensor ``c // rings``. Bins without points hold NaN.
    The multiframes differ from those the table was learned from; the clamp is not applied.
    """

    rings: Array
    """Beams per sensor, ()."""
    range_m: Array
    """Middle of each bin [m], (R,)."""
    incidence_deg: Array
    """Middle of each bin [deg], (I,)."""
    channel_count: Array
    channel_before: Array
    """Mean and deviation of raw intensity by channel, (2, C)."""
    channel_after: Array
    range_count: Array
    range_before: Array
    """Mean and deviation of raw intensity by range, (2, R)."""
    range_after: Array
    incidence_count: Array
    incidence_before: Array
    """Mean and deviation of raw intensity by incidence, (2, I)."""
    incidence_after: Array
    all_before: Array
    """Mean and deviation over all points, (2,)."""
    all_after: Array
    channel_same_count: Array
    channel_same: Array
    """Intensity relative to the same surface by channel: raw, then normalized, (2, C); 1 = equal
    to all other points of these surfaces."""
    range_same_count: Array
    range_same: Array
    """The same by range, (2, R)."""
    incidence_same_count: Array
    incidence_same: Array
    """The same by incidence, (2, I)."""

    def save(self, path: Path) -> None:
        """Write ``diagnostics.npz``."""
        save_record(path, self)

    @staticmethod
    def load(path: Path) -> Diagnostics:
        """Read ``diagnostics.npz``.

        Raises:
            StoreError: If the file is missing or damaged.
        """
        return load_record(path, Diagnostics)


def spread(count: Array, curve: Array, *, min_count: int = 1) -> float:
    """Largest minus smallest mean of a dependency curve (2, N), without sparse bins."""
    means = curve[0, count >= min_count]
    return float(means.max() - means.min()) if len(means) else 0.0


def diagnose(
    table: IntensityTable, sums: Array, surfaces: Surfaces, *, seen: Observations
) -> Diagnostics:
    """Dependency curves of some points before and after normalization by a table.

    The curves of means also depend on which objects are near and far; those of the same surface do
    not.

    Args:
        table: The normalization.
        sums: Count, sum and sum of squares of each bin's raw intensities, (S, B, I, R, 3).
        surfaces: Brightness of the surfaces.
        seen: Points to compare with their surfaces.
    """
    after = _normalized_sums(table, sums)
    curves: dict[str, Array] = {}
    for name, axes in {"channel": (2, 3), "range": (0, 1, 2), "incidence": (0, 1, 3)}.items():
        marginal = sums.sum(axis=axes).reshape(-1, 3)
        if name == "incidence":
            marginal = marginal[:-1]
        normalized = after.sum(axis=axes).reshape(-1, 3)[: len(marginal)]
        curves[f"{name}_count"] = marginal[:, 0]
        curves[f"{name}_before"], curves[f"{name}_after"] = _curve(marginal), _curve(normalized)
    _, rings, incidences, ranges, _ = sums.shape
    return Diagnostics(
        rings=np.array(float(rings)),
        range_m=table.range_bin_m * np.arange(0.5, ranges),
        incidence_deg=np.rad2deg(table.incidence_bin_rad * np.arange(0.5, incidences - 1)),
        all_before=_curve(sums.sum(axis=(0, 1, 2, 3))[None])[:, 0],
        all_after=_curve(after.sum(axis=(0, 1, 2, 3))[None])[:, 0],
        **curves,
        **_same_surface(table, surfaces, seen),
    )


def _same_surface(
    table: IntensityTable, surfaces: Surfaces, seen: Observations
) -> dict[str, Array]:
    """Curves of intensity over brightness, and their point counts."""
    brightness = surfaces.brightness_of(seen.cell)
    rows = np.flatnonzero(brightness > 0.0)
    channel, incidence, ranges = seen.bins[rows].T
    _, rings, incidences, count = table.mean.shape
    at = (channel // rings, channel % rings, incidence, ranges)
    raw = seen.intensity[rows].astype(np.float64)
    values = (raw, table.gain[at] * raw + table.offset[at])
    axes = {
        "channel": (channel, table.mean.shape[0] * rings),
        "range": (ranges, count),
        "incidence": (incidence, incidences),
    }
    out: dict[str, Array] = {}
    for name, (bins, size) in axes.items():
        due = np.bincount(bins, brightness[rows], size)
        curve = np.stack([_over(np.bincount(bins, v, size), due) for v in values])
        points = np.bincount(bins, minlength=size).astype(np.float64)
        kept = slice(0, size - (name == "incidence"))
        out[f"{name}_same_count"], out[f"{name}_same"] = points[kept], curve[:, kept]
    return out


def _over(seen: NDArray[Any], due: NDArray[Any]) -> Array:
    """Ratio of two sums per bin, relative to the ratio of all; NaN without points, (N,)."""
    whole = seen.sum() / due.sum() if due.sum() > 0.0 else 1.0
    return np.asarray(seen / np.where(due > 0.0, due, np.nan) / (whole or 1.0))


def _normalized_sums(table: IntensityTable, sums: Array) -> Array:
    """Sums of ``g x + o`` from the sums of ``x``: normalization is linear inside a bin."""
    g, o = table.gain.astype(np.float64), table.offset.astype(np.float64)
    count, first, second = sums[..., 0], sums[..., 1], sums[..., 2]
    return np.stack(
        [count, g * first + o * count, g**2 * second + 2.0 * g * o * first + o**2 * count], axis=-1
    )


def _curve(sums: Array) -> Array:
    """Mean and deviation, NaN without points, (N, 3) -> (2, N)."""
    count = np.where(sums[:, 0] > 0, sums[:, 0], np.nan)
    mean = sums[:, 1] / count
    return np.stack([mean, np.sqrt(np.maximum(sums[:, 2] / count - mean**2, 0.0))])
