"""Drift over segments of the trajectory: V's metric (Eq. 3.1) and the official KITTI metric."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from recon4.evaluation.ate import PosePairs
from recon4.evaluation.tuning import SEGMENT_DRIFT
from recon4.geometry.se3 import SE3, Array

Rows = NDArray[np.integer]


OFFICIAL_M = tuple(float(length) for length in range(100, 801, 100))
"""Lengths of the pieces in the official benchmark [m]."""
WALK_M = tuple(float(length) for length in range(5, 41, 5))
"""Lengths for walks too short for the official ones [m]."""


@dataclass(frozen=True, slots=True)
class DriftRow:
    """Mean error of all pieces of one length."""

    length: float
    """Length of the pieces in the unit of the table."""
    pieces: int
    translation: float
    """Error of the end position over the length of the piece [m/m]; NaN = no piece."""
    rotation_rad_m: float
    """Error of the end rotation over the length of the piece [rad/m]; NaN = no piece."""


@dataclass(frozen=True, slots=True)
class Drift:
    """Drift by one metric."""

    metric: str
    """Name of the metric and its lengths."""
    unit: str
    """Unit of `DriftRow.length`: ``frames`` or ``m``."""
    rows: tuple[DriftRow, ...]
    pieces: int
    translation: float
    """Mean over all pieces [m/m]; NaN = the walk is shorter than the shortest piece."""
    rotation_rad_m: float
    """Mean over all pieces [rad/m]."""


def thesis_drift(
    pairs: PosePairs, *, lengths: Sequence[int] = SEGMENT_DRIFT.thesis_frames, step: int = 10
) -> Drift:
    """V Eq. 3.1: ``|E_s - C_s| / l_s`` over pieces of n frames.

    ``E_s`` and ``C_s`` are the true and the estimated end position, aligned at the first pose of
    the piece; ``l_s`` is the path length of the ground truth in it.

    Args:
        pairs: One pose a frame.
        lengths: Lengths of the pieces [frames].
        step: Frames between the starts of two pieces.
    """
    starts = np.arange(0, len(pairs), step)
    ends = {float(n): np.where(starts + n < len(pairs), starts + n, -1) for n in lengths}
    name = f"V Eq. 3.1, pieces of {lengths[0]} to {lengths[-1]} frames"
    return _drift(pairs, starts, ends, metric=name, unit="frames")


def official_drift(
    pairs: PosePairs, *, lengths_m: Sequence[float] = OFFICIAL_M, step: int = 10
) -> Drift:
    """The official KITTI metric: pieces of a given path length of the ground truth.

    Args:
        pairs: One pose a frame.
        lengths_m: Lengths of the pieces [m]; stated in the result.
        step: Frames between the starts of two pieces.
    """
    path_length_m = _path_length_m(pairs)
    starts = np.arange(0, len(pairs), step)
    ends = {}
    for length_m in lengths_m:
        end = np.searchsorted(path_length_m, path_length_m[starts] + length_m, side="right")
        ends[float(length_m)] = np.where(end < len(pairs), end, -1)
    official = tuple(lengths_m) == OFFICIAL_M
    name = f"KITTI, pieces of {lengths_m[0]:g} to {lengths_m[-1]:g} m"
    name = name if official else f"{name} (not official)"
    return _drift(pairs, starts, ends, metric=name, unit="m")


def _path_length_m(pairs: PosePairs) -> Array:
    """Path length of the ground truth before each pose [m], (N,)."""
    steps_m = np.linalg.norm(np.diff(pairs.T_true_body.t, axis=0), axis=1)
    return np.concatenate([[0.0], np.cumsum(steps_m)])


def _drift(
    pairs: PosePairs, starts: Rows, ends: dict[float, Rows], *, metric: str, unit: str
) -> Drift:
    path_length_m = _path_length_m(pairs)
    rows, all_translation, all_rotation = [], [], []
    for length, end in ends.items():
        first, last = starts[end >= 0], end[end >= 0]
        covered_m = path_length_m[last] - path_length_m[first]
        moved = covered_m > SEGMENT_DRIFT.min_path_m
        first, last, covered_m = first[moved], last[moved], covered_m[moved]
        length_m = covered_m if unit == "frames" else np.full(len(last), length)
        error = _end_errors(pairs, first, last)
        translation = np.linalg.norm(error.t, axis=1) / length_m
        rotation = error.angle() / length_m
        rows.append(DriftRow(length, len(translation), _mean(translation), _mean(rotation)))
        all_translation.append(translation)
        all_rotation.append(rotation)
    translation, rotation = np.concatenate(all_translation), np.concatenate(all_rotation)
    return Drift(metric, unit, tuple(rows), len(translation), _mean(translation), _mean(rotation))


def _end_errors(pairs: PosePairs, first: Rows, last: Rows) -> SE3:
    """Error of the end pose of each piece, aligned at its first pose."""
    T_estimated = pairs.T_map_body[first].inverse() @ pairs.T_map_body[last]
    T_true = pairs.T_true_body[first].inverse() @ pairs.T_true_body[last]
    return T_true.inverse() @ T_estimated


def _mean(values: Array) -> float:
    return float(values.mean()) if len(values) else float("nan")
