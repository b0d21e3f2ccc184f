"""Surfaces of some rows of cells of a tile: planes fitted to all returns around a point.

`docs/explanation/surfaces.md` explains the algorithm with its equations; the steps of `fit_rows`
are its sections.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from recon4.kernels import (
    surface_cells,
    surface_ends,
    surface_points,
    surface_shapes,
    surface_slots,
    surface_windows,
)
from recon4.kernels.moments import MOMENTS
from recon4.kernels.surface_records import (
    PLANE,
    SLOTS,
    SURFACE,
    Cells,
    Moved,
    Neighbors,
    PlaneLimits,
    Returns,
    Sides,
    StrayLimits,
    Supported,
)
from recon4.mapping.grid import Grid
from recon4.mapping.records import Records, Views
from recon4.mapping.tile_memory import ScratchArray
from recon4.mapping.tuning import NORMALS


@dataclass(frozen=True, slots=True)
class WindowShape:
    """What the plane of a window has to be, in one round of fitting."""

    max_sigma: float
    """Largest standard deviation across [noise]."""
    max_bend: float
    """Largest root mean square distance of its parts [noise]."""
    isotropic: float
    """Part of the noise's variance that is the same in all directions: poses and voxels."""
    min_ratio: float
    """Least part of the returns of the window: noise beyond an edge has chance planes of a dozen
    returns."""


@dataclass(frozen=True, slots=True)
class SurfaceTuning:
    """Constants of fitted surfaces, chosen on the scene `exhibition` (docs: page map, figures)."""

    loose: WindowShape = WindowShape(1.5, 1.0, 1.0, 0.0)
    """First rounds: the windows still hold returns of other surfaces."""
    strict: WindowShape = WindowShape(1.15, 0.3, 0.05, 0.02)
    """Last round."""
    min_returns: float = 12.0
    """Of a plane."""
    min_along_cells: float = 0.3
    """Least standard deviation along a plane [cells]."""
    min_cos: float = 0.5
    """Cells of a window whose normals differ more are left out."""
    bend_m: float = 0.002
    """Standard deviation of a cell's surface from the plane of its window [m]."""
    one_sheet: float = 1.0
    """Below this standard deviation a surface is one sheet whatever its shape [noise]."""
    max_skew: float = 0.35
    """Of distances on one sheet; also the least excess kurtosis, negative."""
    shape_reach: float = 4.0
    """Farther points say nothing of the shape [noise]."""
    round_gate: float = 2.5
    """While planes are fitted, farther returns do not count [standard deviations]."""
    gate: float = 3.7
    """Points farther from their plane keep their place [standard deviations]."""
    min_support: float = 0.5
    """Least support of a second plane of a cell [returns]."""
    min_loose: float = 3.0
    """A cell with more returns off its only plane is looked at for others."""
    stray_ratio: float = 0.015
    """Largest ratio of stray returns among those around them."""
    stray_density: float = 200.0
    """As many returns of no surface are stray ones whatever their ratio [1/m² of the cells]."""
    far_ratio: float = 0.15
    """The same of those measured from afar: the surfaces around them are known better."""
    afar: float = 1.75
    """Times the mean range of the returns on surfaces."""

    def window(self, shape: WindowShape, cell_m: float, noise_m: float) -> PlaneLimits:
        """Limits of one round for a cell edge and a noise [m]."""
        return PlaneLimits(
            self.min_returns,
            shape.min_ratio,
            shape.max_sigma * noise_m,
            self.min_along_cells * cell_m,
            shape.max_bend * noise_m,
            shape.isotropic,
            self.bend_m,
        )

    def strays(self, cell_m: float) -> StrayLimits:
        """Which returns are few, for a cell edge [m]."""
        few = self.stray_density * (3.0 * cell_m) ** 2
        return StrayLimits(self.stray_ratio, few, self.far_ratio, self.afar)


TUNING = SurfaceTuning()


@dataclass(frozen=True, slots=True, eq=False)
class FittedSurfaces:
    """What is known of the surface at each of N points."""

    shift_m: NDArray[np.float32]
    """From the point to the surface [m], (N, 3); zeros where there is none."""
    surface_of: NDArray[np.int32]
    """Row of its surface, (N,)."""
    surfaces: NDArray[np.float32]
    """Of `surface_records.SURFACE` numbers, (K, 6)."""
    stray: NDArray[np.bool_]
    """Returns of no surface, few beside those of the surfaces around them, (N,)."""
    support: NDArray[np.int32]
    """Points in the 3 x 3 x 3 cells around, the point itself included; 0 = the surfaces are not
    fitted to it, (N,)."""

    def clear(self) -> NDArray[np.float32]:
        """State that no point has a surface; the row that says so is the first, (1, 6)."""
        for values in (self.shift_m, self.surface_of, self.stray, self.support):
            values.fill(0)
        return np.array([[0.0, 0.0, 0.0, np.nan, 0.0, 0.0]], np.float32)

    def copy(
        self,
        begin: int,
        to: FittedSurfaces,
        to_rows: slice,
        *,
        among: NDArray[np.bool_],
    ) -> None:
        """Copy what is known of points that lie one after the other.

        Args:
            begin: Row of the first.
            to: Receives it, with the same rows of surfaces.
            to_rows: Rows of ``to`` that they are of.
            among: Which rows of ``to`` they are, in their order, (M,).
        """
        of = among[to_rows]
        rows = slice(begin, begin + int(np.count_nonzero(of)))
        to.shift_m[to_rows][of] = self.shift_m[rows]
        to.stray[to_rows][of] = self.stray[rows]
        to.support[to_rows][of] = self.support[rows]
        to.surface_of[to_rows][of] = self.surface_of[rows]

    @property
    def on_surface(self) -> NDArray[np.bool_]:
        """Which points have a surface, (N,)."""
        return ~np.isnan(self.surfaces[:, 3])[self.surface_of]

    @property
    def normal(self) -> NDArray[np.float32]:
        """Unit normal of the surface; that of the neighborhood where there is none, (N, 3)."""
        return self.surfaces[self.surface_of, :3]

    @property
    def facts(self) -> NDArray[np.float32]:
        """Standard deviation of the returns across it [m], how many there are, and planarity 0..1.

        NaN, 0, 0 where there is none, (3, N).
        """
        return self.surfaces[self.surface_of, 3:].T


@dataclass(frozen=True, slots=True)
class Noise:
    """How far returns lie from the surface that they are of."""

    range_m: float
    """Standard deviation of a range [m]; what is thicker may be two sheets."""
    all_m: float
    """With that of poses, beams and bends, where these are known less well [m]."""


def fit_rows(
    records: Records, grid: Grid, rows: tuple[int, int], *, noise: Noise, array: ScratchArray
) -> FittedSurfaces:
    """Fit the surfaces of some rows of cells of a tile.

    Args:
        records: In the order of their cells, (N,).
        grid: The grid.
        rows: First row along y that there is, and the first beyond; windows of the outermost cells
            are incomplete, and these have no surfaces.
        noise: Of the returns.
        array: Memory for what is computed and for the result.
    """
    measured = Views.of(records).f4
    fit = _Fit.begin(records, grid, rows, noise=noise, array=array)
    windows = fit.windows()
    supported = fit.supported(windows)
    moved = fit.moved(measured, windows, supported)
    stray = fit.strays(supported)
    support = np.repeat(windows.support, np.diff(fit.returns.first))
    fit.cells.row[fit.cells.number] = -1
    return FittedSurfaces(moved.shift_m, moved.surface_of, moved.surfaces, stray, support)


@dataclass(frozen=True, slots=True, eq=False)
class _Windows:
    """The planes of the windows of 3 x 3 x 3 cells around each cell."""

    planes: NDArray[np.float64]
    """For both sides of each cell, (C, 2, 11)."""
    moments: NDArray[np.float64]
    """Of the returns of each side of a cell that lie near its plane, (C, 2, MOMENTS)."""
    calm: NDArray[np.bool_]
    """Whether all cells of the window have similar normals, (C,)."""
    normals: NDArray[np.float64]
    """Of all points of the window, zeros = none, (C, 3)."""
    support: NDArray[np.int32]
    """Points of the window, (C,)."""

    @property
    def in_rows(self) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Planes and moments, two rows for each cell."""
        return self.planes.reshape(-1, PLANE.numbers), self.moments.reshape(-1, MOMENTS)


@dataclass(frozen=True, slots=True, eq=False)
class _Fit:
    """The steps from the returns of a tile to the planes of its cells."""

    returns: Returns
    cells: Cells
    neighbors: Neighbors
    rings: NDArray[np.uint8]
    """0 = outermost cells, whose windows are incomplete, (C,)."""
    noise: Noise
    array: ScratchArray

    @classmethod
    def begin(
        cls,
        records: Records,
        grid: Grid,
        rows: tuple[int, int],
        *,
        noise: Noise,
        array: ScratchArray,
    ) -> _Fit:
        """The returns, the cells that hold them, and which cells are neighbors."""
        n, side, views = len(records), grid.side_cells, Views.of(records)
        xyz, to_sensor = (array(name, (n, 3), np.float32) for name in ("means", "to_sensor"))
        weight, first = array("weight", (n,), np.float32), array("first", (n + 1,), np.int32)
        surface_cells.unpack_returns(
            views.f4, views.i2, views.u1, grid.voxel_m, Returns(xyz, to_sensor, weight, first)
        )
        number = array("cells", (n,), np.int32)
        row = array(f"cell_rows-{side}", (side**3,), np.int32, fresh=0xFF)
        cells = Cells(number, row, side, grid.halo_cells, grid.cell_m)
        count = surface_cells.find_cells(views.f4, cells, first)
        cells = cells._replace(number=number[:count])
        near = Neighbors(
            array("first_neighbors", (count + 1,), np.int32),
            array("neighbors", (27 * count,), np.int32),
            array("neighbor_offsets", (27 * count,), np.uint8),
        )
        entries = surface_cells.list_neighbors(cells, near)
        near = Neighbors(near.first, near.row[:entries], near.offset[:entries])
        rings = array("rings", (count,), np.uint8)
        surface_cells.find_rings(cells, *rows, rings)
        returns = Returns(xyz, to_sensor, weight, first[: count + 1])
        return cls(returns, cells, near, rings, noise, array)

    def windows(self) -> _Windows:
        """Planes of the windows around all cells."""
        array, returns, near, count = self.array, self.returns, self.neighbors, len(self.rings)
        axis, normals = array("axes", (2, count, 3), np.float64)
        moments = array("moments", (count, 2, MOMENTS), np.float64)
        sides = Sides(axis, moments, array("views", (count, 2, 4), np.float64))
        planes = array("planes", (count, 2, PLANE.numbers), np.float64)
        support = array("window_support", (count,), np.int32)
        calm, every, changed, again, inner = array("marks", (5, count), np.bool_)
        made = _Windows(planes, moments, calm, normals, support)
        np.greater(self.rings, 0, out=inner)
        every.fill(True)
        planes.fill(0.0)
        axis.fill(0.0)
        # Which sides: one normal a window, then the two sides of it.
        surface_windows.side_moments(returns, every, sides)
        surface_windows.window_normals(returns, near, sides, NORMALS.min_points, support)
        normals[:] = axis
        surface_windows.seen_from_behind(returns, axis, changed)
        surface_windows.side_moments(returns, changed, sides)
        self._fit_windows(made, sides, TUNING.loose, todo=inner)
        # Windows without a plane are divided by where they were seen from.
        surface_windows.view_axes(returns, planes, axis, changed)
        surface_windows.around(changed, near, again)
        again &= inner
        surface_windows.side_moments(returns, changed, sides)
        self._fit_windows(made, sides, TUNING.loose, todo=again)
        # Once more without the returns far from these planes.
        surface_windows.near_moments(returns, planes, TUNING.round_gate, sides)
        self._fit_windows(made, sides, TUNING.strict, todo=inner)
        self._drop_mixed(planes)
        return made

    def _fit_windows(
        self, made: _Windows, sides: Sides, shape: WindowShape, *, todo: NDArray[np.bool_]
    ) -> None:
        limits = TUNING.window(shape, self.cells.edge_m, self.noise.all_m)
        surface_windows.window_planes(
            self.neighbors, sides, TUNING.min_cos, limits, todo, made.planes, made.calm
        )

    def _drop_mixed(self, planes: NDArray[np.float64]) -> None:
        """Drop planes of two sheets, and those beside their cell."""
        count = len(planes)
        sums = self.array("sums", (count, 2, 5), np.float64)
        kept = self.array("kept", (count, 2), np.bool_)
        reach_m, least_m = TUNING.shape_reach * self.noise.all_m, self.noise.range_m
        surface_shapes.shape_sums(self.returns, planes, reach_m, sums)
        least_m *= TUNING.one_sheet
        surface_shapes.drop_mixed(
            self.cells, self.neighbors, sums, least_m, TUNING.max_skew, planes, kept
        )
        planes[:, :, PLANE.sigma] *= kept

    def supported(self, windows: _Windows) -> Supported:
        """The planes of every cell that its returns support."""
        array, count = self.array, len(self.rings)
        made = Supported(
            array("supported", (count, SLOTS), np.int32),
            array("several", (count,), np.int32),
            array("plane_of_point", self.returns.weight.shape, np.uint8),
            array("sums", (0, SLOTS, MOMENTS), np.float64),
        )
        several = surface_slots.only_plane(
            self.returns, windows.planes, windows.calm, TUNING.round_gate, TUNING.min_loose, made
        )
        made = made._replace(sums=array("sums", (several, SLOTS, MOMENTS), np.float64))
        planes, _ = windows.in_rows
        thickness = array("thickness", (2 * count,), np.float64)
        surface_slots.thickness_of(planes, thickness)
        surface_slots.choose_planes(
            self.returns, self.cells, planes, thickness, TUNING.round_gate, TUNING.min_support, made
        )
        return made

    def moved(
        self, measured: NDArray[np.float32], windows: _Windows, supported: Supported
    ) -> Moved:
        """The points on the planes of their cells."""
        array, (n, count) = self.array, (len(measured), len(self.rings))
        made = Moved(
            array("slab_shift_m", (n, 3), np.float32),
            array("slab_surface_of", (n,), np.int32),
            array("surfaces", (min(n, SLOTS * count) + count, SURFACE), np.float32),
        )
        returns = self.returns._replace(xyz=measured)
        limits = TUNING.window(TUNING.strict, self.cells.edge_m, self.noise.all_m)
        surfaces = surface_points.onto_planes(
            returns, self.cells, self.rings, self.neighbors, windows.normals, *windows.in_rows,
            supported, limits, TUNING.gate, made,
        )  # fmt: skip
        beyond = array("beyond", (count, SLOTS, 4), np.bool_)
        surface_ends.find_beyond(returns, self.cells, self.neighbors, supported, made, beyond)
        surfaces = surface_ends.put_back(
            returns, self.cells, windows.normals, beyond, supported.of_point, made, surfaces
        )
        return made._replace(surfaces=made.surfaces[:surfaces])

    def strays(self, supported: Supported) -> NDArray[np.bool_]:
        """Which points are stray returns, (N,)."""
        stray = self.array("slab_stray", self.returns.weight.shape, np.bool_)
        sums = self.array("sums", (len(self.rings), 5), np.float64)
        limits = TUNING.strays(self.cells.edge_m)
        surface_points.find_strays(
            self.returns, self.neighbors, supported.of_point, limits, sums, stray
        )
        return stray
