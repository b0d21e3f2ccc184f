"""Surfaces of a tile: planes fitted to all returns around a point; the point moves onto them."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from functools import partial

import numpy as np
from numpy.typing import NDArray

from recon4.kernels import surface_cells
from recon4.kernels.surface_records import SURFACE
from recon4.mapping.grid import Grid
from recon4.mapping.records import RECORD, Records, Views, chosen_records, gathered
from recon4.mapping.surface_fit import FittedSurfaces, Noise, fit_rows
from recon4.mapping.threads import in_turn
from recon4.mapping.tile_memory import Scratch, TileMeans
from recon4.mapping.tuning import MAP_BUILD, TILE_SURFACES


def fit_surfaces(
    records: Records,
    grid: Grid,
    *,
    noise_m: float,
    stands: NDArray[np.bool_] | None = None,
    means: TileMeans | None = None,
) -> FittedSurfaces:
    """Fit the surfaces of a tile, some rows of cells at a time.

    Only the records that are fitted at once are copied, not the tile.

    Args:
        records: In the order of their voxels, with the halo, (N,).
        grid: The grid.
        noise_m: Standard deviation of a range [m].
        stands: Records that surfaces are fitted to; the others have none, (N,). None = all.
        means: Memory in which they are computed, and threads.
    """
    n, means = len(records), means or TileMeans()
    stands = np.ones(n, np.bool_) if stands is None else stands
    found = FittedSurfaces(
        np.empty((n, 3), np.float32),
        np.empty(n, np.int32),
        np.empty((0, SURFACE), np.float32),
        np.empty(n, np.bool_),
        np.empty(n, np.int32),
    )
    surfaces = [found.clear()]
    slabs, tile = list(_slabs(records, grid, stands)), _Tile(records, stands, grid)
    fit = partial(
        _fit_slab,
        tile=tile,
        noise=Noise(noise_m, noise_m),
        scratch=means.scratch or Scratch(),
        found=found,
    )
    count, most = len(surfaces[0]), max(map(tile.size, slabs))
    each = means.each if most * MAP_BUILD.workers <= TILE_SURFACES.together else in_turn
    for slab, made in zip(slabs, each(fit, slabs), strict=True):
        for run in slab.runs:
            found.surface_of[run.own][stands[run.own]] += count
        surfaces.append(made)
        count += len(made)
    return replace(found, surfaces=np.concatenate(surfaces))


@dataclass(frozen=True, slots=True)
class _Tile:
    """A tile, and which of its records surfaces are fitted to."""

    records: Records
    stands: NDArray[np.bool_]
    grid: Grid

    def count(self, rows: slice) -> int:
        """How many of some rows surfaces are fitted to."""
        return int(np.count_nonzero(self.stands[rows]))

    def size(self, slab: _Slab) -> int:
        """How many records of a slab surfaces are fitted to."""
        return sum(self.count(run.every) for run in slab.runs)

    def gathered(self, slab: _Slab, scratch: Scratch) -> Records:
        """The records of a slab that surfaces are fitted to."""
        parts = (
            chosen_records(self.records[run.every], self.stands[run.every]) for run in slab.runs
        )
        if len(slab.runs) == 1:
            return next(parts)
        return gathered(parts, scratch.array("slab", (self.size(slab),), RECORD))


def _fit_slab(
    slab: _Slab, *, tile: _Tile, noise: Noise, scratch: Scratch, found: FittedSurfaces
) -> NDArray[np.float32]:
    """Fit a slab; its surfaces, (K, 6), whose rows in ``found`` are counted from 0."""
    records = tile.gathered(slab, scratch)
    fitted = fit_rows(records, tile.grid, slab.rows, noise=noise, array=scratch.array)
    begin = 0
    for run in slab.runs:
        margin = tile.count(slice(run.every.start, run.own.start))
        fitted.copy(begin + margin, found, run.own, among=tile.stands)
        begin += tile.count(run.every)
    return fitted.surfaces.copy()


@dataclass(frozen=True, slots=True)
class _Run:
    """Records of a tile that lie one after the other."""

    every: slice
    own: slice
    """Without those of the margins of a slab."""


@dataclass(frozen=True, slots=True)
class _Slab:
    """What is fitted at once."""

    rows: tuple[int, int]
    """First row of cells along y, margins included, and the first beyond."""
    runs: list[_Run]


def _slabs(records: Records, grid: Grid, stands: NDArray[np.bool_]) -> Iterator[_Slab]:
    n, moves = len(records), np.flatnonzero(~stands)
    if n - len(moves) < TILE_SURFACES.slab + TILE_SURFACES.slab // 2:
        yield _Slab((0, grid.side_cells), [_Run(slice(0, n), slice(0, n))])
        return
    firsts, side = _first_of_rows(records, grid), grid.side_cells
    standing = np.diff(firsts - np.searchsorted(moves, firsts))
    for low, high in _row_spans(standing.reshape(-1, side).sum(axis=0)):
        rows = max(low - TILE_SURFACES.margin, 0), min(high + TILE_SURFACES.margin, side)
        every, own = _runs(firsts, grid, rows), _runs(firsts, grid, (low, high))
        yield _Slab(rows, [_Run(*pair) for pair in zip(every, own, strict=True)])


def _first_of_rows(records: Records, grid: Grid) -> NDArray[np.int64]:
    """First record of each row of cells along x, and N after the last."""
    firsts = np.empty(grid.side_cells**2 + 1, np.int64)
    surface_cells.first_of_rows(
        Views.of(records).f4,
        grid.voxel_m,
        grid.cell_voxels,
        grid.side_cells,
        grid.halo_cells,
        firsts,
    )
    return firsts


def _runs(firsts: NDArray[np.int64], grid: Grid, rows: tuple[int, int]) -> list[slice]:
    """Records of some rows of cells, layer by layer."""
    (low, high), side = rows, grid.side_cells
    return [slice(firsts[k * side + low], firsts[k * side + high]) for k in range(side)]


def _row_spans(counts: NDArray[np.int64]) -> Iterator[tuple[int, int]]:
    """First and last row (not included) of parts of about `TILE_SURFACES.slab` records.

    Slabs are upright: a floor would put most of a tile into one of layers.
    """
    low, total = 0, np.concatenate([[0], np.cumsum(counts)])
    for row in range(1, len(total)):
        full = (
            total[row] - total[low] >= TILE_SURFACES.slab
            and total[-1] - total[row] >= TILE_SURFACES.slab // 2
        )
        if full or row == len(total) - 1:
            yield low, row
            low = row
