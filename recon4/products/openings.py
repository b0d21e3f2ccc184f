"""Doors and windows: stretches of a face without a wall, through which something was seen."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from recon4.geometry.se3 import Array
from recon4.mapping.tiles import TileSet
from recon4.products.faces import Face, columns_of
from recon4.products.storeys import BuildingStorey
from recon4.products.tuning import OPENINGS, WALL_CELLS
from recon4.products.wall_cells import Masks, WallCells

OpeningKind = Literal["door", "window", "hidden"]


@dataclass(frozen=True, slots=True)
class FaceOpening:
    """A door or window in a face, or a stretch of which nothing was seen."""

    start_m: float
    end_m: float
    """From the start of the face, along it [m]."""
    sill_m: float
    head_m: float
    """Heights over the floor [m]."""
    seen_through: bool
    """Whether rays went through it; else furniture hides what is there, or nobody looked."""

    @property
    def kind(self) -> OpeningKind:
        """A door begins at the floor."""
        if not self.seen_through:
            return "hidden"
        return "door" if self.sill_m < OPENINGS.door_m else "window"


@dataclass(frozen=True, slots=True, eq=False)
class Rays:
    """A sample of the rays that measured a map, as seen from above, and their heights."""

    origin: Array
    """Where the sensors were [m], (R, 3)."""
    hit: Array
    """What they measured [m], (R, 3)."""


def sample_rays(tiles: TileSet) -> Rays:
    """An even sample of the rays of a map."""
    origins, hits = [np.empty((0, 3))], [np.empty((0, 3))]
    ratio = min(1.0, OPENINGS.rays / max(1, len(tiles)))
    for tile in tiles if tiles.columns.paths.known else ():
        columns = tile.read(["xyz", "t_ns", "sensor"], limit=int(np.ceil(ratio * len(tile))))
        hits.append(columns["xyz"].astype(np.float64) + tile.origin_m)
        origins.append(tiles.columns.paths.at(columns["t_ns"], columns["sensor"]))
    return Rays(np.concatenate(origins), np.concatenate(hits))


def openings_of(
    face: Face, cells: WallCells, rays: Rays, *, storey: BuildingStorey
) -> list[FaceOpening]:
    """Doors, windows and hidden stretches of a face.

    Where the cut has no wall, either furniture hides it or it is open. It is open if rays went
    through it.
    """
    columns = columns_of(face, cells, OPENINGS.bin_m)
    low, high = (round(z_m / WALL_CELLS.bit_m) for z_m in OPENINGS.cut_m)
    cut = np.uint64((1 << high) - (1 << low))
    solid = np.bitwise_count(columns & cut) >= OPENINGS.solid * (high - low)
    through = _pierced(face, rays, storey)
    found = []
    for first, stop in _runs(~_closed(solid)):
        width = (stop - first) * OPENINGS.bin_m
        a, b = (int(k * OPENINGS.bin_m / OPENINGS.ray_cell_m) for k in (first, stop))
        opened = through[a : b + 1].mean() >= OPENINGS.pierced
        opened &= OPENINGS.min_width_m <= width <= OPENINGS.max_width_m
        sill, head = _heights(columns[first:stop], (low + high) // 2)
        edges = [
            _jamb(face, cells, first * OPENINGS.bin_m, toward=1.0),
            _jamb(face, cells, stop * OPENINGS.bin_m, toward=-1.0),
        ]
        found.append(FaceOpening(edges[0], edges[1], sill, head, bool(opened)))
    return found


def _closed(solid: NDArray[np.bool_]) -> NDArray[np.bool_]:
    """Without narrow gaps, and without single columns of surface."""
    from scipy.ndimage import binary_closing, binary_opening

    width = max(3, round(OPENINGS.bridged_m / OPENINGS.bin_m))
    padded = np.pad(solid, width, constant_values=True)
    padded = binary_closing(padded, np.ones(width, bool))
    out: NDArray[np.bool_] = binary_opening(padded, np.ones(3, bool))[width:-width]
    return out


def _runs(mask: NDArray[np.bool_]) -> list[tuple[int, int]]:
    """Where runs of True begin and end."""
    steps = np.diff(np.concatenate([[0], mask.astype(np.int8), [0]]))
    begin, end = (np.flatnonzero(steps == step).tolist() for step in (1, -1))
    return list(zip(begin, end, strict=True))


def _pierced(face: Face, rays: Rays, storey: BuildingStorey) -> NDArray[np.bool_]:
    """Where rays went through a face within the cut, for each `OPENINGS.ray_cell_m` of it."""
    count = int(face.length_m / OPENINGS.ray_cell_m) + 1
    a = (rays.origin[:, :2] - face.start) @ face.n
    b = (rays.hit[:, :2] - face.start) @ face.n
    away = OPENINGS.behind_m
    crosses = ((a > away) & (b < -away)) | ((a < -away) & (b > away))
    p, q = rays.origin[crosses], rays.hit[crosses]
    part = (a[crosses] / (a[crosses] - b[crosses]))[:, None]
    at = p + part * (q - p)
    s, z = face.along(at[:, :2]), at[:, 2] - storey.floor_m
    inside = (s > 0.0) & (s < face.length_m) & (z > OPENINGS.cut_m[0]) & (z < OPENINGS.cut_m[1])
    rows = (s[inside] / OPENINGS.ray_cell_m).astype(np.int64)
    out: NDArray[np.bool_] = np.bincount(rows, minlength=count)[:count] > 0
    return out


def _heights(columns: Masks, middle: int) -> tuple[float, float]:
    """Median height of the surface below and above the cut [m]; 0 and the top without one."""
    bits = (columns[:, None] >> np.arange(WALL_CELLS.bits, dtype=np.uint64)) & np.uint64(1)
    below = np.where(bits[:, :middle] > 0, np.arange(1, middle + 1), 0).max(axis=1)
    above = np.where(bits[:, middle:] > 0, np.arange(middle, WALL_CELLS.bits), WALL_CELLS.bits)
    sill, head = np.median(below), np.median(above.min(axis=1))
    return float(sill) * WALL_CELLS.bit_m, float(head) * WALL_CELLS.bit_m


def _jamb(face: Face, cells: WallCells, edge_m: float, *, toward: float) -> float:
    """Where the side of an opening is, from the start of the face [m]: its own surface, if seen."""
    offset = cells.p - face.start
    s, depth = offset @ face.u, -offset @ face.n
    near = (np.abs(s - edge_m) < OPENINGS.jamb_m) & (depth > 0.0) & (depth < OPENINGS.reveal_m)
    near &= toward * (cells.n @ face.u) > 0.9
    if near.sum() < OPENINGS.jamb_cells:
        return edge_m
    return float(np.average(s[near], weights=cells.weight[near]))
