"""Named arrays that the kernels of fitted surfaces share; algorithm: docs, page surfaces.

Numba passes a named tuple as its fields, so a name costs nothing. N points, C cells with points.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray


class PlaneNumbers(NamedTuple):
    """Where the numbers of a plane are. Its unit normal (0, 1, 2) points to the sensors that saw
    it.
    """

    offset: int = 3
    """n · p of its points p [m]."""
    sigma: int = 4
    """Standard deviation of the returns across it [m]; 0 = there is no plane."""
    weight: int = 5
    """Returns that it was fitted to."""
    planarity: int = 6
    """From 0 (a line, a ball) to 1."""
    middle: int = 7
    """First of the mean of its returns x, y, z [m]."""
    own_offset: int = 10
    """The offset at the cell itself: a surface need not be quite flat [m]."""
    numbers: int = 11
    """Of a plane."""


PLANE = PlaneNumbers()


SLOTS = 3
"""Planes of a cell: a surface, an edge of two, a corner of three."""

SURFACE = 6
"""Numbers of the surface of a point: unit normal (0, 1, 2), standard deviation across it [m] (3),
returns (4), planarity (5); without a surface the normal of the neighborhood, NaN, 0, 0."""


class Returns(NamedTuple):
    """Points of a tile in the order of their cells."""

    xyz: NDArray[np.float32]
    """Unbiased positions from the tile's origin [m], (N, 3)."""
    to_sensor: NDArray[np.float32]
    """Vectors to the sensor [m], (N, 3)."""
    weight: NDArray[np.float32]
    """Returns that each point stands for, (N,)."""
    first: NDArray[np.int32]
    """First point of each cell, and N after the last, (C + 1,)."""


class Cells(NamedTuple):
    """The cells with points, and how cells lie in the tile."""

    number: NDArray[np.int32]
    """Number i + side (j + side k) of each in tile and halo, (C,)."""
    row: NDArray[np.int32]
    """Row of each number, -1 = no points, (side³,)."""
    side: int
    """Cells along tile and halo."""
    halo: int
    """Cells of the halo."""
    edge_m: float
    """Edge of a cell [m]."""


class Neighbors(NamedTuple):
    """The cells with points among the 3 x 3 x 3 around each cell, itself included."""

    first: NDArray[np.int32]
    """First entry of each cell, and their number after the last, (C + 1,)."""
    row: NDArray[np.int32]
    """Rows of the neighbors, (entries,)."""
    offset: NDArray[np.uint8]
    """Which of the 27 each is: i + 3 j + 9 k, 13 = the cell itself, (entries,)."""


class Sides(NamedTuple):
    """Sums of each cell's returns, apart for those seen from either side of an axis."""

    axis: NDArray[np.float64]
    """Unit vectors; zeros = one side only, (C, 3)."""
    moments: NDArray[np.float64]
    """About the tile's origin, (C, 2, MOMENTS)."""
    views: NDArray[np.float64]
    """Sums of the unit vectors to the sensor and their weight, (C, 2, 4)."""


class PlaneLimits(NamedTuple):
    """What a plane through the returns of a window has to be."""

    min_returns: float
    min_ratio: float
    """Least part of all returns of the window."""
    max_sigma_m: float
    """Largest standard deviation across, for beams along the normal [m]."""
    min_along_m: float
    """Least standard deviation along [m]."""
    max_bend_m: float
    """See `surface_shapes.is_bent` [m]."""
    isotropic: float
    """Part of the noise's variance that is the same in all directions (poses, voxels)."""
    bend_m: float
    """Standard deviation of a cell's surface from the plane of its window [m]."""


class Supported(NamedTuple):
    """The planes of every cell that its returns support."""

    plane: NDArray[np.int32]
    """Rows of the planes of the windows (two rows a cell), -1 = none, (C, SLOTS)."""
    several: NDArray[np.int32]
    """Row in ``sums`` of cells of several planes, -1 = only the plane of its window, (C,)."""
    of_point: NDArray[np.uint8]
    """Which of its cell's planes each point lies on, SLOTS = none, (N,)."""
    sums: NDArray[np.float64]
    """Moments of what supports them, (K, SLOTS, MOMENTS)."""


class Moved(NamedTuple):
    """Points on their surfaces."""

    shift_m: NDArray[np.float32]
    """From the point to the surface [m], zeros where there is none, (N, 3)."""
    surface_of: NDArray[np.int32]
    """Row of its surface, (N,)."""
    surfaces: NDArray[np.float32]
    """(at most (SLOTS + 1) C, SURFACE)."""


class StrayLimits(NamedTuple):
    """Which returns of no surface are few beside those of the surfaces around them."""

    ratio: float
    """Largest part of the returns of the 3 x 3 x 3 cells around."""
    few: float
    """As many are few whatever their ratio [returns]."""
    far_ratio: float
    """The same of those that were measured from afar."""
    afar: float
    """Times the mean range of the returns on surfaces."""
