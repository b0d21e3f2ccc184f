"""A map of a billion points: copies of the tiles of a real one, side by side.

``python -m tests.benchmarks.billion_points OUT PROJECT [POINTS]``: OUT is a finished project, for
`tests.benchmarks.map_page`; PROJECT has the map to copy. Needs some 14 bytes a point on disk.
"""

from __future__ import annotations

import json
import sys
from pathlib import Path
from typing import Any

import numpy as np

from recon4.first_view.files import FIRST_FILES, write_first_files
from recon4.mapping.columns import BLOCKS, PATHS, index_dtype
from recon4.mapping.tiles import TileSet
from recon4.slices.map_crs import LOCAL
from recon4.store.arrays import load_array
from recon4.store.project import read_artifacts
from recon4.store.stage import Input, StageContext
from tests.benchmarks.large_map import build_with_map
from tests.project_builder import loop_walk

BETWEEN_M = 5.0
"""Width of what is between copies, at least; they begin at whole tiles."""


def build(root: Path, source: Path, *, points: int) -> None:
    """Make a finished project in an empty folder."""
    folder = read_artifacts(source)["map"]
    build_with_map(root, _map, what=Input(f"{folder} {points}", (folder, points)))


def _map(context: StageContext, *, what: tuple[Path, int]) -> None:
    source, points = what
    facts = json.loads((source / "tiles.json").read_text())
    copies = -(-points // facts["points"])
    tiles = context.out / "tiles"
    tiles.mkdir()
    (tiles / PATHS).write_bytes((source / "tiles" / PATHS).read_bytes())
    for name in facts["fields"]:
        data = (source / "tiles" / f"{name}.zst").read_bytes()
        with (tiles / f"{name}.zst").open("wb") as file:
            for _ in range(copies):
                file.write(data)
    blocks = load_array(source / "tiles" / BLOCKS, index_dtype(facts["fields"]))
    np.save(tiles / BLOCKS, _repeated(blocks, copies))
    (context.out / "tiles.json").write_text(json.dumps(_spread(facts, copies)))
    tiles, walk_m = TileSet.open(context.out), loop_walk().T_a_b.t
    write_first_files(context.out / FIRST_FILES, tiles, LOCAL, walk_m=walk_m)


def _repeated(blocks: np.ndarray, copies: int) -> np.ndarray:
    """The index of blocks that follow each other several times."""
    every = np.tile(blocks, copies)
    number = np.repeat(np.arange(copies), len(blocks))
    every["stop"] += number * blocks["stop"][-1]
    every["end"] += number[:, None] * blocks["end"][-1]
    return every


def _spread(facts: dict[str, Any], copies: int) -> dict[str, Any]:
    """The list of tiles of a map in several places of a square grid."""
    low, high = (np.array(one) for one in facts["bounds_m"])
    steps = np.ceil((high - low + BETWEEN_M) / facts["tile_m"]).astype(int)
    last = facts["tiles"][-1]
    rows = last["stop"] + last.get("strays", 0)
    wide = int(np.ceil(np.sqrt(copies * steps[1] / steps[0])))
    tiles = []
    for k in range(copies):
        away = np.array([k % wide * steps[0], k // wide * steps[1], 0])
        shift = away * facts["tile_m"]
        for tile in facts["tiles"]:
            moved = {
                name: (shift + tile[name]).tolist() for name in ("origin_m", "low_m", "high_m")
            }
            begins = {name: tile[name] + k * rows for name in ("start", "stop")}
            tiles.append(tile | moved | begins | {"ijk": (away + tile["ijk"]).tolist()})
    counts = {name: copies * count for name, count in facts["classes"].items()}
    bounds = [
        np.min([tile["low_m"] for tile in tiles], axis=0).tolist(),
        np.max([tile["high_m"] for tile in tiles], axis=0).tolist(),
    ]
    points = copies * facts["points"]
    return facts | {"points": points, "bounds_m": bounds, "tiles": tiles, "classes": counts}


if __name__ == "__main__":
    build(Path(sys.argv[1]), Path(sys.argv[2]), points=int(float((sys.argv[3:] or ["1e9"])[0])))
