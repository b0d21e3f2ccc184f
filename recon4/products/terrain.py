"""Models of the terrain of outdoor walks: heights of the ground, or of what is highest."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from recon4.errors import ConfigError
from recon4.geometry.se3 import Array
from recon4.locales.coded import CodedText
from recon4.mapping.tiles import TileSet
from recon4.model.classes import PointClass
from recon4.products.tuning import TERRAIN
from recon4.slices.geotiff import GeoRaster
from recon4.slices.points import SliceWindow
from recon4.slices.slice_image import RasterGrid
from recon4.slices.slice_plane import SlicePlane

TerrainKind = Literal["dtm", "dsm"]


@dataclass(frozen=True, slots=True, eq=False)
class Terrain:
    """Heights of a map seen from above, in its own frame."""

    kind: TerrainKind
    grid: RasterGrid
    height_m: NDArray[np.float32]
    """Height in the map [m], NaN where nothing was seen, (H, W); the first row is the north."""
    sd_m: NDArray[np.float32]
    """Standard deviation of the points of a cell from its height [m], (H, W)."""
    position_sd_m: float
    """Stated standard deviation of the positions, their median [m]; 0 = not stated."""

    @property
    def seen(self) -> NDArray[np.bool_]:
        """Cells with a height, (H, W)."""
        return np.isfinite(self.height_m)

    @property
    def plane(self) -> SlicePlane:
        """The plane of the raster."""
        level = float(np.nanmedian(self.height_m)) if self.seen.any() else 0.0
        return SlicePlane.horizontal(level)

    def centers_m(self) -> tuple[Array, Array]:
        """Coordinates x (W,) and y (H,) of the middles of the cells in the map [m]."""
        step, window = self.grid.pixel_m, self.grid.window
        x = np.asarray(window.left + (np.arange(self.grid.width) + 0.5) * step, np.float64)
        y = np.asarray(window.top - (np.arange(self.grid.height) + 0.5) * step, np.float64)
        return x, y

    def raster(self, up_m: float = 0.0) -> GeoRaster:
        """Heights as they are written, shifted up to those of a CRS [m]."""
        pixels = np.where(self.seen, self.height_m + np.float32(up_m), np.float32(TERRAIN.nodata))
        return GeoRaster(pixels.astype(np.float32), self.plane, self.grid, TERRAIN.nodata)


@dataclass(frozen=True, slots=True)
class TerrainPart:
    """A part of a map."""

    window: SliceWindow
    """Seen from above [m]."""
    low_m: float = -np.inf
    high_m: float = np.inf
    """Points below and above are left out, as a ceiling [m]."""


def terrain(
    tiles: TileSet, kind: TerrainKind, *, cell_m: float, part: TerrainPart | None = None
) -> Terrain:
    """Heights of the ground (``dtm``) or of what is highest (``dsm``), cell by cell.

    Ground is what has the class; in a map without that class it is found by a progressive
    morphological filter (Zhang et al. 2003) on the lowest level surface of each cell. Its height is
    the mean of the points near the lowest. Cells without ground stay empty: nothing is
    interpolated. Memory is that of the raster.

    Args:
        tiles: The map.
        kind: Which surface.
        cell_m: Edge of a cell [m].
        part: Only this part of the map; tiles beside it are not read.

    Raises:
        ConfigError: If the map is empty or the raster too large.
    """
    part = part or TerrainPart(_window(tiles))
    grid = _grid(part.window, cell_m)
    shape, ground = (grid.height, grid.width), kind == "dtm"
    edge = np.full(shape, np.inf if ground else -np.inf).ravel()
    for rows, z_m in _cells(tiles, grid, part, ground=ground):
        (np.minimum if ground else np.maximum).at(edge, rows, z_m)
    lowest = edge.reshape(shape)
    if ground and not has_ground(tiles):
        lowest = np.where(_is_ground(lowest, cell_m), lowest, np.nan)
    lowest[~np.isfinite(lowest)] = np.nan
    points = _cells(tiles, grid, part, ground=ground)
    height, sd = _means(points, lowest)
    return Terrain(kind, grid, height, sd, _position_sd(tiles))


def has_ground(tiles: TileSet) -> bool:
    """Whether points of a map have the class ground."""
    return bool(tiles.notes.classes.get(int(PointClass.GROUND)))


def spacing_m(tiles: TileSet, part: TerrainPart) -> float:
    """Distance of neighboring points of a part of a map, seen from above where it was seen [m].

    The median over cells of `TERRAIN.density_m` that have points; 0 if none has.

    Raises:
        ConfigError: If the part is too large.
    """
    grid = _grid(part.window, TERRAIN.density_m)
    counts = np.zeros(grid.width * grid.height)
    for rows, _ in _cells(tiles, grid, part, ground=False):
        counts += np.bincount(rows, minlength=len(counts))
    seen = counts[counts > 0.0]
    return float(TERRAIN.density_m / np.sqrt(np.median(seen))) if len(seen) else 0.0


def _window(tiles: TileSet) -> SliceWindow:
    if not len(tiles):
        raise ConfigError(CodedText("terrain-none"))
    low, high = (np.asarray(corner)[:2] for corner in tiles.bounds_m)
    return SliceWindow(*low.tolist(), *high.tolist())


def _grid(window: SliceWindow, cell_m: float) -> RasterGrid:
    """Whole cells, so that the same place has the same cells in any part of a map."""
    low, high = np.array([window.left, window.bottom]), np.array([window.right, window.top])
    low, high = np.floor(low / cell_m) * cell_m, (np.floor(high / cell_m) + 1.0) * cell_m
    return RasterGrid(SliceWindow(*low.tolist(), *high.tolist()), cell_m)


def _cells(
    tiles: TileSet, grid: RasterGrid, part: TerrainPart, *, ground: bool
) -> Iterator[tuple[NDArray[np.int64], Array]]:
    """Cell and height of points, tile by tile; of the ground only those of its class, or without it
    those of level surfaces.
    """
    of_ground = ["classification" if has_ground(tiles) else "normal"] if ground else []
    window = grid.window
    rounding_m = 1e-4  # of points at the edge of a map
    low = np.array([window.left - rounding_m, window.bottom - rounding_m, part.low_m])
    high = np.array([window.right + rounding_m, window.top + rounding_m, part.high_m])
    for tile in tiles:
        if np.any(np.array(tile.high_m) < low) or np.any(np.array(tile.low_m) > high):
            continue
        columns = tile.read(["xyz", *of_ground])
        p = columns["xyz"].astype(np.float64) + tile.origin_m
        inside = np.all((p >= low) & (p <= high), axis=1)
        if "classification" in columns:
            inside &= columns["classification"] == PointClass.GROUND
        elif ground:
            inside &= columns["normal"][:, 2] > TERRAIN.level
        p = p[inside]
        column = ((p[:, 0] - window.left) / grid.pixel_m).astype(np.int64)
        row = ((window.top - p[:, 1]) / grid.pixel_m).astype(np.int64)
        column, row = np.clip(column, 0, grid.width - 1), np.clip(row, 0, grid.height - 1)
        yield row * grid.width + column, p[:, 2]


def _is_ground(lowest: Array, cell_m: float) -> NDArray[np.bool_]:
    """Progressive morphological filter: cells that no opening lowers by more than its limit."""
    from scipy.ndimage import distance_transform_edt, maximum_filter, minimum_filter

    known = np.isfinite(lowest)
    if not known.any():
        return known
    nearest = distance_transform_edt(~known, return_distances=False, return_indices=True)
    surface = lowest[tuple(nearest)]
    ground, width, before = known.copy(), 3, 1
    while width * cell_m <= TERRAIN.widest_m:
        opened = maximum_filter(minimum_filter(surface, width), width)
        limit = TERRAIN.step_m + TERRAIN.slope * (width - before) * cell_m / 2.0
        ground &= surface - opened <= limit
        surface, before, width = opened, width, 2 * width - 1
    return ground


def _means(
    points: Iterator[tuple[NDArray[np.int64], Array]], edge: Array
) -> tuple[NDArray[np.float32], NDArray[np.float32]]:
    """Mean height of the points near the lowest or highest one, and their deviation, (H, W)."""
    flat = edge.ravel()
    count, total, squares = np.zeros((3, len(flat)))
    for rows, z_m in points:
        off = z_m - flat[rows]
        near = np.abs(off) <= TERRAIN.surface_m
        count += np.bincount(rows[near], minlength=len(flat))
        total += np.bincount(rows[near], off[near], len(flat))
        squares += np.bincount(rows[near], off[near] ** 2, len(flat))
    n = np.maximum(count, 1.0)
    mean = total / n
    sd = np.sqrt(np.maximum(squares / n - mean**2, 0.0))
    shape = edge.shape
    return (
        (flat + mean).reshape(shape).astype(np.float32),
        sd.reshape(shape).astype(np.float32),
    )


def _position_sd(tiles: TileSet) -> float:
    """Median of the stated deviations of the positions [m]; 0 if none are stated."""
    if "position_sd_m" not in tiles.fields:
        return 0.0
    parts = [tile.read(["position_sd_m"], limit=1000)["position_sd_m"] for tile in tiles]
    stated = np.concatenate([np.empty(0), *parts]).astype(np.float64)
    stated = stated[np.isfinite(stated)]
    return float(np.median(stated)) if len(stated) else 0.0
