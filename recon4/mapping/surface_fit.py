"""Surfaces of some rows of cells of a tile: planes fitted to all returns around a point."""

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
from recon4.kernels.surface_cells import PLANE, SLOTS
from recon4.kernels.surface_points import SURFACE
from recon4.mapping.grid import Grid
from recon4.mapping.normals import MIN_POINTS
from recon4.mapping.records import Records, Views
from recon4.mapping.scratch import ScratchArray

ROUND_GATE = 2.5
"""While planes are fitted, farther returns do not count [standard deviations]."""
GATE = 3.7
"""Points farther from their plane keep their place [standard deviations]."""
SPREAD = 1.15
"""Largest standard deviation across a surface [noise of the range]."""
ONE_SHEET = 1.0
"""Below this standard deviation a surface is one sheet whatever its shape [noise]."""
MIN_RETURNS = 12.0
MIN_SUPPORT = 0.5
"""Least support of a second plane of a cell [returns]."""
MIN_LOOSE = 3.0
"""A cell with more returns off its only plane is looked at for others."""
LOOSE, STRICT = (1.5, 1.0, 1.0, 0.0), (SPREAD, 0.3, 0.05, 0.02)
"""Rounds of fitting windows: largest deviation across [noise], largest bend [noise], the part of
the noise's variance that is the same in all directions (poses and voxels), and the least part of
the returns of the window: noise beyond an edge has chance planes of a dozen returns."""
STRAY_RATIO = 0.015
"""Largest ratio of stray returns among those around them."""
STRAY_DENSITY = 200.0
"""As many returns of no surface are stray ones whatever their ratio [1/m² of the cells around]."""
FAR_RATIO = 0.15
"""The same of those that were measured from afar: the surfaces around them are known better."""
AFAR = 1.75
"""Times the mean range of the returns on surfaces."""
BEND_M = 0.002
"""Standard deviation of a cell's surface from the plane of its window [m]."""


@dataclass(frozen=True, slots=True, eq=False)
class FittedSurfaces:
    """What is known of the surface at each of N points."""

    shift_m: NDArray[np.float32]
    """From the point to the surface [m], (N, 3); zeros where there is none."""
    surface_of: NDArray[np.int32]
    """Row of its surface, (N,)."""
    surfaces: NDArray[np.float32]
    """Of `surface_points.SURFACE` numbers, (K, 6)."""
    stray: NDArray[np.bool_]
    """Returns of no surface, few beside those of the surfaces around them, (N,)."""
    support: NDArray[np.int32]
    """Points in the 3 x 3 x 3 cells around, the point itself included, (N,)."""

    def copy(self, rows: slice, to: FittedSurfaces, to_rows: slice, *, first: int) -> None:
        """Copy what is known of some points, whose surfaces are in ``to`` from row ``first`` on."""
        to.shift_m[to_rows] = self.shift_m[rows]
        to.stray[to_rows] = self.stray[rows]
        to.support[to_rows] = self.support[rows]
        np.add(self.surface_of[rows], first, out=to.surface_of[to_rows])

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
    rings: NDArray[np.uint8]


@dataclass(frozen=True, slots=True, eq=False)
class _Windows:
    """Planes of windows, with the moments of the sides of each cell."""

    planes: NDArray[np.float64]
    moments: NDArray[np.float64]
    calm: NDArray[np.bool_]
    normals: NDArray[np.float64]
    support: NDArray[np.int32]


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
    n, views = len(records), Views.of(records)
    means, to_sensor = (array(name, (n, 3), np.float32) for name in ("means", "to_sensor"))
    weight = array("weight", (n,), np.float32)
    surface_cells.unpack_returns(
        views.f4, views.i2, views.u1, grid.voxel_m, means, to_sensor, weight
    )
    found = _cells(views.f4, grid, rows, array=array)
    fit = _Fit((means, to_sensor, weight, found.starts), found, grid, noise, array)
    windows = fit.windows()
    made = fit.moved(views.f4, windows, fit.slots(windows))
    support = np.repeat(windows.support, np.diff(found.starts))
    found.where[found.cells] = -1
    return FittedSurfaces(made.shift_m, made.surface_of, made.surfaces, made.stray, support)


def _cells(
    xyz: NDArray[np.float32], grid: Grid, rows: tuple[int, int], *, array: ScratchArray
) -> _Cells:
    n, side = len(xyz), grid.side_cells
    starts, cells = array("starts", (n + 1,), np.int32), array("cells", (n,), np.int32)
    where = array(f"where-{side}", (side**3,), np.int32, fresh=0xFF)
    count = surface_cells.find_cells(xyz, grid.cell_m, side, grid.halo_cells, starts, cells, where)
    starts, cells = starts[: count + 1], cells[:count]
    begin, near = array("begin", (count + 1,), np.int32), array("near", (27 * count,), np.int32)
    at = array("at", (27 * count,), np.uint8)
    entries = surface_cells.list_neighbors(cells, where, side, begin, near, at)
    rings = array("rings", (count,), np.uint8)
    surface_cells.find_rings(cells, side, *rows, rings)
    return _Cells(starts, cells, where, begin, near[:entries], at[:entries], rings)


@dataclass(frozen=True, slots=True, eq=False)
class _Slots:
    """Up to three planes for every cell."""

    rows: NDArray[np.int32]
    """Of the planes of the windows, -1 = none, (C, SLOTS)."""
    other: NDArray[np.int32]
    """Row in the sums of cells of several planes, -1 = only the plane of its window, (C,)."""
    sums: NDArray[np.float64]
    """Moments of what supports them, (K, SLOTS, MOMENTS)."""
    slot_of: NDArray[np.uint8]
    """Which plane each point supports, SLOTS = none, (N,)."""


@dataclass(frozen=True, slots=True, eq=False)
class _Moved:
    """Points on their surfaces."""

    shift_m: NDArray[np.float32]
    surface_of: NDArray[np.int32]
    surfaces: NDArray[np.float32]
    stray: NDArray[np.bool_]


@dataclass(frozen=True, slots=True, eq=False)
class _Fit:
    """The steps from the returns of a tile to the planes of its cells."""

    points: Points
    """Positions, vectors to the sensor, weights, starts of the cells."""
    found: _Cells
    grid: Grid
    noise: Noise
    array: ScratchArray

    @property
    def step(self) -> tuple[NDArray[np.int32], int, int, float]:
        """Cells, and how they lie in the tile."""
        return self.found.cells, self.grid.side_cells, self.grid.halo_cells, self.grid.cell_m

    def windows(self) -> _Windows:
        """Planes of the windows around all cells."""
        array, found, count = self.array, self.found, len(self.found.cells)
        _, to_sensor, weight, starts = self.points
        planes = array("planes", (count, 2, PLANE), np.float64)
        moments = array("moments", (count, 2, MOMENTS), np.float64)
        views = array("views", (count, 2, 4), np.float64)
        calm, every, changed, again, inner = array("marks", (5, count), np.bool_)
        np.greater(found.rings, 0, out=inner)
        axes, normals = array("axes", (2, count, 3), np.float64)
        support = array("window_support", (count,), np.int32)
        every.fill(True)
        planes.fill(0.0)
        axes.fill(0.0)
        surface_windows.side_moments(*self.points, axes, every, moments, views)
        surface_windows.window_normals(
            starts, found.begin, found.near, moments, views, MIN_POINTS, axes, support
        )
        normals[:] = axes
        surface_windows.seen_from_behind(to_sensor, starts, axes, changed)
        surface_windows.side_moments(*self.points, axes, changed, moments, views)
        made = _Windows(planes, moments, calm, normals, support)
        sides = (axes, moments, views)
        self._fit_windows(made, sides, LOOSE, todo=inner)
        surface_windows.view_axes(to_sensor, weight, starts, planes, axes, changed)
        surface_windows.around(changed, found.begin, found.near, again)
        again &= inner
        surface_windows.side_moments(*self.points, axes, changed, moments, views)
        self._fit_windows(made, sides, LOOSE, todo=again)
        surface_windows.near_moments(*self.points, axes, planes, ROUND_GATE, moments)
        self._fit_windows(made, sides, STRICT, todo=inner)
        self._drop_mixed(planes)
        return made

    def _fit_windows(
        self,
        made: _Windows,
        sides: tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.float64]],
        shape: tuple[float, float, float, float],
        *,
        todo: NDArray[np.bool_],
    ) -> None:
        (spread, bend, same, share), cell_m, noise_m = shape, self.grid.cell_m, self.noise.all_m
        limits = (MIN_RETURNS, spread * noise_m, 0.3 * cell_m, bend * noise_m, same, BEND_M, share)
        found = self.found
        surface_windows.window_planes(
            found.begin, found.near, found.at, *sides, 0.5,
            np.array(limits), todo, made.planes, made.calm,
        )  # fmt: skip

    def _drop_mixed(self, planes: NDArray[np.float64]) -> None:
        count, found = len(planes), self.found
        sums = self.array("sums", (count, 2, 5), np.float64)
        kept = self.array("kept", (count, 2), np.bool_)
        surface_shapes.shape_sums(*self.points, planes, 4.0 * self.noise.all_m, sums)
        surface_shapes.drop_mixed(
            *self.step,
            found.begin,
            found.near,
            sums,
            ONE_SHEET * self.noise.range_m,
            0.35,
            planes,
            kept,
        )
        planes[:, :, 4] *= kept

    def slots(self, windows: _Windows) -> _Slots:
        """The planes of every cell that its returns support."""
        array, found, count = self.array, self.found, len(self.found.cells)
        weight = self.points[2]
        rows, other = array("slots", (count, SLOTS), np.int32), array("other", (count,), np.int32)
        slot_of = array("slot_of", weight.shape, np.uint8)
        others = surface_slots.only_plane(
            *self.points, windows.planes, windows.calm, ROUND_GATE, MIN_LOOSE, rows, slot_of, other
        )
        sums = array("sums", (others, SLOTS, MOMENTS), np.float64)
        flat = windows.planes.reshape(2 * count, PLANE)
        thickness = array("thickness", (2 * count,), np.float64)
        surface_slots.thickness_of(flat, thickness)
        surface_slots.choose_planes(
            *self.points, found.where, *self.step, flat, thickness,
            ROUND_GATE, MIN_SUPPORT, other, rows, slot_of, sums,
        )  # fmt: skip
        return _Slots(rows, other, sums, slot_of)

    def moved(self, xyz: NDArray[np.float32], windows: _Windows, slots: _Slots) -> _Moved:
        """The points on the planes of their cells, and which of them are stray returns."""
        array, found, grid, n = self.array, self.found, self.grid, len(xyz)
        _, to_sensor, weight, starts = self.points
        count = len(found.cells)
        shift_m = array("slab_shift_m", (n, 3), np.float32)
        surface_of = array("slab_surface_of", (n,), np.int32)
        surfaces = array("surfaces", (min(n, SLOTS * count) + count, SURFACE), np.float32)
        made = surface_points.onto_planes(
            xyz, to_sensor, starts, found.rings, found.cells, self.step[1:],
            (found.begin, found.near, found.at), windows.normals,
            windows.planes.reshape(2 * count, PLANE), slots.rows, slots.other,
            windows.moments.reshape(2 * count, MOMENTS), slots.sums,
            np.array([MIN_RETURNS, 0.3 * grid.cell_m, BEND_M]), GATE,
            slots.slot_of, shift_m, surface_of, surfaces,
        )  # fmt: skip
        beyond = array("beyond", (count, SLOTS, 4), np.bool_)
        neighbors = found.begin, found.near, found.at
        surface_ends.find_beyond(
            xyz, weight, starts, found.cells, self.step[1:], neighbors, slots.other,
            slots.slot_of, shift_m, surface_of, surfaces, beyond,
        )  # fmt: skip
        made = surface_ends.put_back(
            xyz, starts, found.cells, self.step[1:], windows.normals, beyond,
            slots.slot_of, shift_m, surface_of, surfaces, made,
        )  # fmt: skip
        stray, sums = array("slab_stray", (n,), np.bool_), array("sums", (count, 5), np.float64)
        few = STRAY_DENSITY * (3.0 * grid.cell_m) ** 2
        surface_points.find_strays(
            to_sensor, weight, starts, found.begin, found.near, slots.slot_of,
            np.array([STRAY_RATIO, few, FAR_RATIO, AFAR]), sums, stray,
        )  # fmt: skip
        return _Moved(shift_m, surface_of, surfaces[:made], stray)
