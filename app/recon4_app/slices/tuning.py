"""Limits of slices, references and exports."""

from __future__ import annotations

import numpy as np
from msgspec import Struct


class AlignViewTuning(Struct, frozen=True, kw_only=True):
    """Alignment on the page."""

    shown: int = 150_000
    """Most points of map and reference on the page."""
    upright: float = np.cos(np.deg2rad(30.0))
    """Cosine of the largest tilt of a floor."""


ALIGN_VIEW = AlignViewTuning()


class ExportImageTuning(Struct, frozen=True, kw_only=True):
    """Images that are exported."""

    finest_m: float = 0.005
    """Pixel of a GeoTIFF, unless it would get too large [m]."""
    max_geotiff_px: int = 6000
    """Longest side of a GeoTIFF [px]."""


EXPORT_IMAGES = ExportImageTuning()


class ExportLimits(Struct, frozen=True, kw_only=True):
    """Exports that are prepared."""

    limit_s: float = 1800.0
    """Longest time an export may take [s]."""
    kept_s: float = 86_400.0
    """A finished export is kept at least this long, unless all exceed `max_kept_bytes` [s]."""
    max_kept_bytes: int = 20 << 30
    """Limit for all kept exports; the oldest are removed first."""
    large_thickness_m: float = 0.5
    """A thicker slice may hold most of the map [m]."""


EXPORTS = ExportLimits()


class SliceRequestLimits(Struct, frozen=True, kw_only=True):
    """Requests for slices."""

    max_side_px: int = 4096
    """Longest side of an image [px]."""
    radii: int = 8
    """Most radii of spheres of a survey that are looked for."""


SLICE_REQUESTS = SliceRequestLimits()


class ReaderLimits(Struct, frozen=True, kw_only=True):
    """Files that are read into memory."""

    max_bytes: int = 64 << 20
    """A larger file was not written by us."""


READERS = ReaderLimits()


class SliceStoreLimits(Struct, frozen=True, kw_only=True):
    """References and sheets of a project."""

    max_references: int = 20
    """References."""
    max_pages: int = 256
    """Pages of a sheet."""
    max_control_bytes: int = 16 << 20
    """Largest file of control points."""


SLICE_STORE = SliceStoreLimits()


class WalkStretchTuning(Struct, frozen=True, kw_only=True):
    """The walk during a finding, as the pages draw it."""

    most_positions: int = 500
    """A longer stretch is thinned out."""


WALK_STRETCH = WalkStretchTuning()
