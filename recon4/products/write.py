"""The products of a map as files: what is wanted, and who writes it."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from pathlib import Path
from typing import Literal

import numpy as np

from recon4.errors import ConfigError
from recon4.locales.coded import CodedText, joined
from recon4.mapping.tiles import TileSet
from recon4.products.drawing import DRAWINGS, DrawingNotes, DrawnShape, DrawnTitle, write_drawing
from recon4.products.fitted_plans import FittedPlans
from recon4.products.storeys import find_storeys, level_surfaces, storey_named
from recon4.products.terrain import Terrain, TerrainKind, terrain
from recon4.review.stamp import Stamp, stamp_file
from recon4.slices.geotiff import GeoRaster, write_raster, write_world_file
from recon4.slices.map_crs import MapFrame
from recon4.slices.slice_plane import SlicePlane
from recon4.store.atomic import atomic_file

ProductKind = Literal["plan", "orthophoto", "terrain"]
ENDINGS: dict[ProductKind, tuple[str, ...]] = {
    "plan": (*DRAWINGS, ".png"),
    "orthophoto": (".tif", ".png"),
    "terrain": (".tif", *DRAWINGS, ".png"),
}
"""Kind of a product -> endings of its files; a ``.png`` is a preview to look at."""


@dataclass(frozen=True, slots=True, kw_only=True)
class ProductOptions:
    """What is wanted of a product; each kind reads some of it."""

    storey: str = ""
    """Of a plan: only this storey. Of an orthophoto: this one; empty = ``0``."""
    line: tuple[float, float, float, float] | None = None
    """Of an orthophoto: an elevation, seen with x1, y1 on the left and x2, y2 on the right [m]."""
    depth_m: float = 1.0
    """Of an elevation: points this far from the line, on both sides together [m]."""
    pixel_m: float = 0.01
    """Of an orthophoto [m]."""
    surface: TerrainKind = "dtm"
    """Of a terrain: the ground, or what is highest."""
    cell_m: float = 0.25
    """Of a terrain [m]."""
    interval_m: float = 0.5
    """Of contours [m]."""

    def __post_init__(self) -> None:
        for name in ("depth_m", "pixel_m", "cell_m", "interval_m"):
            value = getattr(self, name)
            if not (math.isfinite(value) and value > 0.0):
                raise ConfigError(CodedText("number-positive", name=name, value=str(value)))


@dataclass(frozen=True, slots=True, eq=False)
class ProductSource:
    """The map of which a product is made."""

    tiles: TileSet
    frame: MapFrame
    stamp: Stamp | None
    """Its approval, which the file notes; None = not approved, or a draft."""
    plans: FittedPlans = field(default_factory=FittedPlans)
    """Of this map."""

    @property
    def description(self) -> str:
        """For the file: the approval of the map."""
        if self.stamp is None:
            return "recon4, not approved"
        return f"recon4 approval {self.stamp.json_line()}"


def write_product(
    kind: ProductKind, source: ProductSource, path: Path, *, options: ProductOptions
) -> str:
    """Write a product of a map in the format of the ending.

    Args:
        kind: Which product.
        source: The map.
        path: File to write, one of `ENDINGS`; a raster has a world file beside it.
        options: What is wanted of it.

    Returns:
        What was written, in words.

    Raises:
        ConfigError: If the ending is another, or the map does not have what is wanted.
        GeoreferenceError: If a raster is too large for its CRS.
        StoreError: If the file cannot be written.
    """
    if path.suffix.lower() not in ENDINGS[kind]:
        raise ConfigError(
            CodedText("product-endings", kind=kind, endings=" ".join(ENDINGS[kind]), file=path.name)
        )
    if kind == "plan":
        return _write_plan(source, path, options)
    if kind == "orthophoto":
        return _write_orthophoto(source, path, options)
    return _write_terrain(source, path, options)


def _write_plan(source: ProductSource, path: Path, options: ProductOptions) -> str:
    from recon4.products.shapes import plan_shapes, plan_title

    plans = source.plans.of(source.tiles, options.storey)
    shapes = [shape for plan in plans for shape in plan_shapes(plan)]
    if not any(plan.walls for plan in plans):
        raise ConfigError(CodedText("plan-no-wall"))
    _draw(shapes, path, source, titles=[plan_title(plan) for plan in plans])
    return joined(plan.text for plan in plans)


def _write_orthophoto(source: ProductSource, path: Path, options: ProductOptions) -> str:
    from recon4.products.orthophoto import orthophoto, storey_slab

    if options.line:
        a, b = options.line[:2], options.line[2:]
        plane = SlicePlane.vertical(a, b, thickness_m=options.depth_m)
        length_m: float | None = math.dist(a, b)
    else:
        storeys = find_storeys(source.tiles, level_surfaces(source.tiles))
        plane, length_m = storey_slab(storey_named(storeys, options.storey or "0")), None
    made = orthophoto(source.tiles, plane, pixel_m=options.pixel_m, length_m=length_m)
    _raster(made.raster, path, source)
    height, width = made.raster.pixels.shape[:2]
    return CodedText(
        "orthophoto-made", width=width, height=height, pixel_m=options.pixel_m, seen=made.seen
    )


def _write_terrain(source: ProductSource, path: Path, options: ProductOptions) -> str:
    from recon4.products.contours import contours
    from recon4.products.shapes import contour_shapes

    made = terrain(source.tiles, options.surface, cell_m=options.cell_m)
    up_m = up_to_crs(made, source.frame)
    if path.suffix.lower() in DRAWINGS:
        lines = contours(made, interval_m=options.interval_m, up_m=up_m)
        if not lines:
            raise ConfigError(CodedText("contours-none", interval_m=options.interval_m))
        _draw(list(contour_shapes(lines, up_m)), path, source)
        return CodedText("contours-made", count=len(lines), apart_m=options.interval_m)
    _raster(made.raster(up_m), path, source, relief=made)
    seen = float(made.seen.sum()) * options.cell_m**2
    return CodedText(
        "terrain-made",
        width=made.grid.width,
        height=made.grid.height,
        cell_m=options.cell_m,
        seen_m2=seen,
    )


def up_to_crs(made: Terrain, frame: MapFrame) -> float:
    """Heights of the CRS minus those of the map, in the middle of a terrain [m]."""
    if frame.to_crs is None:
        return 0.0
    window = made.grid.window
    middle = [(window.left + window.right) / 2.0, (window.bottom + window.top) / 2.0, 0.0]
    return float(frame.to_crs(np.array([middle]))[0, 2])


def _draw(
    shapes: list[DrawnShape],
    path: Path,
    source: ProductSource,
    *,
    titles: list[DrawnTitle] | None = None,
) -> None:
    from recon4.products.previews import preview_of_shapes, save_preview

    if path.suffix.lower() == ".png":
        save_preview(preview_of_shapes(shapes), path)
        return
    notes = DrawingNotes(frame=source.frame, description=source.description, titles=titles or ())
    with atomic_file(path) as temporary:
        write_drawing(shapes, temporary, notes)
        if source.stamp and path.suffix.lower() == ".dxf":
            stamp_file(temporary, temporary, source.stamp)


def _raster(
    raster: GeoRaster, path: Path, source: ProductSource, *, relief: Terrain | None = None
) -> None:
    from recon4.products.previews import preview_of_pixels, preview_of_terrain, save_preview

    if path.suffix.lower() == ".png":
        image = preview_of_terrain(relief) if relief else preview_of_pixels(raster.pixels)
        save_preview(image, path)
        return
    write_raster(raster, path, frame=source.frame, description=source.description)
    write_world_file(raster, path.with_suffix(".tfw"), frame=source.frame)
