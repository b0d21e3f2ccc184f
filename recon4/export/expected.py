"""How many points an export will have, from a sample of the map."""

from __future__ import annotations

import math
from dataclasses import replace
from itertools import chain

import numpy as np
from numpy.typing import NDArray

from recon4.export.points import OutputCrs, PointSource
from recon4.export.selection import PointSelection
from recon4.export.tuning import EXPECTED
from recon4.mapping.tiles import Tile, TileSet


def expected_points(tiles: TileSet, output: OutputCrs, selection: PointSelection) -> int:
    """About how many points a selection has; exact for all points and for small maps.

    The first points of a tile are an even sample of it. How many points thinning leaves follows
    from a few tiles that are read as a whole.
    """
    source = PointSource.uncounted(tiles, output, selection)
    left_out = tiles.only_strays() if selection.left_out else ()
    parts = [tile for tile in chain(tiles, left_out) if len(tile) and source.may_have(tile)]
    total = sum(map(len, parts))
    if selection.is_whole or not total:
        return total
    all_of = replace(source, selection=replace(selection, thin_m=0.0))
    ratio = min(1.0, EXPECTED.sample / total)
    found = np.array([_found(all_of, tile, math.ceil(ratio * len(tile))) for tile in parts])
    if not selection.thin_m or not found.any():
        return round(found.sum())
    some = _spread(np.flatnonzero(found), total=total)
    thinned = sum(_found(source, parts[k], len(parts[k])) for k in some)
    return max(1, round(found.sum() * thinned / max(1.0, found[some].sum())))


def _found(source: PointSource, tile: Tile, limit: int) -> float:
    """Points of a tile that are wanted, as far as its first points say."""
    count = source.count_of(tile, limit=max(1, limit))
    return count * len(tile) / min(max(1, limit), len(tile))


def _spread(rows: NDArray[np.intp], *, total: int) -> NDArray[np.intp]:
    """Some of the tiles, evenly spread; all of a small map."""
    if total <= EXPECTED.sample or len(rows) <= EXPECTED.tiles:
        return rows
    return rows[np.linspace(0, len(rows) - 1, EXPECTED.tiles).round().astype(int)]
