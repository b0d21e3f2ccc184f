"""Overlap of the view volumes of two multiframes (V §2.5, requirements A4)."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from recon4.geometry.se3 import SE3, Array
from recon4.kernels.overlap import inside_ratio, nearest_ranges, seen_through_ratio
from recon4.registration.tuning import OVERLAP, OverlapTuning


@dataclass(frozen=True, slots=True, eq=False)
class RangeImage:
    """Points of a multiframe (or a few) and the view volume they span around the origin."""

    points: Array
    """Points in the frame of the view [m], (N, 3)."""
    nearest_m: NDArray[np.float32]
    """Smallest range in each bin of azimuth and elevation [m]; 0 = empty."""


def make_range_image(points: Array, settings: OverlapTuning = OVERLAP) -> RangeImage:
    """The spherical z-buffer of points [m], (N, 3), around the origin of their frame."""
    nearest_m = nearest_ranges(
        points, settings.azimuth_bins, settings.elevation_bins, settings.min_points
    )
    return RangeImage(points, nearest_m)


def overlap(
    source: RangeImage,
    target: RangeImage,
    T_source_target: SE3,
    *,
    settings: OverlapTuning = OVERLAP,
) -> float:
    """Fraction of points in the other's view volume, 0..1 (V Eq. 2.6, read as A0 no. 2).

    Args:
        source: The view whose volume is used (mode ``target``, that of the text).
        target: The view whose points are tested.
        T_source_target: Maps points of the target into the source.
        settings: Tolerances and mode.
    """
    if settings.mode == "target":
        return _inside(source, target, T_source_target, settings=settings)
    backward = _inside(target, source, T_source_target.inverse(), settings=settings)
    if settings.mode == "source":
        return backward
    forward = _inside(source, target, T_source_target, settings=settings)
    if settings.mode == "min":
        return min(forward, backward)
    return 2.0 * forward * backward / max(forward + backward, 1e-12)


def seen_through(
    source: RangeImage,
    target: RangeImage,
    T_source_target: SE3,
    *,
    settings: OverlapTuning = OVERLAP,
) -> float:
    """Fraction of points in the free space of the other view, 0..1: the larger of both directions.

    A view of the same place has hardly any: a ray that went on to a wall passed nothing solid.

    Args:
        source: One view.
        target: The other view.
        T_source_target: Maps points of the target into the source.
        settings: Tolerances.
    """
    return max(
        seen_through_ratio(
            view.nearest_m, other.points, np.ascontiguousarray(T.R), T.t,
            settings.relative_tolerance, settings.absolute_tolerance_m,
        )
        for view, other, T in (
            (source, target, T_source_target), (target, source, T_source_target.inverse()),
        )
    )  # fmt: skip


def _inside(
    view: RangeImage, other: RangeImage, T_view_other: SE3, *, settings: OverlapTuning = OVERLAP
) -> float:
    return inside_ratio(
        view.nearest_m,
        other.points,
        np.ascontiguousarray(T_view_other.R),
        T_view_other.t,
        settings.relative_tolerance,
        settings.absolute_tolerance_m,
    )
