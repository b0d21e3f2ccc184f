"""Alignment of a reference with the map, by ICP or by pairs of points; only on request."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from recon4.errors import ConfigError
from recon4.evaluation.reference_mesh import SurfacePoints, fit_planes
from recon4.geometry.se3 import SE3, Array, align_points
from recon4.locales.coded import CodedText, as_coded
from recon4.mapping.tiles import TileSet
from recon4.slices.reference import FAR, MISFIT, Reference
from recon4.slices.reference_fit import fit_of, sample_reference, sample_tiles
from recon4.slices.tuning import ALIGNMENT

_REFUSED = {FAR: "align-far", MISFIT: "align-misfit"}
"""What is said of an alignment after which the reference does not fit."""


def align_by_pairs(p_map: Array, p_reference: Array) -> tuple[SE3, Array]:
    """Rigid fit of corresponding points picked in map and reference, (N, 3) each.

    Returns:
        ``T_map_reference`` and the residual of each pair [m], (N,).

    Raises:
        ConfigError: With fewer than three pairs, or pairs on a line.
    """
    _check_pairs(p_map, p_reference, axes=3)
    T = align_points(p_map, p_reference)
    return T, np.linalg.norm(p_map - T @ p_reference, axis=1)


def align_level_pairs(p_map: Array, p_reference: Array, *, up_m: float) -> tuple[SE3, Array]:
    """Fit of points picked from above: rotation about the vertical and horizontal translation.

    Points on a wall picked from above have any height, so heights of the pairs are not used.

    Args:
        p_map: Picked in the map [m], (N, 3).
        p_reference: The same points in the reference [m], (N, 3).
        up_m: Height of the map minus that of the reference, see `floor_offset`.

    Returns:
        ``T_map_reference`` and the horizontal residual of each pair [m], (N,).

    Raises:
        ConfigError: With fewer than three pairs, or pairs at one place.
    """
    _check_pairs(p_map, p_reference, axes=2)
    flat = np.array([1.0, 1.0, 0.0])
    # A fourth point above the middle holds the vertical axis.
    above = np.array([0.0, 0.0, 1e3])
    a = np.vstack([p_map * flat, (p_map * flat).mean(axis=0) + above])
    b = np.vstack([p_reference * flat, (p_reference * flat).mean(axis=0) + above])
    T = align_points(a, b)
    T = SE3(T.R, T.t * flat + np.array([0.0, 0.0, up_m]))
    return T, np.linalg.norm((p_map - T @ p_reference) * flat, axis=1)


def floor_offset(
    tiles: TileSet,
    reference: Reference,
    p_map: Array,
    *,
    p_reference: Array,
    rng: np.random.Generator,
) -> float:
    """Height of the map's floor minus that of the reference near picked points [m].

    The lowest level of many points on level surfaces within 3 m of the points; 0 where there is
    none.
    """
    ours = _floor_m(sample_tiles(tiles, ALIGNMENT.floor_samples), p_map)
    theirs = _floor_m(sample_reference(reference, rng), p_reference)
    return 0.0 if ours is None or theirs is None else ours - theirs


def _floor_m(surface: SurfacePoints, near: Array) -> float | None:
    from scipy.spatial import cKDTree

    distance, _ = cKDTree(near[:, :2]).query(
        surface.p[:, :2], distance_upper_bound=ALIGNMENT.floor_near_m
    )
    level = np.isfinite(distance) & (np.abs(surface.normals[:, 2]) > ALIGNMENT.level)
    z = surface.p[level, 2]
    if len(z) < ALIGNMENT.min_points:
        return None
    count, edges = np.histogram(
        z, np.arange(z.min() - ALIGNMENT.bin_m, z.max() + 2 * ALIGNMENT.bin_m, ALIGNMENT.bin_m)
    )
    lowest = int(np.flatnonzero(count >= 0.3 * count.max())[0])
    found = z[np.abs(z - edges[lowest : lowest + 2].mean()) <= ALIGNMENT.bin_m]
    return float(np.median(found))


def _check_pairs(p_map: Array, p_reference: Array, *, axes: int) -> None:
    if len(p_map) < 3 or len(p_map) != len(p_reference):
        raise ConfigError(CodedText("align-pairs-few", pairs=len(p_map)))
    spread = p_reference[:, :axes] - p_reference[:, :axes].mean(axis=0)
    if np.linalg.matrix_rank(spread, tol=0.05) < axes - 1:
        raise ConfigError(CodedText("align-pairs-line" if axes == 3 else "align-pairs-place"))


@dataclass(frozen=True, slots=True)
class IcpFit:
    """An alignment by ICP and its quality."""

    T_map_reference: SE3
    near_ratio: float
    """Ratio of the map points within 0.5 m of the reference, 0..1."""
    inlier_ratio: float
    """Ratio of these within 10 cm of its surface, 0..1."""
    mean_m: float
    """Mean distance of the inliers from the surface [m]."""
    text: str
    """Whether the reference fits the map, see `ReferenceFit`."""

    @property
    def description(self) -> CodedText:
        """One line for the list of references."""
        return CodedText(
            "alignment-icp", near=self.near_ratio, on=self.inlier_ratio, mean_m=self.mean_m
        )


def align_by_icp(tiles: TileSet, reference: Reference, *, rng: np.random.Generator) -> IcpFit:
    """Point-to-plane ICP of the map onto the reference, from the present alignment on.

    Both must be within 0.5 m of each other. Errors measured after it no longer include a common
    translation or rotation (V aligns by ICP too).

    Raises:
        ConfigError: If too few map points lie near the reference or on it, or ICP did not
            converge.
    """
    p_map = _sample_map(tiles, rng)
    surface = sample_reference(reference, rng)
    start = reference.T_map_reference.inverse()
    fit = fit_planes(
        p_map, surface, T_model_map=start, rounds=ALIGNMENT.rounds, max_distance_m=ALIGNMENT.near_m
    )
    near = len(fit.distance_m)
    on = fit.distance_m[fit.distance_m < ALIGNMENT.on_m]
    near_ratio, inlier_ratio = near / max(1, len(p_map)), len(on) / max(1, near)
    if near < ALIGNMENT.min_points or near_ratio < ALIGNMENT.min_near:
        limit_cm = round(100.0 * ALIGNMENT.near_m)
        raise ConfigError(CodedText("align-apart", near=near_ratio, limit_cm=limit_cm))
    if not fit.converged:
        raise ConfigError(CodedText("align-endless", rounds=ALIGNMENT.rounds))
    if inlier_ratio < ALIGNMENT.min_on:
        limit_cm = round(100.0 * ALIGNMENT.on_m)
        raise ConfigError(CodedText("align-off", on=inlier_ratio, limit_cm=limit_cm))
    T = fit.T_model_map.inverse()
    check = fit_of(tiles, replace(reference, T_map_reference=T), rng=rng)
    if check.fits is False:
        # Floors and ceilings lie on each other also where a reference is turned.
        why = as_coded(check.text)
        raise ConfigError(CodedText(_REFUSED[why.code], **why.values))
    return IcpFit(T, near_ratio, inlier_ratio, float(on.mean()), check.text)


def _sample_map(tiles: TileSet, rng: np.random.Generator) -> Array:
    ratio = min(1.0, ALIGNMENT.samples / max(1, len(tiles)))
    parts = [tile.xyz_m(limit=int(np.ceil(ratio * len(tile)))) for tile in tiles]
    points = np.concatenate(parts or [np.empty((0, 3))])
    return points[rng.permutation(len(points))[: ALIGNMENT.samples]]
