"""Surfaces of a tile: planes fitted to all returns around a point; the point moves onto them."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from recon4.kernels import surface_cells
from recon4.kernels.surface_records import SURFACE
from recon4.mapping.grid import Grid
from recon4.mapping.records import RECORD, Records, Views, joined
from recon4.mapping.surface_fit import FittedSurfaces, Noise, fit_rows
from recon4.mapping.tile_memory import Scratch
from recon4.mapping.tuning import TILE_SURFACES


def fit_surfaces(
    records: Records, grid: Grid, *, noise_m: float, scratch: Scratch | None = None
) -> FittedSurfaces:
    """Fit the surfaces of a tile, some rows of cells at a time.

    Args:
        records: In the order of their voxels, with the halo, (N,).
        grid: The grid.
        noise_m: Standard deviation of a range [m].
        scratch: Holds the result and what it is computed from; None = fresh memory.
    """
    n, array = len(records), (scratch or Scratch()).array
    found = FittedSurfaces(
        array("shift_m", (n, 3), np.float32),
        array("surface_of", (n,), np.int32),
        np.empty((0, SURFACE), np.float32),
        array("stray", (n,), np.bool_),
        array("support", (n,), np.int32),
    )
    noise = Noise(noise_m, noise_m)
    if n < TILE_SURFACES.slab + TILE_SURFACES.slab // 2:
        every = slice(0, n)
        part = fit_rows(records, grid, (0, grid.side_cells), noise=noise, array=array)
        part.copy(every, found, every, first=0)
        return replace(found, surfaces=part.surfaces.copy())
    firsts = _first_of_rows(records, grid)
    surfaces, count = [], 0
    for low, high in _slabs(np.diff(firsts).reshape(-1, grid.side_cells).sum(axis=0)):
        own = _runs(firsts, grid, (low, high))
        rows = max(low - TILE_SURFACES.margin, 0), min(high + TILE_SURFACES.margin, grid.side_cells)
        runs = _runs(firsts, grid, rows)
        slab = array("slab", (sum(run.stop - run.start for run in runs),), RECORD)
        joined([records[run] for run in runs], slab)
        part = fit_rows(slab, grid, rows, noise=noise, array=array)
        begin = 0
        for run, mine in zip(runs, own, strict=True):
            at = begin + mine.start - run.start
            part.copy(slice(at, at + mine.stop - mine.start), found, mine, first=count)
            begin += run.stop - run.start
        surfaces.append(part.surfaces.copy())
        count += len(part.surfaces)
    return replace(found, surfaces=np.concatenate(surfaces))


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


def _slabs(counts: NDArray[np.int64]) -> Iterator[tuple[int, int]]:
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
