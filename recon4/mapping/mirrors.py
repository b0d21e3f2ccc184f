"""Mirrors in a map: walls through which a LiDAR sees the room before them a second time.

A mirror shows a room as still as the true one, so no registration contradicts it: the map has a
second room behind the wall. What gives it away are beams that cross a wall, and what they meet,
reflected in that wall, is a surface of the room before it. Only surfaces that face the wall count:
floor, ceiling and side walls look the same at every distance. A room in which the carrier was is no
reflection. A door between two like rooms is the same for a LiDAR that stays in one of them, but
smaller than `_MIN_AREA_M2`.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree

from recon4.geometry.se3 import Array
from recon4.mapping.normals import local_normals
from recon4.model.figures import MirrorFigures

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
_ENTERED_RATIO = 0.5
"""A room is real if this ratio of it was seen from behind the wall, too."""
_MOST_BEAMS, _MOST_POINTS = 20_000, 60_000
"""No more beams through a wall, and points on walls, are used."""


@dataclass(frozen=True, slots=True, eq=False)
class Sight:
    """Points of a map with the positions of the sensor that saw them."""

    point_m: Array
    """(N, 3)."""
    origin_m: Array
    """(N, 3)."""

    def __getitem__(self, rows: NDArray[np.intp]) -> Sight:
        return Sight(self.point_m[rows], self.origin_m[rows])


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


def find_mirrors(sight: Sight) -> list[MirrorFigures]:
    """Find mirrors, the largest first.

    Args:
        sight: A sample of the points of a leveled map.
    """
    if len(sight.point_m) < _MIN_SUPPORT:
        return []
    center = sight.point_m.mean(axis=0)
    found = local_normals((sight.point_m - center).astype(np.float32), _CELL_M)
    # What faces a wall is not level.
    rows = (found.support >= _MIN_SUPPORT) & (np.abs(found.normal[:, 2]) < np.sqrt(1 - _FACING**2))
    kept = np.flatnonzero(rows)
    if not len(kept):
        return []
    steep = _Steep(sight[kept], _to_sensor(sight[kept], found.normal[kept].astype(np.float64)))
    mirrors = [_mirror(wall, steep, sight) for wall in _walls(steep)]
    return sorted((m for m in mirrors if m is not None), key=lambda m: -m.area_m2)


def _to_sensor(sight: Sight, normal: Array) -> Array:
    """Normals (N, 3) that point to the side from which their points were seen."""
    side = np.einsum("ni,ni->n", normal, sight.origin_m - sight.point_m)
    return np.where(side[:, None] < 0.0, -normal, normal)


@dataclass(frozen=True, eq=False)
class _Steep:
    """Points on surfaces that are not level, with their normals, (N, 3)."""

    sight: Sight
    normal: Array
    """To the side that was seen."""

    @cached_property
    def tree(self) -> cKDTree:
        """Of all points."""
        return cKDTree(self.sight.point_m, balanced_tree=False, compact_nodes=False)


def _walls(steep: _Steep) -> list[_Wall]:
    """The largest vertical planes, each once."""
    rows = np.flatnonzero(np.abs(steep.normal[:, 2]) < _VERTICAL)
    rows = rows[:: 1 + len(rows) // _MOST_POINTS]
    found: list[_Wall] = []
    while len(rows) > _MIN_SUPPORT and len(found) < _MOST_WALLS:
        slot, key = _bins(steep, rows)
        count = np.bincount(key)
        best = int(np.argmax(count))
        inside = key == best
        angle_rad = float(slot[inside][0]) * _ANGLE_RAD
        of_bin = rows[inside]
        wall = _fitted(steep.sight[of_bin], steep.normal[of_bin], angle_rad)
        place = steep.sight.point_m[rows]
        near = np.abs(wall.height(place)) < _OFFSET_M
        near &= np.abs(steep.normal[rows] @ wall.normal) > np.cos(2.0 * _ANGLE_RAD)
        if len(np.unique(wall.cells(place[near]), axis=0)) >= _WALL_CELLS:
            found.append(wall)
        elif count[best] < _WALL_CELLS:
            break
        rows = rows[~(near | inside)]
    return found


def _bins(steep: _Steep, rows: NDArray[np.intp]) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """Bin of the direction of each normal, and of direction and offset together, (N,) each."""
    n, p = steep.normal[rows, :2], steep.sight.point_m[rows, :2]
    angle = np.mod(np.arctan2(n[:, 1], n[:, 0]), np.pi)
    slots = round(np.pi / _ANGLE_RAD)
    slot = np.rint(angle / _ANGLE_RAD).astype(np.int64) % slots
    axis = np.stack([np.cos(slot * _ANGLE_RAD), np.sin(slot * _ANGLE_RAD)], axis=1)
    shift = np.rint((p * axis).sum(axis=1) / _OFFSET_M).astype(np.int64)
    return slot, (shift - shift.min()) * slots + slot


def _fitted(sight: Sight, normal: Array, angle_rad: float) -> _Wall:
    axis = np.array([np.cos(angle_rad), np.sin(angle_rad), 0.0])
    mean = (normal * np.sign(normal @ axis)[:, None]).mean(axis=0) * [1.0, 1.0, 0.0]
    if (length := float(np.linalg.norm(mean))) > 0.0:  # else all are across the axis of their bin
        axis = mean / length
    offset_m = float(np.median(sight.point_m @ axis))
    before = np.median(sight.origin_m @ axis) > offset_m
    return _Wall(axis, offset_m) if before else _Wall(-axis, -offset_m)


def _mirror(wall: _Wall, steep: _Steep, every: Sight) -> MirrorFigures | None:
    """The part of a wall that shows the room before it; None = less than counts."""
    sight, normal = steep.sight, steep.normal
    before, behind = wall.height(sight.origin_m), -wall.height(sight.point_m)
    beams = np.flatnonzero((before > _BEFORE_M) & (behind > _BEHIND_M))
    beams = beams[np.abs(normal[beams] @ wall.normal) > _FACING]
    beams = beams[:: 1 + len(beams) // _MOST_BEAMS]
    if len(beams) * _GRID_M**2 < _MIN_AREA_M2:
        return None
    point, origin = sight.point_m[beams], sight.origin_m[beams]
    reach, nearest = steep.tree.query(wall.reflected(point), distance_upper_bound=_SAME_M)
    met = np.isfinite(reach)
    turned = normal[beams] - 2.0 * (normal[beams] @ wall.normal)[:, None] * wall.normal
    like = np.einsum("ni,ni->n", turned, normal[np.where(met, nearest, 0)])
    # A mirror shows the side that faces it. In a row of columns, each as far from the next, a plane
    # of their fronts maps columns onto columns, but onto their other sides.
    met &= like > _SAME_COSINE
    part = before[beams] / (before[beams] + behind[beams])
    at = origin + part[:, None] * (point - origin)
    _, which, count = np.unique(wall.cells(at), axis=0, return_inverse=True, return_counts=True)
    which = which.ravel()
    mirrored = (count >= _MIN_BEAMS) & (np.bincount(which, met) >= _MIN_RATIO * count)
    area_m2 = float(mirrored.sum()) * _GRID_M**2
    if area_m2 < _MIN_AREA_M2 or _is_entered(wall, steep, point[met & mirrored[which]]):
        return None
    x, y, _ = at[mirrored[which]].mean(axis=0).tolist()
    crossing = wall.height(every.origin_m) > _BEFORE_M
    crossing &= wall.height(every.point_m) < -_BEHIND_M
    return MirrorFigures(area_m2=area_m2, middle_m=(x, y), behind=float(crossing.mean()))


def _is_entered(wall: _Wall, steep: _Steep, reflected: Array) -> bool:
    """Whether what looks like a reflection, (N, 3), was seen from behind the wall, too."""
    inside = np.flatnonzero(wall.height(steep.sight.origin_m) < -_BEFORE_M)
    if not len(inside):
        return False
    tree = cKDTree(steep.sight.point_m[inside], balanced_tree=False, compact_nodes=False)
    reach, _ = tree.query(reflected, distance_upper_bound=_SAME_M)
    return bool(np.isfinite(reach).mean() > _ENTERED_RATIO)
