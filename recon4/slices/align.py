"""Alignment of a reference with the map, by ICP or by pairs of points; only on request."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from recon4.errors import ConfigError
from recon4.evaluation.reference_mesh import SurfacePoints, fit_planes, sample_mesh
from recon4.geometry.se3 import SE3, Array, align_points
from recon4.mapping.tiles import TileSet
from recon4.slices.reference import Reference

_SAMPLES = 60_000
_TARGETS = 400_000
_ROUNDS = 60
_NEAR_M = 0.5
_ON_M = 0.10
_MIN_POINTS = 100
_MIN_NEAR = 0.02
"""Smallest ratio of map points near the reference, which may be one room of a building."""
_MIN_ON = 0.6
"""Smallest inlier ratio among those points."""


def align_by_pairs(p_map: Array, p_reference: Array) -> tuple[SE3, Array]:
    """Rigid fit of corresponding points picked in map and reference, (N, 3) each.

    Returns:
        ``T_map_reference`` and the residual of each pair [m], (N,).

    Raises:
        ConfigError: With fewer than three pairs, or pairs on a line.
    """
    if len(p_map) < 3 or len(p_map) != len(p_reference):
        raise ConfigError(f"alignment: expected three pairs of points or more, got {len(p_map)}")
    if np.linalg.matrix_rank(p_reference - p_reference.mean(axis=0), tol=0.05) < 2:
        raise ConfigError(
            "alignment: the points lie on a line, so the rotation about it is undetermined"
        )
    T = align_points(p_map, p_reference)
    return T, np.linalg.norm(p_map - T @ p_reference, axis=1)


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

    @property
    def description(self) -> str:
        """One line for the list of references."""
        return (
            f"ICP, point to plane: {100.0 * self.near_ratio:.0f} % of the map near it, "
            f"of these {100.0 * self.inlier_ratio:.0f} % on it, "
            f"{100.0 * self.mean_m:.1f} cm from it on average"
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
    surface = _targets(reference, rng)
    start = reference.T_map_reference.inverse()
    fit = fit_planes(p_map, surface, T_model_map=start, rounds=_ROUNDS, max_distance_m=_NEAR_M)
    near = len(fit.distance_m)
    on = fit.distance_m[fit.distance_m < _ON_M]
    near_ratio, inlier_ratio = near / max(1, len(p_map)), len(on) / max(1, near)
    if near < _MIN_POINTS or near_ratio < _MIN_NEAR:
        raise ConfigError(
            f"ICP: the map and the reference do not overlap: {100.0 * near_ratio:.1f} % of "
            f"the map is within {100.0 * _NEAR_M:.0f} cm of it; align by pairs"
        )
    if not fit.converged or inlier_ratio < _MIN_ON:
        why = f"inlier ratio (10 cm) {100.0 * inlier_ratio:.0f} %"
        if not fit.converged:
            why = f"no convergence after {_ROUNDS} iterations"
        raise ConfigError(f"ICP did not align the reference with the map: {why}; align by pairs")
    return IcpFit(fit.T_model_map.inverse(), near_ratio, inlier_ratio, float(on.mean()))


def _sample_map(tiles: TileSet, rng: np.random.Generator) -> Array:
    ratio = min(1.0, _SAMPLES / max(1, len(tiles)))
    parts = [tile.xyz_m(limit=int(np.ceil(ratio * len(tile)))) for tile in tiles]
    points = np.concatenate(parts or [np.empty((0, 3))])
    return points[rng.permutation(len(points))[:_SAMPLES]]


def _targets(reference: Reference, rng: np.random.Generator) -> SurfacePoints:
    if reference.mesh is not None:
        return sample_mesh(reference.mesh, spacing_m=0.05, rng=rng)
    assert reference.tiles is not None
    ratio = min(1.0, _TARGETS / max(1, len(reference.tiles)))
    points, normals = [np.empty((0, 3))], [np.empty((0, 3))]
    for tile in reference.tiles:
        limit = int(np.ceil(ratio * len(tile)))
        columns = tile.read(["normal"], limit=limit)
        known = np.any(columns["normal"] != 0.0, axis=1)
        points.append(tile.xyz_m(limit=limit)[known])
        normals.append(columns["normal"][known].astype(np.float64))
    return SurfacePoints(np.concatenate(points), np.concatenate(normals))
