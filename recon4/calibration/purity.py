"""Planes without the points of other surfaces: each point by its own standard deviation.

A cube that holds a floor also holds the foot of a chair and the mat before it. Seen at grazing
incidence a floor is exact to some millimeters, so a few points 2 cm above it turn what it says of
the elevation of a beam.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from recon4.calibration.surfaces import SharedSurfaces
from recon4.calibration.tuning_joint import COMMON_PLANES, PURITY
from recon4.geometry.se3 import Array
from recon4.kernels.own_points import along_normal, plane_equations, planes_met

_PRIOR = np.diag([1e-9, 1.0, 1.0])
"""Information on shift [1/m²] and slopes: only planes whose points lie on a line feel it."""


def distance_sd_m(surfaces: SharedSurfaces, beam: Array) -> Array:
    """Standard deviation of the distance of points from their planes by the incidence [m], (M,).

    Args:
        surfaces: Points on planes.
        beam: Unit vectors from the sensors to all points, (N, 3).
    """
    cosine = along_normal(beam, surfaces.point, surfaces.plane, surfaces.normal)
    return np.hypot(PURITY.range_sd_m * cosine, PURITY.across_sd_m)


def only_own_points(
    surfaces: SharedSurfaces, p: Array, beam: Array, *, cube_m: float
) -> SharedSurfaces:
    """Fit the planes again to the points that are on them, and leave the others out.

    Points that see a plane from its other side are of another surface: the underside of a table.
    Cubes with too many points on no plane are left out.

    Args:
        surfaces: Points on planes.
        p: All points in one frame [m], (N, 3).
        beam: Unit vectors from the sensors to them, (N, 3).
        cube_m: Edge of the cubes.
    """
    if len(surfaces) == 0:
        return surfaces
    points = _PointsOfWindow(p, beam, cube_m)
    before = points.facing(surfaces)
    own = points.divided(points.refitted(before))
    own = points.divided(points.refitted(own))
    explained = np.zeros(len(p), bool)
    explained[own.point] = True
    total = np.bincount(before.plane, minlength=len(own))
    known = np.bincount(before.plane, explained[before.point], len(own))
    count = np.bincount(own.plane, minlength=len(own))
    return _only(
        own, (count >= COMMON_PLANES.min_points) & (known >= PURITY.least_explained * total)
    )


@dataclass(frozen=True, slots=True, eq=False)
class _PointsOfWindow:
    """All points of a window."""

    p: Array
    beam: Array
    cube_m: float

    def facing(self, surfaces: SharedSurfaces) -> SharedSurfaces:
        """Planes whose normals point to where most of their points see them from, and these."""
        side = np.sign(along_normal(self.beam, surfaces.point, surfaces.plane, surfaces.normal))
        usual = np.sign(np.bincount(surfaces.plane, side, len(surfaces)))
        kept = side == usual[surfaces.plane]
        normal = np.where(usual > 0.0, -1.0, 1.0)[:, None] * surfaces.normal
        return replace(
            surfaces, normal=normal, point=surfaces.point[kept], plane=surfaces.plane[kept]
        )

    def refitted(self, surfaces: SharedSurfaces) -> SharedSurfaces:
        """The planes moved to where most of their points are."""
        sd_m = distance_sd_m(surfaces, self.beam)
        for _ in range(PURITY.refits):
            frames = _frames(surfaces.normal)
            H, g = plane_equations(
                self.p,
                surfaces.point,
                surfaces.plane,
                frames,
                surfaces.center,
                sd_m,
                PURITY.most_sds,
            )
            step = np.linalg.solve(H + _PRIOR, g[:, :, None])
            lean = np.concatenate([np.ones((len(step), 1, 1)), -step[:, 1:]], axis=1)
            normal = np.sum(lean * frames, axis=1)
            surfaces = replace(
                surfaces,
                center=surfaces.center + step[:, 0] * surfaces.normal,
                normal=normal / np.linalg.norm(normal, axis=1, keepdims=True),
            )
        return surfaces

    def divided(self, surfaces: SharedSurfaces) -> SharedSurfaces:
        """All points that lie on the planes."""
        order = np.lexsort(surfaces.cube.T[::-1])
        plane = planes_met(
            self.p,
            self.beam,
            np.column_stack([surfaces.cube[order], order]),
            surfaces.center,
            surfaces.normal,
            np.bincount(surfaces.plane, minlength=len(surfaces)).astype(np.float64),
            self.cube_m,
            np.array([PURITY.range_sd_m, PURITY.across_sd_m, PURITY.most_sds, PURITY.near_face_m]),
        )
        point = np.flatnonzero(plane >= 0)
        return replace(surfaces, point=point, plane=plane[point])


def _only(surfaces: SharedSurfaces, kept: NDArray[np.bool_]) -> SharedSurfaces:
    """Some of the planes, (V,) bool, and their points."""
    rows = np.flatnonzero(kept[surfaces.plane])
    return SharedSurfaces(
        point=surfaces.point[rows],
        plane=(np.cumsum(kept) - 1)[surfaces.plane[rows]],
        center=surfaces.center[kept],
        normal=surfaces.normal[kept],
        shared=surfaces.shared[kept],
        cube=surfaces.cube[kept],
    )


def _frames(normal: Array) -> Array:
    """Normal and two tangents of each plane, (V, 3, 3)."""
    smallest = np.eye(3)[np.argmin(np.abs(normal), axis=1)]
    first = np.cross(normal, smallest)
    first /= np.linalg.norm(first, axis=1, keepdims=True)
    return np.stack([normal, first, np.cross(normal, first)], axis=1)
