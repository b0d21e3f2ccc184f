"""Effect of beam, incidence and range on intensity, learned from surfaces seen repeatedly.

Floors are near and walls far, so the mean of a bin depends on the objects as much as on the
sensor. A small cube of the map that many beams see, from near and far, has one brightness; the
differences of its points are effects of the sensor. Both are estimated together by Poisson
regression with a fixed effect per cube (Hausman, Hall, Griliches 1984).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from recon4.geometry.se3 import Array
from recon4.intensity.tuning import INTENSITY_SURFACES, IntensityTuning
from recon4.kernels.intensity import surface_equations


@dataclass(frozen=True, slots=True, eq=False)
class Observations:
    """Points with their cubes of the map and their bins."""

    cell: NDArray[np.int64]
    """Cube of the map, `cells_of`, (N,)."""
    bins: NDArray[np.int32]
    """Channel, bin of incidence, bin of range, (N, 3)."""
    intensity: NDArray[np.float32]
    """Raw, (N,)."""

    def __len__(self) -> int:
        return len(self.cell)

    @staticmethod
    def joined(parts: Sequence[Observations]) -> Observations:
        """Concatenate observations."""
        return Observations(
            np.concatenate([np.empty(0, np.int64), *(p.cell for p in parts)]),
            np.concatenate([np.empty((0, 3), np.int32), *(p.bins for p in parts)]),
            np.concatenate([np.empty(0, np.float32), *(p.intensity for p in parts)]),
        )


@dataclass(frozen=True, slots=True, eq=False)
class Surfaces:
    """Result of learning: the factor of every bin and the brightness of every cube."""

    factor: Array
    """Raw over normalized intensity of a bin, (S, B, I, R)."""
    count: Array
    """Number of points of each bin, (S, B, I, R)."""
    cell: NDArray[np.int64]
    """Cubes, ascending, (C,)."""
    brightness: Array
    """Normalized intensity of each, (C,)."""

    def brightness_of(self, cell: NDArray[np.int64]) -> Array:
        """Expected normalized intensity of points in cubes; 0 = unknown cube, (N,)."""
        if len(self.cell) == 0:
            return np.zeros(len(cell))
        row = np.minimum(np.searchsorted(self.cell, cell), len(self.cell) - 1)
        return np.where(self.cell[row] == cell, self.brightness[row], 0.0)


def cells_of(xyz_m: Array, cell_m: float) -> NDArray[np.int64]:
    """Key of the cube of each point; 21 bits per axis, (N, 3) -> (N,)."""
    at = np.floor(xyz_m / cell_m).astype(np.int64) & 0x1FFFFF
    return np.asarray(at[:, 0] << 42 | at[:, 1] << 21 | at[:, 2], dtype=np.int64)


def learn_surfaces(
    seen: Observations, shape: tuple[int, int, int, int], *, settings: IntensityTuning
) -> Surfaces:
    """Estimate the factors of bins and the brightness of cubes.

    The factor of a bin is the product of the factors of beam, incidence and range. A bin deviates
    from this product as far as its points require: they are weighted against a prior of
    ``settings.min_count`` points without deviation.

    Args:
        seen: Points to learn from.
        shape: Sensors, beams, bins of incidence (last: no normal), bins of range.
        settings: Uses ``min_count``.
    """
    order = np.argsort(seen.cell, kind="stable")
    cell, first = np.unique(seen.cell[order], return_index=True)
    starts = np.append(first, len(order))
    bins, intensity = seen.bins[order], seen.intensity[order]
    groups = (shape[0] * shape[1], shape[2], shape[3])
    parts = _log_factors(starts, bins, intensity, groups=groups, weight=float(settings.min_count))
    factor = np.exp(parts[0][:, None, None] + parts[1][:, None] + parts[2])

    flat = np.ravel_multi_index(tuple(bins.T), factor.shape)
    of_point = factor.ravel()[flat]
    brightness = _brightness(starts, intensity, of_point)
    expected = np.repeat(brightness, np.diff(starts)) * of_point
    prior = settings.min_count * float(intensity.mean()) if len(intensity) else 0.0
    found, due = (
        np.bincount(flat, v, factor.size).reshape(factor.shape) for v in (intensity, expected)
    )
    factor *= (found + prior) / (due + prior) if prior else 1.0

    of_point = factor.ravel()[flat]
    total = float(intensity.sum())
    scale = float((intensity / of_point).sum()) / total if total else 1.0
    return Surfaces(
        factor=(factor * scale).reshape(shape),
        count=np.bincount(flat, minlength=factor.size).reshape(shape).astype(np.float64),
        cell=cell,
        brightness=_brightness(starts, intensity, of_point * scale),
    )


def _brightness(starts: NDArray[np.int64], intensity: NDArray[np.float32], factor: Array) -> Array:
    """Maximum-likelihood brightness of each cube: sum of intensities over sum of factors."""
    if len(starts) == 1:
        return np.empty(0)
    seen = np.add.reduceat(intensity.astype(np.float64), starts[:-1])
    return np.asarray(seen / np.add.reduceat(factor, starts[:-1]))


def _log_factors(
    starts: NDArray[np.int64],
    bins: NDArray[np.int32],
    intensity: NDArray[np.float32],
    *,
    groups: tuple[int, int, int],
    weight: float,
) -> list[Array]:
    """Logarithms of the factors of channel, incidence and range; 0 without data."""
    ends = np.cumsum(groups)
    parameters = bins + np.array([0, ends[0], ends[1]], np.int32)
    prior = _prior(groups, weight)
    scaled = intensity / max(float(intensity.mean()) if len(intensity) else 0.0, 1e-9)
    theta = np.zeros(ends[-1])
    for _ in range(INTENSITY_SURFACES.rounds):
        H, g = np.zeros((len(theta), len(theta))), np.zeros(len(theta))
        surface_equations(starts, parameters, scaled, theta, H, g)
        step = np.linalg.solve(H + prior, g - prior @ theta)
        theta += np.clip(step, -INTENSITY_SURFACES.longest_step, INTENSITY_SURFACES.longest_step)
        if np.abs(step).max() < INTENSITY_SURFACES.converged:
            break
    return np.split(theta, ends[:-1])


def _prior(groups: tuple[int, int, int], weight: float) -> Array:
    """Information of the smoothness prior: neighboring bins are equal, worth ``weight`` points."""
    out = INTENSITY_SURFACES.gauge * np.eye(sum(groups))
    channels, incidences, ranges = groups
    for first, size in ((channels, incidences - 1), (channels + incidences, ranges)):
        difference = np.diff(np.eye(size), axis=0)
        rows = slice(first, first + size)
        out[rows, rows] += weight * difference.T @ difference
    return out
