"""A plan without end, kept in square tiles; those around the body are one dense window.

What is done every second costs the same however far the walk has gone, and memory follows the area
that was seen.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

TILE = 64
"""Cells along a side."""
_AROUND = 2
"""Tiles of the window on each side of the one the body is in."""
WINDOW = TILE * (2 * _AROUND + 1)
MARGIN = TILE * _AROUND
"""The body is at least so many cells away from the window's border."""

Key = tuple[int, int]
Layers = dict[str, NDArray[Any]]


class Tiles:
    """Layers of one plan; ``window[name]`` may be written to, and is the truth while it is there.

    Tiles nothing was ever written to are not kept.
    """

    def __init__(self, layers: Mapping[str, tuple[str, float]]) -> None:
        """Make an empty plan.

        Args:
            layers: Name to type and value of what is not known.
        """
        self._layers = layers
        self._kept: dict[Key, Layers] = {}
        self._corner: Key = (-_AROUND, -_AROUND)
        self.window = self._blank(WINDOW)

    @property
    def first_cell(self) -> NDArray[np.int64]:
        """Cell of the window's corner, counted from the origin, (2,)."""
        return np.array(self._corner, dtype=np.int64) * TILE

    def holds(self, cell: NDArray[np.int64]) -> bool:
        """Whether the body may be in a cell without the window being moved."""
        return _corner_for(cell) == self._corner

    def move_to(self, cell: NDArray[np.int64]) -> None:
        """Put the window around a cell."""
        if self.holds(cell):
            return
        self.keep()
        self._corner = _corner_for(cell)
        self.window = self._blank(WINDOW)
        for key, rows in self.parts():
            for name, values in self._kept.get(key, {}).items():
                self.window[name][rows] = values

    def parts(self) -> Iterator[tuple[Key, tuple[slice, slice]]]:
        """Tiles of the window, each with its rows and columns there."""
        for i in range(2 * _AROUND + 1):
            for j in range(2 * _AROUND + 1):
                rows = slice(i * TILE, (i + 1) * TILE), slice(j * TILE, (j + 1) * TILE)
                yield (self._corner[0] + i, self._corner[1] + j), rows

    def keep(self) -> None:
        """Copy the window to its tiles."""
        for key, rows in self.parts():
            tile = {name: self.window[name][rows] for name in self._layers}
            known = any((tile[name] != fill).any() for name, (_, fill) in self._layers.items())
            if known:
                self._kept[key] = {name: values.copy() for name, values in tile.items()}

    def whole(self, name: str) -> tuple[NDArray[np.int64], NDArray[Any]]:
        """A layer of everything that is known: its first cell (2,) and its cells (H, W)."""
        self.keep()
        dtype, fill = self._layers[name]
        if not self._kept:
            return np.zeros(2, np.int64), np.full((0, 0), fill, dtype)
        keys = np.array(list(self._kept), dtype=np.int64)
        first = keys.min(axis=0)
        shape = (keys.max(axis=0) - first + 1) * TILE
        cells = np.full(shape, fill, dtype)
        for key, tile in self._kept.items():
            i, j = (np.array(key) - first) * TILE
            cells[i : i + TILE, j : j + TILE] = tile[name]
        return first * TILE, cells

    def _blank(self, size: int) -> Layers:
        return {n: np.full((size, size), fill, dtype) for n, (dtype, fill) in self._layers.items()}


def _corner_for(cell: NDArray[np.int64]) -> Key:
    i, j = (np.asarray(cell) // TILE - _AROUND).tolist()
    return i, j
