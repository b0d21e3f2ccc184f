"""Correlative search: the best pose in a window, also from a wrong start (Olson 2009)."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from recon4.geometry.se2 import transform
from recon4.geometry.se3 import Array
from recon4.kernels.correlation2d import branch_and_bound, likelihood_field, max_filter
from recon4.slam2d.tuning_matching import CORRELATION


@dataclass(frozen=True, slots=True, eq=False)
class ScanMatch2d:
    """The best pose of a correlative search."""

    pose: Array
    """x [m], y [m], yaw [rad], (3,)."""
    score: float
    """Mean likelihood of the points, 0 to 1."""


@dataclass(frozen=True, slots=True, eq=False)
class LikelihoodField:
    """Likelihood of returns around the points of a map, for `search`."""

    pyramid: NDArray[np.uint8]
    """Of `recon4.kernels.correlation2d.max_filter`."""
    origin: Array
    """Corner of the first cell [m], (2,)."""

    @staticmethod
    def of(points: Array) -> LikelihoodField:
        """The field around points of a map [m], (P, 2)."""
        reach = int(np.ceil(2.5 * CORRELATION.blur_m / CORRELATION.cell_m))
        low, high = points.min(axis=0), points.max(axis=0)
        origin = np.floor(low / CORRELATION.cell_m - reach) * CORRELATION.cell_m
        rows, columns = np.ceil((high - origin) / CORRELATION.cell_m).astype(int) + reach + 1
        offsets = np.arange(-reach, reach + 1) * CORRELATION.cell_m
        squared = offsets[:, None] ** 2 + offsets[None, :] ** 2
        stamp = np.round(255.0 * np.exp(-0.5 * squared / CORRELATION.blur_m**2)).astype(np.uint8)
        field = likelihood_field(
            points, origin, (int(rows), int(columns)), CORRELATION.cell_m, stamp
        )
        return LikelihoodField(max_filter(field, CORRELATION.levels), origin)

    def search(
        self,
        points: Array,
        *,
        initial_pose: Array,
        half_window_m: float,
        half_window_rad: float,
        min_score: float,
    ) -> ScanMatch2d | None:
        """The pose with the largest mean likelihood of the points.

        Args:
            points: In the frame of the laser [m], (P, 2).
            initial_pose: Middle of the window: x [m], y [m], yaw [rad], (3,).
            half_window_m: Largest shift along x and y [m].
            half_window_rad: Largest rotation [rad].
            min_score: Smallest score that counts.

        Returns:
            The best pose, to about a cell; None = none with that score.
        """
        points = thinned(points, CORRELATION.cell_m, max_points=CORRELATION.max_points)
        if not len(points):
            return None
        farthest = min(
            float(np.hypot(points[:, 0], points[:, 1]).max()), CORRELATION.angle_step_range_m
        )
        # One step of the rotation moves the farthest point by a cell (Hess 2016, eq. 7).
        count = int(np.ceil(half_window_rad / (CORRELATION.cell_m / max(farthest, 1.0))))
        angles = np.linspace(-half_window_rad, half_window_rad, 2 * count + 1)
        poses = np.repeat(initial_pose[None], len(angles), axis=0)
        poses[:, 2] += angles
        moved = transform(poses[:, None], points[None])
        cells = np.floor((moved - self.origin) / CORRELATION.cell_m).astype(np.int32)
        window = int(np.ceil(half_window_m / CORRELATION.cell_m))
        score, row, dx, dy = branch_and_bound(self.pyramid, cells, window, min_score)
        if score <= min_score:
            return None
        pose = poses[row] + np.array([dx * CORRELATION.cell_m, dy * CORRELATION.cell_m, 0.0])
        return ScanMatch2d(pose, score)


def thinned(points: Array, cell_m: float, *, max_points: int) -> Array:
    """One point per cell, and an even sample of at most ``max_points`` of them, (Q, 2)."""
    cells = np.floor(points / cell_m).astype(np.int64)
    _, rows = np.unique(cells[:, 0] * (1 << 32) + cells[:, 1], return_index=True)
    rows.sort()
    if len(rows) > max_points:
        rows = rows[np.linspace(0, len(rows) - 1, max_points).astype(np.intp)]
    return points[rows]
