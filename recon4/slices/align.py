"""Laying a reference onto the map: by ICP or by pairs of points. Never done unasked."""

from __future__ import annotations

import numpy as np

from recon4.errors import ConfigError
from recon4.evaluation.mesh import fit_planes, sample_mesh
from recon4.geometry.se3 import SE3, Array, align_points
from recon4.mapping.tiles import TileSet
from recon4.slices.reference import Reference

_SAMPLES = 60_000
_TARGETS = 400_000


def align_by_pairs(p_map: Array, p_reference: Array) -> tuple[SE3, Array]:
    """Rigid fit of points picked in both (N, 3).

    Returns:
        ``T_map_reference`` and what remains at each pair [m], (N,).

    Raises:
        ConfigError: With fewer than three pairs, or pairs on a line.
    """
    if len(p_map) < 3 or len(p_map) != len(p_reference):
        raise ConfigError(f"an alignment takes three pairs of points or more, got {len(p_map)}")
    if np.linalg.matrix_rank(p_reference - p_reference.mean(axis=0), tol=0.05) < 2:
        raise ConfigError("the points of the pairs lie on a line: the turn about it is open")
    T = align_points(p_map, p_reference)
    return T, np.linalg.norm(p_map - T @ p_reference, axis=1)


def align_by_icp(tiles: TileSet, reference: Reference, *, rng: np.random.Generator) -> SE3:
    """Point-to-plane ICP of the map onto the reference, from the present alignment on.

    Both must be within half a metre of each other; the figures after it say nothing about a
    common shift or turn any more (V aligns by ICP too).

    Returns:
        ``T_map_reference``.

    Raises:
        ConfigError: If too little of the map lies near the reference.
    """
    p_map = _sample_map(tiles, rng)
    q, normals = _targets(reference, rng)
    start = reference.T_map_reference.inverse()
    T_reference_map, matched = fit_planes(p_map, q, normals, T_model_map=start)
    if matched < 100:
        raise ConfigError("the map and the reference do not lie on each other: align by pairs")
    return T_reference_map.inverse()


def _sample_map(tiles: TileSet, rng: np.random.Generator) -> Array:
    share = min(1.0, _SAMPLES / max(1, len(tiles)))
    parts = [tile.xyz_m(limit=int(np.ceil(share * len(tile)))) for tile in tiles]
    points = np.concatenate(parts or [np.empty((0, 3))])
    return points[rng.permutation(len(points))[:_SAMPLES]]


def _targets(reference: Reference, rng: np.random.Generator) -> tuple[Array, Array]:
    if reference.mesh is not None:
        return sample_mesh(reference.mesh, spacing_m=0.05, rng=rng)
    assert reference.tiles is not None
    share = min(1.0, _TARGETS / max(1, len(reference.tiles)))
    points, normals = [np.empty((0, 3))], [np.empty((0, 3))]
    for tile in reference.tiles:
        limit = int(np.ceil(share * len(tile)))
        columns = tile.read(["normal"], limit=limit)
        known = np.any(columns["normal"] != 0.0, axis=1)
        points.append(tile.xyz_m(limit=limit)[known])
        normals.append(columns["normal"][known].astype(np.float64))
    return np.concatenate(points), np.concatenate(normals)
