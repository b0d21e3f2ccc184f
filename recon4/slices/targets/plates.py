"""Retro-reflective plates: places that are much brighter than a map usually is.

In the plane of a plate with the center ``c``, the halves ``a`` and ``b`` of its edges turned by
``θ``, a beam of half width ``w`` sees the intensity

    I(p) = m + d S(u, a) S(v, b),      (u, v) = R(θ)ᵀ (p - c)
    S(u, a) = (tanh((u + a) / w) - tanh((u - a) / w)) / 2

Least squares gives ``c``, and its covariance by the scatter of the intensities.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from recon4.geometry.se3 import Array
from recon4.model.targets import TargetKind
from recon4.progress import Progress, track
from recon4.slices.targets.candidate import TargetCandidate
from recon4.slices.targets.cells import TargetCells
from recon4.slices.targets.groups import groups_of
from recon4.slices.targets.near import PlacePoints
from recon4.slices.tuning_targets import PLATES, TARGET_CELLS


def bright_cells(cells: TargetCells, usual: float) -> Array:
    """Places of cells that may be of a plate [m], (N, 3); ``usual``: `usual_intensity`."""
    return cells.xyz[cells.brightest > PLATES.bright * usual]


def find_plates(
    near: PlacePoints, bright: Array, usual: float, *, progress: Progress
) -> list[TargetCandidate]:
    """The plates of a map.

    Args:
        near: Points of the map.
        bright: Bright places in it [m], (N, 3).
        usual: Intensity that is still usual.
        progress: Receives every place that is looked at.
    """
    groups = [
        rows
        for rows in groups_of(bright, 2.0 * TARGET_CELLS.cell_m)
        if len(rows) >= PLATES.least_cells
    ]
    groups.sort(key=len, reverse=True)
    middles = np.array([bright[rows].mean(axis=0) for rows in groups]).reshape(-1, 3)
    groups = [groups[row] for row in near.in_order(middles[: PLATES.most_places])]
    found = []
    for rows in track(groups, progress, what="plates", unit="places"):
        low, high = bright[rows].min(axis=0), bright[rows].max(axis=0)
        extent_m = float(np.linalg.norm(high - low))
        if extent_m > PLATES.sizes_m[1]:
            continue
        middle = 0.5 * (low + high)
        points, value = near.around(middle, 0.5 * extent_m + PLATES.around_m)
        one = plate_at(points, value, usual)
        if one is not None:
            found.append(one)
    return found


def plate_at(points: Array, intensity: Array, usual: float) -> TargetCandidate | None:
    """The plate among some points; None if what is bright there is none.

    Args:
        points: Around a bright place [m], (N, 3).
        intensity: Of each, (N,).
        usual: Intensity that is still usual.
    """
    bright = intensity > PLATES.bright * usual
    if bright.sum() < PLATES.least_points:
        return None
    plane = _PlatePlane.through(points[bright])
    on_it = np.abs(plane.off_m(points)) <= PLATES.off_plane_m
    if (bright & on_it).sum() < PLATES.least_points:
        return None
    plane = _PlatePlane.through(points[bright & on_it])
    uv, value = plane.uv(points[on_it]), intensity[on_it]
    bright = bright[on_it]
    # Between a plate and what is around it: a beam at its edge sees both.
    around = _outside(uv, bright) & ~bright
    if around.sum() < max(PLATES.least_around, PLATES.around_part * bright.sum()):
        found = _outline(uv[bright])
    else:
        found = _fitted(uv, value, bright)
    if found is None:
        return None
    across = plane.sd_m**2
    cov = plane.axes.T @ np.diag([found.sd_m**2, found.sd_m**2, across]) @ plane.axes
    return TargetCandidate(
        kind=TargetKind.PLATE,
        p_map=plane.middle + found.center @ plane.axes[:2],
        cov=cov,
        size_m=2.0 * float(found.halves.max()),
        points=int(bright.sum()),
        agreement=found.agreement,
    )


@dataclass(frozen=True, slots=True, eq=False)
class _PlatePlane:
    middle: Array
    axes: Array
    """Two in the plane, the normal, rows of (3, 3)."""
    sd_m: float

    @staticmethod
    def through(points: Array) -> _PlatePlane:
        middle = np.median(points, axis=0)
        values, vectors = np.linalg.eigh(np.cov((points - middle).T))
        axes = np.array([vectors[:, 2], vectors[:, 1], vectors[:, 0]])
        return _PlatePlane(middle, axes, float(np.sqrt(max(values[0], 0.0))))

    def off_m(self, points: Array) -> Array:
        return np.asarray((points - self.middle) @ self.axes[2])

    def uv(self, points: Array) -> Array:
        return np.asarray((points - self.middle) @ self.axes[:2].T)


@dataclass(frozen=True, slots=True, eq=False)
class _Rectangle:
    center: Array
    """In the plane [m], (2,)."""
    halves: Array
    """Of both edges [m], (2,)."""
    sd_m: float
    agreement: float


def _outside(uv: Array, bright: NDArray[np.bool_]) -> NDArray[np.bool_]:
    """Which points lie around what is bright, in all directions but not far, (N,) bool."""
    low, high = np.quantile(uv[bright], PLATES.outline, axis=0)
    beyond = np.maximum(low - uv, uv - high).max(axis=1)
    return np.asarray((beyond > 0.0) & (beyond < PLATES.around_m), np.bool_)


def _outline(uv: Array) -> _Rectangle | None:
    """A plate that stands free: the middle of what is bright, if that fills a rectangle."""
    turned, R = _upright(uv)
    low, high = np.quantile(turned, PLATES.outline, axis=0)
    halves = 0.5 * (high - low)
    if not _is_size(halves):
        return None
    step = 0.25 * float(halves.min())
    filled = len(np.unique(np.floor((turned - low) / step).astype(int), axis=0))
    agreement = min(1.0, filled / float(np.prod(2.0 * halves / step)))
    if agreement < PLATES.least_filled:
        return None
    return _Rectangle(0.5 * (low + high) @ R.T, halves, PLATES.outline_sd_m, agreement)


def _upright(uv: Array) -> tuple[Array, Array]:
    """Points turned so that their rectangle is smallest, and the turn back, (2, 2)."""
    best: tuple[float, Array] | None = None
    for turn in np.linspace(0.0, np.pi / 2.0, 18, endpoint=False):
        c, s = np.cos(turn), np.sin(turn)
        R = np.array([[c, -s], [s, c]])
        low, high = np.quantile(uv @ R, PLATES.outline, axis=0)
        area = float(np.prod(high - low))
        if best is None or area < best[0]:
            best = area, R
    assert best is not None
    return uv @ best[1], best[1]


def _fitted(uv: Array, value: Array, bright: NDArray[np.bool_]) -> _Rectangle | None:
    """The rectangle of least squares."""
    from scipy.optimize import least_squares

    turned, R = _upright(uv[bright])
    low, high = np.quantile(turned, PLATES.outline, axis=0)
    center, halves = 0.5 * (low + high) @ R.T, 0.5 * (high - low)
    turn = float(np.arctan2(R[1, 0], R[0, 0]))
    dark, light = float(np.median(value[~bright])), float(np.median(value[bright]))
    scaled = (value - dark) / (light - dark)
    near = np.abs(uv - center).max(axis=1) < halves.max() + PLATES.around_m
    uv, scaled = uv[near], scaled[near]

    def off(x: Array) -> Array:
        return np.asarray(x[5] + x[6] * _pattern(uv, x[:5]) - scaled)

    start = [*center, turn, *halves, 0.0, 1.0]
    fit = least_squares(off, start, loss="soft_l1", f_scale=0.5, x_scale="jac")
    pattern = _pattern(uv, fit.x[:5])
    halves = np.abs(fit.x[3:5])
    if not _is_size(halves) or pattern.std() < 1e-6:
        return None
    agreement = float(np.corrcoef(pattern, scaled)[0, 1])
    spread = float(np.sum(off(fit.x) ** 2)) / max(len(uv) - len(fit.x), 1)
    try:
        cov = np.linalg.inv(fit.jac.T @ fit.jac) * spread
    except np.linalg.LinAlgError:
        return None
    sd_m = float(np.sqrt(np.linalg.eigvalsh(cov[:2, :2])[-1]))
    if agreement < PLATES.least_agreement or sd_m > PLATES.most_sd_m:
        return None
    return _Rectangle(fit.x[:2], halves, sd_m, agreement)


def _pattern(uv: Array, x: Array) -> Array:
    """Of a rectangle with the center, turn and halves ``x`` (5,) at points (N, 2)."""
    c, s, w = np.cos(x[2]), np.sin(x[2]), PLATES.edge_m
    d = (uv - x[:2]) @ np.array([[c, -s], [s, c]])
    a = np.abs(x[3:5])
    sides = 0.5 * (np.tanh((d + a) / w) - np.tanh((d - a) / w))
    return np.asarray(sides[:, 0] * sides[:, 1])


def _is_size(halves: Array) -> bool:
    least, most = PLATES.halves_m
    return bool(
        halves.min() >= least
        and halves.max() <= most
        and halves.max() <= PLATES.most_aspect * halves.min()
    )
