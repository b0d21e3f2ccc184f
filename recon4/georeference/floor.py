"""Leveling by the dominant floor, for recordings without an IMU (requirements A8)."""

from __future__ import annotations

import numpy as np

from recon4.geometry.se3 import Array
from recon4.georeference.level import NOT_LEVELED, Leveling, tilt_to
from recon4.georeference.tuning_leveling import FLOOR


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
    normals = _patch_normals(p_odom[near])
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
    angles = np.arccos(np.clip(normals[kept] @ up, -1.0, 1.0))
    spread = float(np.sqrt(np.mean(angles**2)))
    return Leveling(tilt_to(up), "floor", int(kept.sum()), int((~kept).sum()), spread)


def _patch_normals(p_odom: Array) -> Array:
    """Upward normals of flat, nearly horizontal cells, (P, 3)."""
    if len(p_odom) == 0:
        return np.zeros((0, 3))
    cell = np.floor(p_odom / FLOOR.cell_m).astype(np.int64)
    _, patch, count = np.unique(cell, axis=0, return_inverse=True, return_counts=True)
    patch = patch.reshape(-1)
    mean = np.stack([np.bincount(patch, p_odom[:, k]) for k in range(3)], 1) / count[:, None]
    d = p_odom - mean[patch]
    cov = np.empty((len(count), 3, 3))
    for a in range(3):
        for b in range(3):
            cov[:, a, b] = np.bincount(patch, d[:, a] * d[:, b]) / count
    variance, axes = np.linalg.eigh(cov[count >= FLOOR.min_points])
    normal = axes[:, :, 0] * np.sign(axes[:, 2:3, 0])
    # A strip (one scan line) has no normal: the second extent must be that of a surface.
    flat = (variance[:, 0] < FLOOR.flatness_m**2) & (variance[:, 1] > (FLOOR.cell_m / 8.0) ** 2)
    return normal[flat & (normal[:, 2] > np.cos(FLOOR.max_tilt_rad))]
