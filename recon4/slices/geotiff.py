"""Rasters as GeoTIFF 1.1: images of slices, orthophotos, heights of terrain."""

from __future__ import annotations

import io
from dataclasses import dataclass
from enum import IntEnum
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from recon4.errors import GeoreferenceError
from recon4.export.names import check_name
from recon4.geometry.se3 import Array
from recon4.locales.coded import CodedText
from recon4.model.site_control import SITE_GRID
from recon4.slices.map_crs import MapFrame, jacobian
from recon4.slices.slice_image import RasterGrid, SliceImage
from recon4.slices.slice_plane import SlicePlane
from recon4.store.atomic import atomic_file


class GeoTag(IntEnum):
    """Tags of GeoTIFF 1.1."""

    MATRIX = 34264
    KEYS = 34735
    ASCII = 34737
    NODATA = 42113
    """Of GDAL."""


@dataclass(frozen=True, slots=True, eq=False)
class GeoRaster:
    """Pixels in a plane of the map."""

    pixels: NDArray[Any]
    """uint8 (H, W, 4) or (H, W, 2) with the last one transparency, or float32 (H, W)."""
    plane: SlicePlane
    grid: RasterGrid
    nodata: float | None = None
    """Value of pixels that were not seen."""


def write_geotiff(
    drawn: SliceImage,
    path: Path,
    *,
    frame: MapFrame,
    rgba: NDArray[np.uint8],
    description: str = "",
) -> None:
    """Write the image of a slice, colored, transparent where there are no points.

    Args:
        drawn: The slice.
        path: File to write.
        frame: Of the map.
        rgba: Its colors, see `SliceImage.rgba`.
        description: For the tag ImageDescription.

    Raises:
        GeoreferenceError: If an affine transformation would be off by half a pixel at a corner.
        StoreError: If the file cannot be written.
    """
    raster = GeoRaster(rgba, drawn.plane, drawn.paper)
    write_raster(raster, path, frame=frame, description=description)


def write_raster(raster: GeoRaster, path: Path, *, frame: MapFrame, description: str = "") -> None:
    """Write a raster as GeoTIFF.

    In a horizontal plane of a georeferenced map it has its CRS, and a transformation that is exact
    at its center; in the grid of a site its coordinates and no CRS. Others have the coordinates of
    the plane (u, v in meters) and no CRS.

    Args:
        raster: The pixels.
        path: File to write.
        frame: Of the map.
        description: For the tag ImageDescription.

    Raises:
        GeoreferenceError: If an affine transformation would be off by half a pixel at a corner.
        StoreError: If the file cannot be written.
    """
    from PIL import Image, TiffImagePlugin

    check_name(path, ".tif")
    tags = TiffImagePlugin.ImageFileDirectory_v2()
    A, corner = affine_of(raster.plane, raster.grid, frame)
    geo = _tags(raster, frame, A, corner=corner)
    for tag, values in geo.items():
        text = isinstance(values, str)
        tags.tagtype[tag] = 2 if text else (3 if tag == GeoTag.KEYS else 12)
        tags[tag] = values if text else tuple(values)
    tags[TiffImagePlugin.IMAGEDESCRIPTION] = description.encode("ascii", "replace").decode()
    image, made = Image.fromarray(raster.pixels), io.BytesIO()
    image.save(made, format="TIFF", compression="tiff_adobe_deflate", tiffinfo=tags)
    with atomic_file(path) as temporary:  # libtiff itself does not tell a full disk
        temporary.write_bytes(made.getbuffer())


def write_world_file(raster: GeoRaster, path: Path, *, frame: MapFrame) -> None:
    """Write the transformation of a raster as world file (ESRI): of its upper left pixel.

    Args:
        raster: The pixels.
        path: File to write, as ``.tfw``.
        frame: Of the map.
    """
    A, corner = affine_of(raster.plane, raster.grid, frame)
    center = corner + A @ [0.5, 0.5]
    numbers = [A[0, 0], A[1, 0], A[0, 1], A[1, 1], *center]
    with atomic_file(path) as temporary:
        temporary.write_text("".join(f"{x:.10f}\n" for x in numbers), "ascii")


def affine_of(plane: SlicePlane, grid: RasterGrid, frame: MapFrame) -> tuple[Array, Array]:
    """From pixels to coordinates: matrix (2, 2), and the corner of the first pixel, (2,).

    Raises:
        GeoreferenceError: If it would be off by half a pixel at a corner.
    """
    u0, v0 = grid.corner
    scale = np.array([grid.pixel_m, -grid.pixel_m])
    if plane.kind != "horizontal" or frame.to_crs is None:
        return np.diag(scale), np.array([u0, v0])
    middle = np.array([u0 + grid.width * grid.pixel_m / 2.0,
                       v0 - grid.height * grid.pixel_m / 2.0, plane.origin_m[2]])  # fmt: skip
    J, place = jacobian(frame.to_crs, middle)
    _refuse_bent(grid, frame, middle)
    return J[:2, :2] * scale, place[:2] + J[:2, :2] @ (np.array([u0, v0]) - middle[:2])


def _tags(raster: GeoRaster, frame: MapFrame, A: Array, *, corner: Array) -> dict[int, Any]:
    """The transformation from pixels, and keys that name the CRS."""
    citation = ""
    horizontal = raster.plane.kind == "horizontal"
    if horizontal and frame.to_crs is not None and frame.crs != SITE_GRID:
        code = _epsg(frame)
        keys = [(1024, 0, 1, 1), (1025, 0, 1, 1), (3072, 0, 1, code), (3076, 0, 1, 9001)]
    else:
        of = SITE_GRID if horizontal and frame.crs == SITE_GRID else frame.text
        citation = f"recon4 slice {raster.plane.name}, {of}|"
        keys = [(1024, 0, 1, 32767), (1025, 0, 1, 1), (1026, GeoTag.ASCII, len(citation), 0)]
        keys.append((3076, 0, 1, 9001))
    matrix = [A[0, 0], A[0, 1], 0, corner[0], A[1, 0], A[1, 1], 0, corner[1],
              0, 0, 0, 0, 0, 0, 0, 1]  # fmt: skip
    directory = [1, 1, 1, len(keys), *(number for key in keys for number in key)]
    tags: dict[int, Any] = {GeoTag.KEYS: directory, GeoTag.MATRIX: [float(x) for x in matrix]}
    if citation:
        tags[GeoTag.ASCII] = citation.encode("ascii", "replace").decode()
    if raster.nodata is not None:
        tags[GeoTag.NODATA] = f"{raster.nodata:g}"
    return tags


def _refuse_bent(grid: RasterGrid, frame: MapFrame, middle: Array) -> None:
    assert frame.to_crs is not None
    J, place = jacobian(frame.to_crs, middle)
    w = grid.window
    corners = np.array([[x, y, middle[2]] for x in (w.left, w.right) for y in (w.bottom, w.top)])
    off = frame.to_crs(corners) - (place + (corners - middle) @ J.T)
    worst = float(np.linalg.norm(off[:, :2], axis=1).max())
    if worst > max(0.5 * grid.pixel_m, 0.005):
        raise GeoreferenceError(CodedText("geotiff-large", worst=worst, crs=frame.crs))


def _epsg(frame: MapFrame) -> int:
    """Code of the horizontal system."""
    first = frame.crs.removeprefix("EPSG:").split("+")[0]
    if not first.isdigit():
        raise GeoreferenceError(CodedText("geotiff-epsg", crs=frame.crs))
    return int(first)
