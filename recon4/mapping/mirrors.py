"""Mirrors in a map: walls through which a LiDAR sees the room before them a second time.

A mirror shows a room as still as the true one, so no registration contradicts it: the map has a
second room behind the wall. What gives it away are beams that cross a wall, and what they meet,
reflected in that wall, is a surface of the room before it. Only surfaces that face the wall count:
floor, ceiling and side walls look the same at every distance. A door between two like rooms is the
same for a LiDAR, but smaller than `_MIN_AREA_M2`.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree

from recon4.geometry.se3 import Array
from recon4.mapping.normals import local_normals

_CELL_M = 0.15
"""Cells of the normals, which come from three of them."""
_VERTICAL, _MIN_SUPPORT = 0.2, 8
"""Largest z of the normal of a wall; normals from fewer points do not count."""
_ANGLE_RAD, _OFFSET_M = float(np.deg2rad(3.0)), 0.1
"""Bins in which walls are searched."""
_MOST_WALLS = 24
_WALL_CELLS = 12
"""A wall covers at least this many cells of `_GRID_M`."""
_GRID_M = 0.25
"""Cells on a wall, in which beams cross it."""
_BEFORE_M, _BEHIND_M = 0.3, 0.4
"""Beams count that begin and end this far from the wall."""
_FACING = 0.5
"""Cosine between a surface's normal and that of the wall above which it faces it."""
_SAME_M, _SAME_COSINE = 0.12, 0.85
"""A reflected point lies on a surface within this, with the same normal."""
_MIN_BEAMS, _MIN_RATIO = 3, 0.75
"""A cell is mirrored if this many beams cross it, and this ratio of them shows the room before
it."""
_MIN_AREA_M2 = 2.5
_MOST_BEAMS = 20_000


@dataclass(frozen=True, slots=True, eq=False)
class Sight:
    """Points of a map with the positions of the sensor that saw them."""

    point_m: Array
    """(N, 3)."""
    origin_m: Array
    """(N, 3)."""

    def __getitem__(self, rows: NDArray[np.intp]) -> Sight:
        return Sight(self.point_m[rows], self.origin_m[rows])


@dataclass(frozen=True, slots=True)
class MirrorFound:
    """A wall that shows the room before it."""

    area_m2: float
    middle_m: tuple[float, float]
    """x and y of its middle in the map."""
    behind: float
    """Ratio of all points that lie behind it."""

    @property
    def text(self) -> str:
        """A sentence for the operator."""
        x, y = self.middle_m
        return (
            f"A mirror or a glass wall of about {self.area_m2:.0f} m² at x {x:.1f} m, y {y:.1f} m "
            f"doubles the room: what is mapped behind it ({100 * self.behind:.0f} % of all points) "
            "is the room before it, reflected. Leave these points out."
        )


@dataclass(frozen=True, slots=True, eq=False)
class _Wall:
    """A vertical plane ``normal . p = offset``; the normal points to the side of the carrier."""

    normal: Array
    offset_m: float

    def height(self, p: Array) -> Array:
        """Signed distance [m], (N, 3) -> (N,)."""
        return np.asarray(p @ self.normal - self.offset_m)

    def reflected(self, p: Array) -> Array:
        """Points in the mirror, (N, 3)."""
        return np.asarray(p - 2.0 * self.height(p)[:, None] * self.normal)

    def cells(self, p: Array) -> NDArray[np.int64]:
        """Cells of points on the wall: along it and in height, (N, 2)."""
        along = np.array([-self.normal[1], self.normal[0], 0.0])
        return np.floor(np.stack([p @ along, p[:, 2]], axis=1) / _GRID_M).astype(np.int64)


def find_mirrors(sight: Sight) -> list[MirrorFound]:
    """Find mirrors, the largest first.

    Args:
        sight: A sample of the points of a leveled map.
    """
    if len(sight.point_m) < _MIN_SUPPORT:
        return []
    center = sight.point_m.mean(axis=0)
    found = local_normals((sight.point_m - center).astype(np.float32), _CELL_M)
    normal = found.normal.astype(np.float64)
    known = found.support >= _MIN_SUPPORT
    walls = _walls(sight, normal, known & (np.abs(normal[:, 2]) < _VERTICAL))
    mirrors = [_mirror(wall, sight, normal, known=known) for wall in walls]
    return sorted((m for m in mirrors if m is not None), key=lambda m: -m.area_m2)


def _walls(sight: Sight, normal: Array, vertical: NDArray[np.bool_]) -> list[_Wall]:
    """The largest vertical planes, each once."""
    rows = np.flatnonzero(vertical)
    found: list[_Wall] = []
    center = sight.point_m.mean(axis=0)
    while len(rows) > _MIN_SUPPORT and len(found) < _MOST_WALLS:
        n, p = normal[rows, :2], sight.point_m[rows] - center
        angle = np.mod(np.arctan2(n[:, 1], n[:, 0]), np.pi)
        slot = np.rint(angle / _ANGLE_RAD) % round(np.pi / _ANGLE_RAD)
        axis = np.stack([np.cos(slot * _ANGLE_RAD), np.sin(slot * _ANGLE_RAD)], axis=1)
        shift = np.rint((p[:, :2] * axis).sum(axis=1) / _OFFSET_M)
        bins, which, count = np.unique(
            np.stack([slot, shift], axis=1), axis=0, return_inverse=True, return_counts=True
        )
        best = int(np.argmax(count))
        inside = rows[which.ravel() == best]
        wall = _fitted(sight[inside], normal[inside], bins[best, 0] * _ANGLE_RAD)
        near = np.abs(wall.height(sight.point_m[rows])) < _OFFSET_M
        near &= np.abs(normal[rows] @ wall.normal) > np.cos(2.0 * _ANGLE_RAD)
        used = rows[near]
        rows = np.setdiff1d(rows[~near], inside)
        if len(np.unique(wall.cells(sight.point_m[used]), axis=0)) >= _WALL_CELLS:
            found.append(wall)
        elif count[best] < _WALL_CELLS:
            break
    return found


def _fitted(sight: Sight, normal: Array, angle_rad: float) -> _Wall:
    axis = np.array([np.cos(angle_rad), np.sin(angle_rad), 0.0])
    mean = (normal * np.sign(normal @ axis)[:, None]).mean(axis=0) * [1.0, 1.0, 0.0]
    axis = mean / np.linalg.norm(mean)
    offset_m = float(np.median(sight.point_m @ axis))
    before = np.median(sight.origin_m @ axis) > offset_m
    return _Wall(axis, offset_m) if before else _Wall(-axis, -offset_m)


def _mirror(
    wall: _Wall, sight: Sight, normal: Array, *, known: NDArray[np.bool_]
) -> MirrorFound | None:
    """The part of a wall that shows the room before it; None = less than counts."""
    before, behind = wall.height(sight.origin_m), -wall.height(sight.point_m)
    crossing = (before > _BEFORE_M) & (behind > _BEHIND_M)
    facing = np.abs(normal @ wall.normal) > _FACING
    beams = np.flatnonzero(crossing & facing & known)
    beams = beams[:: 1 + len(beams) // _MOST_BEAMS]
    if len(beams) < _MIN_BEAMS:
        return None
    own = np.flatnonzero((behind < -_BEFORE_M) & known)
    if not len(own):
        return None
    tree = cKDTree(sight.point_m[own])
    reach, nearest = tree.query(wall.reflected(sight.point_m[beams]), distance_upper_bound=_SAME_M)
    met = np.isfinite(reach)
    turned = normal[beams] - 2.0 * (normal[beams] @ wall.normal)[:, None] * wall.normal
    nearest = own[np.where(met, nearest, 0)]
    met &= np.abs(np.einsum("ni,ni->n", turned, normal[nearest])) > _SAME_COSINE
    part = before[beams] / (before[beams] + behind[beams])
    ray = sight.point_m[beams] - sight.origin_m[beams]
    at = sight.origin_m[beams] + part[:, None] * ray
    _, which, count = np.unique(wall.cells(at), axis=0, return_inverse=True, return_counts=True)
    which = which.ravel()
    share = np.bincount(which, met) / count
    mirrored = (count >= _MIN_BEAMS) & (share >= _MIN_RATIO)
    area_m2 = float(mirrored.sum()) * _GRID_M**2
    if area_m2 < _MIN_AREA_M2:
        return None
    x, y, _ = at[mirrored[which]].mean(axis=0).tolist()
    return MirrorFound(area_m2, (x, y), float(crossing.mean()))
