"""A map as versions before 2026-11-27 stored it: a ``.npy`` file per field, ranges included."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np

from recon4.mapping.tiles import TileSet


def write_earlier(artifact: Path, out: Path) -> None:
    """The map of an artifact in the earlier layout; its coordinates are rounded already."""
    tiles = TileSet.open(artifact)
    (out / "tiles").mkdir(parents=True)
    parts = [part for tile in tiles for part in (tile, tile.stray_part(tiles.tile_m))]
    for name in tiles.fields:
        np.save(out / "tiles" / name, np.concatenate([part.read([name])[name] for part in parts]))
    facts = json.loads((artifact / "tiles.json").read_text())
    facts |= {"format": 1, "fields": list(tiles.fields)}
    (out / "tiles.json").write_text(json.dumps(facts))
