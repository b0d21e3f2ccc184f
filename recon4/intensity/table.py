"""Makes the table that normalizes intensities (V §2.10, Eq. 2.17; requirements A9, A0 no. 7)."""

from __future__ import annotations

import numpy as np

from recon4.errors import ConfigError
from recon4.geometry.se3 import Array
from recon4.intensity.surfaces import Surfaces
from recon4.intensity.tuning import INTENSITY_TABLE, IntensityTuning
from recon4.locales.coded import CodedText
from recon4.model.intensity_table import IntensityTable


def table_of_sums(sums: Array, *, settings: IntensityTuning, largest: float) -> IntensityTable:
    """Make the table of means and deviations of bins (V Eq. 2.17).

    Args:
        sums: Count, sum and sum of squares of each bin, (S, B, I, R, 3).
        settings: Bins, the least count, the clamp.
        largest: Largest raw intensity.

    Raises:
        ConfigError: If there are no points.
    """
    total = sums.sum(axis=(0, 1, 2, 3))
    _require_points(total)
    target_mean, target_std = (float(v) for v in _moments(total))
    mean = np.full(sums.shape[:4], target_mean, np.float32)
    std = np.full(sums.shape[:4], target_std, np.float32)
    level = np.full(sums.shape[:4], len(INTENSITY_TABLE.coarser), np.uint8)
    for row in range(len(INTENSITY_TABLE.coarser) - 1, -1, -1):
        merged = _merged(sums, *INTENSITY_TABLE.coarser[row])
        enough = merged[..., 0] >= settings.min_count
        bin_mean, bin_std = _moments(merged)
        mean[enough], std[enough], level[enough] = bin_mean[enough], bin_std[enough], row
    expected = target_std * mean / max(target_mean, IntensityTable.SHIFT_ONLY)
    scaled = std >= IntensityTable.SHIFT_ONLY
    std[scaled] = np.maximum(std, settings.min_contrast * expected)[scaled]
    return IntensityTable(
        mean=mean,
        std=std,
        level=level,
        target_mean=target_mean,
        target_std=target_std,
        upper=largest if settings.upper == "raw" else 2.0 * target_mean,
        incidence_bin_rad=float(np.deg2rad(settings.incidence_bin_deg)),
        range_bin_m=settings.range_bin_m,
    )


def table_of_surfaces(
    surfaces: Surfaces, total: Array, *, settings: IntensityTuning, largest: float
) -> IntensityTable:
    """Make the table as if each bin had seen all surfaces of the walk.

    Args:
        surfaces: Factors of the bins: mean and deviation of a bin are those of all points
            times its factor.
        total: Count, sum and sum of squares of all raw intensities, (3,).
        settings: Bins, the least count, the clamp.
        largest: Largest raw intensity.

    Raises:
        ConfigError: If there are no points.
    """
    _require_points(total)
    target_mean, target_std = (float(v) for v in _moments(total))
    level = (surfaces.count < settings.min_count).astype(np.uint8)
    level[surfaces.count.sum(axis=(2, 3)) == 0] = len(INTENSITY_TABLE.coarser)
    return IntensityTable(
        mean=np.asarray(surfaces.factor * target_mean, dtype=np.float32),
        std=np.asarray(surfaces.factor * target_std, dtype=np.float32),
        level=level,
        target_mean=target_mean,
        target_std=target_std,
        upper=largest if settings.upper == "raw" else 2.0 * target_mean,
        incidence_bin_rad=float(np.deg2rad(settings.incidence_bin_deg)),
        range_bin_m=settings.range_bin_m,
    )


def _require_points(total: Array) -> None:
    if total[0] == 0:
        raise ConfigError(CodedText("intensity-none"))


def _moments(sums: Array) -> tuple[Array, Array]:
    """Mean and standard deviation of (..., 3) sums; zeros where there is no point."""
    count = np.maximum(sums[..., 0], 1.0)
    mean = sums[..., 1] / count
    return mean, np.sqrt(np.maximum(sums[..., 2] / count - mean**2, 0.0))


def _merged(sums: Array, incidences: int, ranges: int) -> Array:
    """Replace each bin by the sum of its block of bins, shape as ``sums``.

    The bin without a normal is merged with others only if all incidences are merged.
    """
    size = sums.shape[2]
    if incidences == 0:
        sums = np.repeat(sums.sum(axis=2, keepdims=True), size, axis=2)
    else:
        known = _blocks(sums[:, :, :-1], 2, incidences)
        sums = np.concatenate([known, sums[:, :, -1:]], axis=2)
    return _blocks(sums, 3, ranges or sums.shape[3])


def _blocks(sums: Array, axis: int, width: int) -> Array:
    size = sums.shape[axis]
    starts = np.arange(0, size, width)
    merged = np.add.reduceat(sums, starts, axis=axis)
    return np.repeat(merged, np.diff(np.append(starts, size)), axis=axis)
