"""Runs of records that are merged, and tiles that are read ahead."""

from concurrent.futures import ThreadPoolExecutor

import numpy as np
import pytest
from msgspec import structs

from recon4.mapping import finish
from recon4.mapping.buckets import TileBuckets
from recon4.mapping.finish import read_tiles
from recon4.mapping.grid import Grid
from recon4.mapping.records import RECORD, in_voxel_order
from recon4.mapping.tuning import MAP_BUILD
from recon4.mapping.voxel_runs import merged_runs
from recon4.settings import MapSettings

GRID = Grid.of(MapSettings(voxel_m=0.02))


def some_records(rng, count):
    """In 900 voxels: each is in several runs, some at the same range."""
    records = np.zeros(count, RECORD)
    records["xyz"] = rng.uniform(1.0, [1.6, 1.6, 1.02], (count, 3))
    records["to_sensor"] = rng.integers(1, 4, (count, 3))
    records["frame"], records["returns"] = rng.integers(0, 9, count), 1
    return records


@pytest.mark.parametrize("runs", [1, 2, 13, 27])
def test_merged_runs_are_all_records_in_the_order_of_their_voxels(runs, tmp_path):
    rng = np.random.default_rng(runs)
    parts = [in_voxel_order(some_records(rng, int(n)), GRID) for n in rng.integers(1, 400, runs)]
    (tmp_path / "runs").write_bytes(b"".join(part.tobytes() for part in parts))

    found = merged_runs(tmp_path / "runs", [len(part) for part in parts], GRID)

    np.testing.assert_array_equal(found, in_voxel_order(np.concatenate(parts), GRID))


def test_the_next_tile_is_read_while_one_is_used_unless_it_is_large(tmp_path, monkeypatch):
    read = []

    class Watched(TileBuckets):
        def read(self, tile):
            read.append(tile)
            return super().read(tile)

    rng = np.random.default_rng(1)
    tiles = [(k, 0, 0) for k in range(4)]
    buckets = Watched(tmp_path, GRID)
    monkeypatch.setattr(finish, "MAP_BUILD", structs.replace(MAP_BUILD, ahead=500))
    with ThreadPoolExecutor(1) as pool:
        for tile, count in zip(tiles, (100, 300, 900, 200), strict=True):
            buckets.add({tile: some_records(rng, count)}, pool)
            buckets.flush(pool)
        coming = read_tiles(buckets, tiles, pool)
        used = []
        for _ in tiles:
            used.append(next(coming))
            pool.submit(int).result()  # what was asked for before is read
            used.append(tuple(read))

    assert used[1::2] == [tuple(tiles[:2]), tuple(tiles[:2]), tuple(tiles), tuple(tiles)]
    assert [len(records) for records in used[::2]] == [buckets.counts[tile][0] for tile in tiles]
