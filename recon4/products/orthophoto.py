"""Orthophotos: what is seen from above in a storey, or in front of a wall, by its intensity."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field, replace

import numpy as np
from numpy.typing import NDArray

from recon4.errors import ConfigError
from recon4.locales.coded import CodedText
from recon4.mapping.tiles import TileSet
from recon4.products.storeys import BuildingStorey
from recon4.products.tuning import ORTHOPHOTOS
from recon4.slices.geotiff import GeoRaster
from recon4.slices.points import SliceWindow, points_in
from recon4.slices.slice_image import RasterGrid
from recon4.slices.slice_plane import SlicePlane


@dataclass(frozen=True, slots=True, eq=False)
class Orthophoto:
    """A gray image of the surfaces nearest to the viewer."""

    raster: GeoRaster
    """uint8 (H, W, 2): gray, and 255 where something was seen."""
    gray: tuple[float, float]
    """Normalized intensities that are black and white."""
    seen: float
    """Part of the image that was seen."""


def storey_slab(storey: BuildingStorey) -> SlicePlane:
    """What is seen of a storey from above: its floor and what stands on it."""
    below, above = ORTHOPHOTOS.band_m
    top_m = min(storey.floor_m + above, storey.ceiling_m - ORTHOPHOTOS.below_ceiling_m)
    bottom_m = storey.floor_m - below
    return SlicePlane.horizontal((top_m + bottom_m) / 2.0, thickness_m=top_m - bottom_m)


def orthophoto(
    tiles: TileSet, plane: SlicePlane, *, pixel_m: float, length_m: float | None = None
) -> Orthophoto:
    """Draw the surfaces of a slab that are nearest to the viewer, who looks against its normal.

    The points are read twice; memory is that of the image.

    Args:
        tiles: The map.
        plane: The slab; a vertical one is an elevation, as seen with its first point on the left.
        pixel_m: Edge of a pixel [m].
        length_m: Of an elevation: that of its line [m]; None = all of the slab.

    Raises:
        ConfigError: If the slab is empty or the image too large.
    """
    name = "intensity_normalized" if "intensity_normalized" in tiles.fields else "intensity"
    window = _extent(tiles, plane, pixel_m)
    if length_m is not None:
        window = replace(window, left=0.0, right=length_m)
    grid = RasterGrid(window, pixel_m)
    front = _NearestSurfaces.of(grid)
    for rows, depth, _ in _pixels(tiles, plane, grid, name=name):
        np.maximum.at(front.depth_m, rows, depth)
    for rows, depth, value in _pixels(tiles, plane, grid, name=name):
        near = depth > front.depth_m[rows] - ORTHOPHOTOS.surface_m
        np.add.at(front.total, rows[near], value[near])
        np.add.at(front.count, rows[near], 1)
    return _image(front, plane, grid)


@dataclass(frozen=True, slots=True, eq=False)
class _NearestSurfaces:
    """The surfaces nearest to the viewer, for each pixel."""

    depth_m: NDArray[np.float32]
    total: NDArray[np.float32]
    count: NDArray[np.uint32] = field(repr=False)

    @staticmethod
    def of(grid: RasterGrid) -> _NearestSurfaces:
        size = grid.width * grid.height
        depth = np.full(size, -np.inf, np.float32)
        return _NearestSurfaces(depth, np.zeros(size, np.float32), np.zeros(size, np.uint32))


def _extent(tiles: TileSet, plane: SlicePlane, pixel_m: float) -> SliceWindow:
    """Window of all points of the slab, on whole pixels.

    Raises:
        ConfigError: If there are none.
    """
    low, high = np.full(2, np.inf), np.full(2, -np.inf)
    for part in points_in(tiles, plane):
        low = np.minimum(low, part.uvd[:, :2].min(axis=0))
        high = np.maximum(high, part.uvd[:, :2].max(axis=0))
    if not np.isfinite(low).all():
        raise ConfigError(CodedText("orthophoto-none", plane=plane.name))
    low, high = np.floor(low / pixel_m) * pixel_m, (np.floor(high / pixel_m) + 1.0) * pixel_m
    return SliceWindow(*low.tolist(), *high.tolist())


def _pixels(
    tiles: TileSet, plane: SlicePlane, grid: RasterGrid, *, name: str
) -> Iterator[tuple[NDArray[np.int64], NDArray[np.float32], NDArray[np.float32]]]:
    """Pixel, distance towards the viewer, and intensity of points, tile by tile."""
    for part in points_in(tiles, plane, [name], window=grid.window):
        column = ((part.uvd[:, 0] - grid.window.left) / grid.pixel_m).astype(np.int64)
        row = ((grid.window.top - part.uvd[:, 1]) / grid.pixel_m).astype(np.int64)
        column, row = np.clip(column, 0, grid.width - 1), np.clip(row, 0, grid.height - 1)
        value = part.columns[name].astype(np.float32)
        yield row * grid.width + column, part.uvd[:, 2].astype(np.float32), value


def _image(front: _NearestSurfaces, plane: SlicePlane, grid: RasterGrid) -> Orthophoto:
    shape = (grid.height, grid.width)
    seen = front.count > 0
    if not seen.any():
        raise ConfigError(CodedText("orthophoto-line-none", plane=plane.name))
    value = np.divide(front.total, front.count, out=front.total, where=seen)
    sample = value[seen][:: max(1, int(seen.sum()) // ORTHOPHOTOS.sample)]
    low, high = (float(x) for x in np.percentile(sample, ORTHOPHOTOS.percentiles))
    scaled = 255.0 * (value - low) / max(high - low, 1e-6)
    gray = np.clip(np.nan_to_num(scaled), 0.0, 255.0).astype(np.uint8).reshape(shape)
    pixels = np.zeros((*shape, 2), np.uint8)
    step = ORTHOPHOTOS.rows
    for first in range(0, grid.height, step):
        pixels[first : first + step] = _filled(gray, seen.reshape(shape), first, step=step)
    part = float(np.mean(pixels[:, :, 1] > 0))
    return Orthophoto(GeoRaster(pixels, plane, grid), (low, high), part)


def _filled(
    gray: NDArray[np.uint8], seen: NDArray[np.bool_], first: int, *, step: int
) -> NDArray[np.uint8]:
    """Some rows of the image: pixels between points have the value of the nearest one."""
    from scipy.ndimage import distance_transform_edt

    reach = ORTHOPHOTOS.fill_px
    low = max(0, first - reach)
    some, values = seen[low : first + step + reach], gray[low : first + step + reach]
    out = np.zeros((*some.shape, 2), np.uint8)
    if some.any():
        away, (row, column) = distance_transform_edt(~some, return_indices=True)
        near = away <= reach
        out[near, 0] = values[row[near], column[near]]
        out[near, 1] = 255
    return out[first - low : first - low + step]
