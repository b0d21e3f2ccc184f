"""The table that normalizes intensities (V §2.10, Eq. 2.17; requirements A9, A0 no. 7)."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from recon4.errors import ConfigError, StoreError
from recon4.geometry.se3 import Array
from recon4.intensity.surfaces import Surfaces
from recon4.kernels.intensity import apply_table
from recon4.settings import IntensitySettings
from recon4.store.arrays import load_arrays

SHIFT_ONLY = 0.01
"""Bins with a smaller deviation are shifted, not scaled."""

COARSER: tuple[tuple[int, int], ...] = ((1, 1), (5, 1), (5, 5), (15, 10), (0, 5), (0, 0))
"""Numbers of bins of incidence and of range that are merged, from fine to coarse; 0 = all."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class IntensityTable:
    """``x' = (x - mean_i) * target_std / std_i + target_mean`` with mean and deviation of a bin."""

    mean: NDArray[np.float32]
    """Mean raw intensity by sensor, ring, incidence (last: no normal), range, (S, B, I, R)."""
    std: NDArray[np.float32]
    """Standard deviation of raw intensity, the divisor, (S, B, I, R)."""
    level: NDArray[np.uint8]
    """Row of `COARSER` whose bin was used, (S, B, I, R); one past the last = all points. In a
    table learned from surfaces: 0 = the bin itself, 1 = mostly the factors, one past the last = a
    beam without points."""
    target_mean: float
    target_std: float
    upper: float
    """Upper limit of normalized intensities; the lower one is 0."""
    incidence_bin_rad: float
    range_bin_m: float

    @staticmethod
    def of_sums(sums: Array, *, settings: IntensitySettings, largest: float) -> IntensityTable:
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
        level = np.full(sums.shape[:4], len(COARSER), np.uint8)
        for row in range(len(COARSER) - 1, -1, -1):
            merged = _merged(sums, *COARSER[row])
            enough = merged[..., 0] >= settings.min_count
            bin_mean, bin_std = _moments(merged)
            mean[enough], std[enough], level[enough] = bin_mean[enough], bin_std[enough], row
        expected = target_std * mean / max(target_mean, SHIFT_ONLY)
        scaled = std >= SHIFT_ONLY
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

    @staticmethod
    def of_surfaces(
        surfaces: Surfaces, total: Array, *, settings: IntensitySettings, largest: float
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
        level[surfaces.count.sum(axis=(2, 3)) == 0] = len(COARSER)
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

    @property
    def gain(self) -> NDArray[np.float32]:
        """Factor of each bin; 1 if the deviation is too small as a divisor, (S, B, I, R)."""
        safe = np.where(self.std < SHIFT_ONLY, np.float32(self.target_std or 1.0), self.std)
        return np.asarray((self.target_std or 1.0) / safe, dtype=np.float32)

    @property
    def offset(self) -> NDArray[np.float32]:
        """Added after the factor, (S, B, I, R)."""
        return np.asarray(self.target_mean - self.gain * self.mean, dtype=np.float32)

    def apply(
        self,
        intensity: NDArray[np.uint16],
        *,
        sensor: NDArray[np.uint8],
        ring: NDArray[np.uint8],
        incidence_rad: NDArray[np.float32],
        range_m: NDArray[np.float32],
    ) -> NDArray[np.float32]:
        """Normalized intensities, (N,).

        Args:
            intensity: Raw, (N,).
            sensor: Row in the rig, (N,).
            ring: Beam, (N,).
            incidence_rad: Angle between beam and normal, 0..pi/2, NaN = no normal, (N,).
            range_m: (N,).
        """
        out = np.empty(len(intensity), np.float32)
        apply_table(
            intensity,
            sensor,
            ring,
            incidence_rad,
            range_m,
            self.incidence_bin_rad,
            self.range_bin_m,
            self.gain,
            self.offset,
            self.upper,
            out,
        )
        return out

    def save(self, path: Path) -> None:
        """Write ``table.npz``."""
        numbers = [self.target_mean, self.target_std, self.upper]
        numbers += [self.incidence_bin_rad, self.range_bin_m]
        np.savez_compressed(
            path, mean=self.mean, std=self.std, level=self.level, numbers=np.array(numbers)
        )

    @staticmethod
    def load(path: Path) -> IntensityTable:
        """Read ``table.npz``.

        Raises:
            StoreError: If the file is missing or damaged.
        """
        arrays = load_arrays(path, ["mean", "std", "level", "numbers"])
        mean, std, level, numbers = (arrays[name] for name in ("mean", "std", "level", "numbers"))
        fits = mean.ndim == 4 and mean.shape == std.shape == level.shape and numbers.shape == (5,)
        if not fits or not np.isfinite(mean).all() or not np.isfinite(std).all():
            raise StoreError(f"{path.name} is not a table of intensities")
        target_mean, target_std, upper, incidence_bin_rad, range_bin_m = numbers.tolist()
        return IntensityTable(
            mean=mean,
            std=std,
            level=level,
            target_mean=target_mean,
            target_std=target_std,
            upper=upper,
            incidence_bin_rad=incidence_bin_rad,
            range_bin_m=range_bin_m,
        )


def _require_points(total: Array) -> None:
    if total[0] == 0:
        raise ConfigError("intensity cannot be normalized: there are no points to learn from")


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
