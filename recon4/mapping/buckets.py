"""Buckets: the records of each tile, collected on disk, thinned before each write."""

from __future__ import annotations

from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import numpy as np

from recon4.mapping.grid import Grid
from recon4.mapping.records import RECORD, Records, Tile, in_voxel_order, joined
from recon4.mapping.tuning import BUCKETS
from recon4.mapping.voxel_runs import merged_runs


class TileBuckets:
    """Writes one file per tile into a folder; holds at most `BUCKETS.burst` records in memory."""

    def __init__(self, folder: Path, grid: Grid, *, burst: int = BUCKETS.burst) -> None:
        self._folder = folder
        self._grid = grid
        self._burst = burst
        self._pending: dict[Tile, list[Records]] = {}
        self._held = 0
        self._counts: dict[Tile, list[int]] = {}

    @property
    def folder(self) -> Path:
        """Where they are."""
        return self._folder

    def add(self, parts: dict[Tile, Records], pool: ThreadPoolExecutor) -> None:
        """Add the records of a multiframe; write all when `BUCKETS.burst` is reached."""
        for tile, records in parts.items():
            self._pending.setdefault(tile, []).append(records)
            self._held += len(records)
        if self._held >= self._burst:
            self.flush(pool)

    def flush(self, pool: ThreadPoolExecutor) -> None:
        """Thin and write the records held in memory."""
        pending, self._pending, self._held = self._pending, {}, 0
        tiles = list(pending)
        # Taken out one by one, so that what is thinned does not stand beside what it was.
        thinned = pool.map(lambda tile: self._thinned(pending.pop(tile)), tiles)
        for tile, records in zip(tiles, thinned, strict=True):
            self._counts.setdefault(tile, []).append(len(records))
            with self._path(tile).open("ab") as file:
                file.write(records.data)

    def tiles(self) -> list[Tile]:
        """The tiles that have points, in a fixed order."""
        return sorted(self._counts)

    def read(self, tile: Tile) -> Records:
        """All records of a tile in the order of their voxels, thinned.

        Memory depends on the thinned tile, not on all its points.
        """
        path, counts = self._path(tile), self._counts[tile]
        if self._grid.thin:
            return merged_runs(path, counts, self._grid)
        return in_voxel_order(np.fromfile(path, RECORD), self._grid)

    def drop(self, tile: Tile) -> None:
        """Remove the file of a finished tile; an earlier process may have done so."""
        self._path(tile).unlink(missing_ok=True)

    @property
    def counts(self) -> dict[Tile, list[int]]:
        """Records of each run that was written, by tile."""
        return self._counts

    def take(self, counts: dict[Tile, list[int]]) -> None:
        """Go on with the files of an earlier process, by its `counts`."""
        self._counts = counts

    def _thinned(self, parts: list[Records]) -> Records:
        records = _taken(parts)
        return in_voxel_order(records, self._grid) if self._grid.thin else records

    def _path(self, tile: Tile) -> Path:
        return self._folder / "{}_{}_{}".format(*tile)


def _taken(parts: list[Records]) -> Records:
    """All records of some parts; the list is empty then, which frees them."""
    records = parts[0] if len(parts) == 1 else joined(parts)
    parts.clear()
    return records
