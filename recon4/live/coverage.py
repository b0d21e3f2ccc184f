"""Is everything captured? Plan cells the rays have seen, and where the seen world ends.

Every cell near the way is one of: not seen; free (rays passed); solid and seen well (often, from
near); solid but seen poorly. A **gap** is a row of free cells that border on cells nobody has seen,
near the way: a door not entered, a corner not looked into.
"""

from __future__ import annotations

from dataclasses import dataclass
from enum import IntEnum

import numpy as np
from numpy.typing import NDArray
from scipy import ndimage

from recon4.geometry.se3 import Array
from recon4.kernels.live import trace

CELL_M = 0.25
_GROW = 128
"""Cells a grid grows by."""
_FAR = np.float32(1e9)


class Seen(IntEnum):
    """What is known of a cell."""

    NOTHING = 0
    FREE = 1
    POOR = 2
    WELL = 3


@dataclass(frozen=True, slots=True)
class CoverageRules:
    """What counts as captured."""

    well_hits: int = 12
    """A surface is seen well with so many sampled rays in its cell …"""
    well_range_m: float = 12.0
    """… one of them not longer than this."""
    gap_reach_m: float = 8.0
    """Unseen places are gaps only so near to the way."""
    gap_width_m: float = 0.75
    """Narrower ones are cracks between rays."""
    floor_m: float = 0.9
    """What lies so far below the body is floor: it stands in nobody's way."""
    ceiling_m: float = 0.8
    """Rays that end so far above the body say nothing about the plan."""


@dataclass(frozen=True, slots=True)
class Gap:
    """A place to look at."""

    p_map: tuple[float, float]
    """Its middle [m]."""
    width_m: float
    away_m: float
    """From the nearest point of the way."""


class Coverage:
    """A plan that grows with the walk."""

    def __init__(self, rules: CoverageRules | None = None) -> None:
        self._rules = rules or CoverageRules()
        self.first_cell = np.array([-_GROW, -_GROW])
        """Cell of the grid's corner, counted from the map's origin."""
        shape = (2 * _GROW, 2 * _GROW)
        self._free = np.zeros(shape, dtype=np.uint16)
        self._hits = np.zeros(shape, dtype=np.uint16)
        self._nearest = np.full(shape, _FAR)
        self._way = np.zeros(shape, dtype=np.bool_)

    def add(self, sensor_m: Array, p_map: Array) -> None:
        """Add the rays of a multiframe.

        Args:
            sensor_m: Where the body was [m], (3,).
            p_map: Where sampled rays ended [m], (N, 3).
        """
        up_m = p_map[:, 2] - sensor_m[2]
        p_map, up_m = p_map[up_m < self._rules.ceiling_m], up_m[up_m < self._rules.ceiling_m]
        ranges = np.linalg.norm(p_map - sensor_m, axis=1)
        cells = p_map[:, :2] / CELL_M
        start = sensor_m[:2] / CELL_M
        self._make_room(np.floor(np.concatenate([cells, start[None]])).astype(np.int64))
        solid = up_m > -self._rules.floor_m
        inside = start - self.first_cell
        trace(inside, cells - self.first_cell, ranges, solid, self._free, self._hits, self._nearest)
        self._way[tuple(np.floor(inside).astype(np.int64))] = True

    def seen(self) -> NDArray[np.uint8]:
        """`Seen` of every cell, (H, W); first axis along x."""
        r = self._rules
        solid = self._hits > 1 + self._free // 8
        well = solid & (self._hits >= r.well_hits) & (self._nearest <= r.well_range_m)
        seen = np.zeros(self._free.shape, dtype=np.uint8)
        seen[(self._free > 0) | (self._hits > 0)] = Seen.FREE
        seen[solid] = Seen.POOR
        seen[well] = Seen.WELL
        return seen

    def gaps(self) -> list[Gap]:
        """Places to look at, the widest first."""
        r = self._rules
        seen = self.seen()
        unseen = seen == Seen.NOTHING
        # A cell between cells that were seen lies between two rays: that is no gap.
        unseen &= ndimage.uniform_filter(unseen.astype(np.float32), 3) > 0.5
        edge = (seen == Seen.FREE) & ndimage.binary_dilation(unseen)
        away_m = self._away_m()
        edge &= away_m <= r.gap_reach_m
        labels, count = ndimage.label(edge, structure=np.ones((3, 3)))
        found = []
        for label in range(1, count + 1):
            cells = np.argwhere(labels == label)
            width_m = float(np.ptp(cells, axis=0).max() + 1) * CELL_M
            if width_m < r.gap_width_m:
                continue
            middle = cells[np.argmin(np.linalg.norm(cells - cells.mean(axis=0), axis=1))]
            x, y = ((middle + self.first_cell + 0.5) * CELL_M).tolist()
            found.append(Gap((x, y), width_m, float(away_m[tuple(middle)])))
        return sorted(found, key=lambda gap: -gap.width_m)

    def share_well(self) -> float:
        """Share of the solid cells near the way that are seen well; NaN before there are any."""
        seen = self.seen()
        near = self._away_m() <= self._rules.gap_reach_m
        solid = np.count_nonzero(near & (seen >= Seen.POOR))
        return np.count_nonzero(near & (seen == Seen.WELL)) / solid if solid else float("nan")

    def _away_m(self) -> Array:
        if not self._way.any():
            return np.full(self._way.shape, np.inf)
        distance: Array = ndimage.distance_transform_edt(~self._way)
        return distance * CELL_M

    def _make_room(self, cells: NDArray[np.int64]) -> None:
        low = np.minimum(cells.min(axis=0) - self.first_cell, 0)
        high = np.maximum(cells.max(axis=0) + 1 - self.first_cell - self._free.shape, 0)
        if not low.any() and not high.any():
            return
        before = -(low // _GROW) * _GROW
        after = -(-high // _GROW) * _GROW
        pad = list(zip(before.tolist(), after.tolist(), strict=True))
        self.first_cell = self.first_cell - before
        self._free = np.pad(self._free, pad)
        self._hits = np.pad(self._hits, pad)
        self._nearest = np.pad(self._nearest, pad, constant_values=_FAR)
        self._way = np.pad(self._way, pad)
