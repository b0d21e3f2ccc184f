"""Tiles of the map stage as the viewer needs them: a first part of each, ready to color."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from app.viewer.scene import ColorBy, Tile
from recon4.mapping import tiles as mapping

FIELDS = ("xyz", "intensity", "t_ns", "sensor")


def read_tiles(artifact: Path, *, budget: int, began_ns: int) -> tuple[tuple[Tile, ...], int]:
    """Read a first part of each tile, together at most ``budget`` points.

    Args:
        artifact: Folder of the stage ``map``.
        budget: Points in all.
        began_ns: When the recording began [ns].

    Returns:
        The tiles, and how many points the whole map has.

    Raises:
        StoreError: If the map is missing or damaged.
    """
    whole = mapping.TileSet.open(artifact)
    share = min(1.0, budget / max(len(whole), 1))
    return tuple(_tile(tile, int(len(tile) * share), began_ns) for tile in whole), len(whole)


def _tile(tile: mapping.Tile, count: int, began_ns: int) -> Tile:
    known = "intensity_normalized" in tile.fields
    fields = (*FIELDS, "intensity_normalized") if known else FIELDS
    part = tile.read(fields, limit=count)
    origin_m = np.asarray(tile.origin_m, dtype=np.float64)
    columns: dict[ColorBy, NDArray[Any]] = {
        "raw intensity": part["intensity"],
        "height": part["xyz"][:, 2] + np.float32(origin_m[2]),
        "time": ((part["t_ns"] - began_ns) * 1e-9).astype(np.float32),
        "sensor": part["sensor"],
    }
    if known:
        columns["normalized intensity"] = part["intensity_normalized"]
    name = "_".join(str(k) for k in tile.ijk)
    return Tile(name, origin_m, np.ascontiguousarray(part["xyz"]), columns)
