"""Mirrors in a map: walls through which a LiDAR sees the room before them a second time.

A mirror shows a room as still as the true one, so no registration contradicts it: the map has a
second room behind the wall. What gives it away are beams that cross a wall, and what they meet,
reflected in that wall, is a surface of the room before it. Only surfaces that face the wall count:
floor, ceiling and side walls look the same at every distance. A room in which the carrier was is no
reflection. A door between two like rooms is the same for a LiDAR that stays in one of them, but
smaller than `MIRRORS.min_area_m2`.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import binary_dilation, label
from scipy.spatial import cKDTree

from recon4.errors import StoreError
from recon4.geometry.distinct import distinct
from recon4.geometry.se3 import Array
from recon4.kernels.mirror_planes import Beams, find_reflections
from recon4.mapping.normals import local_normals
from recon4.mapping.tuning import MIRRORS
from recon4.model.figures import MirrorFigures
from recon4.store.arrays import load_arrays, save_arrays


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
class Wall:
    """A vertical plane ``normal . p = offset``; the normal points to the side of the carrier."""

    normal: Array
    offset_m: float

    def height(self, p: Array) -> Array:
        """Signed distance [m], (N, 3) -> (N,)."""
        return np.asarray(p @ self.normal - self.offset_m)

    def reflected(self, p: Array) -> Array:
        """Points in the mirror, (N, 3)."""
        return np.asarray(p - 2.0 * self.height(p)[:, None] * self.normal)

    def on(self, p: Array) -> Array:
        """Places of points on the wall: along it and in height [m], (N, 3) -> (N, 2)."""
        along = np.array([-self.normal[1], self.normal[0], 0.0])
        return np.stack([p @ along, p[:, 2]], axis=1)

    def crossed(self, sight: Sight) -> Array:
        """Where beams that end behind the wall cross it, as `on` has it, (N, 2)."""
        before, behind = self.height(sight.origin_m), -self.height(sight.point_m)
        part = (before / (before + behind))[:, None]
        return self.on(sight.origin_m + part * (sight.point_m - sight.origin_m))

    def place(self, on_m: Array) -> tuple[float, float]:
        """Place in the map, without its height [m], of one on the wall, (2,)."""
        x, y, _ = self.normal * self.offset_m
        return float(x - on_m[0] * self.normal[1]), float(y + on_m[0] * self.normal[0])


@dataclass(frozen=True, slots=True, eq=False)
class Mirror:
    """The part of a wall that shows the room before it."""

    wall: Wall
    cells: NDArray[np.int64]
    """Cells on the wall, along it and in height, (K, 2)."""
    figures: MirrorFigures
    grid_m: float = MIRRORS.grid_m
    """Edge of a cell [m]."""

    def reflects(self, sight: Sight) -> NDArray[np.bool_]:
        """Which points are reflections: their beams cross the mirror, (N,)."""
        found = np.zeros(len(sight.point_m), np.bool_)
        low = self.cells.min(axis=0)
        mirrored = np.zeros(np.ptp(self.cells, axis=0) + 1, np.bool_)
        mirrored[tuple((self.cells - low).T)] = True
        x, y, _ = self.wall.normal.tolist()
        find_reflections(
            Beams(np.ascontiguousarray(sight.point_m), np.ascontiguousarray(sight.origin_m)),
            (x, y, self.wall.offset_m),
            MIRRORS.reflected_m,
            mirrored,
            (int(low[0]), int(low[1]), self.grid_m),
            found,
        )
        return found


def reflections(mirrors: Sequence[Mirror], sight: Sight) -> NDArray[np.bool_]:
    """Which points are reflections of any mirror, (N,)."""
    found = np.zeros(len(sight.point_m), np.bool_)
    for mirror in mirrors:
        found |= mirror.reflects(sight)
    return found


def cells_of(on_m: Array, grid_m: float) -> NDArray[np.int64]:
    """Cells of places on a wall, (N, 2)."""
    return np.floor(on_m / grid_m).astype(np.int64)


def save_mirrors(path: Path, mirrors: Sequence[Mirror]) -> None:
    """Write the planes and cells of mirrors."""
    cells = [mirror.cells for mirror in mirrors]
    save_arrays(
        path,
        {
            "normal": np.array([mirror.wall.normal for mirror in mirrors]).reshape(-1, 3),
            "offset_m": np.array([mirror.wall.offset_m for mirror in mirrors], np.float64),
            "area_m2": np.array([mirror.figures.area_m2 for mirror in mirrors], np.float64),
            "middle_m": np.array([mirror.figures.middle_m for mirror in mirrors]).reshape(-1, 2),
            "behind": np.array([mirror.figures.behind for mirror in mirrors], np.float64),
            "grid_m": np.array([mirror.grid_m for mirror in mirrors], np.float64),
            "count": np.array([len(one) for one in cells], np.int64),
            "cells": np.concatenate([np.empty((0, 2), np.int64), *cells]),
        },
    )


def load_mirrors(path: Path) -> list[Mirror]:
    """Read what `save_mirrors` wrote.

    Raises:
        StoreError: If the file is missing or damaged.
    """
    columns = ["normal", "offset_m", "area_m2", "middle_m", "behind", "grid_m", "count"]
    found = load_arrays(path, [*columns, "cells"])
    rows = {len(found[name]) for name in columns}
    if len(rows) != 1 or found["count"].sum() != len(found["cells"]):
        raise StoreError(f"{path.name}: expected as many rows of each column, got {rows}")
    ends = np.cumsum(found["count"])
    mirrors = []
    for k, (normal, offset_m, area_m2, middle_m, behind, grid_m, count) in enumerate(
        zip(*(found[name] for name in columns), strict=True)
    ):
        x, y = middle_m.tolist()
        figures = MirrorFigures(area_m2=float(area_m2), middle_m=(x, y), behind=float(behind))
        cells = found["cells"][ends[k] - count : ends[k]]
        mirrors.append(Mirror(Wall(normal, float(offset_m)), cells, figures, float(grid_m)))
    return mirrors


def find_mirrors(sight: Sight) -> list[Mirror]:
    """Find mirrors, the largest first.

    Args:
        sight: A sample of the points of a leveled map.
    """
    steep = steep_of(sight)
    mirrors = [_mirror(wall, steep, sight) for wall in _walls(steep)]
    return sorted((m for m in mirrors if m is not None), key=lambda m: -m.figures.area_m2)


def steep_of(sight: Sight) -> Steep:
    """The points of a sample that may face a wall."""
    if not len(sight.point_m):
        return Steep(sight, np.empty((0, 3)))
    center = sight.point_m.mean(axis=0)
    found = local_normals((sight.point_m - center).astype(np.float32), MIRRORS.cell_m)
    # What faces a wall is not level.
    rows = (found.support >= MIRRORS.min_support) & (
        np.abs(found.normal[:, 2]) < np.sqrt(1 - MIRRORS.facing**2)
    )
    kept = np.flatnonzero(rows)
    return Steep(sight[kept], _to_sensor(sight[kept], found.normal[kept].astype(np.float64)))


def _to_sensor(sight: Sight, normal: Array) -> Array:
    """Normals (N, 3) that point to the side from which their points were seen."""
    side = np.einsum("ni,ni->n", normal, sight.origin_m - sight.point_m)
    return np.where(side[:, None] < 0.0, -normal, normal)


@dataclass(frozen=True, eq=False)
class Steep:
    """Points on surfaces that are not level, with their normals, (N, 3)."""

    sight: Sight
    normal: Array
    """To the side that was seen."""

    @cached_property
    def tree(self) -> cKDTree:
        """Of all points."""
        return cKDTree(self.sight.point_m, balanced_tree=False, compact_nodes=False)


def _walls(steep: Steep) -> list[Wall]:
    """The largest vertical planes, each once."""
    rows = np.flatnonzero(np.abs(steep.normal[:, 2]) < MIRRORS.vertical)
    rows = rows[:: 1 + len(rows) // MIRRORS.most_points]
    found: list[Wall] = []
    while len(rows) > MIRRORS.min_support and len(found) < MIRRORS.most_walls:
        slot, key = _bins(steep, rows)
        count = np.bincount(key)
        best = int(np.argmax(count))
        inside = key == best
        angle_rad = float(slot[inside][0]) * MIRRORS.angle_rad
        of_bin = rows[inside]
        wall = _fitted(steep.sight[of_bin], steep.normal[of_bin], angle_rad)
        place = steep.sight.point_m[rows]
        near = np.abs(wall.height(place)) < MIRRORS.offset_m
        near &= np.abs(steep.normal[rows] @ wall.normal) > np.cos(2.0 * MIRRORS.angle_rad)
        cells = cells_of(wall.on(place[near]), MIRRORS.grid_m)
        if len(np.unique(cells, axis=0)) >= MIRRORS.wall_cells:
            found.append(wall)
        elif count[best] < MIRRORS.wall_cells:
            break
        rows = rows[~(near | inside)]
    return found


def _bins(steep: Steep, rows: NDArray[np.intp]) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """Bin of the direction of each normal, and of direction and offset together, (N,) each."""
    n, p = steep.normal[rows, :2], steep.sight.point_m[rows, :2]
    angle = np.mod(np.arctan2(n[:, 1], n[:, 0]), np.pi)
    slots = round(np.pi / MIRRORS.angle_rad)
    slot = np.rint(angle / MIRRORS.angle_rad).astype(np.int64) % slots
    axis = np.stack([np.cos(slot * MIRRORS.angle_rad), np.sin(slot * MIRRORS.angle_rad)], axis=1)
    shift = np.rint((p * axis).sum(axis=1) / MIRRORS.offset_m).astype(np.int64)
    return slot, (shift - shift.min()) * slots + slot


def _fitted(sight: Sight, normal: Array, angle_rad: float) -> Wall:
    axis = np.array([np.cos(angle_rad), np.sin(angle_rad), 0.0])
    mean = (normal * np.sign(normal @ axis)[:, None]).mean(axis=0) * [1.0, 1.0, 0.0]
    if (length := float(np.linalg.norm(mean))) > 0.0:  # else all are across the axis of their bin
        axis = mean / length
    offset_m = float(np.median(sight.point_m @ axis))
    before = np.median(sight.origin_m @ axis) > offset_m
    return Wall(axis, offset_m) if before else Wall(-axis, -offset_m)


def _mirror(wall: Wall, steep: Steep, every: Sight) -> Mirror | None:
    """The part of a wall that shows the room before it; None = less than counts."""
    beams = _through(wall, steep)
    if len(beams) * MIRRORS.grid_m**2 < MIRRORS.min_area_m2:
        return None
    wall = Wall(wall.normal, wall.offset_m + _hangs_before_m(wall, steep, beams))
    sight = steep.sight[beams]
    met = np.abs(match(wall, steep, beams).off_m) < MIRRORS.same_m
    on_m = wall.crossed(sight)
    cells, which, count = np.unique(
        cells_of(on_m, MIRRORS.grid_m), axis=0, return_inverse=True, return_counts=True
    )
    which = which.ravel()
    shown = np.bincount(which[met], minlength=len(count))
    mirrored = (count >= MIRRORS.min_beams) & (shown >= MIRRORS.min_ratio * count)
    mirrored &= _opening_ratio(cells, count, shown) >= MIRRORS.opening_ratio
    area_m2 = float(mirrored.sum()) * MIRRORS.grid_m**2
    if area_m2 < MIRRORS.min_area_m2 or _is_entered(
        wall, steep, sight.point_m[met & mirrored[which]]
    ):
        return None
    middle_m = wall.place(on_m[mirrored[which]].mean(axis=0))
    crossing = wall.height(every.origin_m) > MIRRORS.before_m
    crossing &= wall.height(every.point_m) < -MIRRORS.behind_m
    figures = MirrorFigures(area_m2=area_m2, middle_m=middle_m, behind=float(crossing.mean()))
    other = (count >= MIRRORS.min_beams) & (shown < (1.0 - MIRRORS.min_ratio) * count)
    return Mirror(
        wall,
        _whole(wall, every[np.flatnonzero(crossing)], cells[mirrored], but=cells[other]),
        figures,
    )


def _through(wall: Wall, steep: Steep) -> NDArray[np.intp]:
    """Rows of points that face a wall and whose beams cross it, (M,)."""
    crossing = wall.height(steep.sight.origin_m) > MIRRORS.before_m
    crossing &= wall.height(steep.sight.point_m) < -MIRRORS.behind_m
    beams = np.flatnonzero(crossing)
    beams = beams[np.abs(steep.normal[beams] @ wall.normal) > MIRRORS.facing]
    return beams[:: 1 + len(beams) // MIRRORS.most_beams]


@dataclass(frozen=True, slots=True, eq=False)
class MirrorMatch:
    """Surfaces near points that a wall reflects. M points."""

    off_m: Array
    """From the plane of the surface to the reflected point, inf = there is none like it, (M,)."""
    facing: Array
    """Cosine between the normals of surface and wall, (M,)."""


def match(wall: Wall, steep: Steep, beams: NDArray[np.intp]) -> MirrorMatch:
    """The surfaces that points (M,) would be on if the wall were a mirror."""
    normal, reflected = steep.normal[beams], wall.reflected(steep.sight.point_m[beams])
    reach, nearest = steep.tree.query(reflected, distance_upper_bound=MIRRORS.near_m)
    met = np.isfinite(reach)
    nearest = np.where(met, nearest, 0)
    surface = steep.normal[nearest]
    turned = normal - 2.0 * (normal @ wall.normal)[:, None] * wall.normal
    # A mirror shows the side that faces it. In a row of columns, each as far from the next, a plane
    # of their fronts maps columns onto columns, but onto their other sides.
    met &= np.einsum("ni,ni->n", turned, surface) > MIRRORS.same_cosine
    off_m = np.einsum("ni,ni->n", reflected - steep.sight.point_m[nearest], surface)
    return MirrorMatch(np.where(met, off_m, np.inf), surface @ wall.normal)


def _hangs_before_m(wall: Wall, steep: Steep, beams: NDArray[np.intp]) -> float:
    """How far before its wall a mirror hangs [m]: half of what its reflections are off.

    No mirror is inside of a wall, nor far before it: two like flights of stairs on both sides of
    a wall or of a well mirror each other there. Then it is 0.
    """
    side = steep.normal[np.abs(wall.height(steep.sight.point_m)) < MIRRORS.offset_m] @ wall.normal
    found = match(wall, steep, beams)
    met = np.isfinite(found.off_m)
    if not met.any() or np.median(side[np.abs(side) > np.cos(2.0 * MIRRORS.angle_rad)]) < 0.0:
        return 0.0
    before_m = -0.5 * float(np.median(found.off_m[met] / found.facing[met]))
    return before_m if 0.0 < before_m < MIRRORS.hangs_m else 0.0


def _whole(
    wall: Wall, through: Sight, mirrored: NDArray[np.int64], *, but: NDArray[np.int64]
) -> NDArray[np.int64]:
    """All cells of the openings that mirrored ones are in, and their rims, (K, 2).

    Most beams end at a floor or a wall that says nothing; but no beam crosses a wall.

    Args:
        wall: The wall.
        through: Beams that cross it.
        mirrored: Cells that show the room before the wall, (M, 2).
        but: Cells that show something else, (L, 2).
    """
    at = cells_of(wall.crossed(through), MIRRORS.grid_m)
    low = np.minimum(at.min(axis=0), mirrored.min(axis=0))
    crossed = np.zeros(np.maximum(at.max(axis=0), mirrored.max(axis=0)) - low + 1, np.bool_)
    crossed[tuple((at - low).T)] = True
    inside = ((but >= low) & (but < low + crossed.shape)).all(axis=1)
    crossed[tuple((but[inside] - low).T)] = False
    crossed[tuple((mirrored - low).T)] = True
    opening = label(crossed)[0]
    wanted = distinct(opening[tuple((mirrored - low).T)])
    whole = np.pad(np.isin(opening, wanted), 1)
    return np.argwhere(binary_dilation(whole, np.ones((3, 3)))) + low - 1


def _opening_ratio(
    cells: NDArray[np.int64], count: NDArray[np.intp], shown: NDArray[np.intp]
) -> Array:
    """Ratio of beams that show the room before the wall, in the opening of each cell, (N,).

    An opening is all cells in a row that enough beams cross. All of a mirror shows reflections; of
    the space over the wall between two flights of stairs, which are alike, a part seems to.

    Args:
        cells: Cells that beams cross, (N, 2).
        count: Beams through each, (N,).
        shown: Those of them that show the room, (N,).
    """
    at = tuple((cells - cells.min(axis=0)).T)
    crossed = np.zeros(np.ptp(cells, axis=0) + 1, np.bool_)
    crossed[at] = count >= MIRRORS.min_beams
    opening = label(crossed)[0][at]
    every, shows = (np.bincount(opening, values) for values in (count, shown))
    return np.asarray((shows / np.maximum(every, 1))[opening])


def _is_entered(wall: Wall, steep: Steep, reflected: Array) -> bool:
    """Whether what looks like a reflection, (N, 3), was seen from behind the wall, too."""
    inside = np.flatnonzero(wall.height(steep.sight.origin_m) < -MIRRORS.before_m)
    if not len(inside):
        return False
    tree = cKDTree(steep.sight.point_m[inside], balanced_tree=False, compact_nodes=False)
    reach, _ = tree.query(reflected, distance_upper_bound=MIRRORS.entered_m)
    return bool(np.isfinite(reach).mean() > MIRRORS.entered_ratio)
