"""Figures of a map against the true surfaces, for the benchmark of fitted surfaces."""

from __future__ import annotations

import hashlib
from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from scipy.spatial import cKDTree

from recon4.evaluation.reference_mesh import TriangleMesh, distance_to, sample_mesh
from recon4.evaluation.sharpness import thin
from recon4.geometry.mesh import WorldMesh
from recon4.geometry.se3 import Array
from recon4.mapping.tiles import TileSet
from tests.benchmarks.surface_scene import Exhibition, Rod, TrueEdge

OUTLIER_M = 0.5
_EVERY = 4
_PIECE_M = 0.3
"""Shorter pieces have too few points of a thinned map: two in a bin would be half of the usual."""
_BIN_M = 0.0025
_USUAL = 8.0
"""Pieces with fewer points in a bin say nothing of where a face ends."""
_NEAR_EDGE_M = 0.03
_MET_M = 0.01


@dataclass(frozen=True, slots=True)
class ErrorToTruth:
    """Distances of points from the true surfaces; farther ones than 0.5 m are left out."""

    points: int
    mean_m: float
    median_m: float
    within_2cm: float
    far: float
    """Ratio of points left out."""


@dataclass(frozen=True, slots=True)
class EdgeFigures:
    """How far edges are displaced: median and 95th percentile over pieces of 30 cm."""

    kind: str
    pieces: int
    median_m: float
    p95_m: float
    near_mean_m: float
    """Mean distance from the true surface of all points within 3 cm of an edge [m]."""
    near_p95_m: float


@dataclass(frozen=True, slots=True)
class RodFigures:
    """How much of the thin things is left."""

    diameter_m: float
    measured: int
    """Pieces of 3 cm with returns before anything was removed."""
    kept: float
    """Ratio of these pieces that still have points."""
    points_kept: float


def triangles_of(mesh: WorldMesh) -> TriangleMesh:
    """The same mesh as the evaluation reads it."""
    return TriangleMesh(mesh.vertices_m.astype(np.float64), mesh.triangles.astype(np.int64))


def error_to_truth(chunks: Iterable[Array], mesh: TriangleMesh) -> ErrorToTruth:
    """Distances of every fourth point to the mesh."""
    distance = distance_to(mesh)
    found = np.concatenate([distance(p[::_EVERY]) for p in chunks])
    near = found[found < OUTLIER_M]
    return ErrorToTruth(
        points=len(found),
        mean_m=float(near.mean()),
        median_m=float(np.median(near)),
        within_2cm=float((near < 0.02).mean()),
        far=1.0 - len(near) / len(found),
    )


@dataclass(frozen=True, slots=True)
class Coverage:
    """How much of the true surface has a point of a map within 5 cm."""

    measured: float
    """Of what the raw map has a point within 10 cm of."""
    seen: float
    """Of what a sensor without errors covers on the same walk."""
    met: float
    """Of what such a sensor has a point within 1 cm of: no noise of others is needed there."""


def coverage(
    maps: list[TileSet], perfect: TileSet, mesh: TriangleMesh, *, within_m: float = 0.05
) -> list[Coverage]:
    """Coverage of the true surface by maps; the first is the raw one."""
    sample = sample_mesh(mesh, spacing_m=0.03, rng=np.random.default_rng(0)).p
    away = []
    for tiles in (*maps, perfect):
        few = thin((tile.xyz_m() for tile in tiles), voxel_m=0.01)
        away.append(cKDTree(few).query(sample, distance_upper_bound=4.0 * within_m)[0])
    parts = away[0] < 2.0 * within_m, away[-1] < within_m, away[-1] < _MET_M
    return [Coverage(*(float((d[part] < within_m).mean()) for part in parts)) for d in away[:-1]]


def digest(folder: Path) -> str:
    """Hash of all files of a map."""
    found = hashlib.sha256()
    for path in sorted(p for p in folder.rglob("*") if p.is_file()):
        found.update(path.name.encode())
        found.update(path.read_bytes())
    return found.hexdigest()


def edge_figures(
    tiles: TileSet, scene: Exhibition, mesh: TriangleMesh, *, kind: str
) -> EdgeFigures:
    """Displacement of the edges of one kind."""
    p, normal = _points(tiles)
    shifts: list[float] = []
    near: list[Array] = []
    for edge in scene.edges:
        if edge.kind != kind:
            continue
        local, inside = _at_edge(edge, p)
        shifts += _displacements(edge, local[inside], normal[inside])
        close = np.hypot(local[:, 1], local[:, 2]) < _NEAR_EDGE_M
        near.append(p[inside & close])
    distance_m = distance_to(mesh)(np.concatenate(near))
    size = np.abs(shifts)
    return EdgeFigures(
        kind,
        len(size),
        float(np.median(size)),
        float(np.percentile(size, 95)),
        float(distance_m.mean()),
        float(np.percentile(distance_m, 95)),
    )


def rod_figures(tiles: TileSet, rods: tuple[Rod, ...], diameter_m: float) -> RodFigures:
    """Length of the rods of one diameter that is kept, of what was measured of it."""
    now = np.concatenate([tile.xyz_m() for tile in tiles])
    raw = [tile.xyz_m() for tile in tiles.as_measured()]
    raw += [tile.xyz_m() for tile in tiles.only_strays()]
    before = np.concatenate(raw)
    measured = kept = points = points_kept = 0
    for rod in rods:
        if rod.diameter_m != diameter_m:
            continue
        was, is_now = _pieces(rod, before), _pieces(rod, now)
        measured += int((was > 0).sum())
        kept += int(((was > 0) & (is_now > 0)).sum())
        points += int(was.sum())
        points_kept += int(is_now.sum())
    return RodFigures(diameter_m, measured, kept / measured, points_kept / points)


def _points(tiles: TileSet) -> tuple[Array, Array]:
    parts = [(tile.xyz_m(), tile.read(["normal"])["normal"]) for tile in tiles]
    p, normal = (np.concatenate(column) for column in zip(*parts, strict=True))
    return p, normal.astype(np.float64)


def _at_edge(edge: TrueEdge, p: Array) -> tuple[Array, Array]:
    """Coordinates along the edge and into both faces, and which points are within 12 cm."""
    axis = edge.end_m - edge.start_m
    length_m = float(np.linalg.norm(axis))
    frame = np.stack([axis / length_m, *edge.along])
    local = (p - edge.start_m) @ frame.T
    inside = (local[:, 0] > 0.0) & (local[:, 0] < length_m)
    inside &= np.abs(local[:, 1:]).max(axis=1) < 0.12
    return local, inside


def _displacements(edge: TrueEdge, local: Array, normal: Array) -> list[float]:
    """Where the points of each face end, relative to the edge, piece by piece [m]."""
    found = []
    for face in (0, 1):
        on_face = np.abs(local[:, 2 - face]) < 0.02
        on_face &= np.abs(normal @ edge.along[1 - face]) > 0.7
        s, piece = -local[on_face, 1 + face], np.floor(local[on_face, 0] / _PIECE_M)
        for k in np.unique(piece):
            end_m = _end_of(s[piece == k])
            if end_m is not None:
                found.append(end_m)
    return found


def _end_of(s: Array) -> float | None:
    """Where the density of points falls to half; None = not enough of the face was measured."""
    edges = np.arange(-0.08, 0.0801, _BIN_M)
    counts = np.histogram(s, edges)[0]
    usual = float(np.median(counts[: int(0.06 / _BIN_M)]))
    if usual < _USUAL:
        return None
    full = np.flatnonzero(counts >= 0.5 * usual)
    return float(edges[full[-1] + 1])


def _pieces(rod: Rod, p: Array) -> Array:
    """Points of each piece of 3 cm of a rod: within its radius and 1.5 cm more."""
    axis = rod.end_m - rod.start_m
    length_m = float(np.linalg.norm(axis))
    axis = axis / length_m
    low = np.minimum(rod.start_m, rod.end_m) - 0.1
    high = np.maximum(rod.start_m, rod.end_m) + 0.1
    p = p[((p > low) & (p < high)).all(axis=1)]
    along = (p - rod.start_m) @ axis
    off = np.linalg.norm(p - rod.start_m - along[:, None] * axis, axis=1)
    near = (off < 0.5 * rod.diameter_m + 0.015) & (along > 0.0) & (along < length_m)
    bins = np.arange(0.0, length_m + 0.03, 0.03)
    return np.histogram(along[near], bins)[0].astype(np.float64)
