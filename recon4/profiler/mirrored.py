"""A 2-D laser mounted upside down: its scans turn against the gyroscope."""

from __future__ import annotations

import numpy as np

from recon4.geometry.se3 import Array
from recon4.model.laser_scans import LaserScans
from recon4.model.trajectory import Trajectory
from recon4.profiler.tuning_audits import MIRRORED


def is_mirrored(scans: LaserScans, attitude: Trajectory) -> bool:
    """Whether most scans turn against the gyroscope.

    Args:
        scans: Of the 2-D laser.
        attitude: ``R_map_laser`` by the IMU.
    """
    first = np.flatnonzero(
        (scans.t_ns >= attitude.t_ns[0]) & (scans.t_ns + 2 * MIRRORED.apart_ns <= attitude.t_ns[-1])
    )
    if not len(first):
        return False
    second = np.clip(
        np.searchsorted(scans.t_ns, scans.t_ns[first] + MIRRORED.apart_ns), 0, len(scans) - 1
    )
    inside = scans.t_ns[second] <= attitude.t_ns[-1]
    first, second = first[inside], second[inside]
    heading = [_heading(attitude.at(scans.t_ns[rows]).R) for rows in (first, second)]
    turn = (heading[1] - heading[0] + np.pi) % (2.0 * np.pi) - np.pi
    fast = np.argsort(-np.abs(turn))[: MIRRORED.pairs]
    fast = fast[np.abs(turn[fast]) > MIRRORED.min_turn_rad]
    if len(fast) < MIRRORED.min_pairs:
        return False
    seen = np.array([_rotation(scans, int(first[k]), int(second[k])) for k in fast])
    against = np.sign(seen) == -np.sign(turn[fast])
    return bool(np.mean(against & (seen != 0.0)) > MIRRORED.most)


def _rotation(scans: LaserScans, i: int, j: int) -> float:
    """Rotation of the laser from scan ``i`` to scan ``j`` by their ranges alone [rad]."""
    angles = scans.angles_rad(i)
    a, b = (_ranges_at(scans, k, angles) for k in (i, j))
    step = abs(float(scans.angle_step_rad[i]))
    most = min(int(MIRRORED.search_rad / step), len(a) // 3)
    shifts = range(-most, most + 1, max(1, int(np.deg2rad(0.5) / step)))
    inner = slice(most, len(a) - most)
    # Turned left by s beams, scan j at beam m shows what scan i shows at beam m + s.
    cost = [np.median(np.abs(b[inner] - np.roll(a, -s)[inner])) for s in shifts]
    best = shifts[int(np.argmin(cost))]
    return float(best * step * np.sign(scans.angle_step_rad[i]))


def _ranges_at(scans: LaserScans, k: int, angles: Array) -> Array:
    """Ranges of the beams of scan ``k`` that are nearest to some directions [m]; none is far."""
    ranges = scans.ranges(k)
    beam = np.rint((angles - scans.angle_min_rad[k]) / scans.angle_step_rad[k]).astype(np.int64)
    seen = (beam >= 0) & (beam < len(ranges))
    found = np.where(seen, ranges[np.clip(beam, 0, len(ranges) - 1)], np.nan)
    return np.nan_to_num(found.astype(np.float64), nan=MIRRORED.far_m).clip(max=MIRRORED.far_m)


def _heading(R: Array) -> Array:
    return np.asarray(np.arctan2(R[:, 1, 0], R[:, 0, 0]), dtype=np.float64)
