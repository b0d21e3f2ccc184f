"""Planes that the LiDARs of a window see together, and the distances of points from them."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from recon4.calibration.tuning_joint import COMMON_PLANES
from recon4.geometry.se3 import Array


@dataclass(frozen=True, slots=True, eq=False)
class SharedSurfaces:
    """Points on planes; the points of a cube lie on one plane, whichever LiDAR saw them."""

    point: NDArray[np.intp]
    """Rows of the points, (M,)."""
    plane: NDArray[np.int64]
    """Row of the plane of each, (M,)."""
    center: Array
    """Centers of the planes [m], (V, 3)."""
    normal: Array
    """Unit normals, (V, 3)."""
    shared: NDArray[np.bool_]
    """Whether several LiDARs see the plane, (V,)."""
    cube: NDArray[np.int64]
    """Indices of the cube of each plane, (V, 3)."""

    def __len__(self) -> int:
        return len(self.center)


@dataclass(frozen=True, slots=True, eq=False)
class _Groups:
    """Points of one LiDAR in one cube."""

    count: Array
    mean: Array
    normal: Array
    is_plane: NDArray[np.bool_]


def find_surfaces(
    p: Array, sensor: NDArray[np.uint8], *, cube_m: float, max_sd_m: float, gate_m: float
) -> SharedSurfaces:
    """Divide points into cubes and keep those whose points lie on a plane.

    The points of each LiDAR must lie on a plane by themselves; the planes of two LiDARs in a cube
    may be apart, because that is what a calibration removes.

    Args:
        p: Points in one frame [m], (N, 3).
        sensor: Row of the LiDAR of each, (N,).
        cube_m: Edge of the cubes.
        max_sd_m: Largest standard deviation of the points of one LiDAR across its plane.
        gate_m: Largest distance between the planes of two LiDARs.
    """
    sensors = int(sensor.max()) + 1 if len(sensor) else 1
    cell = np.floor(p / cube_m).astype(np.int64)
    cube = _cube_rows(cell)
    listed, group = np.unique(cube * sensors + sensor, return_inverse=True)
    groups = _fit(p, group, len(listed), max_sd_m=max_sd_m)
    cube_of_group = listed // sensors
    kept = _agreeing(groups, cube_of_group, gate_m)
    planes, plane_of_group = np.unique(cube_of_group[kept], return_inverse=True)
    weight = groups.count[kept]
    total = np.bincount(plane_of_group, weight)
    center = _sums(plane_of_group, weight[:, None] * groups.mean[kept]) / total[:, None]
    leader = _leaders(plane_of_group, weight, len(planes))
    normal = groups.normal[kept][leader]
    row_of_group = np.full(len(listed), -1, np.int64)
    row_of_group[kept] = plane_of_group
    plane = row_of_group[group]
    point = np.flatnonzero(plane >= 0)
    cube_of_plane = np.empty((len(planes), 3), np.int64)
    cube_of_plane[plane[point]] = cell[point]
    shared = np.bincount(plane_of_group) > 1
    return SharedSurfaces(point, plane[point], center, normal, shared, cube_of_plane)


def _cube_rows(cell: NDArray[np.int64]) -> NDArray[np.int64]:
    cell = cell - cell.min(axis=0, initial=0)
    size = cell.max(axis=0, initial=0) + 1
    rows: NDArray[np.int64] = (cell[:, 0] * size[1] + cell[:, 1]) * size[2] + cell[:, 2]
    return rows


def _fit(p: Array, group: NDArray[np.intp], groups: int, *, max_sd_m: float) -> _Groups:
    count = np.bincount(group, minlength=groups).astype(np.float64)
    mean = _sums(group, p, groups) / count[:, None]
    d = p - mean[group]
    products = np.stack([d[:, i] * d[:, j] for i in range(3) for j in range(3)], axis=1)
    cov = (_sums(group, products, groups) / count[:, None]).reshape(-1, 3, 3)
    values, vectors = np.linalg.eigh(cov)
    is_plane = (
        (count >= COMMON_PLANES.min_points)
        & (values[:, 0] < max_sd_m**2)
        & (values[:, 1] > COMMON_PLANES.min_extent_m**2)
        & (values[:, 0] < 0.2 * values[:, 1])
    )
    return _Groups(count, mean, vectors[:, :, 0], is_plane)


def _agreeing(groups: _Groups, cube: NDArray[np.int64], gate_m: float) -> NDArray[np.intp]:
    """Groups that are a plane and agree with the largest group of their cube."""
    rows = np.flatnonzero(groups.is_plane)
    _, place = np.unique(cube[rows], return_inverse=True)
    leader = rows[_leaders(place, groups.count[rows], int(place.max(initial=-1)) + 1)][place]
    facing = np.abs(np.sum(groups.normal[rows] * groups.normal[leader], axis=1))
    apart = np.sum((groups.mean[rows] - groups.mean[leader]) * groups.normal[leader], axis=1)
    return rows[(facing > COMMON_PLANES.min_facing) & (np.abs(apart) < gate_m)]


def _leaders(place: NDArray[np.intp], weight: Array, places: int) -> NDArray[np.intp]:
    """Row with the largest weight in each place, (places,)."""
    order = np.lexsort((weight, place))
    last = np.searchsorted(place[order], np.arange(places), side="right") - 1
    return order[last]


def _sums(group: NDArray[np.intp], values: Array, groups: int = 0) -> Array:
    columns = [np.bincount(group, column, groups) for column in values.T]
    return np.stack(columns, axis=1, dtype=np.float64)
