"""Rendering of slice images from all points of the map in a window, at full resolution."""

from __future__ import annotations

import io
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from recon4.errors import ConfigError
from recon4.geometry.se3 import Array
from recon4.kernels.slices import first_of_pixels, splat
from recon4.locales.coded import CodedText
from recon4.mapping.tiles import TileSet
from recon4.slices.colors import ColorBy, Ground, Span, paint, usual_span
from recon4.slices.points import SliceWindow, TilePart, points_in
from recon4.slices.slice_plane import SlicePlane
from recon4.slices.tuning_files import SLICE_COLORS, SLICE_IMAGES

if TYPE_CHECKING:
    from recon4.slices.reference import Reference

_FIELD: dict[ColorBy, str] = {
    "intensity": "intensity",
    "normalized": "intensity_normalized",
    "time": "t_ns",
    "sensor": "sensor",
}
_FIRST_OF_PIXEL = {"sensor", "distance"}
"""Not averaged over a pixel: a mean of two sensors is no sensor, one far point must be seen."""


@dataclass(frozen=True, slots=True)
class RasterGrid:
    """Drawn part of a slice and its pixel size."""

    window: SliceWindow
    pixel_m: float

    def __post_init__(self) -> None:
        if not self.pixel_m > 0.0 or not np.isfinite(self.pixel_m):
            raise ConfigError(CodedText("slice-pixel", pixel_m=self.pixel_m))
        w = self.window
        corners = np.array([w.left, w.bottom, w.right, w.top])
        if not (np.isfinite(corners).all() and w.right > w.left and w.top > w.bottom):
            raise ConfigError(CodedText("slice-window", corners=str(corners.tolist())))
        if self.width * self.height > SLICE_IMAGES.max_pixels:
            raise ConfigError(
                CodedText(
                    "slice-pixels",
                    max_pixels=SLICE_IMAGES.max_pixels // 10**6,
                    width=self.width,
                    height=self.height,
                )
            )

    @property
    def width(self) -> int:
        """Pixels to the right."""
        return max(1, round((self.window.right - self.window.left) / self.pixel_m))

    @property
    def height(self) -> int:
        """Pixels down."""
        return max(1, round((self.window.top - self.window.bottom) / self.pixel_m))

    @property
    def corner(self) -> Array:
        """Coordinate u of the left edge and v of the upper edge [m], (2,)."""
        return np.array([self.window.left, self.window.top])

    @property
    def radius_px(self) -> int:
        """Radius of a drawn point: points stay visible where pixels are smaller than a dot."""
        return min(SLICE_IMAGES.max_radius_px, int(SLICE_IMAGES.dot_m / self.pixel_m))


@dataclass(frozen=True, slots=True, eq=False)
class SliceImage:
    """A drawn slice; colors come later (`rgba`)."""

    plane: SlicePlane
    paper: RasterGrid
    color: ColorBy
    points: int
    """Points of the map in the window."""
    count: NDArray[np.int32]
    """Points on each pixel, (H, W)."""
    value: Array
    """Mean value of a pixel in the units of `colors.UNITS`, NaN = no point, (H, W)."""
    reference: NDArray[np.bool_]
    """Where the reference is, (H, W)."""
    span: Span
    """Color range of the values."""

    def rgba(self, span: Span, ground: Ground) -> NDArray[np.uint8]:
        """Colors (H, W, 4), transparent where there are no points; single points are paler."""
        out = np.zeros((*self.count.shape, 4), np.uint8)
        out[self.reference] = (*SLICE_COLORS.reference_color, 255)
        hit = self.count > 0
        out[hit, :3] = paint(self.value[hit], span, color=self.color, ground=ground)
        ink = 1.0 - 0.4 ** np.minimum(self.count[hit], 8)
        full = self.reference[hit] | (self.color in _FIRST_OF_PIXEL)
        out[hit, 3] = np.where(full, 255, (255.0 * ink).astype(np.uint8))
        return out


def draw(
    tiles: TileSet,
    plane: SlicePlane,
    paper: RasterGrid,
    *,
    color: ColorBy = "height",
    reference: Reference | None = None,
) -> SliceImage:
    """Draw a slice from all its points. Memory depends on the image, not on the map.

    Args:
        tiles: The map.
        plane: The slice.
        paper: Window and pixel size.
        color: Value to show; the mean of the points of a pixel.
        reference: Drawn beneath; needed for ``distance``.

    Raises:
        ConfigError: If the map or the request lacks what the color needs.
    """
    fields = _fields(tiles, color, reference)
    shape = (paper.height, paper.width)
    count, total = np.zeros(shape, np.int32), np.zeros(shape)
    taken = np.zeros(shape, np.bool_) if color in _FIRST_OF_PIXEL else None
    far: list[Array] = []
    points = 0
    for part in points_in(tiles, plane, fields, window=paper.window):
        points += len(part)
        if taken is not None:
            part = _firsts(part, paper, taken)
        if color == "distance":
            far.append(part.uvd)  # measured all at once below: at most one a pixel
        else:
            values = _values(part, plane, color, tiles=tiles)
            _add(part.uvd, values, paper, count=count, total=total)
    if far and reference is not None:
        uvd = np.concatenate(far)
        _add(uvd, reference.distance(plane.to_map(uvd)), paper, count=count, total=total)
    with np.errstate(invalid="ignore"):
        value = np.where(count > 0, total / count, np.nan)
    return SliceImage(
        plane=plane,
        paper=paper,
        color=color,
        points=points,
        count=count,
        value=value,
        reference=_reference_mask(reference, plane, paper),
        span=usual_span(value, color=color),
    )


def png(rgba: NDArray[np.uint8]) -> bytes:
    """An image file of pixels (H, W, 4)."""
    from PIL import Image

    out = io.BytesIO()
    Image.fromarray(rgba).save(out, format="PNG", compress_level=3)
    return out.getvalue()


def _fields(tiles: TileSet, color: ColorBy, reference: Reference | None) -> list[str]:
    if color == "distance" and reference is None:
        raise ConfigError(CodedText("slice-color-distance"))
    field = _FIELD.get(color)
    if field is not None and field not in tiles.fields:
        raise ConfigError(
            CodedText("slice-no-intensity", color=color, fields=str(list(tiles.fields)))
        )
    return [field] if field else []


def _values(
    part: TilePart, plane: SlicePlane, color: ColorBy, *, tiles: TileSet
) -> NDArray[np.float32]:
    if color == "height":
        z: Array = part.uvd @ plane.axes[:, 2] + plane.origin_m[2]
        return z.astype(np.float32)
    column = part.columns[_FIELD[color]]
    if color == "time":
        first_ns = tiles.first_ns
        return ((column - first_ns) / 1e9).astype(np.float32)
    return column.astype(np.float32)


def _firsts(part: TilePart, paper: RasterGrid, taken: NDArray[np.bool_]) -> TilePart:
    chosen = np.empty(len(part), np.int32)
    count = first_of_pixels(part.uvd, paper.corner, paper.pixel_m, taken, chosen)
    rows = chosen[:count]
    columns = {name: column[rows] for name, column in part.columns.items()}
    return TilePart(part.tile, part.rows[rows], part.uvd[rows], columns)


def _add(
    uvd: Array, values: NDArray[Any], paper: RasterGrid, *, count: NDArray[np.int32], total: Array
) -> None:
    splat(
        uvd,
        np.asarray(values, dtype=np.float32),
        paper.corner,
        paper.pixel_m,
        paper.radius_px,
        count,
        total,
    )


def _reference_mask(
    reference: Reference | None, plane: SlicePlane, paper: RasterGrid
) -> NDArray[np.bool_]:
    shape = (paper.height, paper.width)
    if reference is None:
        return np.zeros(shape, np.bool_)
    count, total = np.zeros(shape, np.int32), np.zeros(shape)
    for uvd in reference.outline(plane, paper.window, step_m=paper.pixel_m):
        ones = np.ones(len(uvd), np.float32)
        splat(uvd, ones, paper.corner, paper.pixel_m, paper.radius_px + 1, count, total)
    return count > 0
