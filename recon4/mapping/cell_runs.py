"""Sums of the returns in cells: a table in memory, and sorted runs of it on disk.

Memory does not grow with the walk. Sums are whole numbers: they are the same in whatever order and
in however many runs the returns were counted.
"""

from __future__ import annotations

from collections.abc import Iterator
from itertools import pairwise
from pathlib import Path
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from recon4.kernels.cell_table import KEY, OFFSET, CellSums, add_returns
from recon4.mapping.structure_tuning import GROUND, RUNS, STRUCTURE
from recon4.mapping.undistort import Placed


class MergedCells(NamedTuple):
    """Some of the cells, whole: no others have keys between theirs."""

    key: NDArray[np.int64]
    """Ascending, (C,)."""
    total: NDArray[np.int64]
    """As `CellSums.total`, (C, 6)."""


class CellRuns:
    """Counts returns in cells. A full table becomes a run in the folder, in the order of keys."""

    def __init__(self, folder: Path, *, places: int = RUNS.places) -> None:
        """There are no returns yet.

        Args:
            folder: For the runs; they stay until the folder is removed.
            places: Of the table, a power of two.
        """
        self._folder, self._sums = folder, _empty_sums(places)
        self._used, self._returns, self._rows = 0, 0, list[int]()

    def add(self, placed: Placed, chosen: NDArray[np.bool_], echo: NDArray[np.uint8]) -> None:
        """Count some of the returns of a multiframe.

        Args:
            placed: They and their sensors.
            chosen: Which of them are counted, (N,).
            echo: Number of the echo of its beam, (N,).

        Raises:
            OSError: If a run cannot be written.
        """
        room = int(RUNS.filled * len(self._sums.key))
        cell_m = GROUND.cell_m, GROUND.height_m
        for start in range(0, len(echo), room // 2):
            part = slice(start, start + room // 2)
            count = len(echo[part])
            if self._used + count > room or self._returns + count > RUNS.returns:
                self.flush()
            xyz, origin = placed.xyz_m[part], placed.origin_m[part]
            counted = chosen[part], echo[part]
            self._used = add_returns(
                xyz, origin, *counted, cell_m, STRUCTURE.range_m, self._sums, self._used
            )
            self._returns += count

    def merged(self, *, least: int, most: int) -> Iterator[MergedCells]:
        """The cells of all runs, in the order of their keys, some at a time.

        Args:
            least: Returns of a cell that counts.
            most: Cells that are kept: those of the first runs. Those of the first one are kept
                however many they are.

        Raises:
            OSError: If a run cannot be written or read.
        """
        self.flush()
        last = self._last_run(least, most) if sum(self._rows) > most else len(self._rows)
        for cells, first in self._slabs(least):
            kept = first <= last
            if kept.any():
                yield MergedCells(cells.key[kept], cells.total[kept])

    def _last_run(self, least: int, most: int) -> int:
        """The last run whose new cells are kept."""
        new = np.zeros(len(self._rows), np.int64)
        for _, first in self._slabs(least):
            new += np.bincount(first, minlength=len(new))
        return max(0, int(np.searchsorted(np.cumsum(new), most, side="right")) - 1)

    def _slabs(self, least: int) -> Iterator[tuple[MergedCells, NDArray[np.intp]]]:
        """Cells that count, and the run in which each is first."""
        runs = [self._run(number) for number in range(len(self._rows))]
        for low, high in _cuts([run.key for run in runs]):
            ends = [np.searchsorted(run.key, (low, high)) for run in runs]
            key = np.concatenate([run.key[a:b] for run, (a, b) in zip(runs, ends, strict=True)])
            total = np.concatenate([run.total[a:b] for run, (a, b) in zip(runs, ends, strict=True)])
            run_of = np.repeat(np.arange(len(runs)), [b - a for a, b in ends])
            order = np.argsort(key, kind="stable")  # the first run of a cell comes first
            starts = np.flatnonzero(np.diff(key[order], prepend=-1))
            sums = np.add.reduceat(total[order], starts, axis=0, dtype=np.int64)
            kept = sums[:, 0] >= least
            rows = order[starts[kept]]
            yield MergedCells(key[rows], sums[kept]), run_of[rows]

    @property
    def rows(self) -> list[int]:
        """Cells of each run in the folder."""
        return self._rows

    def take(self, rows: list[int]) -> None:
        """Go on with the runs of an earlier process, by its `rows`."""
        self._rows = rows

    def flush(self) -> None:
        """Write the table as a run, if it has returns.

        Raises:
            OSError: If it cannot be written.
        """
        if not self._used:
            return
        rows = np.flatnonzero(self._sums.key >= 0)
        rows = rows[np.argsort(self._sums.key[rows])]
        key, total = self._files(len(self._rows))
        np.save(key, self._sums.key[rows])
        np.save(total, self._sums.total[rows])
        self._rows.append(len(rows))
        self._sums.key[:], self._sums.total[:] = -1, 0
        self._used = self._returns = 0

    def _run(self, number: int) -> CellSums:
        key, total = (np.load(path, mmap_mode="r") for path in self._files(number))
        return CellSums(key, total)

    def _files(self, number: int) -> tuple[Path, Path]:
        return self._folder / f"cells-{number}.npy", self._folder / f"cell-sums-{number}.npy"


def coordinate_sums(cells: MergedCells) -> NDArray[np.float64]:
    """Sums of the coordinates of the returns of cells [m], (C, 3); divide them by their number."""
    edge = np.array([GROUND.cell_m, GROUND.cell_m, GROUND.height_m])
    offsets = cells.total[:, 1:4] + 0.5 * cells.total[:, :1]  # what was cut off, on average
    return (cell_numbers(cells.key) * cells.total[:, :1] + offsets / OFFSET.steps) * edge


def cell_numbers(key: NDArray[np.int64]) -> NDArray[np.int64]:
    """Numbers of cells by their keys, (C, 3)."""
    mask = (1 << KEY.each) - 1
    parts = [(key >> shift) & mask for shift in (2 * KEY.each, KEY.each, 0)]
    return np.stack(parts, axis=1) - KEY.zero


def cell_keys(numbers: NDArray[np.int64]) -> NDArray[np.int64]:
    """Keys of cells by their numbers (C, 3)."""
    i, j, k = (numbers + KEY.zero).T
    return np.asarray((i << (2 * KEY.each)) | (j << KEY.each) | k)


def _cuts(keys: list[NDArray[np.int64]]) -> Iterator[tuple[int, int]]:
    """Ranges of keys with about `RUNS.slab` rows of all runs; none cuts a cube."""
    columns = [np.unique(key >> 2 * KEY.each, return_counts=True) for key in keys]
    if not columns:
        return
    first = min(int(number[0]) for number, _ in columns)
    count = np.zeros(max(int(number[-1]) for number, _ in columns) - first + 1, np.int64)
    for number, rows in columns:
        count[number - first] += rows
    slab = np.cumsum(count) // RUNS.slab
    starts = [*np.flatnonzero(np.diff(slab, prepend=-1)), len(count)]
    for low, high in pairwise(starts):
        yield (first + int(low)) << 2 * KEY.each, (first + int(high)) << 2 * KEY.each


def _empty_sums(places: int) -> CellSums:
    return CellSums(np.full(places, -1, np.int64), np.zeros((places, 6), np.uint32))
