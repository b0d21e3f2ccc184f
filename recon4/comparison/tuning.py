"""Tuning of comparisons of two maps."""

from __future__ import annotations

from msgspec import Struct


class M3C2Tuning(Struct, frozen=True, kw_only=True):
    """M3C2 (Lague et al. 2013)."""

    min_neighbors: int = 10
    """Fewer neighbors have no normal."""
    min_points: int = 4
    """Fewer points in a cylinder are no surface: the level of detection needs four (section 3)."""
    confidence: float = 1.96
    """Of the level of detection: 95 % of a normal distribution (equation 1)."""
    usual_sd_m: float = 0.007
    """Standard deviation of a position in a good map, where the map states none [m]: that of two
    poses in the search for double walls (docs/how-to/slices.md)."""
    spacing_m: tuple[float, float] = (0.02, 10.0)
    """Smallest and largest distance of core points [m]."""
    longest_m: float = 5.0
    """Largest scale of normals and largest half length of a cylinder [m]."""
    normal_voxels: float = 8.0
    """The neighborhood of a normal is at least as many voxels wide."""
    cylinder_voxels: float = 4.0
    """A cylinder is at least as many voxels wide: a flat surface has twelve points in it."""
    layer_voxels: float = 2.0
    """Half a layer is at least as many voxels thick."""
    kept_bytes: int = 160 << 20
    """Memory for the tiles of each map that were read last [bytes]."""
    step_m: float = 0.0001
    """Classes of the histograms of absolute distances and levels of detection [m]."""


M3C2 = M3C2Tuning()


class FrameRelationTuning(Struct, frozen=True, kw_only=True):
    """How the frames of two maps lie to each other."""

    rigid_m: float = 0.01
    """Corners of a map may be off this much after the rigid motion between two systems [m]: the
    scale of a projection is not a motion."""


RELATION = FrameRelationTuning()


class PagePointTuning(Struct, frozen=True, kw_only=True):
    """Core points as the page *Map* reads them."""

    step_m: float = 0.0002
    """Step of distances and levels of detection [m]: 16 bits reach 6.5 m."""


PAGE_POINTS = PagePointTuning()
