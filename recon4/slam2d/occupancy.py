"""Occupancy grid: how likely each cell of the plane is occupied."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from recon4.errors import MapTooLarge
from recon4.geometry.se3 import Array
from recon4.kernels.occupancy2d import cast_scan, crossing_beams
from recon4.locales.coded import CodedText
from recon4.slam2d.tuning_graph import OCCUPANCY


@dataclass(slots=True, eq=False)
class OccupancyGrid:
    """Log-odds of square cells; grows where beams leave it."""

    cell_m: float
    """Edge of a cell [m]."""
    p_free: float
    """Probability by which a beam that passes updates a cell."""
    p_occupied: float
    """The same for a return."""
    origin: Array = field(default_factory=lambda: np.zeros(2))
    """Corner of cell (0, 0) in the map [m], (2,)."""
    log_odds: NDArray[np.float32] = field(default_factory=lambda: np.zeros((0, 0), np.float32))
    """0 = unknown, (X, Y): the first index counts along x."""
    _seen: NDArray[np.int32] = field(default_factory=lambda: np.zeros((0, 0), np.int32))
    _scans: int = 0

    @property
    def probability(self) -> NDArray[np.float32]:
        """Probability of each cell to be occupied, 0.5 = unknown, (X, Y)."""
        return self.probability_of(slice(None))

    def probability_of(self, rows: slice) -> NDArray[np.float32]:
        """Probability of the cells of some rows along x, (R, Y)."""
        return np.asarray(1.0 - 1.0 / (1.0 + np.exp(self.log_odds[rows])), np.float32)

    def cover(self, low: Array, high: Array) -> None:
        """Grow to include a rectangle, with a margin on the sides that grow.

        Args:
            low: Its smallest x and y [m], (2,).
            high: Its largest x and y [m], (2,).

        Raises:
            MapTooLarge: If the grid would have more than about `OCCUPANCY.max_cells` cells.
        """
        first = np.floor((low - OCCUPANCY.margin_m) / self.cell_m).astype(np.int64)
        last = np.ceil((high + OCCUPANCY.margin_m) / self.cell_m).astype(np.int64)
        if self.log_odds.size:
            begin = np.round(self.origin / self.cell_m).astype(np.int64)
            end = begin + self.log_odds.shape
            first = np.where(low < self.origin, np.minimum(first, begin), begin)
            last = np.where(high >= end * self.cell_m, np.maximum(last, end), end)
            if np.array_equal(first, begin) and np.array_equal(last, end):
                return
        shape = tuple(int(n) for n in last - first)
        if shape[0] * shape[1] > 1.01 * OCCUPANCY.max_cells:
            raise MapTooLarge(
                CodedText(
                    "grid-large",
                    width_m=shape[0] * self.cell_m,
                    height_m=shape[1] * self.cell_m,
                    cell_m=self.cell_m,
                    max_cells=OCCUPANCY.max_cells,
                )
            )
        log_odds, seen = np.zeros(shape, np.float32), np.zeros(shape, np.int32)
        if self.log_odds.size:
            at = begin - first
            rows = slice(int(at[0]), int(at[0]) + self.log_odds.shape[0])
            columns = slice(int(at[1]), int(at[1]) + self.log_odds.shape[1])
            log_odds[rows, columns], seen[rows, columns] = self.log_odds, self._seen
        self.origin = np.asarray(first * self.cell_m, np.float64)
        self.log_odds, self._seen = log_odds, seen

    def add_scan(self, p_map: Array, laser: Array) -> None:
        """Enter the beams of a scan.

        Args:
            p_map: Returns in the map [m], (P, 2).
            laser: Position of the laser [m], (2,).
        """
        if not len(p_map):
            return
        both = np.concatenate([laser[None], p_map])
        self.cover(both.min(axis=0), both.max(axis=0))
        cells = np.floor((both - self.origin) / self.cell_m).astype(np.int32)
        update = np.array(
            [_log_odds(self.p_occupied), _log_odds(self.p_free), OCCUPANCY.largest_log_odds],
            np.float32,
        )
        self._scans += 1
        cast_scan(self.log_odds, self._seen, cells, self._scans, update)


def crossing_ratio(grid: OccupancyGrid, scans: Iterable[tuple[Array, Array]]) -> float:
    """Fraction of the beams that cross walls of the map before their return.

    In a map that fits together it is small: what moved, and glass. Places that were mapped twice
    side by side, or over each other, have walls in free space.

    Args:
        grid: The finished grid.
        scans: Returns in the map [m], (P, 2), and position of the laser [m], (2,), of some scans.
    """
    crossing, beams = 0, 0
    margin = int(np.ceil(OCCUPANCY.crossing_margin_m / grid.cell_m))
    for p_map, laser in scans:
        both = np.concatenate([laser[None], p_map])
        cells = np.floor((both - grid.origin) / grid.cell_m).astype(np.int32)
        crossing += crossing_beams(grid.log_odds, cells, _log_odds(OCCUPANCY.wall), margin)
        beams += len(p_map)
    return crossing / max(beams, 1)


def fitting_cell_m(low: Array, high: Array, cell_m: float) -> float:
    """The edge of the cells, doubled until a grid over a rectangle is not too large [m]."""
    size_m = np.maximum(high - low, 0.0) + 2.0 * OCCUPANCY.margin_m
    while float(np.prod(size_m / cell_m)) > OCCUPANCY.max_cells:
        cell_m *= 2.0
    return cell_m


def _log_odds(probability: float) -> float:
    return float(np.log(probability / (1.0 - probability)))
