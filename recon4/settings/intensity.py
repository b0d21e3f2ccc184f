"""Settings of the stage `intensity`."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

from recon4.settings.require import require


@dataclass(frozen=True, slots=True, kw_only=True)
class IntensitySettings:
    """Intensity normalization (V §2.10, Eq. 2.17, requirements A9)."""

    method: Literal["surfaces", "bins"] = "surfaces"
    """``surfaces`` compares points of the same surface, so that near floors and far walls are not
    mistaken for an effect of range. ``bins``: as in the text, the plain mean of each bin."""
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
    min_contrast: float = 0.5
    """With ``bins``: lower limit of a bin's deviation as a fraction of the value expected from its
    mean, so that a bin of one material is not stretched to the contrast of all; 0 = plain
    Eq. 2.17."""
    normal_cell_m: float = 0.15
    """Edge of a cell for normals [m]; a neighborhood has three cells along each axis."""
    windows: int = 40
    """Largest number of sampled sections of the walk, ten multiframes each."""
    upper: Literal["raw", "twice_mean"] = "raw"
    """Normalized values are clamped to 0 and the largest raw value, or twice the target mean as in
    the author's code, which clips reflectors."""

    def __post_init__(self) -> None:
        require(self.range_bin_m > 0.0, "range_bin_m must be above 0", self.range_bin_m)
        require(
            0.1 <= self.incidence_bin_deg <= 90.0,
            "incidence_bin_deg must be 0.1 to 90",
            self.incidence_bin_deg,
        )
        require(
            self.max_range_m >= self.range_bin_m,
            "max_range_m must be at least range_bin_m",
            self.max_range_m,
        )
        require(self.min_count >= 2, "min_count must be at least 2", self.min_count)
        require(0.0 <= self.min_contrast <= 1.0, "min_contrast must be 0 to 1", self.min_contrast)
        require(self.normal_cell_m > 0.0, "normal_cell_m must be above 0", self.normal_cell_m)
        require(self.windows >= 1, "windows must be at least 1", self.windows)
        require(self.surface_cell_m > 0.0, "surface_cell_m must be above 0", self.surface_cell_m)
        require(self.surface_points >= 1, "surface_points must be at least 1", self.surface_points)
