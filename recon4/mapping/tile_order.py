"""In which order the rows of a tile are stored, and where its blocks end."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from recon4.kernels.tile_packing import spatial_rows
from recon4.mapping.tuning import TILES

Rows = NDArray[np.int32]
"""Rows of a block or of a part of a tile, (N,)."""


def progressive(rows: NDArray[np.intp]) -> NDArray[np.intp]:
    """Reorder rows given in spatial order so that every prefix samples all of them evenly.

    Stratum ``s`` has every 64th row from the ``s``-th on. The strata are in bit-reversed order, so
    that halves, quarters and eighths are regular samples too. Within a stratum the order stays
    spatial, which compresses well. `spatial_order` is the inverse.
    """
    return rows[np.concatenate([np.arange(s, len(rows), TILES.strata) for s in _strata().tolist()])]


def spatial_order(count: int) -> NDArray[np.intp]:
    """Rows of a tile of ``count`` points in spatial order, the inverse of `progressive`."""
    inverse = np.empty(count, np.intp)
    inverse[progressive(np.arange(count))] = np.arange(count)
    return inverse


def _strata() -> NDArray[np.int64]:
    """The strata of a tile in their stored order, (S,)."""
    bits = TILES.strata.bit_length() - 1
    return np.array([int(f"{s:0{bits}b}"[::-1], 2) for s in range(TILES.strata)])


def block_ends(count: int) -> list[int]:
    """Where the blocks of a part of a tile end: the first sixteenth, then about equal ones.

    A small sample of many tiles is in the first block of each.
    """
    sample = min(TILES.block, -(-count // TILES.sample))
    many = -(-(count - sample) // TILES.block)
    return [sample + (count - sample) * k // max(many, 1) for k in range(many + 1) if count]


def spatial_order_of(count: int, first: int, stop: int) -> Rows:
    """Rows of a block, counted from its first, in spatial order; arguments as in `places_of`."""
    return _order_of(count, first, stop)[0]


def places_of(count: int, first: int, stop: int) -> Rows:
    """Places of a block's rows in the spatial order of its part of the tile, increasing.

    Args:
        count: Rows of its part of the tile.
        first: First of them in the block.
        stop: The one after its last.
    """
    return _order_of(count, first, stop)[1]


def _order_of(count: int, first: int, stop: int) -> tuple[Rows, Rows]:
    rows, places = np.empty((2, stop - first), np.int32)
    spatial_rows(count, _strata(), first, stop, rows, places)
    return rows, places


def stored_blocks(rows: NDArray[np.intp]) -> Iterator[NDArray[np.intp]]:
    """Rows of a part of a tile, block by block, those of a block in spatial order.

    Args:
        rows: In spatial order, (N,).
    """
    for first, stop in pairwise([0, *block_ends(len(rows))]):
        yield rows[places_of(len(rows), first, stop)]
