"""A local 2-D map of lines, and the registration of a scan to it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from recon4.geometry.se2 import wrap
from recon4.geometry.se3 import Array
from recon4.kernels.lines2d import SUMS, add_points, line_equations
from recon4.slam2d.tuning_matching import LINE_MAP


@dataclass(frozen=True, slots=True, eq=False)
class Prior2d:
    """A predicted pose and how certain it is."""

    pose: Array
    """x [m], y [m], yaw [rad], (3,)."""
    information: Array
    """Inverse covariance for yaw, x, y along the axes of the map, (3, 3)."""


@dataclass(frozen=True, slots=True, eq=False)
class Match2d:
    """Result of a registration."""

    pose: Array
    """Pose of the laser in the map: x [m], y [m], yaw [rad], (3,)."""
    H: Array
    """Information of the lines alone for yaw, x, y along the axes of the map, (3, 3)."""
    match_ratio: float
    """Weighted fraction of the points within three standard deviations of a line."""
    variance_ratio: float
    """Mean squared distance to the lines over the expected one."""
    iterations: int
    converged: bool


class LineMap:
    """Points summed in cells of two sizes; each cell with its neighbors gives a line."""

    def __init__(self, *, cell_m: float, extent_m: float) -> None:
        """An empty map.

        Args:
            cell_m: Edge of the smallest cells [m].
            extent_m: Largest extent of the points that are in it at one time [m].
        """
        self._cells_m = [cell_m * factor for factor in LINE_MAP.levels]
        self._sums = [
            np.zeros((size, size, SUMS))
            for size in (int(np.ceil(extent_m / cell)) + 3 for cell in self._cells_m)
        ]

    def add(self, points: Array) -> None:
        """Add points in the frame of the map [m], (P, 2)."""
        for sums, cell_m in zip(self._sums, self._cells_m, strict=True):
            add_points(sums, points, cell_m, 1.0)

    def remove(self, points: Array) -> None:
        """Remove points that were added before [m], (P, 2)."""
        for sums, cell_m in zip(self._sums, self._cells_m, strict=True):
            add_points(sums, points, cell_m, -1.0)

    def register(
        self,
        points: Array,
        weights: Array,
        *,
        start: Array,
        prior: Prior2d | None = None,
        sd_m: float,
    ) -> Match2d:
        """Find the pose at which points fit to the lines: Gauss-Newton, coarse cells first.

        Args:
            points: In the frame of the laser [m], (P, 2).
            weights: Weight of each point, (P,).
            start: Pose to start from, (3,).
            prior: What else is known of the pose.
            sd_m: Standard deviation of a distance [m].
        """
        pose, out = np.array(start, np.float64), np.zeros(14)
        iterations, inliers, converged = 0, 0.0, False
        coarse, coarse_m = self._sums[0], self._cells_m[0]
        for sums, cell_m in zip(self._sums, self._cells_m, strict=True):
            scales = np.array([cell_m, coarse_m, max(sd_m, 0.1 * cell_m), 1.5 * cell_m])
            converged = False
            for _ in range(LINE_MAP.max_iterations):
                inliers = line_equations(sums, coarse, points, weights, pose, scales, out)
                step = _step(out, pose, prior)
                pose += step
                iterations += 1
                converged = _is_small(step)
                if converged:
                    break
        pose[2] = wrap(pose[2])
        total = float(weights.sum())
        return Match2d(
            pose=pose,
            H=out[:9].reshape(3, 3).copy(),
            match_ratio=inliers / total if total > 0.0 else 0.0,
            variance_ratio=float(out[12] * sd_m**2 / out[13]) if out[13] > 0.0 else np.nan,
            iterations=iterations,
            converged=converged,
        )


def _step(out: Array, pose: Array, prior: Prior2d | None) -> Array:
    """A step of Gauss-Newton in x, y, yaw."""
    H, g = out[:9].reshape(3, 3) + 1e-9 * np.eye(3), out[9:12].copy()
    if prior is not None:
        off = pose - prior.pose
        H = H + prior.information
        g += prior.information @ np.array([wrap(off[2]), off[0], off[1]])
    yaw, x, y = np.linalg.solve(H, -g)
    return np.array([x, y, yaw])


def _is_small(step: Array) -> bool:
    return bool(
        np.hypot(step[0], step[1]) < LINE_MAP.converged_m and abs(step[2]) < LINE_MAP.converged_rad
    )


def stack_points(parts: Sequence[Array]) -> Array:
    """Points of several scans as one array, (P, 2)."""
    return np.concatenate(parts) if parts else np.zeros((0, 2))
