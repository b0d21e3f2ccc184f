"""Scan matching of hector_slam: Gauss-Newton on the gradient of one occupancy grid.

Kohlbrecher 2011; the constants are those of requirements A12 L-1. The grid is kept at several
resolutions, each updated with the scans themselves. There is no prediction: each scan starts at the
pose of the one before, with the rotation of the attitude if there is one.
"""

from __future__ import annotations

import numpy as np

from recon4.geometry.se2 import between, transform, wrap
from recon4.geometry.se3 import Array
from recon4.kernels.occupancy2d import gradient_equations
from recon4.slam2d.line_map import Match2d
from recon4.slam2d.occupancy import OccupancyGrid
from recon4.slam2d.tuning import HectorTuning
from recon4.slam2d.tuning_matching import HECTOR


class HectorMap:
    """Occupancy grids of several resolutions, and the registration to them."""

    def __init__(self, settings: HectorTuning) -> None:
        """Empty grids."""
        self._settings = settings
        self._grids = [
            OccupancyGrid(settings.cell_m * 2**level, settings.p_free, settings.p_occupied)
            for level in range(settings.levels)
        ]
        self._updated_at: Array | None = None

    @property
    def empty(self) -> bool:
        """Whether no scan was entered yet."""
        return self._updated_at is None

    def register(self, points: Array, start: Array) -> Match2d:
        """Find the pose at which the returns lie on occupied cells, coarse grid first.

        Args:
            points: In the frame of the laser [m], (P, 2).
            start: Pose to start from, (3,).
        """
        pose, out, iterations = np.array(start, np.float64), np.zeros(14), 0
        step = np.zeros(3)
        for level in reversed(range(len(self._grids))):
            grid = self._grids[level]
            frame = np.array([*grid.origin, grid.cell_m])
            of_level = self._settings.coarse_iterations if level else self._settings.iterations
            for _ in range(of_level):
                gradient_equations(grid.log_odds, points, pose, frame, out)
                step = _step(out)
                pose += step
                iterations += 1
        pose[2] = wrap(pose[2])
        finest = self._grids[0]
        gradient_equations(
            finest.log_odds, points, pose, np.array([*finest.origin, finest.cell_m]), out
        )
        # Squared residuals have the variance of an occupancy at its edge: one cell wide.
        variance = max(float(out[12] / max(out[13], 1.0)), 1e-3)
        return Match2d(
            pose=pose,
            H=out[:9].reshape(3, 3) / variance,
            match_ratio=self._match_ratio(points, pose),
            variance_ratio=variance,
            iterations=iterations,
            converged=bool(np.hypot(step[0], step[1]) < finest.cell_m),
        )

    def update(self, points: Array, pose: Array) -> bool:
        """Enter a scan if the laser has moved far enough since the last one; returns whether."""
        if self._updated_at is not None:
            moved = between(self._updated_at, pose)
            near = float(np.hypot(moved[0], moved[1])) < self._settings.update_m
            if near and abs(float(moved[2])) < self._settings.update_rad:
                return False
        p_map = transform(pose, points)
        for grid in self._grids:
            grid.add_scan(p_map, pose[:2])
        self._updated_at = pose.copy()
        return True

    def _match_ratio(self, points: Array, pose: Array) -> float:
        grid = self._grids[min(1, len(self._grids) - 1)]
        cells = np.floor((transform(pose, points) - grid.origin) / grid.cell_m).astype(np.int64)
        inside = np.all((cells >= 0) & (cells < grid.log_odds.shape), axis=1)
        cells = cells[inside]
        hits = grid.log_odds[cells[:, 0], cells[:, 1]] > np.log(
            HECTOR.matched / (1.0 - HECTOR.matched)
        )
        return float(hits.sum()) / max(len(points), 1)


def _step(out: Array) -> Array:
    H = out[:9].reshape(3, 3)
    # Without any gradient nothing can be estimated; hector does not move then either.
    if H[1, 1] == 0.0 or H[2, 2] == 0.0:
        return np.zeros(3)
    turn, x, y = np.linalg.solve(H + 1e-9 * np.eye(3), out[9:12])
    turn = float(np.clip(turn, -HECTOR.largest_turn_rad, HECTOR.largest_turn_rad))
    return np.array([x, y, turn])
