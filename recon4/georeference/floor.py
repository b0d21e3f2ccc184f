"""Leveling by the dominant floor, for recordings without an IMU (requirements A8)."""

from __future__ import annotations

import numpy as np

from recon4.geometry.se3 import Array
from recon4.georeference.level import NOT_LEVELED, Leveling, tilt_to

_CELL_M = 0.4
_MIN_POINTS = 12
_BELOW_M = 0.3
"""The floor lies at least this far below the sensor [m]."""
_NEAR_M = 8.0
_MAX_TILT_RAD = np.deg2rad(30.0)
_FLATNESS_M = 0.03
"""Thickness of a patch of floor (standard deviation)."""
_AGREE_RAD = np.deg2rad(2.0)
_MIN_PATCHES = 5
_MAX_CANDIDATES = 500


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
    near = (offset[:, 2] < -_BELOW_M) & (np.hypot(offset[:, 0], offset[:, 1]) < _NEAR_M)
    normals = _patch_normals(p_odom[near])
    if len(normals) < _MIN_PATCHES:
        return NOT_LEVELED
    step = max(1, len(normals) // _MAX_CANDIDATES)
    agree = normals[::step] @ normals.T > np.cos(_AGREE_RAD)
    up = normals[::step][np.argmax(agree.sum(1))]
    for _ in range(5):
        kept = normals @ up > np.cos(_AGREE_RAD)
        up = normals[kept].mean(0) / np.linalg.norm(normals[kept].mean(0))
    if kept.sum() < _MIN_PATCHES:
        return NOT_LEVELED
    angles = np.arccos(np.clip(normals[kept] @ up, -1.0, 1.0))
    spread = float(np.sqrt(np.mean(angles**2)))
    return Leveling(tilt_to(up), "floor", int(kept.sum()), int((~kept).sum()), spread)


def _patch_normals(p_odom: Array) -> Array:
    """Upward normals of flat, nearly horizontal cells, (P, 3)."""
    if len(p_odom) == 0:
        return np.zeros((0, 3))
    cell = np.floor(p_odom / _CELL_M).astype(np.int64)
    _, patch, count = np.unique(cell, axis=0, return_inverse=True, return_counts=True)
    patch = patch.reshape(-1)
    mean = np.stack([np.bincount(patch, p_odom[:, k]) for k in range(3)], 1) / count[:, None]
    d = p_odom - mean[patch]
    cov = np.empty((len(count), 3, 3))
    for a in range(3):
        for b in range(3):
            cov[:, a, b] = np.bincount(patch, d[:, a] * d[:, b]) / count
    variance, axes = np.linalg.eigh(cov[count >= _MIN_POINTS])
    normal = axes[:, :, 0] * np.sign(axes[:, 2:3, 0])
    # A strip (one scan line) has no normal: the second extent must be that of a surface.
    flat = (variance[:, 0] < _FLATNESS_M**2) & (variance[:, 1] > (_CELL_M / 8.0) ** 2)
    return normal[flat & (normal[:, 2] > np.cos(_MAX_TILT_RAD))]
