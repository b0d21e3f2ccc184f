"""Black-white targets: the center of a board with four sectors, found by intensity near a pick.

Two opposite sectors are white, the other two black. In the plane of the board, with the center
``c`` and the edges turned by ``θ``, a beam of half width ``w`` sees the intensity

    I(p) = m + a tanh(u / w) tanh(v / w),      (u, v) = R(θ)ᵀ (p - c)

A coarse search over ``c`` and ``θ`` gives the start; least squares gives ``c``, and its covariance
``s² (JᵀJ)⁻¹`` by the scatter ``s`` of the intensities.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from recon4.geometry.se3 import Array
from recon4.mapping.tiles import TileSet
from recon4.slices.pick import columns_near
from recon4.slices.tuning import BLACK_WHITE


@dataclass(frozen=True, slots=True, eq=False)
class BlackWhiteTarget:
    """The center of a target."""

    p_map: Array
    """[m], (3,)."""
    sd_m: float
    """Standard deviation (1 σ) in the plane of the board, in the direction in which it is largest,
    by the scatter of intensities; errors of the poses are not in it [m]."""
    sd_across_m: float
    """The same across the board, that of a single point: neighbors share their errors [m]."""
    normal: Array
    """Of the board, of either sign, (3,)."""
    points: int
    """Points of the board that were used."""
    agreement: float
    """Correlation of the intensities with the pattern, 1 = they are the pattern."""


def find_black_white(tiles: TileSet, p_map: Array) -> BlackWhiteTarget | None:
    """The target around a place in a map [m], (3,); None if there is none."""
    value = "intensity_normalized" if "intensity_normalized" in tiles.fields else "intensity"
    near = columns_near(tiles, p_map, BLACK_WHITE.reach_m + BLACK_WHITE.radius_m, value)
    return black_white_at(near["xyz"], near[value].astype(np.float64), p_map)


def black_white_at(
    points: Array, intensity: Array, p_map: Array, *, reach_m: float = BLACK_WHITE.reach_m
) -> BlackWhiteTarget | None:
    """The target near a place; None if no pattern of this kind is there, or it is seen in part.

    Args:
        points: Around the place [m], (N, 3).
        intensity: Of each, in any unit, (N,).
        p_map: The place [m], (3,).
        reach_m: How far from it the search begins [m].
    """
    board = _board(points, intensity, p_map)
    if board is None:
        return None
    fitted = _fit(board, _start(board, reach_m))
    if fitted is not None:
        fitted = _fit(board, fitted.at)  # with the points around its own center
    if fitted is None or not _is_target(board, fitted):
        return None
    return BlackWhiteTarget(
        p_map=board.middle + fitted.at[:2] @ board.axes[:2],
        sd_m=fitted.sd_m,
        sd_across_m=board.sd_m,
        normal=board.axes[2],
        points=fitted.count,
        agreement=fitted.agreement,
    )


@dataclass(frozen=True, slots=True, eq=False)
class _Board:
    """Points on the plane around a pick."""

    middle: Array
    axes: Array
    """Two in the plane, the normal, rows of (3, 3)."""
    uv: Array
    """From the pick [m], (N, 2)."""
    value: Array
    """Intensities, of mean 0 and deviation 1, (N,)."""
    sd_m: float
    """Of the points about the plane [m]."""


@dataclass(frozen=True, slots=True, eq=False)
class _Fitted:
    at: Array
    """u, v [m], turn [rad], (3,)."""
    sd_m: float
    agreement: float
    count: int


def _board(points: Array, intensity: Array, p_map: Array) -> _Board | None:
    close = np.linalg.norm(points - p_map, axis=1) <= BLACK_WHITE.radius_m
    for _ in range(BLACK_WHITE.plane_rounds):
        if close.sum() < BLACK_WHITE.least_points:
            return None
        middle = points[close].mean(axis=0)
        values, vectors = np.linalg.eigh(np.cov((points[close] - middle).T))
        off_m = (points - middle) @ vectors[:, 0]
        sd_m = float(np.sqrt(max(values[0], 0.0)))
        close = np.abs(off_m) <= max(BLACK_WHITE.least_off_m, BLACK_WHITE.off_sd * sd_m)
    if sd_m > BLACK_WHITE.most_rough_m or close.sum() < BLACK_WHITE.least_points:
        return None
    axes = np.array([vectors[:, 2], vectors[:, 1], vectors[:, 0]])
    foot = p_map - axes[2] * ((p_map - middle) @ axes[2])
    value = intensity[close]
    spread = float(value.std())
    if spread <= 0.0:
        return None
    uv = (points[close] - foot) @ axes[:2].T
    return _Board(foot, axes, uv, (value - value.mean()) / spread, sd_m)


def _pattern(uv: Array, at: Array) -> Array:
    """The pattern of a target at u, v with a turn, (N, 2) -> (N,)."""
    c, s = np.cos(at[2]), np.sin(at[2])
    d = uv - at[:2]
    u, v = (c * d[:, 0] + s * d[:, 1]) / BLACK_WHITE.beam_m, (c * d[:, 1] - s * d[:, 0])
    out: Array = np.tanh(u) * np.tanh(v / BLACK_WHITE.beam_m)
    return out


def _agreement(board: _Board, at: Array) -> tuple[float, int]:
    """Correlation of the pattern with the points around its center, and how many they are."""
    near = np.linalg.norm(board.uv - at[:2], axis=1) <= BLACK_WHITE.radius_m
    count = int(near.sum())
    if count < BLACK_WHITE.least_points:
        return 0.0, count
    a, b = _pattern(board.uv[near], at), board.value[near]
    if a.std() < BLACK_WHITE.tiny or b.std() < BLACK_WHITE.tiny:
        return 0.0, count
    return float(np.corrcoef(a, b)[0, 1]), count


def _start(board: _Board, reach_m: float) -> Array:
    """Center and turn of the pattern that agrees best; a turn by 90° exchanges black and white."""
    step = max(1, len(board.uv) // BLACK_WHITE.search_points)
    thin = replace(board, uv=board.uv[::step], value=board.value[::step])
    steps = np.arange(-reach_m, reach_m + 1e-9, BLACK_WHITE.search_m)
    turns = np.linspace(0.0, np.pi, BLACK_WHITE.turns, endpoint=False)
    starts = np.array(np.meshgrid(steps, steps, turns)).reshape(3, -1).T
    return np.asarray(starts[np.argmax([_agreement(thin, at)[0] for at in starts])])


def _fit(board: _Board, start: Array) -> _Fitted | None:
    from scipy.optimize import least_squares

    near = np.linalg.norm(board.uv - start[:2], axis=1) <= BLACK_WHITE.radius_m
    uv, value = board.uv[near], board.value[near]
    if len(uv) < BLACK_WHITE.least_points:
        return None

    def off(x: Array) -> Array:
        made: Array = x[3] + x[4] * _pattern(uv, x[:3]) - value
        return made

    found = least_squares(off, [*start, 0.0, 1.0], loss="soft_l1", f_scale=0.5, x_scale="jac")
    free = len(uv) - len(found.x)
    try:
        cov = np.linalg.inv(found.jac.T @ found.jac) * float(np.sum(off(found.x) ** 2)) / free
    except np.linalg.LinAlgError:
        return None
    agreement, count = _agreement(board, found.x[:3])
    sd_m = float(np.sqrt(np.linalg.eigvalsh(cov[:2, :2])[-1]))
    return _Fitted(found.x[:3], sd_m, agreement, count)


def _is_target(board: _Board, fitted: _Fitted) -> bool:
    """Whether all four sectors are seen, and both white ones are brighter than both black ones."""
    away = float(np.linalg.norm(fitted.at[:2]))
    if away > BLACK_WHITE.reach_m or fitted.agreement < BLACK_WHITE.least_agreement:
        return False
    c, s = np.cos(fitted.at[2]), np.sin(fitted.at[2])
    d = (board.uv - fitted.at[:2]) @ np.array([[c, -s], [s, c]])
    inner = np.linalg.norm(d, axis=1) <= BLACK_WHITE.radius_m
    clear = inner & (np.abs(d).min(axis=1) >= BLACK_WHITE.beam_m)
    sector = 2 * (d[:, 0] > 0.0) + (d[:, 1] > 0.0)
    parts = [board.value[clear & (sector == k)] for k in range(4)]
    if min(map(len, parts)) < BLACK_WHITE.least_sector:
        return False
    black = max(np.median(parts[1]), np.median(parts[2]))
    white = min(np.median(parts[0]), np.median(parts[3]))
    noise = float(np.median([part.std() for part in parts]))
    return bool(
        white - black >= BLACK_WHITE.contrast_sd * noise and fitted.sd_m <= BLACK_WHITE.most_sd_m
    )
