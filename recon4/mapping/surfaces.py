"""Surfaces of a tile: planes fitted to all returns around a point; the point moves onto them."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from recon4.kernels import surface_cells, surface_points, surface_slots, surface_windows
from recon4.kernels.moments import MOMENTS
from recon4.kernels.surface_cells import PLANE, SLOTS
from recon4.mapping.grid import Grid
from recon4.mapping.records import Records, to_sensor_m

ROUND_GATE = 2.5
"""While planes are fitted, farther returns do not count [standard deviations]."""
GATE = 3.7
"""Points farther from their plane keep their place [standard deviations]."""
SPREAD = 1.15
"""Largest standard deviation across a surface [noise of the range]."""
ONE_SHEET = 1.0
"""Below this standard deviation a surface is one sheet whatever its shape [noise]."""
MIN_RETURNS = 12.0
MIN_SUPPORT = 3.0
LOOSE, STRICT = (1.5, 0.0, 1.0, 1.0), (SPREAD, ROUND_GATE, 0.3, 0.05)
"""Rounds of fitting windows: largest deviation across [noise], gate [standard deviations], largest
bend [noise], and the part of the noise's variance that is the same in all directions: poses and
voxels."""
STRAY_RATIO = 0.015
"""Largest ratio of stray returns among those around them."""
BEND_M = 0.002
"""Standard deviation of a cell's surface from the plane of its window [m]."""


@dataclass(frozen=True, slots=True, eq=False)
class FittedSurfaces:
    """What is known of the surface at each of N points."""

    shift_m: NDArray[np.float32]
    """From the point to the surface [m], (N, 3); zeros where there is none."""
    normal: NDArray[np.float32]
    """Unit normal of the surface; that of the neighborhood where there is none, (N, 3)."""
    facts: NDArray[np.float32]
    """Standard deviation of the returns across it [m], how many there are, and planarity 0..1;
    NaN, 0, 0 where there is none, (3, N)."""
    stray: NDArray[np.bool_]
    """Returns of no surface, few beside those of the surfaces around them, (N,)."""


@dataclass(frozen=True, slots=True)
class _Cells:
    starts: NDArray[np.int32]
    cells: NDArray[np.int32]
    where: NDArray[np.int32]


def fit_surfaces(
    records: Records, normals: NDArray[np.float32], grid: Grid, *, noise_m: float
) -> FittedSurfaces:
    """Fit the surfaces of a tile.

    Args:
        records: In the order of their voxels, with the halo, (N,).
        normals: Of `local_normals` with the grid's cells, (N, 3).
        grid: The grid.
        noise_m: Standard deviation of a range [m].
    """
    xyz, to_sensor = np.ascontiguousarray(records["xyz"]), to_sensor_m(records)
    weight = records["returns"].astype(np.float32)
    found = _cells(xyz, grid)
    means = np.empty_like(xyz)
    surface_cells.means_of_voxels(xyz, records["returns"].copy(), grid.voxel_m, means)
    step = (found.cells, found.where, grid.side_cells)
    planes = _window_planes((means, to_sensor, weight), found, normals, grid=grid, noise_m=noise_m)
    slots = np.empty((len(found.cells), SLOTS, PLANE))
    slot_of = np.empty(len(xyz), np.uint8)
    surface_slots.choose_planes(
        means, to_sensor, weight, found.starts, *step, grid.cell_m, planes, ROUND_GATE, MIN_SUPPORT,
        slots, slot_of,
    )  # fmt: skip
    moments = np.empty((len(found.cells), SLOTS, MOMENTS))
    surface_slots.slot_moments(
        means, weight, found.starts, found.cells, grid.side_cells, grid.cell_m, slot_of, moments
    )
    limits = np.array([MIN_RETURNS, SPREAD * noise_m, 0.3 * grid.cell_m, BEND_M])
    fitted = np.empty_like(slots)
    surface_slots.refit_planes(*step, grid.cell_m, slots, moments, limits, fitted)
    shift, facts = np.zeros((len(xyz), 3), np.float32), np.empty((3, len(xyz)), np.float32)
    surface_points.onto_planes(xyz, to_sensor, found.starts, fitted, GATE, slot_of, shift)
    normal, stray = normals.copy(), np.empty(len(xyz), np.bool_)
    surface_points.facts_of_points(found.starts, fitted, slot_of, normal, facts)
    surface_points.find_strays(weight, found.starts, *step, slot_of, STRAY_RATIO, stray)
    return FittedSurfaces(shift, normal, facts, stray)


def _cells(xyz: NDArray[np.float32], grid: Grid) -> _Cells:
    n = len(xyz)
    starts, cells = np.empty(n + 1, np.int32), np.empty(n, np.int32)
    where = np.full(grid.side_cells**3, -1, np.int32)
    count = surface_cells.find_cells(xyz, grid.cell_m, grid.side_cells, starts, cells, where)
    return _Cells(starts[: count + 1].copy(), cells[:count].copy(), where)


def _window_planes(
    points: Any, found: _Cells, normals: NDArray[np.float32], *, grid: Grid, noise_m: float
) -> NDArray[np.float64]:
    xyz, to_sensor, weight = points
    count = len(found.cells)
    of_cell = normals[found.starts[:-1]].astype(np.float64)
    planes, moments = np.zeros((count, 2, PLANE)), np.empty((count, 2, MOMENTS))
    views = np.empty((count, 2, 3))
    first = True
    for spread, gate, bend, same in (LOOSE, LOOSE, STRICT):
        shape = [spread * noise_m, 0.3 * grid.cell_m, bend * noise_m, same]
        surface_windows.side_moments(
            xyz, to_sensor, weight, found.starts, found.cells, grid.side_cells, grid.cell_m,
            of_cell, planes, gate, moments, views,
        )  # fmt: skip
        surface_windows.window_planes(
            found.cells, found.where, grid.side_cells, grid.cell_m, of_cell, moments, views, 0.5,
            np.array([MIN_RETURNS, *shape]), planes,
        )  # fmt: skip
        if first:
            surface_windows.view_axes(to_sensor, weight, found.starts, planes, of_cell)
            first = False
    sums, kept = np.empty((count, 2, 5)), np.empty_like(planes)
    surface_windows.shape_sums(xyz, to_sensor, weight, found.starts, planes, 4.0 * noise_m, sums)
    surface_windows.drop_mixed(
        found.cells, found.where, grid.side_cells, sums, ONE_SHEET * noise_m, 0.35, planes, kept
    )
    return kept
