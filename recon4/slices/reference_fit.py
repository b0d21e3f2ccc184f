"""Whether a reference fits the map at all: a wrong one still has points near it."""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from recon4.evaluation.reference_mesh import SurfacePoints, sample_mesh
from recon4.geometry.se3 import SE3
from recon4.locales.coded import CodedText
from recon4.mapping.tiles import TileSet
from recon4.slices.reference import FAR, FITS, MISFIT, Reference
from recon4.slices.tuning import REFERENCE_FIT
from recon4.slices.tuning_files import REFERENCES


@dataclass(frozen=True, slots=True)
class ReferenceFit:
    """How well map and reference lie on each other."""

    near_ratio: float
    """Ratio of the map within 50 cm of the reference, 0..1."""
    walls_ratio: float | None
    """Of the walls within 2 m of the other: ratio within 10 cm of one of the same orientation.
    None = hardly any walls."""
    level_ratio: float | None
    """The same of floors and ceilings. These agree also where the reference is turned."""
    fits: bool | None
    """None = not judged: map or reference have hardly any flat surface."""
    text: str
    """The same in words, a `CodedText`."""


def reference_fit(
    map_points: SurfacePoints, surface: SurfacePoints, T_map_reference: SE3
) -> ReferenceFit:
    """Compare samples of a map with samples of a reference, in its own frame.

    Each is compared with the other: either may be one room of the other's building, and then the
    larger one has surfaces beside it that are not in the smaller one.
    """
    if not len(map_points.p) or not len(surface.p):
        return ReferenceFit(0.0, None, None, None, CodedText("reference-unjudged"))
    moved = SurfacePoints(T_map_reference @ surface.p, surface.normals @ T_map_reference.R.T)
    ours, theirs = _agreement(map_points, moved), _agreement(moved, map_points)
    return _judged(
        ours.near_ratio, _best(ours.walls, theirs.walls), _best(ours.level, theirs.level)
    )


class _Agreement(NamedTuple):
    near_ratio: float
    walls: float | None
    level: float | None


def _agreement(points: SurfacePoints, other: SurfacePoints) -> _Agreement:
    """How many of the points near another surface lie on it."""
    from scipy.spatial import cKDTree

    every = max(1, len(points.p) // REFERENCE_FIT.compared)
    p, normals = points.p[::every], points.normals[::every]
    distance, row = cKDTree(other.p).query(p, distance_upper_bound=REFERENCE_FIT.covered_m)
    covered = np.isfinite(distance)
    n, m = normals[covered], other.normals[row[covered]]
    across = np.abs(np.einsum("ni,ni->n", m, p[covered] - other.p[row[covered]]))
    agrees = (across < REFERENCE_FIT.on_m) & (
        np.abs(np.einsum("ni,ni->n", n, m)) > REFERENCE_FIT.parallel
    )
    agrees &= distance[covered] < REFERENCES.far_m
    level = np.abs(n[:, 2]) > REFERENCE_FIT.level
    near_ratio = float((distance < REFERENCES.far_m).mean())
    return _Agreement(near_ratio, _ratio(agrees, ~level), _ratio(agrees, level))


def _best(a: float | None, b: float | None) -> float | None:
    return max((ratio for ratio in (a, b) if ratio is not None), default=None)


def fit_of(tiles: TileSet, reference: Reference, *, rng: np.random.Generator) -> ReferenceFit:
    """How well a reference lies on the map at its present alignment."""
    map_points = sample_tiles(tiles, REFERENCE_FIT.samples)
    return reference_fit(map_points, sample_reference(reference, rng), reference.T_map_reference)


def sample_tiles(tiles: TileSet, count: int) -> SurfacePoints:
    """Points with normals spread over a map or cloud; those without a normal are left out."""
    ratio = min(1.0, count / max(1, len(tiles)))
    points, normals = [np.empty((0, 3))], [np.empty((0, 3))]
    for tile in tiles:
        limit = int(np.ceil(ratio * len(tile)))
        columns = tile.read(["normal"], limit=limit)
        known = np.any(columns["normal"] != 0.0, axis=1)
        points.append(tile.xyz_m(limit=limit)[known])
        normals.append(columns["normal"][known].astype(np.float64))
    return SurfacePoints(np.concatenate(points), np.concatenate(normals))


def sample_reference(reference: Reference, rng: np.random.Generator) -> SurfacePoints:
    """Points with normals spread over a reference, in its own frame."""
    if reference.mesh is not None:
        return sample_mesh(reference.mesh, spacing_m=0.05, rng=rng)
    assert reference.tiles is not None
    return sample_tiles(reference.tiles, REFERENCE_FIT.samples)


def _ratio(agrees: NDArray[np.bool_], group: NDArray[np.bool_]) -> float | None:
    count = int(group.sum())
    if count < max(REFERENCE_FIT.least_points, REFERENCE_FIT.least_part * len(group)):
        return None
    return float(agrees[group].mean())


def _judged(near: float, walls: float | None, level: float | None) -> ReferenceFit:
    if near < REFERENCE_FIT.least_near:
        far = CodedText(FAR, near=near, limit_cm=round(100.0 * REFERENCES.far_m))
        return ReferenceFit(near, walls, level, False, far)
    known = [ratio for ratio in (walls, level) if ratio is not None]
    if not known:
        return ReferenceFit(near, walls, level, None, CodedText("reference-unjudged"))
    fits = all(ratio >= REFERENCE_FIT.least_agreeing for ratio in known)
    text = CodedText(
        FITS if fits else MISFIT,
        walls=_quoted(walls),
        level=_quoted(level),
        limit_cm=round(100.0 * REFERENCE_FIT.on_m),
    )
    return ReferenceFit(near, walls, level, fits, text)


def _quoted(ratio: float | None) -> float:
    """A ratio as texts quote it; negative = not known."""
    return -1.0 if ratio is None else ratio
