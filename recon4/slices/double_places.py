"""Report of the double wall check: patches grouped into places."""

from __future__ import annotations

from dataclasses import dataclass, fields

import numpy as np
from numpy.typing import NDArray

from recon4.geometry.se3 import Array
from recon4.model.plain import finite_or_none
from recon4.slices.tuning import DOUBLE_PLACES


@dataclass(frozen=True, slots=True)
class DoubleWall:
    """A surface seen by two visits; its figures are medians of its patches."""

    middle_m: tuple[float, float, float]
    """Center of its patches in the map [m]."""
    normal: tuple[float, float, float]
    """Normal of the surface, toward the sensor or away from it."""
    separation_m: float
    """Distance of the two layers [m]."""
    limit_m: float
    """Largest separation explained by noise and pose errors [m]."""
    sigma_m: float
    """Thickness of one layer (standard deviation within a visit) [m]."""
    bimodality: float
    """Ashman's D, ``separation / sigma``: above 2 the layers are distinct."""
    share: float
    """Fraction of the points in the weaker layer, 0..0.5."""
    patches: int
    """Number of patches of this place."""
    points: int
    spans_s: tuple[tuple[float, float], tuple[float, float]]
    """First and last second since the start of the visits of both layers."""
    frames: tuple[tuple[int, int], tuple[int, int]]
    """First and last multiframe of both layers."""


@dataclass(frozen=True, slots=True)
class DoubleReport:
    """Result of the double wall check."""

    walls: tuple[DoubleWall, ...]
    """Double walls, the largest separation first."""
    surfaces: tuple[DoubleWall, ...]
    """Other surfaces, the nearest to their limit first; at most `DOUBLE_PLACES.max_surfaces`."""
    patches: int
    """Flat patches with at least two visits: the only ones that can be checked."""
    double_patches: int
    share: float
    """Fraction of double patches among those visited twice, 0..1."""
    median_separation_m: float | None
    """Median separation of all patches visited twice [m]; None = there are none."""
    p95_separation_m: float | None
    median_sigma_m: float | None
    """Thickness of a surface within a visit [m]."""
    points: int


@dataclass(frozen=True, slots=True, eq=False)
class Patches:
    """Flat patches with at least two visits, as columns (P,) or (P, 3)."""

    middle_m: Array
    normal: Array
    sigma_m: Array
    separation_m: Array
    limit_m: Array
    share: Array
    points: Array
    spans_s: Array
    frames: Array
    double: NDArray[np.bool_]


def report(found: list[Patches], points: int) -> DoubleReport:
    """Combine the patches of all tiles into a report.

    Args:
        found: Patches of one tile each, in any order.
        points: How many points the map has.
    """
    every = _joined(found)
    separation = every.separation_m
    median, p95 = np.percentile(separation, [50, 95]) if len(separation) else (np.nan, np.nan)
    sigma = float(np.median(every.sigma_m)) if len(separation) else np.nan
    double = int(every.double.sum())
    walls = _places(every, every.double)
    others = _places(every, ~every.double)
    surfaces = [others[place] for place in others.keys() - walls.keys()]
    surfaces.sort(key=lambda one: (-one.separation_m / one.limit_m, one.middle_m))
    return DoubleReport(
        walls=tuple(sorted(walls.values(), key=lambda one: (-one.separation_m, one.middle_m))),
        surfaces=tuple(surfaces[: DOUBLE_PLACES.max_surfaces]),
        patches=len(separation),
        double_patches=double,
        share=double / len(separation) if len(separation) else 0.0,
        median_separation_m=finite_or_none(median),
        p95_separation_m=finite_or_none(p95),
        median_sigma_m=finite_or_none(sigma),
        points=points,
    )


def _joined(found: list[Patches]) -> Patches:
    """All patches in one table."""
    if not found:
        one, three = np.empty(0), np.empty((0, 3))
        none = np.empty((0, 2, 2))
        return Patches(
            middle_m=three, normal=three, sigma_m=one, separation_m=one, limit_m=one, share=one,
            points=one, spans_s=none, frames=none, double=np.empty(0, np.bool_),
        )  # fmt: skip
    columns = {
        f.name: np.concatenate([getattr(part, f.name) for part in found]) for f in fields(Patches)
    }
    return Patches(**columns)


def _places(every: Patches, chosen: NDArray[np.bool_]) -> dict[tuple[int, ...], DoubleWall]:
    """Places of the chosen patches, by cell and axis they face."""
    rows = np.flatnonzero(chosen)
    facing = np.argmax(np.abs(every.normal[rows]), axis=1)
    cell = np.floor(every.middle_m[rows] / DOUBLE_PLACES.place_m).astype(np.int64)
    keys, owner, count = np.unique(
        np.column_stack([cell, facing]), axis=0, return_inverse=True, return_counts=True
    )
    order = np.argsort(owner.ravel(), kind="stable")
    parts = np.split(rows[order], np.cumsum(count)[:-1])
    return {
        tuple(key): _wall(every, part)
        for key, part in zip(keys.tolist(), parts, strict=False)
        if len(part) >= DOUBLE_PLACES.min_patches
    }


def _wall(every: Patches, rows: NDArray[np.intp]) -> DoubleWall:
    def median(values: Array) -> float:
        return float(np.median(values[rows]))

    typical = rows[np.argsort(every.separation_m[rows], kind="stable")[len(rows) // 2]]
    separation, sigma = median(every.separation_m), median(every.sigma_m)
    x, y, z = every.middle_m[rows].mean(axis=0).tolist()
    nx, ny, nz = every.normal[typical].tolist()
    (a0, a1), (b0, b1) = every.spans_s[typical].tolist()
    (fa0, fa1), (fb0, fb1) = every.frames[typical].astype(int).tolist()
    return DoubleWall(
        middle_m=(x, y, z),
        normal=(nx, ny, nz),
        separation_m=separation,
        limit_m=median(every.limit_m),
        sigma_m=sigma,
        bimodality=separation / max(sigma, 1e-6),
        share=median(every.share),
        patches=len(rows),
        points=int(every.points[rows].sum()),
        spans_s=((a0, a1), (b0, b1)),
        frames=((fa0, fa1), (fb0, fb1)),
    )
