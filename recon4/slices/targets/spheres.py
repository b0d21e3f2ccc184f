"""Spheres: places where the normals of surfaces around them meet at one distance.

The fit gives center ``c`` and radius ``r`` by least squares of ``|p - c| - r``.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from recon4.geometry.se3 import Array
from recon4.model.targets import TargetKind
from recon4.progress import Progress, track
from recon4.slices.targets.candidate import TargetCandidate
from recon4.slices.targets.cells import TargetCells
from recon4.slices.targets.groups import best_apart
from recon4.slices.targets.near import PlacePoints
from recon4.slices.tuning_targets import SPHERES, TARGET_CELLS


@dataclass(frozen=True, slots=True, eq=False)
class SpherePlaces:
    """Places that may be the middle of a sphere, N of them."""

    xyz: Array
    """[m], (N, 3)."""
    radius_m: Array
    """That was looked for, (N,)."""
    score: Array
    """Part of the sphere whose normals meet there, (N,)."""

    @staticmethod
    def joined(parts: list[SpherePlaces]) -> SpherePlaces:
        """All of them."""
        return SpherePlaces(
            np.concatenate([one.xyz for one in parts]).reshape(-1, 3),
            np.concatenate([one.radius_m for one in parts]),
            np.concatenate([one.score for one in parts]),
        )


def sphere_places(cells: TargetCells, radii_m: tuple[float, ...]) -> SpherePlaces:
    """Where the normals of cells meet, for each radius."""
    from scipy.spatial import cKDTree

    rows = np.flatnonzero(cells.flatness() < SPHERES.flat)
    unit = _normals(cells, rows)
    sound = np.linalg.norm(unit, axis=1) > 0.5
    xyz, unit = cells.xyz[rows[sound]], unit[sound]
    parts = [SpherePlaces(np.zeros((0, 3)), np.zeros(0), np.zeros(0))]
    for radius_m in radii_m if len(xyz) else ():
        meet = xyz - radius_m * unit
        count = cKDTree(meet).query_ball_point(meet, SPHERES.near_m, return_length=True)
        part = count / (4.0 * np.pi * radius_m**2 / TARGET_CELLS.cell_m**2)
        like = np.flatnonzero(part >= SPHERES.covered)
        best = like[best_apart(meet[like], part[like], 2.0 * SPHERES.near_m)]
        parts.append(SpherePlaces(meet[best], np.full(len(best), radius_m), part[best]))
    return SpherePlaces.joined(parts)


def _normals(cells: TargetCells, rows: NDArray[np.intp]) -> Array:
    """Unit normals of some cells, away from the inside, (M, 3); zero = not known."""
    normal = cells.normal[rows]
    length = np.linalg.norm(normal, axis=1)[:, None]
    return np.asarray(np.where(length > 0.3, normal / np.maximum(length, 1e-9), 0.0))


def find_spheres(
    near: PlacePoints, places: SpherePlaces, *, progress: Progress
) -> list[TargetCandidate]:
    """The spheres of a map; the progress receives every place that is looked at."""
    chosen = [np.zeros(0, np.intp)]
    for radius in np.unique(places.radius_m):
        rows = np.flatnonzero(places.radius_m == radius)
        apart = best_apart(places.xyz[rows], places.score[rows], SPHERES.near_m)
        chosen.append(rows[apart[: SPHERES.most_places]])
    best = np.concatenate(chosen)
    found = list[TargetCandidate]()
    rows = near.in_order(places.xyz[best], best).tolist()
    for row in track(rows, progress, what="spheres", unit="places"):
        place, radius_m = places.xyz[row], float(places.radius_m[row])
        if any(np.linalg.norm(one.p_map - place) < one.size_m for one in found):
            continue
        around_m = radius_m * (1.0 + SPHERES.radius_off) + SPHERES.empty_m[1]
        one = sphere_at(near.around(place, around_m)[0], place, radius_m)
        if one is not None:
            found.append(one)
    return found


def sphere_at(points: Array, place: Array, radius_m: float) -> TargetCandidate | None:
    """The sphere around a place; None if there is none.

    Args:
        points: Around the place [m], (N, 3).
        place: About its middle [m], (3,).
        radius_m: About its radius.
    """
    x, inside = np.array([*place, radius_m]), np.zeros(len(points), np.bool_)
    for _ in range(SPHERES.rounds):
        d = points - x[:3]
        reach = np.linalg.norm(d, axis=1)
        inside = np.abs(reach - x[3]) <= SPHERES.shell_m
        if inside.sum() < SPHERES.least_points:
            return None
        A = np.c_[d[inside] / reach[inside, None], np.ones(inside.sum())]
        v = reach[inside] - x[3]
        x = x + np.linalg.lstsq(A, v, rcond=None)[0]
        if abs(x[3] - radius_m) > SPHERES.radius_off * radius_m:
            return None
    d = points - x[:3]
    reach = np.linalg.norm(d, axis=1)
    inside = np.abs(reach - x[3]) <= SPHERES.shell_m
    if inside.sum() < SPHERES.least_points:
        return None
    unit, v = d[inside] / reach[inside, None], reach[inside] - x[3]
    rough_m = float(np.sqrt(np.mean(v**2)))
    low, high = SPHERES.empty_m
    around = np.count_nonzero((reach > x[3] + low) & (reach < x[3] + high))
    round_ = float(np.linalg.eigvalsh(unit.T @ unit / len(unit))[0])
    if (
        rough_m > SPHERES.most_rough_m
        or round_ < SPHERES.least_round
        or around > SPHERES.most_around * inside.sum()
    ):
        return None
    A = np.c_[unit, np.ones(len(unit))]
    cov = rough_m**2 * np.linalg.inv(A.T @ A)
    return TargetCandidate(
        kind=TargetKind.SPHERE,
        p_map=x[:3],
        cov=cov[:3, :3],
        size_m=float(x[3]),
        points=int(inside.sum()),
        agreement=float(1.0 - rough_m / SPHERES.shell_m),
    )
