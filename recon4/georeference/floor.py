"""Leveling by the dominant floor, for walks without IMU."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from recon4.geometry.se3 import Array
from recon4.georeference.level import NOT_LEVELED, Leveling, tilt_to
from recon4.georeference.tuning_leveling import FLOOR, LEVELING


@dataclass(frozen=True, slots=True, eq=False)
class _FloorPatches:
    """Flat, nearly horizontal pieces of floor."""

    middle: Array
    """[m], (P, 3)."""
    covariance: Array
    """Of the points of each [m²], (P, 3, 3)."""
    normal: Array
    """Upward, (P, 3)."""

    def only(self, rows: NDArray[np.bool_]) -> _FloorPatches:
        return _FloorPatches(self.middle[rows], self.covariance[rows], self.normal[rows])


def level_by_floor(p_odom: Array, origin_odom: Array) -> Leveling:
    """Level by the direction that most horizontal patches below the sensor have in common.

    Only directions are compared: stories, landings and stair treads contribute, ramps are
    outliers.

    Args:
        p_odom: Points of the map, a sample [m], (N, 3).
        origin_odom: Position of the body when each was measured [m], (N, 3). Its z axis must be
            up within 30 degrees.

    Returns:
        ``source == "none"`` if fewer than five patches agree.
    """
    offset = p_odom - origin_odom
    near = (offset[:, 2] < -FLOOR.below_m) & (np.hypot(offset[:, 0], offset[:, 1]) < FLOOR.near_m)
    patches = _floor_patches(p_odom[near])
    normals = patches.normal
    if len(normals) < FLOOR.min_patches:
        return NOT_LEVELED
    step = max(1, len(normals) // FLOOR.max_candidates)
    agree = normals[::step] @ normals.T > np.cos(FLOOR.agree_rad)
    up = normals[::step][np.argmax(agree.sum(1))]
    for _ in range(5):
        kept = normals @ up > np.cos(FLOOR.agree_rad)
        up = normals[kept].mean(0) / np.linalg.norm(normals[kept].mean(0))
    if kept.sum() < FLOOR.min_patches:
        return NOT_LEVELED
    up = _normal_of_levels(patches.only(kept), up)
    angles = np.arccos(np.clip(normals[kept] @ up, -1.0, 1.0))
    spread = float(np.sqrt(np.mean(angles**2)))
    return Leveling(tilt_to(up), "floor", int(kept.sum()), int((~kept).sum()), spread)


def _floor_patches(p_odom: Array) -> _FloorPatches:
    """Flat, nearly horizontal cells."""
    if len(p_odom) == 0:
        return _FloorPatches(np.zeros((0, 3)), np.zeros((0, 3, 3)), np.zeros((0, 3)))
    cell = np.floor(p_odom / FLOOR.cell_m).astype(np.int64)
    _, patch, count = np.unique(cell, axis=0, return_inverse=True, return_counts=True)
    patch = patch.reshape(-1)
    mean = np.stack([np.bincount(patch, p_odom[:, k]) for k in range(3)], 1) / count[:, None]
    d = p_odom - mean[patch]
    cov = np.empty((len(count), 3, 3))
    for a in range(3):
        for b in range(3):
            cov[:, a, b] = np.bincount(patch, d[:, a] * d[:, b]) / count
    many = count >= FLOOR.min_points
    variance, axes = np.linalg.eigh(cov[many])
    normal = axes[:, :, 0] * np.sign(axes[:, 2:3, 0])
    # A strip (one scan line) has no normal: the second extent must be that of a surface.
    flat = (variance[:, 0] < FLOOR.flatness_m**2) & (variance[:, 1] > (FLOOR.cell_m / 8.0) ** 2)
    rows = flat & (normal[:, 2] > np.cos(FLOOR.max_tilt_rad))
    return _FloorPatches(mean[many][rows], cov[many][rows], normal[rows])


def _normal_of_levels(patches: _FloorPatches, up: Array) -> Array:
    """The common normal of the planes in which patches lie, by least squares.

    A floor of meters says it better than its patches, whose normals turn where a wall or a chair
    begins. Neighbors of nearly one height are of one plane: a threshold, a kerb, or a step of
    a flight of stairs parts two.

    Args:
        patches: Some.
        up: Nearly the normal, (3,).
    """
    level = _levels(patches.middle, up)
    kept = np.ones(len(level), np.bool_)
    for _ in range(5):
        count = np.maximum(np.bincount(level, kept), 1)
        middle = [np.bincount(level, kept * x) / count for x in patches.middle.T]
        off = patches.middle - np.stack(middle, axis=1)[level]
        scatter = patches.covariance[kept].sum(axis=0) + off[kept].T @ off[kept]
        normal = np.linalg.eigh(scatter)[1][:, 0]
        up = normal * np.sign(normal @ up)
        away_m = np.abs(off @ up)
        kept = away_m <= LEVELING.trim * 1.4826 * np.median(away_m) + 1e-9
    return up


def _levels(p: Array, up: Array) -> NDArray[np.int32]:
    """Which plane each patch is of, by their middles (P, 3) [m], (P,)."""
    from scipy.sparse import coo_array
    from scipy.sparse.csgraph import connected_components
    from scipy.spatial import cKDTree

    a, b = cKDTree(p).query_pairs(FLOOR.reach_m, output_type="ndarray").T
    flat = np.abs((p[a] - p[b]) @ up) < FLOOR.step_m
    joined = coo_array((np.ones(flat.sum()), (a[flat], b[flat])), shape=(len(p), len(p)))
    level: NDArray[np.int32] = connected_components(joined, directed=False)[1]
    return level
