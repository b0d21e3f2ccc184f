"""Is everything captured? Plan cells the rays have seen, and where the seen world ends.

Every cell near the path is one of: not seen; free (rays passed); solid and seen well (often, from
near); solid but seen poorly. A **gap** is a row of free cells near the path that border on unseen
cells: a door not entered, a corner not looked into. Each floor has its own plan.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from enum import IntEnum
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy import ndimage
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components

from recon4.geometry.se3 import Array
from recon4.kernels.live import trace
from recon4.live.preview.tiles import Key, Tiles
from recon4.live.preview.tuning import FLOOR_DETECTION, PLAN_TILES

_FAR = 1e9
_LAYERS = {
    "free": ("u4", 0),
    "hits": ("u4", 0),
    "nearest_m": ("f4", _FAR),
    "away_m": ("f4", _FAR),
    "seen": ("u1", 0),
    "edge": ("?", 0),
}


class CoverageClass(IntEnum):
    """Coverage of a cell."""

    NOTHING = 0
    FREE = 1
    POOR = 2
    WELL = 3


@dataclass(frozen=True, slots=True)
class CoverageRules:
    """Limits of the coverage classes and gaps."""

    well_hits: int = 12
    """A surface is seen well with at least this many sampled rays in its cell …"""
    well_range_m: float = 12.0
    """… and one of them not longer than this."""
    gap_reach_m: float = 8.0
    """Largest distance of a gap from the path."""
    gap_width_m: float = 0.75
    """Smallest width of a gap; narrower ones lie between two rays."""
    floor_m: float = 0.9
    """Points this far below the body are floor and not solid."""
    ceiling_m: float = 0.8
    """Rays that end this far above the body are ignored."""


@dataclass(frozen=True, slots=True)
class CoverageGap:
    """A place that was not seen."""

    p_map: tuple[float, float]
    """Its center [m]."""
    width_m: float
    away_m: float
    """Distance from the path."""


@dataclass(slots=True)
class _Floor:
    """The plan of one floor, and counts per tile."""

    tiles: Tiles = field(default_factory=lambda: Tiles(_LAYERS))
    last_cell: Key | None = None
    edges: dict[Key, NDArray[np.int64]] = field(default_factory=dict)
    """Cells (N, 2) of gaps; their distances from the path are in `away_m`."""
    away_m: dict[Key, NDArray[np.float32]] = field(default_factory=dict)
    solid: dict[Key, tuple[int, int]] = field(default_factory=dict)
    """Number of solid cells near the path, and of those seen well."""
    gaps: list[CoverageGap] = field(default_factory=list)


class Coverage:
    """Coverage plans of all floors; call `refresh` before reading results."""

    def __init__(self, rules: CoverageRules | None = None) -> None:
        self._rules = rules or CoverageRules()
        self._heights = Floors()
        self._floors: dict[int, _Floor] = {}
        reach = int(self._rules.gap_reach_m / PLAN_TILES.cell_m)
        steps = np.arange(-reach, reach + 1)
        self._disk_m = (np.hypot(*np.meshgrid(steps, steps)) * PLAN_TILES.cell_m).astype(np.float32)

    @property
    def floor(self) -> int:
        """Number of the current floor, in the order of first visits."""
        return self._heights.now

    def add(self, body_m: Array, p_map: Array, *, solid: bool = True) -> None:
        """Add the rays of a multiframe or scan.

        Args:
            body_m: Position of the body [m], (3,).
            p_map: End points of sampled rays [m], (N, 3).
            solid: Whether the rays end at surfaces; otherwise they only say what is free.
        """
        floor = self._heights.at(float(body_m[2]))
        if floor not in self._floors:
            self._floors[floor] = _Floor()
        plan = self._floors[floor]
        here = np.floor(body_m[:2] / PLAN_TILES.cell_m).astype(np.int64)
        if not plan.tiles.contains(here):
            self._count(plan)
            plan.tiles.move_to(here)
        self._trace(plan.tiles, body_m, p_map, solid=solid)
        key = (int(here[0]), int(here[1]))
        if key != plan.last_cell:
            plan.last_cell = key
            self._walk(plan.tiles, here)

    def refresh(self) -> None:
        """Classify the cells and find the gaps of the current floor."""
        if self.floor in self._floors:
            plan = self._floors[self.floor]
            self._count(plan)
            plan.gaps = self._gaps_of(plan)

    def seen(self) -> tuple[NDArray[np.int64], NDArray[np.uint8]]:
        """`CoverageClass` of the cells of this floor: first cell (2,), cells (H, W), x down."""
        if self.floor not in self._floors:
            return np.zeros(2, np.int64), np.zeros((0, 0), np.uint8)
        first, cells = self._floors[self.floor].tiles.whole("seen")
        return first, cells.astype(np.uint8, copy=False)

    def gaps(self) -> list[CoverageGap]:
        """Gaps on this floor, the widest first."""
        return self._floors[self.floor].gaps if self.floor in self._floors else []

    def gaps_elsewhere(self) -> int:
        """Number of gaps on all other floors."""
        return sum(len(p.gaps) for floor, p in self._floors.items() if floor != self.floor)

    def well_seen_ratio(self) -> float:
        """Part of the solid cells near the path, on all floors, that is seen well, 0 to 1.

        NaN if there are none.
        """
        counts = [pair for plan in self._floors.values() for pair in plan.solid.values()]
        solid, well = sum(pair[0] for pair in counts), sum(pair[1] for pair in counts)
        return well / solid if solid else float("nan")

    def _gaps_of(self, plan: _Floor) -> list[CoverageGap]:
        if not plan.edges:
            return []
        cells = np.concatenate(list(plan.edges.values()))
        away_m = np.concatenate(list(plan.away_m.values()))
        found = []
        for rows in _connected(cells):
            mine = cells[rows]
            width_m = float(np.ptp(mine, axis=0).max() + 1) * PLAN_TILES.cell_m
            if width_m < self._rules.gap_width_m:
                continue
            middle = int(np.argmin(np.linalg.norm(mine - mine.mean(axis=0), axis=1)))
            x, y = ((mine[middle] + 0.5) * PLAN_TILES.cell_m).tolist()
            found.append(CoverageGap((x, y), width_m, float(away_m[rows[middle]])))
        return sorted(found, key=lambda gap: (-gap.width_m, gap.p_map))

    def _trace(self, tiles: Tiles, body_m: Array, p_map: Array, *, solid: bool) -> None:
        up_m = p_map[:, 2] - body_m[2]
        below = up_m < self._rules.ceiling_m
        ray_m, up_m = p_map[below] - body_m, up_m[below]
        plan_m = np.hypot(ray_m[:, 0], ray_m[:, 1])
        cut = np.minimum(1.0, PLAN_TILES.ray_m / np.maximum(plan_m, 1e-9))
        start = body_m[:2] / PLAN_TILES.cell_m - tiles.first_cell
        ends = start + ray_m[:, :2] * (cut / PLAN_TILES.cell_m)[:, None]
        walls = (up_m > -self._rules.floor_m) & (plan_m <= PLAN_TILES.ray_m) & solid
        layers = (tiles.window[name] for name in ("free", "hits", "nearest_m"))
        trace(start, ends, np.linalg.norm(ray_m, axis=1), walls, *layers)

    def _walk(self, tiles: Tiles, here: NDArray[np.int64]) -> None:
        """Update the distances of the cells around a cell of the path."""
        i, j = (here - tiles.first_cell).tolist()
        reach = len(self._disk_m) // 2
        around = tiles.window["away_m"][i - reach : i + reach + 1, j - reach : j + reach + 1]
        np.minimum(around, self._disk_m, out=around)

    def _count(self, plan: _Floor) -> None:
        w = plan.tiles.window
        w["seen"][:] = seen = self._classified(w)
        unseen = seen == CoverageClass.NOTHING
        # An unseen cell between seen cells lies between two rays and is not a gap.
        unseen &= ndimage.uniform_filter(unseen.astype(np.float32), 3) > 0.5
        near = w["away_m"] <= self._rules.gap_reach_m
        edge = (seen == CoverageClass.FREE) & ndimage.binary_dilation(unseen) & near
        # Cells beyond the border are unknown here; no ray reaches them.
        w["edge"][1:-1, 1:-1] = edge[1:-1, 1:-1]
        solid, well = near & (seen >= CoverageClass.POOR), near & (seen == CoverageClass.WELL)
        for key, rows in plan.tiles.parts():
            cells = np.argwhere(w["edge"][rows])
            plan.edges[key] = cells + np.array(key) * PLAN_TILES.tile
            plan.away_m[key] = w["away_m"][rows][tuple(cells.T)]
            plan.solid[key] = int(np.count_nonzero(solid[rows])), int(np.count_nonzero(well[rows]))

    def _classified(self, w: dict[str, NDArray[Any]]) -> NDArray[np.uint8]:
        r = self._rules
        free, hits = w["free"], w["hits"]
        solid = hits > 1 + free // 8
        well = solid & (hits >= r.well_hits) & (w["nearest_m"] <= r.well_range_m)
        seen = np.zeros(free.shape, dtype=np.uint8)
        seen[(free > 0) | (hits > 0)] = CoverageClass.FREE
        seen[solid] = CoverageClass.POOR
        seen[well] = CoverageClass.WELL
        return seen


def _connected(cells: NDArray[np.int64]) -> list[NDArray[np.intp]]:
    """Groups of cells (N, 2; rows, each once) that touch each other, also at corners."""
    if not len(cells):
        return []
    low = cells.min(axis=0)
    width = int(np.ptp(cells[:, 1])) + 3
    keys = (cells[:, 0] - low[0]) * width + cells[:, 1] - low[1] + 1
    order = np.argsort(keys)
    ordered = keys[order]
    pairs = []
    for step in (1, width - 1, width, width + 1):  # right, and the three below
        place = np.minimum(np.searchsorted(ordered, ordered + step), len(keys) - 1)
        there = ordered[place] == ordered + step
        pairs.append(np.stack([order[there], order[place[there]]]))
    a, b = np.concatenate(pairs, axis=1)
    joined = coo_array((np.ones(len(a), np.bool_), (a, b)), shape=(len(keys), len(keys)))
    _, labels = connected_components(joined, directed=False)
    by_label = np.argsort(labels, kind="stable")
    return np.split(by_label, np.flatnonzero(np.diff(labels[by_label])) + 1)


class Floors:
    """Floors in the order of their first visit."""

    def __init__(self) -> None:
        self._heights_m: list[float] = []
        self.now = 0
        """Number of the current floor."""

    def __len__(self) -> int:
        return len(self._heights_m)

    def at(self, z_m: float) -> int:
        """Number of the floor at a body height [m]; call it for every multiframe."""
        away_m = [abs(z_m - height_m) for height_m in self._heights_m]
        if not away_m or min(away_m) > FLOOR_DETECTION.apart_m:
            self._heights_m.append(z_m)
            self.now = len(self._heights_m) - 1
            return self.now
        nearest = away_m.index(min(away_m))
        if away_m[nearest] < away_m[self.now] - FLOOR_DETECTION.nearer_m:
            self.now = nearest
        self._heights_m[self.now] += FLOOR_DETECTION.follow * (z_m - self._heights_m[self.now])
        return self.now
