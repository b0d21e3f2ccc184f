"""Black-white boards in a whole map: where intensities turn twice around a place.

Around the center of four sectors, in the angle ``φ`` about the normal, intensities ``I`` have a
second harmonic ``|Σ (I - m) exp(2iφ)| / Σ |I - m|`` of 2/π and no first one; at an edge it is the
other way round. Such places are compared with the pattern (`recon4.slices.black_white`).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from recon4.geometry.se3 import Array
from recon4.model.targets import TargetKind
from recon4.progress import Progress, track
from recon4.slices.black_white import black_white_at
from recon4.slices.targets.candidate import TargetCandidate
from recon4.slices.targets.cells import TargetCells
from recon4.slices.targets.groups import best_apart
from recon4.slices.targets.near import PlacePoints
from recon4.slices.tuning import BLACK_WHITE
from recon4.slices.tuning_targets import BOARD_SEARCH


def board_places(cells: TargetCells) -> tuple[Array, Array]:
    """Places that may be the center of a board [m], (N, 3), and how much they are like one."""
    from scipy.spatial import cKDTree

    rows = np.flatnonzero(cells.contrast() >= BOARD_SEARCH.contrast)
    if not len(rows):
        return np.zeros((0, 3)), np.zeros(0)
    tree = cKDTree(cells.xyz)
    away, near = tree.query(
        cells.xyz[rows],
        k=min(BOARD_SEARCH.neighbors, len(cells.xyz)),
        distance_upper_bound=BOARD_SEARCH.radius_m,
    )
    away, near = np.atleast_2d(away), np.atleast_2d(near)
    there = np.isfinite(away)
    near = np.where(there, near, 0)
    enough = there.sum(axis=1) >= BOARD_SEARCH.least_neighbors
    rows, near, there = rows[enough], near[enough], there[enough]
    like, score = _four_sectors(_surroundings(cells, rows, near=near, there=there))
    best = best_apart(cells.xyz[like], score, BOARD_SEARCH.apart_m)
    return cells.xyz[like[best]], score[best]


def border_cells(cells: TargetCells, low: Array, high: Array) -> TargetCells:
    """Cells near what may be a board at the faces of a tile, of which the next one has a part.

    Args:
        cells: Of a tile.
        low: Corner of the tile [m], (3,).
        high: The opposite corner [m], (3,).
    """
    from scipy.spatial import cKDTree

    reach_m = BOARD_SEARCH.radius_m
    off = np.minimum(cells.xyz - low, high - cells.xyz).min(axis=1)
    at_face = np.flatnonzero(off <= 2.0 * reach_m)
    seeds = at_face[(cells.contrast()[at_face] >= BOARD_SEARCH.contrast) & (off[at_face] < reach_m)]
    if not len(seeds):
        return cells.part(seeds)
    away, _ = cKDTree(cells.xyz[seeds]).query(cells.xyz[at_face], distance_upper_bound=reach_m)
    return cells.part(at_face[np.isfinite(away)])


def find_boards(
    near: PlacePoints, places: Array, score: Array, *, progress: Progress
) -> list[TargetCandidate]:
    """The boards of a map.

    Args:
        near: Points of the map.
        places: That may be one [m], (N, 3).
        score: How much each is like one, (N,).
        progress: Receives every place that is looked at.
    """
    best = best_apart(places, score, BOARD_SEARCH.apart_m)[: BOARD_SEARCH.most_places]
    found = list[TargetCandidate]()
    rows = near.in_order(places[best], best)
    for place in track(places[rows], progress, what="boards", unit="places"):
        if any(np.linalg.norm(one.p_map - place) < BOARD_SEARCH.apart_m for one in found):
            continue
        points, value = near.around(place, BLACK_WHITE.reach_m + BLACK_WHITE.radius_m)
        one = black_white_at(points, value, place, reach_m=BOARD_SEARCH.reach_m)
        if one is None:
            continue
        n = one.normal
        within, across = one.sd_m**2, one.sd_across_m**2
        cov = within * (np.eye(3) - np.outer(n, n)) + across * np.outer(n, n)
        found.append(
            TargetCandidate(
                kind=TargetKind.BOARD,
                p_map=one.p_map,
                cov=cov,
                size_m=0.0,
                points=one.points,
                agreement=one.agreement,
            )
        )
    return found


@dataclass(frozen=True, slots=True, eq=False)
class _Surroundings:
    """Cells around N places, K each."""

    rows: NDArray[np.intp]
    """Of the places, (N,)."""
    value: Array
    """Intensities, (N, K)."""
    angle: Array
    """About the normal, (N, K)."""
    weight: Array
    """How much each counts: its points, at most `BOARD_SEARCH.counted`, (N, K)."""


def _surroundings(
    cells: TargetCells,
    rows: NDArray[np.intp],
    *,
    near: NDArray[np.intp],
    there: NDArray[np.bool_],
) -> _Surroundings:
    """What is around places on a plane; the others are left out."""
    d = cells.xyz[near] - cells.xyz[rows][:, None]
    counted = np.minimum(cells.count[near], BOARD_SEARCH.counted)
    weight = np.where(there, counted, 0.0)
    _, _, across = _planes(d, weight)
    there = there & (across <= BOARD_SEARCH.behind_m)  # without the other face of a thin wall
    weight = np.where(there, weight, 0.0)
    flat, axes, _ = _planes(d, weight)
    u, v = (np.einsum("nki,ni->nk", d, axes[:, :, k]) for k in (2, 1))
    ring = there & (np.hypot(u, v) > BOARD_SEARCH.inner_m)
    flat &= ring.sum(axis=1) >= BOARD_SEARCH.least_neighbors
    return _Surroundings(
        rows[flat],
        cells.value[near[flat]],
        np.arctan2(v[flat], u[flat]),
        (weight * ring)[flat],
    )


def _planes(d: Array, weight: Array) -> tuple[NDArray[np.bool_], Array, Array]:
    """Which of N surroundings are flat, their axes (N, 3, 3), cells off the planes [m], (N, K)."""
    total = np.maximum(weight.sum(axis=1), 1e-9)
    off = d - (np.einsum("nki,nk->ni", d, weight) / total[:, None])[:, None]
    values, axes = np.linalg.eigh(np.einsum("nki,nkj,nk->nij", off, off, weight))
    across = np.abs(np.einsum("nki,ni->nk", off, axes[:, :, 0]))
    return values[:, 0] <= total * BOARD_SEARCH.rough_m**2, axes, across


def _four_sectors(around: _Surroundings) -> tuple[NDArray[np.intp], Array]:
    """Which places have four sectors, two of them dark, and how clearly, 0 to 1."""
    value, angle, weight = around.value, around.angle, around.weight  # of each cell
    level = (value * weight).sum(axis=1) / weight.sum(axis=1)
    swing = (value - level[:, None]) * weight
    total = np.maximum(np.abs(swing).sum(axis=1), 1e-9)
    first, second = ((swing * np.exp(1j * order * angle)).sum(axis=1) / total for order in (1, 2))
    turned = angle - 0.5 * np.angle(second)[:, None]
    sector = np.floor((turned + 0.25 * np.pi) / (0.5 * np.pi)).astype(int) % 4
    means = []
    for k in range(4):
        inside = weight * (sector == k)
        seen = inside.sum(axis=1)
        mean = (value * inside).sum(axis=1) / np.maximum(seen, 1.0)
        means.append(np.where(seen > 0.0, mean, np.nan))
    with np.errstate(invalid="ignore"):
        white, black = np.minimum(means[0], means[2]), np.maximum(means[1], means[3])
        like = (white - black) >= BOARD_SEARCH.sectors * white
    like &= np.abs(second) >= BOARD_SEARCH.second
    like &= np.abs(first) <= BOARD_SEARCH.first
    return around.rows[like], (np.abs(second) - np.abs(first))[like]
