"""Tuning of the normalization of intensities."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

from msgspec import Struct

from recon4.settings import IntensitySettings


@dataclass(frozen=True, slots=True, kw_only=True)
class IntensityTuning(IntensitySettings):
    """Bins and sampled points of the table (docs/explanation/intensity.md; requirements A9)."""

    surface_cell_m: float = 0.25
    """Points in a cube of this edge lie on one surface [m] (``surfaces``)."""
    surface_points: int = 500_000
    """Approximate number of sampled points that are compared (``surfaces``)."""
    range_bin_m: float = 0.2
    """Width of a bin of range [m]."""
    incidence_bin_deg: float = 1.0
    """Width of a bin of incidence angle [deg]."""
    max_range_m: float = 60.0
    """Farther points belong to the last bin of range [m]."""
    min_count: int = 200
    """Bins with fewer points fall back to a coarser bin, or to the product of the factors of beam,
    incidence and range (``surfaces``)."""
    normal_cell_m: float = 0.15
    """Edge of a cell for normals [m]; a neighborhood has three cells along each axis."""
    upper: Literal["raw", "twice_mean"] = "raw"
    """Normalized values are clamped to 0 and the largest raw value, or twice the target mean as in
    the author's code, which clips reflectors."""
    windows: int = 40
    """Largest number of sampled sections of the walk, ten multiframes each."""


class SampleTuning(Struct, frozen=True, kw_only=True):
    """What the table is learned from."""

    samples: int = 10
    """Multiframes in a window."""
    stride: int = 10
    """Multiframes from one sample to the next: a window is 10 s long."""
    held_out: int = 5
    """Every n-th sample is held out from learning and used for the diagnostics."""


SAMPLING = SampleTuning()


class IntensitySurfaceTuning(Struct, frozen=True, kw_only=True):
    """Effects learned from surfaces that are seen repeatedly."""

    rounds: int = 12
    """Limit of iterations of Newton's method; five are usual."""
    converged: float = 1e-4
    """Relative change of a factor below which it has converged."""
    longest_step: float = 1.0
    """Largest change of the logarithm of a factor in one iteration."""
    gauge: float = 1e-3
    """Weight of the prior on unobservable factors: the three groups have a common scale."""


INTENSITY_SURFACES = IntensitySurfaceTuning()


class IntensityTableTuning(Struct, frozen=True, kw_only=True):
    """The table that normalizes intensities."""

    coarser: tuple[tuple[int, int], ...] = ((1, 1), (5, 1), (5, 5), (15, 10), (0, 5), (0, 0))
    """Numbers of bins of incidence and of range that are merged, from fine to coarse; 0 = all."""


INTENSITY_TABLE = IntensityTableTuning()
