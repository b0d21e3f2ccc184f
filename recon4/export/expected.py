"""How many points an export will have, from a sample of the map."""

from __future__ import annotations

from itertools import chain

import numpy as np

from recon4.export.points import OutputCrs, PointSource
from recon4.export.selection import PointSelection
from recon4.export.tuning import EXPECTED
from recon4.geometry.se3 import Array
from recon4.mapping.tiles import Tile, TileSet


def expected_points(tiles: TileSet, output: OutputCrs, selection: PointSelection) -> int:
    """About how many points a selection has; exact for all points and for small maps.

    The first points of a tile are an even sample of it.
    """
    source = PointSource.uncounted(tiles, output, selection)
    left_out = tiles.only_strays() if selection.left_out else ()
    parts = [tile for tile in chain(tiles, left_out) if len(tile) and source.may_have(tile)]
    sizes = np.array([len(tile) for tile in parts], np.int64)
    total = int(sizes.sum())
    if selection.is_whole or not total:
        return total
    looked_at = np.ceil(min(1.0, EXPECTED.sample / total) * sizes).astype(np.int64)
    limits = zip(parts, looked_at.tolist(), strict=True)
    found = np.array([source.count_of(tile, limit=limit) for tile, limit in limits], np.float64)
    if not selection.thin_m or total <= EXPECTED.sample:
        return round(float((found * sizes / looked_at).sum()))
    rows = np.flatnonzero(found)
    return _thinned(source, [parts[row] for row in rows], found[rows]) if len(rows) else 0


def _thinned(source: PointSource, parts: list[Tile], found: Array) -> int:
    """About how many points thinning leaves, from what it leaves of the first points of tiles.

    Some tiles are read as a whole. How many times as many points these have left applies to tiles
    in which the points lie as close together.

    Args:
        source: The map.
        parts: Tiles with points.
        found: Points of each that are left of its sample, above 0, (N,).
    """
    count = min(EXPECTED.tiles, len(parts))
    some = ((np.arange(count) + 0.5) / count * len(parts)).astype(int)
    whole = [source.count_of(parts[row], limit=len(parts[row])) for row in some]
    left = found / [len(tile) for tile in parts]
    order = np.argsort(left[some])
    known = np.log(whole / found[some])[order]
    times = np.exp(np.interp(np.log(left), np.log(left[some])[order], known))
    return max(1, round(float((found * times).sum())))
