"""Double walls: one surface that two visits place at two positions.

The map is cut into patches (a cell, and the side it was seen from), and each patch into visits
(windows of time). Within a visit a surface is sharp. If the separation of two groups of visits
exceeds what noise and pose errors explain, the wall is double. Equations:
``docs/how-to/slices.md``.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from recon4.errors import ConfigError
from recon4.geometry.se3 import Array
from recon4.kernels.doubles import COLUMNS, best_split, gather
from recon4.locales.coded import CodedText
from recon4.mapping.tiles import Tile, TileSet
from recon4.progress import Progress, Silent
from recon4.slices.double_places import DoubleReport, Patches, report
from recon4.slices.tuning import DOUBLE_WALLS


@dataclass(frozen=True, slots=True, kw_only=True)
class DoubleRule:
    """Thresholds of the double wall check."""

    cell_m: float = 0.12
    """Width of a patch [m]: a step in a wall lies in few of them."""
    depth: int = 3
    """Length of a patch along its normal, in widths."""
    window_s: float = 5.0
    """Points closer in time belong to one visit [s]."""
    min_points: int = 20
    """Smallest number of points of each of the two groups."""
    min_ratio: float = 0.10
    """Smallest fraction of the patch's points in each of the two groups."""
    max_sigma_m: float = 0.04
    """Largest thickness of a surface within a visit [m] (standard deviation)."""
    min_spread_m: float = 0.02
    """Smallest extent of a surface [m] (standard deviation along it)."""
    max_aside_m: float = 0.04
    """Largest distance of the centers of the two groups along the surface [m]."""
    pose_sigma_m: float = 0.007
    """Standard deviation of the position of a surface between visits of a good map [m]."""
    z: float = 3.0
    """Significance limit in standard deviations."""
    correlated: float = 10.0
    """Number of neighboring points per independent measurement (same beam and angle)."""


def find_double_walls(
    tiles: TileSet, *, rule: DoubleRule | None = None, progress: Progress | None = None
) -> DoubleReport:
    """Find double walls among the surfaces visited twice. Memory is that of one tile.

    Args:
        tiles: The map, with normals.
        rule: Thresholds; None = the defaults.
        progress: Counts points.

    Raises:
        ConfigError: If the map has no normals or times.
    """
    rule, progress = rule or DoubleRule(), progress or Silent()
    missing = {"normal", "t_ns", "frame_id"} - set(tiles.fields)
    if missing:
        raise ConfigError(CodedText("doubles-fields", missing=str(sorted(missing))))
    progress.start("double walls", len(tiles), "points")
    # Points moved onto a common surface would hide that it was measured at two places.
    tiles = tiles.as_measured()
    first_ns = tiles.first_ns
    found, split = [], []
    for tile in tiles:
        visits = _visits(tile, rule, first_ns)
        inner = _inner(visits, tile, rule, tile_m=tiles.tile_m)
        found.append(_judge(visits.take(inner), rule))
        split.append(visits.take(~inner))
        progress.advance(len(tile))
    found.append(_judge(_merged(split), rule))
    return report([patches for patches in found if len(patches.points)], len(tiles))


@dataclass(frozen=True, slots=True, eq=False)
class _Visits:
    """Points of one patch in one window of time, as columns (K,)."""

    cell: NDArray[np.int64]
    """The cell in the middle of the patch, counted from the map's origin, (K, 3)."""
    face: NDArray[np.int64]
    """Axis of its normal, twice, plus 1 if it looks down the axis."""
    window: NDArray[np.int64]
    sums: Array
    """As `recon4.kernels.doubles` makes them, (K, 12)."""

    def take(self, rows: NDArray[Any]) -> _Visits:
        """Some of them."""
        return _Visits(self.cell[rows], self.face[rows], self.window[rows], self.sums[rows])

    def patches(self) -> NDArray[np.int64]:
        """Number of the patch of each row, the same for all its visits."""
        low = self.cell.min(axis=0, initial=0)
        side = self.cell.max(axis=0, initial=0) - low + 1
        i, j, k = (self.cell - low).T
        return ((k * side[1] + j) * side[0] + i) * 6 + self.face


def _visits(tile: Tile, rule: DoubleRule, first_ns: int) -> _Visits:
    columns = tile.read(["xyz", "normal", "t_ns", "frame_id"])
    # One more layer of cells on all sides: cell centers may lie outside of the points.
    base = np.floor((np.array(tile.low_m) - 1e-4) / rule.cell_m).astype(np.int64) - rule.depth
    low = base.astype(np.float64) * rule.cell_m
    side = int(np.ceil(np.max(np.array(tile.high_m) - low) / rule.cell_m)) + rule.depth + 1
    size, used = DOUBLE_WALLS.first_table, -1
    while used < 0:
        keys, sums = np.full(size, -1, np.int64), np.zeros((size, COLUMNS))
        used = 0
        for first in range(0, len(tile), DOUBLE_WALLS.block):
            rows = slice(first, first + DOUBLE_WALLS.block)
            used = gather(
                columns["xyz"][rows],
                columns["normal"][rows].view(np.uint16),
                columns["t_ns"][rows],
                columns["frame_id"][rows],
                first_ns,
                int(rule.window_s * 1e9),
                low - tile.origin_m,
                base,
                rule.cell_m,
                rule.depth,
                side,
                keys,
                sums,
                used,
            )
            if used < 0:
                size *= 2
                break
    taken = keys >= 0
    return _unpacked(keys[taken], sums[taken], base, side=side)


def _unpacked(
    keys: NDArray[np.int64], sums: Array, base: NDArray[np.int64], *, side: int
) -> _Visits:
    cell, face = np.divmod(keys, 6)
    rest, i = np.divmod(cell, side)
    rest, j = np.divmod(rest, side)
    window, k = np.divmod(rest, side)
    return _Visits(np.stack([i, j, k], axis=1) + base, face, window, sums)


def _inner(visits: _Visits, tile: Tile, rule: DoubleRule, *, tile_m: float) -> NDArray[np.bool_]:
    """Mask of the patches that lie completely in the tile."""
    half = np.zeros((len(visits.face), 3), np.int64)
    np.put_along_axis(half, visits.face[:, None] // 2, rule.depth // 2, axis=1)
    low = (visits.cell - half) * rule.cell_m - tile.origin_m
    high = (visits.cell + half + 1) * rule.cell_m - tile.origin_m
    return np.asarray(np.all((low > 0.0) & (high < tile_m), axis=1))


def _merged(parts: list[_Visits]) -> _Visits:
    """Merge patches that lie in several tiles."""
    if not parts:
        return _Visits(
            np.empty((0, 3), np.int64), np.empty(0, np.int64), np.empty(0, np.int64),
            np.empty((0, COLUMNS)),
        )  # fmt: skip
    every = _Visits(
        np.concatenate([p.cell for p in parts]),
        np.concatenate([p.face for p in parts]),
        np.concatenate([p.window for p in parts]),
        np.concatenate([p.sums for p in parts]),
    )
    order = np.lexsort([every.window, every.patches()])
    every = every.take(order)
    same = np.diff(every.patches()) == 0
    start = np.flatnonzero(np.concatenate([[True], ~(same & (np.diff(every.window) == 0))]))
    start = start[: len(order)]
    if not len(start):
        return every
    sums = np.add.reduceat(every.sums, start, axis=0)
    sums[:, 10] = np.minimum.reduceat(every.sums[:, 10], start)
    sums[:, 11] = np.maximum.reduceat(every.sums[:, 11], start)
    first = every.take(start)
    return _Visits(first.cell, first.face, first.window, sums)


def _judge(visits: _Visits, rule: DoubleRule) -> Patches:
    """Flat patches with at least two visits, and which of them are double."""
    visits = visits.take(visits.sums[:, 0] >= 8.0)  # too few points for a position
    visits = visits.take(np.lexsort([visits.window, visits.patches()]))
    _, owner, count = np.unique(visits.patches(), return_inverse=True, return_counts=True)
    visits = visits.take(count[owner] >= 2)
    _, first, owner, count = np.unique(
        visits.patches(), return_index=True, return_inverse=True, return_counts=True
    )
    start = np.append(first, len(owner)).astype(np.int64)
    sums, total = visits.sums, np.bincount(owner, visits.sums[:, 0], len(first))
    within = np.add.reduceat(_scatter(sums), first) if len(first) else np.empty((0, 3, 3))
    values, vectors = np.linalg.eigh(within)
    normal = vectors[:, :, 0]
    along = np.einsum("kd,kd->k", sums[:, 1:4] / sums[:, :1], normal[owner])
    lower = _lower_group(start, sums[:, 0], along)
    sigma = np.sqrt(np.maximum(values[:, 0], 0.0) / np.maximum(total - count, 1.0))
    spread = np.sqrt(np.maximum(values[:, 1], 0.0) / np.maximum(total, 1.0))
    groups = [
        _group(visits, along, mask, owner=owner, patches=len(first)) for mask in (lower, ~lower)
    ]
    return _patches(visits.take(first), rule, shape=(normal, sigma, spread), groups=groups)


def _scatter(sums: Array) -> Array:
    """Scatter of each window about its own mean, (K, 3, 3)."""
    upper = sums[:, 4:10]
    full = upper[:, [0, 1, 2, 1, 3, 4, 2, 4, 5]].reshape(-1, 3, 3)
    mean = sums[:, 1:4] / sums[:, :1]
    return full - sums[:, 0, None, None] * mean[:, :, None] * mean[:, None, :]


def _lower_group(start: NDArray[np.int64], n: Array, along: Array) -> NDArray[np.bool_]:
    owner = np.repeat(np.arange(len(start) - 1), np.diff(start))
    order = np.lexsort([along, owner])
    split = np.zeros(len(start) - 1, np.int64)
    best_split(start, n, along, order, split)
    rank = np.arange(len(along)) - start[owner]
    lower = np.zeros(len(along), np.bool_)
    lower[order] = rank < split[owner]
    return lower


@dataclass(frozen=True, slots=True, eq=False)
class _Group:
    """One of the two groups of visits of each patch, as columns (P,)."""

    n: Array
    along_m: Array
    mean_m: Array
    windows: Array
    """First and last, (P, 2)."""
    frames: Array
    """First and last multiframe, (P, 2)."""


def _group(
    visits: _Visits,
    along: Array,
    mask: NDArray[np.bool_],
    *,
    owner: NDArray[np.intp],
    patches: int,
) -> _Group:
    mine, sums = owner[mask], visits.sums[mask]

    def total(values: Array) -> Array:
        return np.bincount(mine, values, patches).astype(np.float64)

    def ends(low: Array, high: Array) -> Array:
        out = np.tile([np.inf, -np.inf], (patches, 1))
        np.minimum.at(out[:, 0], mine, low)
        np.maximum.at(out[:, 1], mine, high)
        return out

    n = total(sums[:, 0])
    safe = np.maximum(n, 1.0)
    window = visits.window[mask].astype(np.float64)
    return _Group(
        n=n,
        along_m=total(sums[:, 0] * along[mask]) / safe,
        mean_m=np.stack([total(sums[:, a]) / safe for a in (1, 2, 3)], axis=1),
        windows=ends(window, window + 1.0),
        frames=ends(sums[:, 10], sums[:, 11]),
    )


def _patches(
    patch: _Visits, rule: DoubleRule, *, shape: tuple[Array, Array, Array], groups: list[_Group]
) -> Patches:
    normal, sigma, spread = shape
    a, b = groups
    total = np.maximum(a.n + b.n, 1.0)
    separation = b.along_m - a.along_m
    step = b.mean_m - a.mean_m
    aside = np.linalg.norm(step - separation[:, None] * normal, axis=1)
    limit = limit_m(sigma, a.n, b.n, rule=rule)
    share = np.minimum(a.n, b.n) / total
    flat = (sigma <= rule.max_sigma_m) & (spread >= rule.min_spread_m)
    flat &= (np.minimum(a.n, b.n) >= rule.min_points) & (share >= rule.min_ratio)
    flat &= aside <= rule.max_aside_m
    # Between the faces of a thin wall normals are unreliable; such points fit another plane.
    flat &= np.abs(np.take_along_axis(normal, patch.face[:, None] // 2, axis=1)[:, 0]) >= 0.5
    mean = (a.n[:, None] * a.mean_m + b.n[:, None] * b.mean_m) / total[:, None]
    middle = (patch.cell + 0.5) * rule.cell_m + mean
    return Patches(
        middle_m=middle[flat],
        normal=normal[flat],
        sigma_m=sigma[flat],
        separation_m=separation[flat],
        limit_m=limit[flat],
        share=share[flat],
        points=total[flat],
        spans_s=np.stack([a.windows, b.windows], axis=1)[flat] * rule.window_s,
        frames=np.stack([a.frames, b.frames], axis=1)[flat],
        double=(separation > limit)[flat],
    )


def limit_m(sigma_m: Array, n_a: Array, n_b: Array, *, rule: DoubleRule) -> Array:
    """Largest separation explained by noise and good poses [m], (P,).

    ``z * sqrt(sigma^2 c (1 / n_a + 1 / n_b) + 2 pose_sigma^2)``: the noise of two means, of which
    ``c`` neighboring points count as one, and of two poses.
    """
    noise = sigma_m**2 * rule.correlated * (1.0 / np.maximum(n_a, 1.0) + 1.0 / np.maximum(n_b, 1.0))
    out: Array = rule.z * np.sqrt(noise + 2.0 * rule.pose_sigma_m**2)
    return out
