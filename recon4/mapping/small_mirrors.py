"""Small mirrors: columns and doors clad with them, whose planes have no points of their own.

Their reflections lie where nothing can be seen: beams seem to cross a wall, a floor or a cupboard.
For each such point the surfaces of the room say in which planes it would be their reflection
(`recon4.kernels.mirror_planes`). Where many agree, the plane is fitted to them, and the mirror is
the rectangle with the most beams that show the room, less those that show something else. From
`MIRRORS.min_area_m2` on `find_mirrors` decides: a house behind a glass front is as large.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from recon4.geometry.se3 import Array
from recon4.kernels.cluster_rays import count_passes, find_crossing
from recon4.kernels.mirror_planes import Faces, ReflectionRules, propose_planes
from recon4.mapping.cell_runs import cell_keys
from recon4.mapping.mirrors import (
    Mirror,
    Sight,
    Steep,
    Wall,
    cells_of,
    match,
    reflections,
    steep_of,
)
from recon4.mapping.structure import indexed
from recon4.mapping.tuning import MIRRORS, SMALL_MIRRORS
from recon4.model.figures import MirrorFigures


def find_small_mirrors(sight: Sight, large: Sequence[Mirror]) -> list[Mirror]:
    """Find mirrors that `find_mirrors` misses, those that most beams propose first.

    Args:
        sight: A sample of the points of a leveled map.
        large: Mirrors that are known.
    """
    steep, direct = steep_of(sight), ~reflections(large, sight)
    crossing = _crossing(steep.sight, sight[np.flatnonzero(direct)])
    crossing &= ~reflections(large, steep.sight)
    beams = np.flatnonzero(crossing)
    beams = beams[:: 1 + len(beams) // SMALL_MIRRORS.most_beams]
    votes = _votes(steep, beams)
    found: list[Mirror] = []
    for _ in range(SMALL_MIRRORS.most_planes):
        best = _largest(votes)
        if not best.any():
            break
        mirror = _mirror(_fitted(_plane(votes[best], beams), steep), steep, crossing)
        if mirror is not None:
            found.append(_with_figures(mirror, sight))
            best |= mirror.reflects(steep.sight)[beams[votes[:, 0].astype(np.intp)]]
        votes = votes[~best]
    return found


def _crossing(of: Sight, sight: Sight) -> NDArray[np.bool_]:
    """Which beams seem to cross what stands, by where all others end, (N,)."""
    edge_m = SMALL_MIRRORS.cell_m
    rules = (edge_m, SMALL_MIRRORS.margin_m, SMALL_MIRRORS.farthest_m)
    cells = indexed(np.unique(cell_keys(np.floor(sight.point_m / edge_m).astype(np.int64))))
    counts = np.zeros((len(cells.key), 2), np.int64)
    each = np.arange(len(cells.key), dtype=np.int32)
    origin_m, end_m = (np.ascontiguousarray(p) for p in (sight.origin_m, sight.point_m))
    count_passes(origin_m, end_m, cells, each, rules, counts)
    stands = counts[:, 1] >= SMALL_MIRRORS.least_ends
    stands &= counts[:, 0] <= SMALL_MIRRORS.crossed_ratio * counts[:, 1]
    crosses = np.zeros(len(of.point_m), np.bool_)
    origin_m, end_m = (np.ascontiguousarray(p) for p in (of.origin_m, of.point_m))
    find_crossing(origin_m, end_m, cells, stands, rules, crosses)
    return crosses


@dataclass(frozen=True, slots=True, eq=False)
class _MirrorPlane:
    """A plane in which points would be reflections."""

    wall: Wall
    beams: NDArray[np.intp]
    """Rows of the points, (N,)."""


def _largest(votes: Array) -> NDArray[np.bool_]:
    """Which votes are of the plane that most points have in common, none if they are too few."""
    if not len(votes):
        return np.zeros(0, np.bool_)
    angle = np.arctan2(votes[:, 2], votes[:, 1]) / SMALL_MIRRORS.angle_rad
    angle = np.rint(angle) % round(2.0 * np.pi / SMALL_MIRRORS.angle_rad)
    steps = votes[:, 3] / SMALL_MIRRORS.offset_m, votes[:, 4] / SMALL_MIRRORS.along_m
    bins = np.stack([angle, *np.rint(steps)])
    which = np.unique(bins, axis=1, return_inverse=True)[1].ravel()
    count = np.bincount(np.unique(np.stack([which, votes[:, 0].astype(np.int64)]), axis=1)[0])
    return (which == np.argmax(count)) & (count.max() >= SMALL_MIRRORS.least_votes)


def _plane(votes: Array, beams: NDArray[np.intp]) -> _MirrorPlane:
    """The plane of some votes."""
    mean = np.append(votes[:, 1:3].mean(axis=0), 0.0)
    wall = Wall(mean / np.linalg.norm(mean), float(np.median(votes[:, 3])))
    return _MirrorPlane(wall, beams[np.unique(votes[:, 0]).astype(np.intp)])


def _votes(steep: Steep, beams: NDArray[np.intp]) -> Array:
    """Planes that each point proposes, rows of `propose_planes`, (V, 6)."""
    place = np.floor(steep.sight.point_m / SMALL_MIRRORS.surface_m)
    side = np.rint(1.5 * steep.normal)
    kinds = np.concatenate([place, side], axis=1).astype(np.int64)
    few = np.unique(kinds, axis=0, return_index=True)[1]
    few = few[np.argsort(steep.sight.point_m[few, 2])]
    room = Faces(steep.sight.point_m[few], steep.normal[few])
    shown = Faces(steep.sight.point_m[beams], steep.normal[beams])
    rules = ReflectionRules(
        MIRRORS.facing,
        SMALL_MIRRORS.aside_m,
        SMALL_MIRRORS.lift_m,
        MIRRORS.before_m,
        MIRRORS.behind_m,
    )
    votes = np.empty((64 * len(beams), 6))
    origin_m = np.ascontiguousarray(steep.sight.origin_m[beams])
    return votes[: propose_planes(shown, origin_m, room, rules, votes)]


def _fitted(plane: _MirrorPlane, steep: Steep) -> _MirrorPlane | None:
    """The plane in which its points lie best on surfaces; None = there is none near."""
    wall, beams = plane.wall, plane.beams
    point, given = steep.sight.point_m[beams], steep.normal[beams]
    for reach_m in SMALL_MIRRORS.reach_m:
        reach, nearest = steep.tree.query(
            wall.reflected(point), distance_upper_bound=MIRRORS.near_m
        )
        rows = np.flatnonzero(np.isfinite(reach))
        surface = steep.normal[nearest[rows]]
        turned = given[rows] - 2.0 * (given[rows] @ wall.normal)[:, None] * wall.normal
        away = wall.reflected(point[rows]) - steep.sight.point_m[nearest[rows]]
        off_m = np.einsum("ni,ni->n", away, surface)
        same = np.einsum("ni,ni->n", turned, surface) > MIRRORS.same_cosine
        same &= np.abs(off_m) < reach_m
        if np.count_nonzero(same) < SMALL_MIRRORS.least_votes:
            return None
        along = np.array([-wall.normal[1], wall.normal[0], 0.0])
        p, n = point[rows], surface
        by_turn = -2.0 * ((p @ along) * (n @ wall.normal) + wall.height(p) * (n @ along))
        slope = np.stack([by_turn, 2.0 * (n @ wall.normal)], axis=1)[same]
        turn, shift = np.linalg.lstsq(slope, -off_m[same], rcond=None)[0].tolist()
        if max(abs(turn), abs(shift)) > MIRRORS.near_m:
            return None
        normal = np.cos(turn) * wall.normal + np.sin(turn) * along
        wall = Wall(normal, wall.offset_m + shift)
    return _MirrorPlane(wall, beams)


def _mirror(plane: _MirrorPlane | None, steep: Steep, crossing: NDArray[np.bool_]) -> Mirror | None:
    """The rectangle of a plane that shows the room; None = it is no mirror.

    Args:
        plane: The plane, fitted.
        steep: Surfaces.
        crossing: Which of their beams seem to cross what stands, (N,).
    """
    if plane is None:
        return None
    wall = plane.wall
    behind = wall.height(steep.sight.point_m) < -MIRRORS.behind_m
    behind &= wall.height(steep.sight.origin_m) > MIRRORS.before_m
    beams = np.flatnonzero(behind & (np.abs(steep.normal @ wall.normal) > MIRRORS.facing))
    cells = cells_of(wall.crossed(steep.sight[beams]), SMALL_MIRRORS.grid_m)
    near_m = np.median(wall.crossed(steep.sight[plane.beams]), axis=0)
    center = cells_of(near_m, SMALL_MIRRORS.grid_m)
    near = (np.abs(cells - center) <= round(SMALL_MIRRORS.around_m / SMALL_MIRRORS.grid_m)).all(1)
    beams, cells = beams[near], cells[near]
    if len(beams) < SMALL_MIRRORS.min_beams:
        return None
    shows = np.abs(match(wall, steep, beams).off_m) < SMALL_MIRRORS.same_m
    low, high = _rectangle(cells, np.where(shows, 1.0, -SMALL_MIRRORS.other))
    inside = ((cells >= low) & (cells <= high)).all(axis=1)
    shown = np.count_nonzero(shows & inside)
    sides_m = (high - low + 1) * SMALL_MIRRORS.grid_m
    fits = sides_m.min() >= SMALL_MIRRORS.least_side_m and sides_m.prod() < MIRRORS.min_area_m2
    fits &= shown >= max(SMALL_MIRRORS.min_beams, SMALL_MIRRORS.min_ratio * inside.sum())
    if not fits or crossing[beams[inside]].mean() < SMALL_MIRRORS.min_crossing:
        return None
    if _is_seen_past(steep.sight, beams[shows & inside], through=beams[inside]):
        return None
    whole = np.argwhere(np.ones(high - low + 1, np.bool_)) + low
    middle_m = wall.place(0.5 * SMALL_MIRRORS.grid_m * np.asarray(low + high + 1, np.float64))
    figures = MirrorFigures(area_m2=float(sides_m.prod()), middle_m=middle_m, behind=0.0)
    return Mirror(wall, whole, figures, SMALL_MIRRORS.grid_m)


def _is_seen_past(sight: Sight, shown: NDArray[np.intp], *, through: NDArray[np.intp]) -> bool:
    """Whether what a mirror seems to show is seen by beams past it, too: then it is there.

    Args:
        sight: All beams.
        shown: Rows of beams that show the room.
        through: Rows of all beams through the mirror.
    """
    keys = cell_keys(np.floor(sight.point_m / SMALL_MIRRORS.cell_m).astype(np.int64))
    past = np.ones(len(keys), np.bool_)
    past[through] = False
    seen = np.isin(keys[shown], keys[past]).mean()
    return bool(seen > SMALL_MIRRORS.most_seen)


def _rectangle(
    cells: NDArray[np.int64], weight: Array
) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """First and last cell of the rectangle with the largest sum (Bentley 1984), (2,) each.

    Args:
        cells: Of each beam, (N, 2).
        weight: What it adds, some above 0, (N,).
    """
    least = cells.min(axis=0)
    table = np.zeros(np.ptp(cells, axis=0) + 1)
    np.add.at(table, tuple((cells - least).T), weight)
    sums = np.concatenate([np.zeros((1, table.shape[1])), table.cumsum(axis=0)])
    best, low, high = -np.inf, least, least
    for first in range(len(table)):
        columns = (sums[first + 1 :] - sums[first]).cumsum(axis=1)
        before = np.pad(columns[:, :-1], ((0, 0), (1, 0)))
        gain = columns - np.minimum.accumulate(before, axis=1)
        row, last = np.unravel_index(np.argmax(gain), gain.shape)
        if gain[row, last] > best:
            best = float(gain[row, last])
            begin = int(np.argmin(before[row, : last + 1]))
            low, high = np.array([[first, begin], [first + int(row), int(last)]]) + least
    return low, high


def _with_figures(mirror: Mirror, sight: Sight) -> Mirror:
    """The mirror with the part of all points that it reflects."""
    behind = float(mirror.reflects(sight).mean())
    figures = MirrorFigures(
        area_m2=mirror.figures.area_m2, middle_m=mirror.figures.middle_m, behind=behind
    )
    return Mirror(mirror.wall, mirror.cells, figures, mirror.grid_m)
