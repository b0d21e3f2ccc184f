"""Files of a finished 2-D map, as nav2's map_server reads them."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from recon4.settings.slam2d import Grid2dSettings
from recon4.slam2d.occupancy import OccupancyGrid

_FREE, _UNKNOWN, _OCCUPIED = 254, 205, 0
"""Gray values of map_saver."""
_OCCUPIED_THRESHOLD, _FREE_THRESHOLD = 0.65, 0.196
"""Thresholds for these gray values: 205 is a probability of 0.1961, which is neither."""


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
