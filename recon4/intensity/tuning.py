"""Tuning of the normalization of intensities."""

from __future__ import annotations

from dataclasses import dataclass

from recon4.settings import IntensitySettings


@dataclass(frozen=True, slots=True, kw_only=True)
class IntensityTuning(IntensitySettings):
    """Bins and sampled points of the table (docs/intensity.md; requirements A9)."""

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
    windows: int = 40
    """Largest number of sampled sections of the walk, ten multiframes each."""
