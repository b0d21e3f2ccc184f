"""An unbounded plan in square tiles; the tiles around the body form one dense window.

The cost per second does not depend on the path length, and memory follows the area seen.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from recon4.live.preview.tuning import PLAN_TILES

Key = tuple[int, int]
Layers = dict[str, NDArray[Any]]


class Tiles:
    """Layers of one plan; ``window[name]`` is writable and overrides the stored tiles.

    Tiles with unknown cells only are not stored.
    """

    def __init__(self, layers: Mapping[str, tuple[str, float]]) -> None:
        """Create an empty plan.

        Args:
            layers: Name -> data type and value of unknown cells.
        """
        self._layers = layers
        self._kept: dict[Key, Layers] = {}
        self._corner: Key = (-PLAN_TILES.around, -PLAN_TILES.around)
        self.window = self._blank(PLAN_TILES.window)

    @property
    def first_cell(self) -> NDArray[np.int64]:
        """Cell coordinates of the window's corner, (2,)."""
        return np.array(self._corner, dtype=np.int64) * PLAN_TILES.tile

    def contains(self, cell: NDArray[np.int64]) -> bool:
        """Whether the window need not be moved for a body in this cell."""
        return _corner_for(cell) == self._corner

    def move_to(self, cell: NDArray[np.int64]) -> None:
        """Move the window around a cell."""
        if self.contains(cell):
            return
        self.keep()
        self._corner = _corner_for(cell)
        self.window = self._blank(PLAN_TILES.window)
        for key, rows in self.parts():
            for name, values in self._kept.get(key, {}).items():
                self.window[name][rows] = values

    def parts(self) -> Iterator[tuple[Key, tuple[slice, slice]]]:
        """Tiles of the window, each with its rows and columns in it."""
        for i in range(2 * PLAN_TILES.around + 1):
            for j in range(2 * PLAN_TILES.around + 1):
                rows = (
                    slice(i * PLAN_TILES.tile, (i + 1) * PLAN_TILES.tile),
                    slice(j * PLAN_TILES.tile, (j + 1) * PLAN_TILES.tile),
                )
                yield (self._corner[0] + i, self._corner[1] + j), rows

    def keep(self) -> None:
        """Copy the window to the stored tiles."""
        for key, rows in self.parts():
            tile = {name: self.window[name][rows] for name in self._layers}
            known = any((tile[name] != fill).any() for name, (_, fill) in self._layers.items())
            if known:
                self._kept[key] = {name: values.copy() for name, values in tile.items()}

    def whole(self, name: str) -> tuple[NDArray[np.int64], NDArray[Any]]:
        """A layer of the plan near the body: first cell (2,), cells (H, W)."""
        self.keep()
        dtype, fill = self._layers[name]
        body = np.array(self._corner, np.int64) + PLAN_TILES.around
        keys = np.array(list(self._kept), dtype=np.int64).reshape(-1, 2)
        keys = keys[np.abs(keys - body).max(axis=1) <= PLAN_TILES.shown]
        if not len(keys):
            return np.zeros(2, np.int64), np.full((0, 0), fill, dtype)
        first = keys.min(axis=0)
        shape = (keys.max(axis=0) - first + 1) * PLAN_TILES.tile
        cells = np.full(shape, fill, dtype)
        for key in keys:
            i, j = (key - first) * PLAN_TILES.tile
            cells[i : i + PLAN_TILES.tile, j : j + PLAN_TILES.tile] = self._kept[
                int(key[0]), int(key[1])
            ][name]
        return first * PLAN_TILES.tile, cells

    def _blank(self, size: int) -> Layers:
        return {n: np.full((size, size), fill, dtype) for n, (dtype, fill) in self._layers.items()}


def _corner_for(cell: NDArray[np.int64]) -> Key:
    i, j = (np.asarray(cell) // PLAN_TILES.tile - PLAN_TILES.around).tolist()
    return i, j
