"""Snapping of a picked point to a corner, an edge or a plane of the points around it.

Planes are found one after the other by RANSAC (Fischler and Bolles 1981), scored as by Torr and
Zisserman (MSAC, 2000), and fitted by least squares. Where three meet there is a corner, where two
meet an edge.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from itertools import combinations
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from recon4.geometry.se3 import Array
from recon4.slices.tuning import SNAPS

SnapKind = Literal["corner", "edge", "plane"]


@dataclass(frozen=True, slots=True, eq=False)
class PickRay:
    """What a person points at."""

    origin_m: Array
    """(3,)"""
    direction: Array
    """Length 1, (3,)."""
    hit_m: Array
    """The point that was hit, (3,)."""
    reach_m: float
    """Farthest that an edge or a corner may lie from the ray [m]."""


@dataclass(frozen=True, slots=True, eq=False)
class Snapped:
    """Where a pick snapped to."""

    kind: SnapKind
    p_map: Array
    """[m], (3,)."""
    sd_m: float
    """Standard deviation (1 σ) by the scatter of points about their planes, in the direction in
    which it is largest [m]. That of a single point: neighbors share their errors."""


@dataclass(frozen=True, slots=True, eq=False)
class _Plane:
    normal: Array
    offset_m: float
    """Of its points: normal · p."""
    points: Array
    """(N, 3)."""
    sd_m: float
    apart_m: float
    """Distance of neighboring points, if they fill a rectangle evenly."""

    def off_m(self, p: Array) -> Array:
        """Signed distances of points (..., 3) [m]."""
        found: Array = p @ self.normal - self.offset_m
        return found


def radius_around(reach_m: float) -> float:
    """Radius in which points decide about a pick with this reach [m]."""
    low, high = SNAPS.around
    return min(max(SNAPS.times * reach_m, low), high)


def snap(points: Array, pick: PickRay, *, rng: np.random.Generator) -> Snapped | None:
    """Snap a pick: to a corner within reach, else to an edge, else to the plane that was hit.

    Args:
        points: Around the hit, within `radius_around` of it [m], (N, 3).
        pick: The ray and what it hit.
        rng: For the hypotheses.

    Returns:
        The place; None if what was hit is on no plane, or the ray grazes it.
    """
    planes = _planes(points, rng)
    near = [one for one in planes if abs(one.off_m(pick.hit_m)) <= SNAPS.fitted_m[1]]
    if not near:
        return None
    hit = min(near, key=lambda one: abs(float(one.off_m(pick.hit_m))))
    others = [one for one in planes if one is not hit and _meet(one, hit)]
    for pair in combinations(others, 2):
        found = _corner((hit, *pair), pick) if _meet(*pair) else None
        if found is not None:
            return found
    edges = [edge for other in others if (edge := _edge(hit, other, pick)) is not None]
    if edges:
        return min(edges, key=lambda one: _from_ray(one.p_map, pick))
    return _on_plane(hit, pick)


def _planes(points: Array, rng: np.random.Generator) -> list[_Plane]:
    """The planes of some points, the largest first."""
    points = rest = points[:: max(1, -(-len(points) // SNAPS.most_points))]
    found: list[_Plane] = []
    while len(found) < SNAPS.planes and len(rest) >= SNAPS.least_points:
        plane = _largest(rest, rng)
        if plane is None:
            break
        found.append(plane)
        rest = rest[np.abs(plane.off_m(rest)) > SNAPS.fitted_m[1]]
    return [_apart_from(one, found, points) for one in found]


def _apart_from(plane: _Plane, planes: list[_Plane], points: Array) -> _Plane:
    """A plane without the points near the others, which would tilt it; those are its own still."""
    inside = np.abs(plane.off_m(points)) <= SNAPS.fitted_m[1]
    alone = inside.copy()
    for other in planes:
        if other is not plane:
            alone &= np.abs(other.off_m(points)) > SNAPS.guard_m
    again = _fitted(points[alone], np.ones(np.count_nonzero(alone), np.bool_))
    if again is None:
        return plane
    near = np.abs(again.off_m(points)) <= SNAPS.fitted_m[1]
    return replace(again, points=points[near])


def _largest(points: Array, rng: np.random.Generator) -> _Plane | None:
    """The plane with most points, fitted; None if there is none."""
    triples = points[rng.integers(0, len(points), (SNAPS.hypotheses, 3))]
    normals = np.cross(triples[:, 1] - triples[:, 0], triples[:, 2] - triples[:, 0])
    lengths = np.linalg.norm(normals, axis=1)
    sound = lengths > 1e-6
    if not sound.any():
        return None
    normals = normals[sound] / lengths[sound, None]
    offsets = np.einsum("hi,hi->h", normals, triples[sound, 0])
    off = (points @ normals.T - offsets) / SNAPS.near_m
    best = int(np.argmax(np.maximum(1.0 - off**2, 0.0).sum(axis=0)))  # MSAC
    return _fitted(points, np.abs(points @ normals[best] - offsets[best]) <= SNAPS.near_m)


def _fitted(points: Array, inside: NDArray[np.bool_]) -> _Plane | None:
    """Least squares plane through those points, whose inliers are chosen again by their scatter."""
    low, high = SNAPS.fitted_m
    plane: _Plane | None = None
    for _ in range(SNAPS.rounds):
        chosen = points[inside]
        if len(chosen) < SNAPS.least_points:
            return None
        middle = chosen.mean(axis=0)
        values, vectors = np.linalg.eigh(np.cov((chosen - middle).T))
        if values[1] < SNAPS.least_width_m**2:
            return None
        normal, sd = vectors[:, 0], float(np.sqrt(max(values[0], 0.0)))
        area_m2 = 12.0 * float(np.sqrt(values[1] * values[2]))
        apart_m = float(np.sqrt(area_m2 / len(chosen)))
        plane = _Plane(normal, float(normal @ middle), chosen, sd, apart_m)
        inside = np.abs(plane.off_m(points)) <= min(max(SNAPS.sigmas * sd, low), high)
    return plane if plane is not None and _is_surface(plane, points) else None


def _is_surface(plane: _Plane, points: Array) -> bool:
    """Whether points are on a plane rather than on both sides of it, as those of a bush."""
    off = np.abs(plane.off_m(points))
    near, about = (np.count_nonzero(off <= times * SNAPS.near_m) for times in (1.0, 3.0))
    return bool(near >= SNAPS.contrast * about)


def _meet(a: _Plane, b: _Plane) -> bool:
    return abs(float(a.normal @ b.normal)) < SNAPS.apart


def _corner(planes: tuple[_Plane, _Plane, _Plane], pick: PickRay) -> Snapped | None:
    normals = np.stack([one.normal for one in planes])
    if abs(np.linalg.det(normals)) < 1.0 - SNAPS.apart:
        return None
    offset_m = np.array([one.offset_m for one in planes])
    p = np.asarray(np.linalg.solve(normals, offset_m), np.float64)
    return _met("corner", p, planes, pick=pick)


def _edge(a: _Plane, b: _Plane, pick: PickRay) -> Snapped | None:
    """The point of an edge that is nearest to the ray."""
    along = np.cross(a.normal, b.normal)
    along /= np.linalg.norm(along)
    normals = np.stack([a.normal, b.normal, along])
    offset_m = np.array([a.offset_m, b.offset_m, along @ pick.hit_m])
    base = np.asarray(np.linalg.solve(normals, offset_m), np.float64)
    cosine = float(along @ pick.direction)
    if 1.0 - cosine**2 < SNAPS.grazing**2:
        return _met("edge", base, (a, b), pick=pick)
    between = base - pick.origin_m
    t = (cosine * (pick.direction @ between) - along @ between) / (1.0 - cosine**2)
    return _met("edge", base + t * along, (a, b), pick=pick)


def _met(kind: SnapKind, p: Array, planes: tuple[_Plane, ...], *, pick: PickRay) -> Snapped | None:
    """A place where planes meet, if it is within reach and each of them comes as far."""
    if _from_ray(p, pick) > pick.reach_m:
        return None
    if np.linalg.norm(p - pick.hit_m) > radius_around(pick.reach_m):
        return None
    if not all(_reaches(one, p) for one in planes):
        return None
    inverse = np.linalg.pinv(np.stack([one.normal for one in planes]))
    scaled = inverse * np.array([one.sd_m for one in planes])
    return Snapped(kind, p, float(np.linalg.norm(scaled, 2)))


def _reaches(plane: _Plane, p: Array) -> bool:
    """Whether a plane has points near a place, not only its extension."""
    near_m = max(SNAPS.support_m, SNAPS.support_times * plane.apart_m)
    near = np.linalg.norm(plane.points - p, axis=1) <= near_m
    return bool(np.count_nonzero(near) >= SNAPS.support_points)


def _on_plane(plane: _Plane, pick: PickRay) -> Snapped | None:
    """Where the ray goes through a plane."""
    cosine = float(plane.normal @ pick.direction)
    if abs(cosine) < SNAPS.grazing:
        return None
    depth = -float(plane.off_m(pick.origin_m)) / cosine
    p = pick.origin_m + depth * pick.direction
    return Snapped("plane", p, plane.sd_m) if _reaches(plane, p) else None


def _from_ray(p: Array, pick: PickRay) -> float:
    between = p - pick.origin_m
    return float(np.linalg.norm(between - (between @ pick.direction) * pick.direction))
