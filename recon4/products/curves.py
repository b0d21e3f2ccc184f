"""Curved walls: arcs of circles fitted where straight faces are the chords of one."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from recon4.geometry.se3 import Array
from recon4.products.faces import Face
from recon4.products.tuning import CURVES, OPENINGS, WALL_CELLS
from recon4.products.wall_cells import WallCells

Rows = NDArray[np.intp]


@dataclass(frozen=True, slots=True, eq=False)
class CurvedFace:
    """One side of a curved wall, seen from above."""

    center: Array
    """Of its circle, in the map [m], (2,)."""
    radius_m: float
    start_rad: float
    sweep_rad: float
    """Counterclockwise from the direction of x; a whole circle has 2π."""
    rows: Rows
    """Cells on it."""
    rms_m: float
    """Of the distances of the cells that it was fitted to [m]."""

    @property
    def length_m(self) -> float:
        """Along the arc [m]."""
        return self.radius_m * self.sweep_rad

    @property
    def line(self) -> Array:
        """As a polyline that is off by `CURVES.chord_m` at most [m], (N, 2)."""
        step = 2.0 * np.arccos(1.0 - CURVES.chord_m / self.radius_m)
        turn = np.linspace(0.0, self.sweep_rad, int(np.ceil(self.sweep_rad / step)) + 1)
        around = np.column_stack([np.cos(self.start_rad + turn), np.sin(self.start_rad + turn)])
        return np.asarray(self.center + self.radius_m * around)


def curved_faces(faces: list[Face], cells: WallCells) -> tuple[list[CurvedFace], list[Face]]:
    """The arcs whose chords were fitted as straight faces, and the faces that are none.

    Two neighboring chords give a circle: p₁ - p₂ = -ρ (n₁ - n₂). It is fitted to the cells near it
    by least squares (Kåsa 1976) with an ever smaller tolerance. The longest arc is taken first. It
    ends where nothing is at the height of the cut: chords over a door stay straight faces.
    """
    found: list[CurvedFace] = []
    free = cells.high & _cut(cells)
    left = faces
    circles = list(_circles(faces))
    while circles:
        fitted = [one for c, rho in circles for one in _arcs(cells, c, rho, free=free)]
        best = max(fitted, key=lambda one: one.length_m, default=None)
        if best is None:
            break
        found.append(best)
        free[best.rows] = False
        left = [face for face in left if not _is_chord(face, best)]
        circles = list(_circles(left))
    return found, left


def _cut(cells: WallCells) -> NDArray[np.bool_]:
    """Whether there is a wall at the height of the cut, (N,)."""
    low, high = (round(z_m / WALL_CELLS.bit_m) for z_m in OPENINGS.cut_m)
    seen = np.bitwise_count(cells.heights & np.uint64((1 << high) - (1 << low)))
    return np.asarray(seen >= OPENINGS.solid * (high - low))


def _circles(faces: list[Face]) -> Iterator[tuple[Array, float]]:
    """Center and signed radius by pairs of neighboring chords; > 0 = seen from inside."""
    least, most = CURVES.radius_m
    for a, b in _neighbors(faces):
        turn = float(np.arccos(np.clip(a.n @ b.n, -1.0, 1.0)))
        if not CURVES.turn_rad[0] <= turn <= CURVES.turn_rad[1]:
            continue
        apart, bend = (a.start + a.end - b.start - b.end) / 2.0, a.n - b.n
        rho = -float(apart @ bend) / float(bend @ bend)
        if least <= abs(rho) <= most:
            yield (a.start + a.end) / 2.0 + rho * a.n, rho


def _neighbors(faces: list[Face]) -> Iterator[tuple[Face, Face]]:
    """Pairs of faces of which an end of one is near an end of the other."""
    from scipy.spatial import cKDTree

    if not faces:
        return
    ends = np.array([end for face in faces for end in (face.start, face.end)])
    close = cKDTree(ends).query_pairs(CURVES.near_m, output_type="ndarray") // 2
    pairs = np.unique(close[close[:, 0] != close[:, 1]], axis=0)
    for i, k in pairs.tolist():
        yield faces[i], faces[k]


def _arcs(
    cells: WallCells, center: Array, rho: float, *, free: NDArray[np.bool_]
) -> Iterator[CurvedFace]:
    """Arcs on a circle near the given one."""
    inward, radius, rows = np.sign(rho), abs(rho), np.empty(0, np.intp)
    for tolerance in np.geomspace(CURVES.wide_m, CURVES.narrow_m, CURVES.rounds):
        rows = _on_circle(cells, center, inward * radius, free=free, tolerance_m=float(tolerance))
        if len(rows) < CURVES.least_cells:
            return
        center, radius = _fitted(cells.p[rows], cells.weight[rows])
        if not CURVES.radius_m[0] <= radius <= CURVES.radius_m[1]:
            return
    away = cells.p[rows] - center
    angle = np.arctan2(away[:, 1], away[:, 0]) % (2.0 * np.pi)
    for start, sweep, mine in _runs(angle, CURVES.bridged_m / radius):
        off = np.linalg.norm(away[mine], axis=1) - radius
        rms = float(np.sqrt(np.mean(off**2)))
        steps = max(1.0, sweep * radius / CURVES.step_m)
        turned = ((angle[mine] - start) % (2.0 * np.pi)) * radius
        fill = len(np.unique(np.floor(turned / CURVES.step_m))) / steps
        if sweep >= CURVES.sweep_rad and rms <= CURVES.rms_m and fill >= CURVES.fill:
            yield CurvedFace(center, radius, start, sweep, rows[mine], rms)


def _on_circle(
    cells: WallCells, center: Array, rho: float, *, free: NDArray[np.bool_], tolerance_m: float
) -> Rows:
    away = cells.p - center
    distance = np.maximum(np.linalg.norm(away, axis=1), 1e-9)
    radial = np.einsum("ni,ni->n", away, cells.n) / distance * -np.sign(rho)
    near = np.abs(distance - abs(rho)) <= tolerance_m
    return np.flatnonzero(free & near & (radial >= CURVES.agree))


def _fitted(p: Array, weight: Array) -> tuple[Array, float]:
    """Center and radius of the circle through places, (N, 2): linear least squares."""
    middle = np.average(p, axis=0, weights=weight)
    d, w = p - middle, np.sqrt(weight)
    A = np.column_stack([2.0 * d, np.ones(len(d))]) * w[:, None]
    x, y, c = np.linalg.lstsq(A, np.einsum("ni,ni->n", d, d) * w, rcond=None)[0].tolist()
    return middle + np.array([x, y]), float(np.sqrt(max(c + x * x + y * y, 0.0)))


def _runs(angle: Array, gap_rad: float) -> Iterator[tuple[float, float, Rows]]:
    """Runs of angles around a circle without a long gap: start, sweep, rows."""
    order = np.argsort(angle)
    sorted_ = angle[order]
    step = np.diff(sorted_, append=sorted_[0] + 2.0 * np.pi)
    ends = np.flatnonzero(step > gap_rad)
    if not len(ends):
        yield float(sorted_[0]), 2.0 * np.pi, order
        return
    around = np.roll(order, -(int(ends[-1]) + 1))
    for mine in np.split(around, np.cumsum(np.diff(ends, prepend=ends[-1] - len(order)))[:-1]):
        start = float(angle[mine[0]])
        yield start, float((angle[mine[-1]] - start) % (2.0 * np.pi)), mine


def _is_chord(face: Face, arc: CurvedFace) -> bool:
    """Whether a straight face lies along an arc."""
    p = np.array([face.start, (face.start + face.end) / 2.0, face.end]) - arc.center
    off = np.abs(np.linalg.norm(p, axis=1) - arc.radius_m)
    angle = np.arctan2(p[1, 1], p[1, 0])
    within = (angle - arc.start_rad) % (2.0 * np.pi) <= arc.sweep_rad
    return bool(within and off.max() <= CURVES.wide_m)
