"""Faces of walls: straight lines fitted to the upright surfaces that reach the ceiling."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from recon4.geometry.se3 import Array
from recon4.products.tuning import FACES, WALL_CELLS
from recon4.products.wall_cells import Masks, WallCells

Rows = NDArray[np.intp]


@dataclass(frozen=True, slots=True, eq=False)
class Face:
    """One side of a wall, seen from above: a line from ``start`` to ``end``."""

    start: Array
    end: Array
    """Ends in the map, x and y [m], (2,)."""
    n: Array
    """Unit normal, towards the side it was seen from, (2,)."""
    rows: Rows
    """Cells on it, of all heights."""
    rms_m: float
    """Of the distances of the cells that it was fitted to [m]."""

    @property
    def length_m(self) -> float:
        """From start to end [m]."""
        return float(np.linalg.norm(self.end - self.start))

    @property
    def u(self) -> Array:
        """Unit direction from start to end: the normal is on its left, (2,)."""
        return np.array([self.n[1], -self.n[0]])

    def along(self, p: Array) -> Array:
        """Distance of places from the start, along the face [m], (N, 2) -> (N,)."""
        out: Array = (p - self.start) @ self.u
        return out

    def at(self, s: float) -> Array:
        """The place at a distance from the start, (2,)."""
        return self.start + s * self.u


@dataclass(frozen=True, slots=True, eq=False)
class _FittedLine:
    p: Array
    n: Array
    rms_m: float


def fit_faces(cells: WallCells) -> list[Face]:
    """Fit lines to the cells that reach the ceiling, the longest runs first.

    From the cell with the most surface a run of cells with its normal is followed; weighted least
    squares with an ever smaller tolerance gives the line. Its cells are taken, then the next one
    follows. Ends near the corner of two lines are moved to it.
    """
    free = cells.high.copy()
    unowned = np.ones(len(cells), bool)
    tree = _neighbors(cells)
    order = np.argsort(-tree)
    found: list[Face] = []
    for seed in order:
        if not free[seed]:
            continue
        face = _grow(cells, int(seed), free=free, unowned=unowned)
        if face is None:
            free[seed] = False
            continue
        free[face.rows] = False
        unowned[face.rows] = False
        found.append(face)
    return _with_corners(_without_attachments(_tall(found, cells)))


def _tall(faces: list[Face], cells: WallCells) -> list[Face]:
    """Faces that have enough surface: signs and lamps hang from the ceiling, too."""
    kept = []
    for face in faces:
        height = np.bitwise_count(columns_of(face, cells, FACES.column_m)).astype(np.float64)
        if np.percentile(height, FACES.tall_percentile) * WALL_CELLS.bit_m >= FACES.tall_m:
            kept.append(face)
    return kept


def columns_of(face: Face, cells: WallCells, step_m: float) -> Masks:
    """Heights at which a face has surface, for each step along it, (S,)."""
    count = max(1, round(face.length_m / step_m))
    masks = np.zeros(count, np.uint64)
    step = np.clip((face.along(cells.p[face.rows]) / step_m).astype(np.int64), 0, count - 1)
    np.bitwise_or.at(masks, step, cells.heights[face.rows])
    return masks


def _without_attachments(faces: list[Face]) -> list[Face]:
    """Faces without those that are fixed to a longer one: boards, trunking, frames."""
    kept: list[Face] = []
    for face in sorted(faces, key=lambda one: -one.length_m):
        if not any(_attached(face, other) for other in kept):
            kept.append(face)
    return kept


def _attached(face: Face, other: Face) -> bool:
    off = (np.array([face.start, face.end]) - other.start) @ other.n
    s = np.clip(other.along(np.array([face.start, face.end])), 0.0, other.length_m)
    near = np.abs(off).max() < FACES.attached_m and float(face.n @ other.n) > FACES.agree
    return bool(near and np.ptp(s) > 0.5 * face.length_m)


def _neighbors(cells: WallCells) -> Array:
    """Surface around each cell: seeds begin where there is most of it, (N,)."""
    from scipy.spatial import cKDTree

    out = np.zeros(len(cells))
    high = np.flatnonzero(cells.high)
    if not len(high):
        return out
    near = cKDTree(cells.p[high]).sparse_distance_matrix(
        cKDTree(cells.p[high]), 4.0 * FACES.wide_m, output_type="coo_matrix"
    )
    same = np.einsum("ij,ij->i", cells.n[high[near.row]], cells.n[high[near.col]]) > FACES.agree
    out[high] = np.bincount(near.row[same], cells.weight[high[near.col[same]]], len(high))
    return out


def _grow(
    cells: WallCells, seed: int, *, free: NDArray[np.bool_], unowned: NDArray[np.bool_]
) -> Face | None:
    """The face through a cell; None if there is none."""
    line = _FittedLine(cells.p[seed], cells.n[seed], 0.0)
    taken = np.empty(0, np.intp)
    for tolerance in np.geomspace(FACES.wide_m, FACES.narrow_m, FACES.rounds):
        rows = _run(cells, line, free, seed=seed, tolerance_m=float(tolerance))
        if len(rows) < FACES.min_cells:
            return None
        line, taken = _fitted(cells, rows), rows
    u = np.array([line.n[1], -line.n[0]])
    s = (cells.p[taken] - line.p) @ u
    low, high = float(s.min()), float(s.max())
    if high - low < FACES.min_length_m or _fill(s) < FACES.min_fill:
        return None
    offset = cells.p - line.p
    along = offset @ u
    own = unowned & (np.abs(offset @ line.n) < FACES.own_m) & (cells.n @ line.n > 0.8)
    own &= (along > low - FACES.own_m) & (along < high + FACES.own_m)
    return Face(line.p + low * u, line.p + high * u, line.n, np.flatnonzero(own), line.rms_m)


def _run(
    cells: WallCells, line: _FittedLine, free: NDArray[np.bool_], *, seed: int, tolerance_m: float
) -> Rows:
    """Cells on a line without a long gap from the seed on."""
    offset = cells.p - line.p
    on = free & (np.abs(offset @ line.n) < tolerance_m) & (cells.n @ line.n > FACES.agree)
    rows = np.flatnonzero(on)
    if not len(rows):
        return rows
    s = offset[rows] @ [line.n[1], -line.n[0]]
    order = np.argsort(s)
    part = np.concatenate([[0], np.cumsum(np.diff(s[order]) > FACES.bridged_m)])
    at = float((cells.p[seed] - line.p) @ [line.n[1], -line.n[0]])
    mine = part[min(int(np.searchsorted(s[order], at)), len(rows) - 1)]
    return rows[order[part == mine]]


def _fitted(cells: WallCells, rows: Rows) -> _FittedLine:
    """Weighted least squares of a line through cells."""
    p, w = cells.p[rows], cells.weight[rows]
    middle = np.average(p, axis=0, weights=w)
    toward = np.average(cells.n[rows], axis=0, weights=w)
    toward /= np.linalg.norm(toward)
    n = toward
    if np.ptp((p - middle) @ [toward[1], -toward[0]]) > FACES.straight_m:
        d = (p - middle) * np.sqrt(w)[:, None]
        n = np.linalg.eigh(d.T @ d)[1][:, 0]
        n = n if n @ toward > 0.0 else -n
    rms = float(np.sqrt(np.average(((p - middle) @ n) ** 2, weights=w)))
    return _FittedLine(middle, n, rms)


def _fill(s: Array) -> float:
    """Part of a line that has cells."""
    step = 2.0 * FACES.own_m
    return len(np.unique(np.floor(s / step))) / max(1.0, np.ptp(s) / step)


def _with_corners(faces: list[Face]) -> list[Face]:
    """Faces with their ends moved to the corners in which they meet, without short lone ones."""
    ends = np.array([[face.start, face.end] for face in faces]).reshape(-1, 2, 2)
    moved, met = ends.copy(), np.zeros(len(faces), bool)
    for k, face in enumerate(faces):
        for side in (0, 1):
            corner = _corner(faces, ends, k, side=side)
            if corner is not None:
                moved[k, side] = corner
                met[k] = True
    return [
        replace(face, start=moved[k, 0], end=moved[k, 1])
        for k, face in enumerate(faces)
        if (moved[k, 1] - moved[k, 0]) @ face.u > (0.0 if met[k] else FACES.alone_m)
    ]


def _corner(faces: list[Face], ends: Array, k: int, *, side: int) -> Array | None:
    """The nearest crossing of one end's face with another face that reaches it."""
    own, end = faces[k], ends[k, side]
    best, found = FACES.corner_m, None
    for j, other in enumerate(faces):
        turn = float(own.u @ other.n)
        if j == k or abs(own.n @ other.n) > FACES.square:
            continue
        at = end + (float((other.start - end) @ other.n) / turn) * own.u
        s = float((at - ends[j, 0]) @ other.u)
        beyond = max(-s, s - other.length_m, 0.0)
        away = max(float(np.linalg.norm(at - end)), beyond)
        if away < best:
            best, found = away, at
    return found
