"""A map whose points somebody moved, with files that fit each other."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from recon4.mapping.columns import BLOCKS, PackedColumns
from recon4.mapping.tile_packing import pack
from recon4.mapping.tiles import TileSet

CHANGED = ("tiles/xyz.zst", f"tiles/{BLOCKS}")
"""Files that `move_points` changes."""


def move_points(artifact: Path, by_m: float = 0.1) -> None:
    """Move the points of the first block of a map to the east."""
    columns = TileSet.open(artifact).columns
    assert isinstance(columns, PackedColumns)
    index, column = columns.index.copy(), columns.fields.index("xyz")
    before, rows = int(index["end"][0, column]), slice(0, int(index["stop"][0]), 1)
    xyz = columns.read(["xyz"], rows)["xyz"] + np.array([by_m, 0.0, 0.0], np.float32)
    data, index["width"][0, column], _ = pack("xyz", xyz[columns.order(0)])
    path = artifact / "tiles" / "xyz.zst"
    path.write_bytes(data + path.read_bytes()[before:])
    index["end"][:, column] += len(data) - before
    np.save(artifact / "tiles" / BLOCKS, index)
