"""Files of a finished 2-D map, as nav2's map_server reads them."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from recon4.bounded import read_text_limited
from recon4.errors import StoreError
from recon4.settings.slam2d import Grid2dSettings
from recon4.slam2d.occupancy import OccupancyGrid

_FREE, _UNKNOWN, _OCCUPIED = 254, 205, 0
"""Gray values of map_saver."""
_OCCUPIED_THRESHOLD, _FREE_THRESHOLD = 0.65, 0.196
"""Thresholds for these gray values: 205 is a probability of 0.1961, which is neither."""


_MAX_YAML_BYTES = 4096
_MAX_PIXELS = 1 << 28


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
        return self.gray == _OCCUPIED

    @property
    def free(self) -> NDArray[np.bool_]:
        """Cells that beams crossed, (Y, X)."""
        return self.gray == _FREE


def trinary_image(grid: OccupancyGrid, settings: Grid2dSettings) -> NDArray[np.uint8]:
    """Occupied black, free white, unknown gray; the first row has the largest y, (Y, X)."""
    probability = grid.probability
    image = np.full(probability.shape, _UNKNOWN, np.uint8)
    image[probability < settings.free_threshold] = _FREE
    image[probability > settings.occupied_threshold] = _OCCUPIED
    return np.ascontiguousarray(np.flipud(image.T))


def write_map(folder: Path, grid: OccupancyGrid, settings: Grid2dSettings) -> None:
    """Write ``map.png`` and ``map.yaml``.

    Args:
        folder: Where to write.
        grid: The finished grid.
        settings: Thresholds.
    """
    from PIL import Image

    Image.fromarray(trinary_image(grid, settings), mode="L").save(folder / "map.png")
    text = (
        "image: map.png\n"
        "mode: trinary\n"
        f"resolution: {grid.cell_m:.6g}\n"
        f"origin: [{grid.origin[0]:.6f}, {grid.origin[1]:.6f}, 0]\n"
        "negate: 0\n"
        f"occupied_thresh: {_OCCUPIED_THRESHOLD}\n"
        f"free_thresh: {_FREE_THRESHOLD}\n"
    )
    (folder / "map.yaml").write_text(text, "ascii")


def read_map(folder: Path) -> TrinaryMap:
    """Read the files of `write_map`.

    Raises:
        StoreError: If they are missing, damaged or larger than any map.
    """
    from PIL import Image

    text = read_text_limited(folder / "map.yaml", _MAX_YAML_BYTES, failure=StoreError)
    facts = dict(line.partition(": ")[::2] for line in text.splitlines())
    try:
        x, y = facts["origin"].strip("[]").split(",")[:2]
        cell_m, origin_m = float(facts["resolution"]), (float(x), float(y))
        with Image.open(folder / "map.png", formats=["PNG"]) as image:
            if image.mode != "L" or image.width * image.height > _MAX_PIXELS:
                raise ValueError(f"an image of {image.width} x {image.height}, {image.mode}")
            gray = np.asarray(image)
    except (KeyError, ValueError, OSError, SyntaxError) as error:
        raise StoreError(f"{folder.name}: the 2-D map cannot be read: {error}") from error
    return TrinaryMap(gray, cell_m, origin_m)
