"""Small maps made by arithmetic and written by the real writer."""

from pathlib import Path

import numpy as np

from recon4.mapping.map_notes import MapNotes
from recon4.mapping.tile import FIELDS, STORED
from recon4.mapping.tile_writer import TileWriter
from recon4.mapping.tiles import TileSet

TILE_M = 5.0
T0_NS = 1_700_000_000_000_000_000


def write_map(out: Path, p_map, *, crs=None, strays=0, **columns) -> TileSet:
    """A map of the given points [m], (N, 3); the last of each tile are stray returns."""
    out.mkdir(parents=True, exist_ok=True)
    n = len(p_map)
    given = {"t_ns": np.full(n, T0_NS, np.int64), **columns}
    with TileWriter(out, STORED, tile_m=TILE_M) as writer:
        writer.notes = MapNotes(voxel_m=0.01, crs=crs, sensors=("V1", "V2"))
        ijk = np.floor(p_map / TILE_M).astype(np.int64)
        for key in np.unique(ijk, axis=0):
            mine = np.all(ijk == key, axis=1)
            tile = {
                name: np.zeros((mine.sum(), width) if width > 1 else mine.sum(), dtype)
                for name, (dtype, width) in FIELDS.items()
            }
            tile["xyz"] = (p_map[mine] - key * TILE_M).astype(np.float32)
            tile |= {name: np.asarray(values)[mine] for name, values in given.items()}
            writer.append(tuple(key.tolist()), tile, strays=strays)
    return TileSet.open(out)


def wall(rng, count, *, x_m=0.0, sigma_m=0.01, size_m=(4.0, 2.0)):
    """Points on a wall across x, seen from the positive side, with its normals."""
    p = np.column_stack(
        [
            x_m + sigma_m * rng.standard_normal(count),
            rng.uniform(0.0, size_m[0], count),
            rng.uniform(0.0, size_m[1], count),
        ]
    )
    return p, np.tile([1.0, 0.0, 0.0], (count, 1))
