"""Files of a finished 2-D map, as nav2's map_server reads them."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from recon4.errors import StoreError
from recon4.locales.coded import CodedText
from recon4.slam2d.occupancy import OccupancyGrid
from recon4.slam2d.tuning import Grid2dTuning
from recon4.slam2d.tuning_graph import MAP_FILES_2D
from recon4.untrusted.bounded import read_text_limited


@dataclass(frozen=True, slots=True, eq=False)
class TrinaryMap:
    """A finished 2-D map as it was written."""

    gray: NDArray[np.uint8]
    """Occupied 0, unknown 205, free 254; the first row has the largest y, (Y, X)."""
    cell_m: float
    """Side of a cell [m]."""
    origin_m: tuple[float, float]
    """Lower left corner in the map frame [m]."""

    @property
    def occupied(self) -> NDArray[np.bool_]:
        """Cells with a surface, (Y, X)."""
        return self.gray == MAP_FILES_2D.occupied

    @property
    def free(self) -> NDArray[np.bool_]:
        """Cells that beams crossed, (Y, X)."""
        return self.gray == MAP_FILES_2D.free


def trinary_image(grid: OccupancyGrid, settings: Grid2dTuning) -> NDArray[np.uint8]:
    """Occupied black, free white, unknown gray; the first row has the largest y, (Y, X)."""
    width, height = grid.log_odds.shape
    image = np.full((height, width), MAP_FILES_2D.unknown, np.uint8)
    columns = max(1, MAP_FILES_2D.block_cells // max(height, 1))
    for first in range(0, width, columns):
        probability = grid.probability_of(slice(first, first + columns)).T[::-1]
        part = image[:, first : first + columns]
        part[probability < settings.free_threshold] = MAP_FILES_2D.free
        part[probability > settings.occupied_threshold] = MAP_FILES_2D.occupied
    return image


def overview_of(gray: NDArray[np.uint8]) -> tuple[NDArray[np.uint8], int]:
    """An image of at most `MAP_FILES_2D.overview_cells` a side, with the same lower left corner.

    A cell is occupied if any of those that it joins is, else free if any is.

    Args:
        gray: Image of a map, (Y, X).

    Returns:
        The smaller image, and how many cells it joins along x and along y.
    """
    joined = max(1, -(-max(gray.shape) // MAP_FILES_2D.overview_cells))
    if joined == 1:
        return gray, 1
    rows, columns = (-(-n // joined) for n in gray.shape)
    out = np.full((rows, columns), MAP_FILES_2D.unknown, np.uint8)
    for row in range(rows):  # the last row begins at the lower edge
        last = len(gray) - joined * (rows - 1 - row)
        part = gray[max(last - joined, 0) : last]
        starts = np.arange(0, gray.shape[1], joined)
        occupied = np.logical_or.reduceat((part == MAP_FILES_2D.occupied).any(axis=0), starts)
        free = np.logical_or.reduceat((part == MAP_FILES_2D.free).any(axis=0), starts)
        out[row] = np.where(
            occupied, MAP_FILES_2D.occupied, np.where(free, MAP_FILES_2D.free, MAP_FILES_2D.unknown)
        )
    return out, joined


def write_map(folder: Path, grid: OccupancyGrid, settings: Grid2dTuning) -> TrinaryMap:
    """Write ``map.png`` and ``map.yaml``, and ``overview.png`` and ``overview.yaml`` for pages.

    Args:
        folder: Where to write.
        grid: The finished grid.
        settings: Thresholds.

    Returns:
        The map as it was written.
    """
    gray = trinary_image(grid, settings)
    made = TrinaryMap(gray, grid.cell_m, (float(grid.origin[0]), float(grid.origin[1])))
    small, joined = overview_of(gray)
    _write(folder, "map", made)
    _write(folder, "overview", TrinaryMap(small, joined * made.cell_m, made.origin_m))
    return made


def _write(folder: Path, name: str, made: TrinaryMap) -> None:
    from PIL import Image

    Image.fromarray(made.gray, mode="L").save(folder / f"{name}.png")
    text = (
        f"image: {name}.png\n"
        "mode: trinary\n"
        f"resolution: {made.cell_m:.6g}\n"
        f"origin: [{made.origin_m[0]:.6f}, {made.origin_m[1]:.6f}, 0]\n"
        "negate: 0\n"
        f"occupied_thresh: {MAP_FILES_2D.occupied_threshold}\n"
        f"free_thresh: {MAP_FILES_2D.free_threshold}\n"
    )
    (folder / f"{name}.yaml").write_text(text, "ascii")


def read_overview(folder: Path) -> TrinaryMap:
    """Read what pages show of a map; of an earlier version the map itself.

    Raises:
        StoreError: If the files are missing, damaged or larger than any map.
    """
    return _read(folder, overview_name(folder))


def overview_name(folder: Path) -> str:
    """Name of the image that pages show, without its ending."""
    return "overview" if (folder / "overview.png").is_file() else "map"


def _read(folder: Path, name: str) -> TrinaryMap:
    from PIL import Image

    text = read_text_limited(
        folder / f"{name}.yaml", MAP_FILES_2D.max_yaml_bytes, failure=StoreError
    )
    lines = (line.partition(": ") for line in text.splitlines())
    facts = {name: value for name, _, value in lines}
    try:
        x, y = facts["origin"].strip("[]").split(",")[:2]
        cell_m, origin_m = float(facts["resolution"]), (float(x), float(y))
        with Image.open(folder / f"{name}.png", formats=["PNG"]) as image:
            if image.mode != "L" or image.width * image.height > MAP_FILES_2D.max_pixels:
                raise ValueError(f"an image of {image.width} x {image.height}, {image.mode}")
            gray = np.asarray(image)
    except (KeyError, ValueError, OSError, SyntaxError, Image.DecompressionBombError) as error:
        raise StoreError(
            CodedText("map-2d-unreadable", folder=folder.name, why=str(error))
        ) from error
    return TrinaryMap(gray, cell_m, origin_m)
