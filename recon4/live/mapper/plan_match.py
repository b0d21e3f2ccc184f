"""Horizontal pose hypotheses of a view in a map, by correlation of two plans of walls."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy import ndimage

from recon4.geometry.se3 import Array
from recon4.live.mapper.tuning import PLAN_MATCH


def plan_hypotheses(
    target_m: Array,
    source_m: Array,
    *,
    most: int,
    heading: tuple[float, float] | None = None,
) -> list[tuple[float, Array]]:
    """Rotations and shifts that align most walls of a view with walls of the map, best first.

    The number of points of the view on walls of the map is, for one rotation and all shifts, the
    cross-correlation of the two plans; it is computed by FFT.

    Args:
        target_m: Horizontal wall points of the map relative to the place [m], (N, 2).
        source_m: Horizontal wall points of the view relative to the sensor [m], (M, 2).
        most: Number of hypotheses.
        heading: Yaw and how far the true one can be from it [rad]; None = any.

    Returns:
        Yaw [rad] and shift [m] (2,) that map the view onto the map, up to 5 m away.
    """
    source_m = source_m[np.linalg.norm(source_m, axis=1) < PLAN_MATCH.reach_m]
    if not len(source_m) or not len(target_m):
        return []
    walls = ndimage.gaussian_filter(np.minimum(_raster(target_m), 1.0), 1.0)
    spectrum = np.fft.rfft2(walls)
    yaws = _yaws(heading)
    reach = round(PLAN_MATCH.shift_m / PLAN_MATCH.cell_m)
    shifts = np.arange(-reach, reach + 1)
    scores = np.stack([_scores(spectrum, source_m, yaw)[np.ix_(shifts, shifts)] for yaw in yaws])
    found = []
    for _ in range(most):
        k, i, j = np.unravel_index(int(np.argmax(scores)), scores.shape)
        found.append((float(yaws[k]), np.array([shifts[i], shifts[j]]) * PLAN_MATCH.cell_m))
        _suppress(scores, yaws, (int(k), int(i), int(j)))
    return found


def _yaws(heading: tuple[float, float] | None) -> Array:
    """The yaws that are tried [rad]."""
    center, reach = heading or (np.pi, np.pi)
    steps = int(min(reach, np.pi) / PLAN_MATCH.yaw_step_rad)
    yaws: Array = center + PLAN_MATCH.yaw_step_rad * np.arange(-steps, steps + 1.0)
    return yaws


def _scores(spectrum: NDArray[np.complex128], source_m: Array, yaw: float) -> Array:
    c, s = np.cos(yaw), np.sin(yaw)
    plan = np.minimum(_raster(source_m @ np.array([[c, s], [-s, c]])), 3.0)
    scores: Array = np.fft.irfft2(spectrum * np.conj(np.fft.rfft2(plan)), s=plan.shape)
    return scores


def _raster(p_m: Array) -> Array:
    cells = np.floor(p_m / PLAN_MATCH.cell_m + 0.5).astype(np.int64) + PLAN_MATCH.cells // 2
    cells = cells[((cells >= 0) & (cells < PLAN_MATCH.cells)).all(axis=1)]
    counts = np.bincount(
        cells[:, 0] * PLAN_MATCH.cells + cells[:, 1], minlength=PLAN_MATCH.cells**2
    )
    return counts.reshape(PLAN_MATCH.cells, PLAN_MATCH.cells).astype(np.float64)


def _suppress(scores: Array, yaws: Array, at: tuple[int, int, int]) -> None:
    """Exclude the neighborhood of a maximum, which belongs to the same hypothesis."""
    turned = np.abs(np.angle(np.exp(1j * (yaws - yaws[at[0]]))))
    rows = np.flatnonzero(turned < PLAN_MATCH.apart_rad)
    near = round(PLAN_MATCH.apart_m / PLAN_MATCH.cell_m)
    a, b = max(at[1] - near, 0), max(at[2] - near, 0)
    scores[rows, a : at[1] + near + 1, b : at[2] + near + 1] = -np.inf
