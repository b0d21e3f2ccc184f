"""Surfaces of a tile: planes fitted to all returns around a point; the point moves onto them."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import DTypeLike, NDArray

from recon4.kernels import (
    surface_cells,
    surface_points,
    surface_shapes,
    surface_slots,
    surface_windows,
)
from recon4.kernels.moments import MOMENTS
from recon4.kernels.surface_cells import PLANE, SLOTS
from recon4.kernels.surface_points import SURFACE
from recon4.mapping.grid import Grid
from recon4.mapping.normals import MIN_POINTS
from recon4.mapping.records import Records, Views
from recon4.mapping.scratch import Scratch

ScratchArray = Callable[[str, tuple[int, ...], DTypeLike], NDArray[Any]]
"""`Scratch.array`"""

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
LOOSE, STRICT = (1.5, 1.0, 1.0), (SPREAD, 0.3, 0.05)
"""Rounds of fitting windows: largest deviation across [noise], largest bend [noise], and the part
of the noise's variance that is the same in all directions: poses and voxels."""
STRAY_RATIO = 0.015
"""Largest ratio of stray returns among those around them."""
BEND_M = 0.002
"""Standard deviation of a cell's surface from the plane of its window [m]."""


@dataclass(frozen=True, slots=True, eq=False)
class FittedSurfaces:
    """What is known of the surface at each of N points."""

    rows: NDArray[np.float32]
    """Of `surface_points.SURFACE` numbers, (N, 9)."""
    stray: NDArray[np.bool_]
    """Returns of no surface, few beside those of the surfaces around them, (N,)."""
    support: NDArray[np.int32]
    """Points in the 3 x 3 x 3 cells around, the point itself included, (N,)."""

    @property
    def shift_m(self) -> NDArray[np.float32]:
        """From the point to the surface [m], (N, 3); zeros where there is none."""
        return self.rows[:, :3]

    @property
    def normal(self) -> NDArray[np.float32]:
        """Unit normal of the surface; that of the neighborhood where there is none, (N, 3)."""
        return self.rows[:, 3:6]

    @property
    def facts(self) -> NDArray[np.float32]:
        """Standard deviation of the returns across it [m], how many there are, and planarity 0..1.

        NaN, 0, 0 where there is none, (3, N).
        """
        return self.rows[:, 6:].T


Points = tuple[NDArray[np.float32], NDArray[np.float32], NDArray[np.float32], NDArray[np.int32]]


@dataclass(frozen=True, slots=True, eq=False)
class _Cells:
    """Cells with points, and which of them are neighbors."""

    starts: NDArray[np.int32]
    cells: NDArray[np.int32]
    where: NDArray[np.int32]
    begin: NDArray[np.int32]
    near: NDArray[np.int32]
    at: NDArray[np.uint8]
    inner: NDArray[np.bool_]


@dataclass(frozen=True, slots=True, eq=False)
class _Windows:
    """Planes of windows, with the moments of the sides of each cell."""

    planes: NDArray[np.float64]
    moments: NDArray[np.float64]
    calm: NDArray[np.bool_]
    normals: NDArray[np.float64]
    support: NDArray[np.int32]


def fit_surfaces(
    records: Records, grid: Grid, *, noise_m: float, scratch: Scratch | None = None
) -> FittedSurfaces:
    """Fit the surfaces of a tile.

    Args:
        records: In the order of their voxels, with the halo, (N,).
        grid: The grid.
        noise_m: Standard deviation of a range [m].
        scratch: Holds the result and what it is computed from; None = fresh memory.
    """
    n, views, array = len(records), Views.of(records), (scratch or Scratch()).array
    means, to_sensor = (array(name, (n, 3), np.float32) for name in ("means", "to_sensor"))
    weight = array("weight", (n,), np.float32)
    surface_cells.unpack_returns(
        views.f4, views.i2, views.u1, grid.voxel_m, means, to_sensor, weight
    )
    found = _cells(views.f4, grid, array)
    fit = _Fit((means, to_sensor, weight, found.starts), found, grid, noise_m, array)
    windows = fit.windows()
    planes = fit.planes_of_cells(windows)
    slot_of, rows = array("slot_of", (n,), np.uint8), array("rows", (n, SURFACE), np.float32)
    surface_points.onto_planes(
        views.f4, to_sensor, found.starts, windows.normals, planes, GATE, slot_of, rows
    )
    stray, sums = array("stray", (n,), np.bool_), array("stray_sums", (len(planes), 2), np.float64)
    surface_points.find_strays(
        weight, found.starts, found.begin, found.near, slot_of, STRAY_RATIO, sums, stray
    )
    support = np.repeat(windows.support, np.diff(found.starts))
    return FittedSurfaces(rows, stray, support)


def _cells(xyz: NDArray[np.float32], grid: Grid, array: ScratchArray) -> _Cells:
    n, side = len(xyz), grid.side_cells
    starts, cells = array("starts", (n + 1,), np.int32), array("cells", (n,), np.int32)
    where = array("where", (side**3,), np.int32)
    where.fill(-1)
    count = surface_cells.find_cells(xyz, grid.cell_m, side, grid.halo_cells, starts, cells, where)
    starts, cells = starts[: count + 1], cells[:count]
    begin, near = array("begin", (count + 1,), np.int32), array("near", (27 * count,), np.int32)
    at = array("at", (27 * count,), np.uint8)
    entries = surface_cells.list_neighbors(cells, where, side, begin, near, at)
    inner = array("inner", (count,), np.bool_)
    surface_cells.find_inner(cells, side, inner)
    return _Cells(starts, cells, where, begin, near[:entries], at[:entries], inner)


@dataclass(frozen=True, slots=True, eq=False)
class _Fit:
    """The steps from the returns of a tile to the planes of its cells."""

    points: Points
    """Positions, vectors to the sensor, weights, starts of the cells."""
    found: _Cells
    grid: Grid
    noise_m: float
    array: ScratchArray

    @property
    def step(self) -> tuple[NDArray[np.int32], int, int, float]:
        """Cells, and how they lie in the tile."""
        return self.found.cells, self.grid.side_cells, self.grid.halo_cells, self.grid.cell_m

    def windows(self) -> _Windows:
        """Planes of the windows around all cells."""
        array, found, count = self.array, self.found, len(self.found.cells)
        means, to_sensor, weight, starts = self.points
        planes = array("planes", (count, 2, PLANE), np.float64)
        moments = array("moments", (count, 2, MOMENTS), np.float64)
        views = array("views", (count, 2, 4), np.float64)
        calm, every, changed, again = array("marks", (4, count), np.bool_)
        once = array("once", weight.shape, np.float32)
        axes, normals = array("axes", (2, count, 3), np.float64)
        support = array("support", (count,), np.int32)
        every.fill(True)
        planes.fill(0.0)
        once.fill(1.0)
        axes.fill(0.0)
        surface_windows.side_moments(means, to_sensor, once, starts, axes, every, moments, views)
        surface_windows.window_normals(
            starts, found.begin, found.near, moments, views, MIN_POINTS, axes, support
        )
        normals[:] = axes
        surface_windows.seen_from_behind(to_sensor, starts, axes, changed)
        surface_windows.side_moments(*self.points, axes, every, moments, views)
        made = _Windows(planes, moments, calm, normals, support)
        sides = (axes, moments, views)
        self._fit_windows(made, sides, LOOSE, todo=found.inner)
        surface_windows.view_axes(to_sensor, weight, starts, planes, axes, changed)
        surface_windows.around(changed, found.begin, found.near, again)
        again &= found.inner
        surface_windows.side_moments(*self.points, axes, changed, moments, views)
        self._fit_windows(made, sides, LOOSE, todo=again)
        surface_windows.near_moments(*self.points, axes, planes, ROUND_GATE, moments)
        self._fit_windows(made, sides, STRICT, todo=found.inner)
        self._drop_mixed(planes)
        return made

    def _fit_windows(
        self,
        made: _Windows,
        sides: tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.float64]],
        shape: tuple[float, float, float],
        *,
        todo: NDArray[np.bool_],
    ) -> None:
        (spread, bend, same), cell_m, noise_m = shape, self.grid.cell_m, self.noise_m
        limits = (MIN_RETURNS, spread * noise_m, 0.3 * cell_m, bend * noise_m, same, BEND_M)
        found = self.found
        surface_windows.window_planes(
            found.begin, found.near, found.at, *sides, 0.5,
            np.array(limits), todo, made.planes, made.calm,
        )  # fmt: skip

    def _drop_mixed(self, planes: NDArray[np.float64]) -> None:
        count, found = len(planes), self.found
        sums = self.array("shape_sums", (count, 2, 5), np.float64)
        kept = self.array("kept", (count, 2), np.bool_)
        surface_shapes.shape_sums(*self.points, planes, 4.0 * self.noise_m, sums)
        surface_shapes.drop_mixed(
            *self.step, found.begin, found.near, sums, ONE_SHEET * self.noise_m, 0.35, planes, kept
        )
        planes[:, :, 4] *= kept

    def planes_of_cells(self, windows: _Windows) -> NDArray[np.float64]:
        """Up to three planes for every cell, (C, SLOTS, PLANE)."""
        array, found, grid, count = self.array, self.found, self.grid, len(self.found.cells)
        slots, fitted = array("slots", (2, count, SLOTS, PLANE), np.float64)
        sums = array("slot_sums", (count, SLOTS, MOMENTS), np.float64)
        simple = array("simple", (count,), np.bool_)
        slot_of = array("slot_of", (len(self.points[0]),), np.uint8)
        surface_slots.only_plane(
            *self.points, windows.planes, windows.moments, windows.calm, ROUND_GATE, MIN_SUPPORT,
            slots, slot_of, sums, simple,
        )  # fmt: skip
        flat = windows.planes.reshape(2 * count, PLANE)
        thickness = array("thickness", (2 * count,), np.float64)
        surface_slots.thickness_of(flat, thickness)
        surface_slots.choose_planes(
            *self.points, found.where, *self.step, flat, thickness,
            ROUND_GATE, MIN_SUPPORT, simple, slots, slot_of, sums,
        )  # fmt: skip
        surface_slots.refit_planes(
            *self.step, found.begin, found.near, found.at, simple,
            slots, sums, np.array([MIN_RETURNS, 0.3 * grid.cell_m, BEND_M]), fitted,
        )  # fmt: skip
        return fitted
