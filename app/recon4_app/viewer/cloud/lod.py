"""Level of detail: which parts of which tiles one camera needs (spacing as seen on screen).

A tile is cut into chunks that build on each other: chunks 0 to k together are an even sample of
it. A chunk once sent is never sent again in another form, so refining costs only what is new.
"""

from __future__ import annotations

import heapq
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from recon4.geometry.se3 import Array
from recon4_app.viewer.tuning import LOD

Chunk = tuple[int, int]
"""Row of the tile, number of the chunk."""


@dataclass(frozen=True, slots=True)
class Rows:
    """Some rows of a tile: ``start:stop:step``."""

    start: int
    stop: int
    step: int = 1

    def __len__(self) -> int:
        return len(range(self.start, self.stop, self.step))

    @property
    def index(self) -> slice:
        """The same for indexing."""
        return slice(self.start, self.stop, self.step)


def base_step(points: int, most: int) -> int:
    """Power of two ``n`` such that every n-th point of the map is at most ``most`` points."""
    step = 1
    while points > most * step:
        step *= 2
    return step


def chunks_of(count: int, step: int) -> tuple[Rows, ...]:
    """Cut a tile of ``count`` points: first every ``step``-th, then each time as many again.

    Inside its first 64th a tile lies in spatial order, so there a sample is every n-th row; from
    there on the tile's own order makes every prefix a sample.
    """
    ends = [count * k // LOD.strata for k in LOD.strata_ends]
    rows: list[Rows] = []
    begin = 0
    if step >= LOD.strata:
        stride = step // LOD.strata
        begin = ends[0]
        rows.append(Rows(0, begin, stride))
        while stride > 1:
            rows.append(Rows(stride // 2, begin, stride))
            stride //= 2
    else:
        begin = count * max(LOD.strata // step, 1) // LOD.strata
        rows.append(Rows(0, begin))
    for end in ends:
        if end > begin:
            rows.append(Rows(begin, end))
            begin = end
    return (rows[0], *(part for part in rows[1:] if len(part)))


@dataclass(frozen=True, slots=True, eq=False)
class Camera:
    """A camera: pose and field of view."""

    position_m: Array
    """(3,)"""
    R_map_camera: Array
    """Columns: right, down, ahead, (3, 3)."""
    fov_rad: float
    """Angle from the lower to the upper rim."""
    width_px: int
    height_px: int

    @property
    def aspect(self) -> float:
        """Width by height of the image."""
        return self.width_px / max(self.height_px, 1)

    @property
    def focal_px(self) -> float:
        """Pixels a length takes at its own distance."""
        return self.height_px / (2.0 * np.tan(self.fov_rad / 2.0))


@dataclass(frozen=True, slots=True, eq=False)
class TileBoxes:
    """The tiles as the choice sees them."""

    low_m: Array
    """(T, 3)"""
    high_m: Array
    """(T, 3)"""
    area_m2: Array
    """Surface a tile's points lie on, (T,)."""
    sizes: tuple[NDArray[np.int64], ...]
    """Points of the chunks of each tile."""

    def __len__(self) -> int:
        return len(self.sizes)


def choose(boxes: TileBoxes, camera: Camera, budget: int) -> list[Chunk]:
    """The chunks beyond the first of each tile that a camera needs, coarse and central ones first.

    Args:
        boxes: All tiles.
        camera: Where one looks from.
        budget: Points that may be added to the first chunks.

    Returns:
        Each chunk comes after the chunks it builds on.
    """
    if len(boxes) == 0:
        return []
    scale_px = camera.focal_px * _weights(boxes, camera) / _distances_m(boxes, camera)
    heap = [
        (-_spacing_px(boxes, tile, 1, scale_px=scale_px[tile]), tile, 1)
        for tile in np.flatnonzero(in_sight(boxes, camera)).tolist()
        if len(boxes.sizes[tile]) > 1
    ]
    heapq.heapify(heap)
    chosen: list[Chunk] = []
    while heap:
        spacing, tile, chunk = heapq.heappop(heap)
        size = int(boxes.sizes[tile][chunk])
        if -spacing < LOD.fine_px:
            break
        if size > budget:
            continue
        budget -= size
        chosen.append((tile, chunk))
        if chunk + 1 < len(boxes.sizes[tile]):
            finer = _spacing_px(boxes, tile, chunk + 1, scale_px=scale_px[tile])
            heapq.heappush(heap, (-finer, tile, chunk + 1))
    return chosen


def in_sight(boxes: TileBoxes, camera: Camera) -> NDArray[np.bool_]:
    """Tiles that are not wholly outside one of the four sides of the view, (T,)."""
    tall = np.tan(camera.fov_rad / 2.0)
    wide = tall * camera.aspect
    inward = np.array(
        [[-1.0, 0.0, wide], [1.0, 0.0, wide], [0.0, -1.0, tall], [0.0, 1.0, tall], [0.0, 0.0, 1.0]]
    )
    normals = inward @ camera.R_map_camera.T
    low, high = boxes.low_m - camera.position_m, boxes.high_m - camera.position_m
    farthest = np.maximum(normals[:, None] * low, normals[:, None] * high).sum(axis=2)
    return np.asarray((farthest >= 0.0).all(axis=0))


def _distances_m(boxes: TileBoxes, camera: Camera) -> Array:
    outside = np.maximum(boxes.low_m - camera.position_m, camera.position_m - boxes.high_m)
    return np.maximum(np.linalg.norm(np.maximum(outside, 0.0), axis=1), LOD.nearest_m)


def _weights(boxes: TileBoxes, camera: Camera) -> Array:
    """1 for tiles in the center of the view, less towards its edge, (T,)."""
    to_middle = (boxes.low_m + boxes.high_m) / 2.0 - camera.position_m
    length = np.maximum(np.linalg.norm(to_middle, axis=1), 1e-9)
    ahead = to_middle @ camera.R_map_camera[:, 2] / length
    off = np.arccos(np.clip(ahead, -1.0, 1.0)) / (camera.fov_rad / 2.0)
    return 1.0 - (1.0 - LOD.edge_weight) * np.clip(off, 0.0, 1.0)


def _spacing_px(boxes: TileBoxes, tile: int, chunks: int, *, scale_px: float) -> float:
    """Distance of neighboring points on screen with this number of chunks of a tile shown."""
    shown = max(int(boxes.sizes[tile][:chunks].sum()), 1)
    return float(np.sqrt(boxes.area_m2[tile] / shown) * scale_px)
