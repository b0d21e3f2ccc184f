"""Surfaces of sparse places: fitted at a larger scale to points that have none at the usual one."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import maximum_filter

from recon4.mapping.grid import Grid
from recon4.mapping.records import Records
from recon4.mapping.scratch import Scratch
from recon4.mapping.surfaces import SPREAD, FittedSurfaces, Noise, fit_layers

SCALE = 3
"""Cells of the larger scale are as many times as large."""
FEW = 400
"""A neighborhood of fewer points is sparse."""
NOISE = 3.0
"""Sparse points are far from the sensor or few recordings: poses and beams are less exact."""
THICKER = 1.4
"""Sparse surfaces this many times as thick as most of a tile are not believed."""
_REACH = 5
"""Cells along a window of windows: what the planes of a cell depend on."""


def with_sparse_places(
    records: Records,
    found: FittedSurfaces,
    grid: Grid,
    *,
    noise_m: float,
    scratch: Scratch | None = None,
) -> FittedSurfaces:
    """Put points without a surface onto those fitted to windows three times as large.

    Only points with few others around them, so that edges and thin things of dense places are not
    looked at again.

    Args:
        records: As in `fit_surfaces`, (N,).
        found: What it found; changed in place.
        grid: The grid.
        noise_m: Standard deviation of a range [m].
        scratch: Memory to work in; None = fresh memory.
    """
    loose = np.isnan(found.surfaces[:, 3])[found.surface_of] & (found.support < FEW)
    if not loose.any():
        return found
    coarse = Grid(
        grid.voxel_m, SCALE * grid.cell_voxels, -(-grid.tile_cells // SCALE), grid.thin, 1
    )
    cell = _cells_of(records, coarse)
    marked = np.zeros((coarse.side_cells,) * 3, np.uint8)
    marked.flat[cell[loose]] = 1
    wanted = np.flatnonzero(maximum_filter(marked, _REACH).ravel()[cell])
    rows = wanted[np.argsort(cell[wanted], kind="stable")]
    array = (scratch or Scratch()).array
    layers = 0, coarse.side_cells
    noise = Noise(noise_m, NOISE * noise_m)
    made = fit_layers(np.take(records, rows), coarse, layers, noise=noise, array=array)
    on_surface = ~np.isnan(made.surfaces[:, 3])[made.surface_of]
    on_surface &= _thin_enough(made, loose[rows] & on_surface, noise_m)
    moved = np.flatnonzero(loose[rows] & on_surface)
    stray = np.flatnonzero(loose[rows] & made.stray)
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
    return np.asarray(sigma_m < max(SPREAD * noise_m, THICKER * usual_m))


def _cells_of(records: Records, grid: Grid) -> NDArray[np.intp]:
    """Index of the cell of each record, as the kernels number them, (N,)."""
    at = np.floor(records["xyz"] / np.float32(grid.cell_m)).astype(np.intp) + grid.halo_cells
    i, j, k = np.clip(at, 0, grid.side_cells - 1).T
    return np.asarray((k * grid.side_cells + j) * grid.side_cells + i)
