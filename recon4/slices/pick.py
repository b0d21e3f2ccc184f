"""Picking: the map point at a position of a slice, and the surface near given coordinates."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass

import numpy as np

from recon4.geometry.se3 import Array
from recon4.georeference.tuning_control import SIGHTINGS
from recon4.mapping.tile import Columns
from recon4.mapping.tiles import TileSet
from recon4.slices.points import SliceWindow, points_in
from recon4.slices.slice_plane import SlicePlane, Vector
from recon4.slices.tuning import PICKS

_DESCRIBED = ("intensity", "sensor", "ring", "frame_id", "t_ns")


@dataclass(frozen=True, slots=True)
class Picked:
    """A point of the map, full resolution."""

    p_map: Vector
    """[m]"""
    uv: tuple[float, float]
    """Position on the slice [m]."""
    off_m: float
    """Distance from the requested position [m]."""
    about: dict[str, float]
    """Intensity, sensor, ring, multiframe, seconds since the start."""


def pick(
    tiles: TileSet, plane: SlicePlane, uv: tuple[float, float], *, radius_m: float
) -> Picked | None:
    """The point of a slice nearest to a position on it; None if there is none within the radius."""
    u, v = uv
    window = SliceWindow(u - radius_m, v - radius_m, u + radius_m, v + radius_m)
    fields = [name for name in _DESCRIBED if name in tiles.fields]
    best: tuple[float, Array, dict[str, float]] | None = None
    for part in points_in(tiles, plane, fields, window=window):
        off = np.hypot(part.uvd[:, 0] - u, part.uvd[:, 1] - v)
        row = int(np.argmin(off))
        if off[row] <= radius_m and (best is None or off[row] < best[0]):
            about = {name: float(part.columns[name][row]) for name in fields}
            best = float(off[row]), part.uvd[row], about
    if best is None:
        return None
    off_m, uvd, about = best
    if "t_ns" in about:
        about["time_s"] = (about.pop("t_ns") - tiles.first_ns) / 1e9
    x, y, z = (float(value) for value in plane.to_map(uvd[None])[0])
    return Picked((x, y, z), (float(uvd[0]), float(uvd[1])), off_m, about)


@dataclass(frozen=True, slots=True, eq=False)
class SurfaceFoot:
    """The foot of a point on a flat surface of the map."""

    p_map: Array
    """[m], (3,)."""
    normal: Array
    """Unit normal, of either sign, (3,): the only direction in which the foot is a measurement."""


def nearest_surface(tiles: TileSet, p_map: Array, *, radius_m: float = 0.3) -> SurfaceFoot | None:
    """The foot of given coordinates [m], (3,), on the nearest surface of the map.

    The surface is the plane through the points within 10 cm of the nearest one. None if there is
    no point within the radius, if they are not flat (an edge, a pole: no point of it is known to
    be the surveyed one), or if the foot lies beside them, where the plane is only extrapolated.
    """
    points = points_near(tiles, p_map, radius_m)
    if not len(points):
        return None
    nearest = points[np.argmin(np.linalg.norm(points - p_map, axis=1))]
    plane = _plane_at(points_near(tiles, nearest, PICKS.plane_m))
    if plane is None:
        return None
    middle, n = plane
    foot: Array = p_map - n * (n @ (p_map - middle))
    if np.linalg.norm(foot - nearest) > PICKS.plane_m:
        return None
    return SurfaceFoot(foot, n)


def measured_directions(tiles: TileSet, plane: SlicePlane, p_map: Array) -> Array:
    """The directions in which a point picked on a slice is measured, rows of (2..3, 3).

    A person sees the two of the slice. Across it the point is any of the slab, unless it lies on
    a surface: then also across the surface.
    """
    surface = _plane_at(points_near(tiles, p_map, PICKS.plane_m))
    seen = plane.axes[:2]
    return seen if surface is None else np.vstack([seen, surface[1]])


def points_near(tiles: TileSet, p_map: Array, radius_m: float) -> Array:
    """Points of the map in a ball [m], (N, 3)."""
    return columns_near(tiles, p_map, radius_m)["xyz"]


def absent_picks(
    tiles: TileSet, picks: Mapping[str, Array], radii_m: Mapping[str, float]
) -> set[str]:
    """Ids of the places that the map does not have: too few points around them.

    Args:
        tiles: The map.
        picks: Id -> place [m], (3,).
        radii_m: Id -> radius of a sphere, whose middle is the place.
    """

    def without_points(names: Iterable[str], limit: int | None) -> set[str]:
        found = set()
        for name in names:
            radius_m = SIGHTINGS.around_m + radii_m.get(name, 0.0)
            near = columns_near(tiles, picks[name], radius_m, limit=limit)["xyz"]
            if len(near) < SIGHTINGS.points:
                found.add(name)
        return found

    return without_points(without_points(picks, PICKS.sample), None)


def columns_near(
    tiles: TileSet, p_map: Array, radius_m: float, *names: str, limit: int | None = None
) -> Columns:
    """Points of the map in a ball: ``xyz`` in the map [m], (N, 3) float64, and other fields.

    Args:
        tiles: The map.
        p_map: Middle of the ball [m], (3,).
        radius_m: Its radius.
        names: Other fields.
        limit: Most points of each tile that are read; None = all.
    """
    low, high = p_map - radius_m, p_map + radius_m
    near: list[Columns] = []
    for tile in tiles:
        if np.any(np.array(tile.low_m) > high) or np.any(np.array(tile.high_m) < low):
            continue
        found = tile.read(["xyz", *names], limit=limit)
        box = np.all(np.abs(found["xyz"] - (p_map - tile.origin_m)) <= radius_m, axis=1)
        found = {name: values[box] for name, values in found.items()}
        found["xyz"] = found["xyz"].astype(np.float64) + tile.origin_m
        ball = np.linalg.norm(found["xyz"] - p_map, axis=1) <= radius_m
        near.append({name: values[ball] for name, values in found.items()})
    if not near:
        return {"xyz": np.empty((0, 3)), **{name: np.empty(0) for name in names}}
    return {name: np.concatenate([one[name] for one in near]) for name in near[0]}


def _plane_at(around: Array) -> tuple[Array, Array] | None:
    """Middle and unit normal of points that lie on a plane; None if they do not."""
    if len(around) < PICKS.least_points:
        return None
    middle = around.mean(axis=0)
    values, vectors = np.linalg.eigh(np.cov((around - middle).T))
    if values[1] < 9.0 * values[0]:
        return None
    return middle, vectors[:, 0]
