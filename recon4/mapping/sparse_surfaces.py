"""Surfaces of sparse places: fitted at a larger scale to points that have none at the usual one."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from recon4.kernels.surface_cells import number_cells
from recon4.mapping.grid import Grid
from recon4.mapping.records import Records, Views
from recon4.mapping.surface_fit import TUNING, FittedSurfaces, Noise, fit_rows
from recon4.mapping.tile_memory import Scratch, TileMeans
from recon4.mapping.tuning import SPARSE_SURFACES


def with_sparse_places(
    records: Records,
    found: FittedSurfaces,
    *,
    grid: Grid,
    noise_m: float,
    means: TileMeans | None = None,
) -> FittedSurfaces:
    """Put points without a surface onto those fitted to windows three times as large.

    Only points with few others around them, so that edges and thin things of dense places are not
    looked at again.

    Args:
        records: As in `fit_surfaces`, (N,).
        found: What it found; changed in place.
        grid: The grid.
        noise_m: Standard deviation of a range [m].
        means: Memory to work in.
    """
    from scipy.ndimage import maximum_filter  # slow to import, and readers of maps need none

    fitted = found.support > 0
    loose = fitted & ~found.on_surface & (found.support < SPARSE_SURFACES.few)
    if loose.sum() <= SPARSE_SURFACES.share * np.count_nonzero(fitted):
        return found
    scale = SPARSE_SURFACES.scale
    tile_cells = -(-grid.tile_cells // scale)
    coarse = Grid(grid.voxel_m, scale * grid.cell_voxels, tile_cells, grid.thin, 1)
    array = ((means and means.scratch) or Scratch()).array
    cell, xyz = array("coarse_cells", (len(records),), np.int32), Views.of(records).f4
    number_cells(xyz, coarse.cell_m, coarse.side_cells, coarse.halo_cells, cell)
    marked = np.zeros((coarse.side_cells,) * 3, np.bool_)
    marked.flat[cell[loose]] = True
    near = maximum_filter(marked, SPARSE_SURFACES.reach).ravel()[cell]
    wanted = np.flatnonzero(near & fitted)
    rows = wanted[np.argsort(cell[wanted], kind="stable")]
    noise = Noise(noise_m, SPARSE_SURFACES.noise * noise_m)
    every = 0, coarse.side_cells
    made = fit_rows(np.take(records, rows), coarse, every, noise=noise, array=array)
    mine = loose[rows]
    able = mine & made.on_surface
    moved = np.flatnonzero(able & _thin_enough(made, able, noise_m))
    stray = np.flatnonzero(mine & made.stray)
    found.shift_m[rows[moved]] = made.shift_m[moved]
    found.surface_of[rows[moved]] = made.surface_of[moved] + len(found.surfaces)
    found.stray[rows[moved]] = False
    found.stray[rows[stray]] = True
    return replace(found, surfaces=np.concatenate([found.surfaces, made.surfaces]))


def _thin_enough(
    made: FittedSurfaces, moved: NDArray[np.bool_], noise_m: float
) -> NDArray[np.bool_]:
    """Which points lie on a surface about as thick as the others; others may be two sheets."""
    sigma_m = made.surfaces[made.surface_of, 3]
    usual_m = float(np.median(sigma_m[moved])) if moved.any() else 0.0
    return np.asarray(
        sigma_m < max(TUNING.strict.max_sigma * noise_m, SPARSE_SURFACES.thicker * usual_m)
    )
