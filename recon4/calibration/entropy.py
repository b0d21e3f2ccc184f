"""Mounts and clocks by the sharpness of the map (requirements L-CAL-1; Maddern 2012).

The Rényi quadratic entropy of the map, from closest points only, is minimized by Powell's method:
``E = -sum_i G(p_i - p_j, 2 sigma^2)`` over the nearest neighbor ``p_j`` of each point that was
measured at least ``t_d`` before or after it. The trajectory stays as it is.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np
from scipy.optimize import OptimizeResult, minimize
from scipy.spatial import cKDTree

from recon4.calibration.parameters import Parameters
from recon4.calibration.tuning import EntropyTuning
from recon4.calibration.window import Window, place
from recon4.geometry.se3 import Array
from recon4.model.calibration_figures import IMU
from recon4.model.rig import Rig

_UNIT = {"rad": np.deg2rad(0.1), "m": 0.01, "s": 0.001}
"""What Powell's method counts as one, for each kind of parameter."""


@dataclass(frozen=True, slots=True, eq=False)
class EntropyEstimate:
    """Result of a minimization."""

    rig: Rig
    parameters: Parameters
    change: Array
    """From the rig it began with, (P,)."""
    costs: Array
    """Lowest cost after each evaluation, (N,)."""
    converged: bool


def calibrate_by_entropy(
    windows: Sequence[Window],
    rig: Rig,
    parameters: Parameters,
    *,
    settings: EntropyTuning,
    progress: Callable[[], None] = lambda: None,
) -> EntropyEstimate:
    """Minimize the entropy of the map over mounts and clocks of LiDARs.

    Args:
        windows: Of the walk, with their trajectories.
        rig: Where to begin.
        parameters: Of LiDARs; those of the IMU do not move points and stay.
        settings: Width of the kernel, time threshold, number of points and evaluations.
        progress: Called after each evaluation.
    """
    thinned = [_thinned(window, settings.points) for window in windows]
    movable = np.array([parameter.sensor != IMU for parameter in parameters.listed])
    unit = np.array([_UNIT[parameter.unit] for parameter in parameters.listed])[movable]
    lowest: list[float] = []

    def change_of(x: Array) -> Array:
        change = np.zeros(len(parameters))
        change[movable] = x * unit
        return change

    def cost(x: Array) -> float:
        value = entropy_cost(thinned, parameters.changed(rig, change_of(x)), settings)
        lowest.append(min(value, lowest[-1] if lowest else np.inf))
        progress()
        return value

    found: OptimizeResult = minimize(
        cost,
        np.zeros(int(movable.sum())),
        method="Powell",
        options={"ftol": settings.tolerance, "xtol": 0.05, "maxfev": settings.evaluations},
    )
    change = change_of(np.asarray(found.x, np.float64))
    return EntropyEstimate(
        parameters.changed(rig, change), parameters, change, np.array(lowest), bool(found.success)
    )


def entropy_cost(windows: Sequence[Window], rig: Rig, settings: EntropyTuning) -> float:
    """Mean over the windows of ``-sum_i G(p_i - p_j) / N``, -1..0; smaller is sharper."""
    costs = []
    for window in windows:
        p = place(window, rig).odom
        # The nearest few: the first that was measured at another time, or by another LiDAR, counts.
        near, row = cKDTree(p).query(p, k=settings.neighbors + 1, workers=2)
        apart = np.abs(window.t_s[row] - window.t_s[:, None]) > settings.min_gap_s
        other = apart | (window.sensor[row] != window.sensor[:, None])
        other[:, 0] = False
        closest = np.where(other, near, np.inf).min(axis=1)
        costs.append(-np.mean(np.exp(-(closest**2) / (4.0 * settings.kernel_m**2))))
    return float(np.mean(costs))


def _thinned(window: Window, points: int) -> Window:
    step = max(1, len(window.t_s) // points) | 1
    rows = slice(None, None, step)
    return replace(
        window,
        p_sensor=window.p_sensor[rows],
        sensor=window.sensor[rows],
        ring=window.ring[rows],
        t_s=window.t_s[rows],
    )
