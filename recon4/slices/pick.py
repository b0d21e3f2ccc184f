"""Picking: the map point at a position of a slice, and the surface near given coordinates."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from recon4.geometry.se3 import Array
from recon4.mapping.tiles import TileSet
from recon4.slices.points import SliceWindow, points_in
from recon4.slices.slice_plane import SlicePlane, Vector

_DESCRIBED = ("intensity", "sensor", "ring", "frame_id", "t_ns")
_PLANE_M = 0.10
"""Radius within which a surface is fitted by a plane [m]."""


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


def nearest_surface(tiles: TileSet, p_map: Array, *, radius_m: float = 0.3) -> Array | None:
    """The nearest point of the map's surface to given coordinates [m], (3,).

    The foot of the point on the plane through the points within 10 cm of the nearest one; the
    nearest map point itself where they are not flat. None if there is none within the radius.
    """
    low, high = p_map - radius_m, p_map + radius_m
    near = [np.empty((0, 3))]
    for tile in tiles:
        if np.any(np.array(tile.low_m) > high) or np.any(np.array(tile.high_m) < low):
            continue
        xyz = tile.read(["xyz"])["xyz"]
        box = np.all(np.abs(xyz - (p_map - tile.origin_m)) <= radius_m, axis=1)
        near.append(xyz[box].astype(np.float64) + tile.origin_m)
    points = np.concatenate(near)
    off = np.linalg.norm(points - p_map, axis=1)
    points, off = points[off <= radius_m], off[off <= radius_m]
    if not len(points):
        return None
    nearest = points[np.argmin(off)]
    around = points[np.linalg.norm(points - nearest, axis=1) <= _PLANE_M]
    if len(around) < 8:
        return np.asarray(nearest)
    middle = around.mean(axis=0)
    values, vectors = np.linalg.eigh(np.cov((around - middle).T))
    if values[1] < 9.0 * values[0]:
        return np.asarray(nearest)
    n = vectors[:, 0]
    foot: Array = p_map - n * (n @ (p_map - middle))
    return foot
