"""Images of the map: points summed into pixels, in two passes with little memory."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass, field
from io import BytesIO

import numpy as np
from numpy.typing import NDArray

from recon4.geometry.se3 import Array
from recon4.kernels.image_sums import add_to_pixels
from recon4.mapping.tiles import TileSet
from recon4.report.tuning import MAP_IMAGES


@dataclass(frozen=True, slots=True, eq=False)
class MapChunk:
    """Some points of the finished map."""

    xyz_m: Array
    """Points in the frame of the map [m], (N, 3)."""
    intensity: NDArray[np.integer]
    """As measured by the sensor, (N,)."""
    normalized: NDArray[np.floating] | None = None
    """After normalization, (N,); None = not normalized."""


@dataclass(frozen=True, slots=True)
class MapProjection:
    """Direction of view on the map."""

    name: str
    right: int
    """Axis of the map that points to the right."""
    up: int
    """Axis of the map that points up."""
    labels: tuple[str, str]
    """What the two axes are called."""


ABOVE = MapProjection("from above", 0, 1, ("x", "y"))
FRONT = MapProjection("from the side, along y", 0, 2, ("x", "z"))
SIDE = MapProjection("from the side, along x", 1, 2, ("y", "z"))
PROJECTIONS = (ABOVE, FRONT, SIDE)


@dataclass(frozen=True, slots=True)
class ImageFrame:
    """Part of the plane that an image shows."""

    left_m: float
    bottom_m: float
    pixel_m: float
    """Edge of a pixel [m]."""
    width: int
    """Pixels."""
    height: int
    """Pixels."""


@dataclass(slots=True, eq=False)
class Raster:
    """Sums over the points in each pixel; row 0 is the top of the image."""

    view: MapProjection
    frame: ImageFrame
    sums: Array = field(init=False)
    """Points, their heights, intensities and normalized intensities, (P, 4)."""
    ink: bytes | None = field(init=False, default=None)
    """Image of the density, once it was made."""

    def __post_init__(self) -> None:
        self.sums = np.zeros((self.frame.width * self.frame.height, 4))

    def add(self, chunk: MapChunk) -> None:
        """Add points."""
        self.ink = None
        known = [chunk.intensity, chunk.normalized] if self.view is ABOVE else []
        columns = [one for one in known if one is not None]  # shown from above only
        values = np.empty((len(chunk.xyz_m), len(columns)), np.float32)
        for k, column in enumerate(columns):
            values[:, k] = column
        f = self.frame
        axes, corner = (self.view.right, self.view.up), (f.left_m, f.bottom_m)
        add_to_pixels(chunk.xyz_m, values, axes, corner, f.pixel_m, f.width, self.sums)

    @property
    def count(self) -> Array:
        """Points of each pixel, (P,)."""
        return self.sums[:, 0]

    @property
    def z_sum(self) -> Array:
        """Sum of the heights of each pixel [m], (P,)."""
        return self.sums[:, 1]

    @property
    def intensity_sum(self) -> Array:
        """Sum of the intensities of each pixel, (P,)."""
        return self.sums[:, 2]

    @property
    def normalized_sum(self) -> Array:
        """Sum of the normalized intensities of each pixel, (P,)."""
        return self.sums[:, 3]

    @property
    def seen(self) -> NDArray[np.int64]:
        """Pixels with points, (S,)."""
        return np.flatnonzero(self.count)

    def mean(self, total: Array) -> Array:
        """Mean of each pixel that is `seen`, (S,)."""
        seen = self.seen
        return np.asarray(total[seen] / self.count[seen])

    @property
    def density(self) -> Array:
        """Points of each pixel that is `seen` on a logarithmic scale, above 0 to 1, (S,)."""
        seen = self.count[self.seen]
        top = np.log1p(np.percentile(seen, 99.5)) if len(seen) else 1.0
        return np.clip(np.log1p(seen) / top, 0.0, 1.0)


def map_chunks(tiles: TileSet, points: int = MAP_IMAGES.points) -> Iterator[MapChunk]:
    """The points of a map, or an even sample of about this many at most."""
    ratio = min(1.0, points / max(len(tiles), 1))
    normalized = "intensity_normalized" in tiles.fields
    for tile in tiles:
        limit = int(np.ceil(ratio * len(tile)))
        fields = ["intensity", "intensity_normalized"] if normalized else ["intensity"]
        columns = tile.read(fields, limit=limit)
        yield MapChunk(
            tile.xyz_m(limit=limit), columns["intensity"], columns.get("intensity_normalized")
        )


def rasterize(
    chunks: Callable[[int], Iterable[MapChunk]], views: tuple[MapProjection, ...] = PROJECTIONS
) -> list[Raster]:
    """Sum the points of a map into images, one per view, all of one scale.

    Args:
        chunks: Makes a pass over an even sample of at most this many points of the map.
        views: Directions of view.

    Returns:
        Empty if the map has no points.
    """
    bounds = _bounds(chunks(MAP_IMAGES.outline_points))
    if bounds is None:
        return []
    low, high = bounds
    pixel_m = _pixel_m(float((high - low).max()))
    rasters = [Raster(view, _frame(view, low, high, pixel_m=pixel_m)) for view in views]
    for chunk in chunks(MAP_IMAGES.points):
        for raster in rasters:
            raster.add(chunk)
    return rasters


def ink_png(raster: Raster) -> bytes:
    """Image of the point density: walls seen from above are dark lines."""
    if raster.ink is None:
        shade = _steps(raster.density**1.3)
        rgba = np.zeros((len(shade), 4))
        rgba[:, 3] = shade
        raster.ink = _png(raster, rgba)
    return raster.ink


def height_png(raster: Raster) -> tuple[bytes, tuple[float, float]]:
    """Image of the mean height, paler where points are few; with the ends of its scale [m]."""
    from matplotlib import colormaps

    z_m = raster.mean(raster.z_sum)
    low, high = _ends(z_m, 1.0, 99.0)
    rgba = np.array(colormaps["viridis"](_steps((z_m - low) / (high - low))))
    rgba[:, 3] = 0.25 + 0.75 * _steps(raster.density)
    return _png(raster, rgba), (low, high)


def intensity_png(raster: Raster, *, normalized: bool) -> tuple[bytes, tuple[float, float]]:
    """Gray image of the mean intensity; with the intensities of black and white."""
    mean = raster.mean(raster.normalized_sum if normalized else raster.intensity_sum)
    low, high = _ends(mean, 2.0, 98.0)
    shade = _steps((mean - low) / (high - low))
    known = np.isfinite(mean).astype(float)
    return _png(raster, np.stack([shade, shade, shade, known], axis=-1)), (low, high)


def _bounds(chunks: Iterable[MapChunk]) -> tuple[Array, Array] | None:
    """Bounds of all but a thousandth of the points, in steps of 0.25 m."""
    bins: list[Counter[int]] = [Counter(), Counter(), Counter()]
    for chunk in chunks:
        if not len(chunk.xyz_m):
            continue
        for axis, counter in enumerate(bins):
            key = np.floor(chunk.xyz_m[:, axis] / MAP_IMAGES.bin_m).astype(np.int64)
            first = int(key.min())
            for step, count in enumerate(np.bincount(key - first).tolist()):
                counter[first + step] += count
    if not bins[0]:
        return None
    ends = np.array([_trimmed(counter) for counter in bins])
    return ends[:, 0], ends[:, 1]


def _trimmed(counter: Counter[int]) -> tuple[float, float]:
    keys = np.array(sorted(counter))
    ratio = np.cumsum([counter[key] for key in keys]) / counter.total()
    first = keys[np.searchsorted(ratio, MAP_IMAGES.trim)]
    last = keys[np.searchsorted(ratio, 1.0 - MAP_IMAGES.trim)]
    return float(first - 1) * MAP_IMAGES.bin_m, float(last + 2) * MAP_IMAGES.bin_m


def _pixel_m(extent_m: float) -> float:
    """1, 2 or 5 times a power of ten, so that the extent fits into the image."""
    wanted = max(extent_m / MAP_IMAGES.max_pixels, 0.01)
    power = 10.0 ** np.floor(np.log10(wanted))
    return float(next(step * power for step in (1, 2, 5, 10) if step * power >= wanted * 0.999))


def _frame(view: MapProjection, low: Array, high: Array, *, pixel_m: float) -> ImageFrame:
    size = np.ceil((high - low) / pixel_m).astype(int)
    return ImageFrame(
        float(low[view.right]),
        float(low[view.up]),
        pixel_m,
        int(size[view.right]),
        int(size[view.up]),
    )


def _ends(values: Array, low: float, high: float) -> tuple[float, float]:
    seen = values[np.isfinite(values)]
    a, b = np.percentile(seen, [low, high]) if len(seen) else (0.0, 1.0)
    return (float(a), float(b)) if b - a > 1e-9 else (float(a) - 0.5, float(a) + 0.5)


def _steps(shade: Array) -> Array:
    return np.round(np.nan_to_num(np.clip(shade, 0.0, 1.0)) * MAP_IMAGES.levels) / MAP_IMAGES.levels


def _png(raster: Raster, rgba: Array) -> bytes:
    """An image of the pixels with points, colors 0 to 1, (S, 4); the others are transparent."""
    from PIL import Image

    pixels = np.zeros((raster.frame.height, raster.frame.width, 4), np.uint8)
    pixels.reshape(-1, 4)[raster.seen] = np.round(255.0 * rgba)
    buffer = BytesIO()
    Image.fromarray(pixels, "RGBA").save(buffer, "PNG")
    return buffer.getvalue()
