"""Point density per square centimeter (V §3.2: ZEB-1 0.9, 4RECON 10.1)."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree

from recon4.errors import ConfigError
from recon4.geometry.se3 import Array
from recon4.locales.coded import CodedText

_CM2_PER_M2 = 1e4


@dataclass(frozen=True, slots=True, eq=False)
class PlanePatch:
    """A parallelogram picked on a wall, floor or ceiling."""

    corner: Array
    """One corner [m], (3,)."""
    side_u: Array
    """From the corner along one side [m], (3,)."""
    side_v: Array
    """From the corner along the other side [m], (3,)."""
    half_thickness_m: float = 0.05
    """Points nearer to the plane than this belong to it [m]."""

    @property
    def area_m2(self) -> float:
        """Area [m²]."""
        return float(np.linalg.norm(np.cross(self.side_u, self.side_v)))

    def count(self, p: Array) -> int:
        """Number of the points (N, 3) on the patch."""
        A = np.stack([self.side_u, self.side_v, np.cross(self.side_u, self.side_v) / self.area_m2])
        u, v, height_m = np.linalg.solve(A.T, (p - self.corner).T)
        on_it = (u >= 0) & (u <= 1) & (v >= 0) & (v <= 1)
        return int((on_it & (np.abs(height_m) <= self.half_thickness_m)).sum())


@dataclass(frozen=True, slots=True)
class Density:
    """Points on a patch."""

    points: int
    area_m2: float
    points_per_cm2: float


@dataclass(frozen=True, slots=True)
class SurfaceDensity:
    """Density on the surfaces of the whole map, at random points of it."""

    places: int
    radius_m: float
    low_per_cm2: float
    """10th percentile [points/cm²]."""
    median_per_cm2: float
    high_per_cm2: float
    """90th percentile [points/cm²]."""


def patch_density(chunks: Iterable[Array], patch: PlanePatch) -> Density:
    """Measure the density on a patch.

    Args:
        chunks: Points of the map [m], arrays of (N, 3).
        patch: The patch, in the frame of the map.

    Raises:
        ConfigError: If the sides of the patch span no area.
    """
    if not patch.area_m2 > 1e-6:
        raise ConfigError(CodedText("density-area", area_m2=patch.area_m2))
    points = sum(patch.count(np.asarray(chunk, dtype=np.float64)) for chunk in chunks)
    return Density(points, patch.area_m2, points / (patch.area_m2 * _CM2_PER_M2))


def surface_density(
    chunks: Iterable[Array], places: Array, *, radius_m: float = 0.1
) -> SurfaceDensity:
    """Points in a ball over the area of its great circle: exact on flat surfaces.

    Args:
        chunks: Points of the map [m], arrays of (N, 3); every point is counted.
        places: Centers of the balls: random points of the map [m], (M, 3), M > 0.
        radius_m: Radius of the ball [m].
    """
    tree = cKDTree(places)
    counts = np.zeros(len(places), dtype=np.int64)
    for chunk in chunks:
        rows = _rows_within(tree, np.asarray(chunk, dtype=np.float64), radius_m)
        counts += np.bincount(rows, minlength=len(places))
    per_cm2 = counts / (np.pi * radius_m**2 * _CM2_PER_M2)
    low, median, high = np.percentile(per_cm2, [10, 50, 90])
    return SurfaceDensity(len(places), radius_m, float(low), float(median), float(high))


def _rows_within(tree: cKDTree, points: Array, radius_m: float) -> NDArray[np.int64]:
    """Rows of the tree's places, one for every (place, point) pair within the radius."""
    if not len(points):
        return np.empty(0, dtype=np.int64)
    near = np.isfinite(tree.query(points, distance_upper_bound=radius_m)[0])
    lists = tree.query_ball_point(points[near], radius_m)
    return np.fromiter((row for rows in lists for row in rows), dtype=np.int64)
