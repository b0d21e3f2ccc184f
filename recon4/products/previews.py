"""Previews of products, to be looked at before they are downloaded."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from PIL import Image, ImageDraw

from recon4.geometry.se3 import Array
from recon4.products.drawing import DrawnShape
from recon4.products.terrain import Terrain
from recon4.products.tuning import PREVIEWS
from recon4.store.atomic import atomic_file

_COLORS = {
    "WALLS_FILL": "#9a9a9a",
    "WALLS": "#111111",
    "COLUMNS": "#b00020",
    "DOORS": "#1b7f3b",
    "WINDOWS": "#1f5fd0",
    "WALLS_HIDDEN": "#c4a000",
    "FURNITURE": "#8d99a6",
}
"""Of the parts of a plan, on white paper."""


def preview_of_shapes(shapes: Sequence[DrawnShape]) -> Image.Image:
    """A drawing of a plan, at most `PREVIEWS.side_px` wide and high."""
    every = np.concatenate([shape.p_map[:, :2] for shape in shapes])
    low, high = every.min(axis=0), every.max(axis=0)
    margin = PREVIEWS.margin_px
    scale = (PREVIEWS.side_px - 2 * margin) / max(float((high - low).max()), 1.0)
    size = np.ceil((high - low) * scale).astype(int) + 2 * margin
    image = Image.new("RGB", (int(size[0]), int(size[1])), "white")
    draw = ImageDraw.Draw(image)

    def pixels(p: Array) -> list[tuple[float, float]]:
        x = margin + (p[:, 0] - low[0]) * scale
        y = size[1] - margin - (p[:, 1] - low[1]) * scale
        return list(zip(x.tolist(), y.tolist(), strict=True))

    for shape in shapes:
        color = _COLORS[shape.layer.name.split("_", 1)[1]]
        if shape.layer.hatched:
            draw.polygon(pixels(shape.p_map), fill=color)
            for hole in shape.holes:
                draw.polygon(pixels(hole), fill="white")
        else:
            line = pixels(shape.p_map)
            draw.line([*line, line[0]] if shape.closed else line, fill=color, width=2)
    return image


def preview_of_pixels(pixels: NDArray[np.uint8]) -> Image.Image:
    """A gray image with transparency, thinned to `PREVIEWS.side_px`."""
    step = -(-max(pixels.shape[:2]) // PREVIEWS.side_px)
    return Image.fromarray(np.ascontiguousarray(pixels[::step, ::step]))


def preview_of_terrain(terrain: Terrain) -> Image.Image:
    """Heights from dark to light, with the shade of a light from the north-west."""
    step = -(-max(terrain.height_m.shape) // PREVIEWS.side_px)
    z = terrain.height_m[::step, ::step].astype(np.float64)
    seen = np.isfinite(z)
    low, high = np.percentile(z[seen], [2.0, 98.0]) if seen.any() else (0.0, 1.0)
    down, right = np.gradient(z, terrain.grid.pixel_m * step)
    shade = np.clip(0.5 + 0.5 * (down - right), 0.0, 1.0)
    level = np.clip((z - low) / max(high - low, 1e-6), 0.0, 1.0)
    gray = 255.0 * np.nan_to_num(0.6 * level + 0.4 * np.where(np.isfinite(shade), shade, 0.5))
    return Image.fromarray(np.dstack([gray, 255 * seen]).astype(np.uint8))


def save_preview(image: Image.Image, path: Path) -> None:
    """Write an image as PNG.

    Raises:
        StoreError: If the file cannot be written.
    """
    with atomic_file(path) as temporary:
        image.save(temporary, format="PNG")
