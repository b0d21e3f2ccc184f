"""Volumes in a map: boxes, balls, polygons extended along their normal, strokes, clusters."""

from __future__ import annotations

from typing import TypeAlias

import msgspec
import numpy as np
from numpy.typing import NDArray

from recon4.errors import ConfigError
from recon4.geometry.se3 import SE3, Array
from recon4.locales.coded import CodedText
from recon4.model.cell_clusters import (
    Clusters,
    cluster_bounds,
    cluster_corners,
    cluster_of,
    moved_clusters,
)
from recon4.model.tuning import VOLUMES

Vector: TypeAlias = tuple[float, float, float]


class Box(msgspec.Struct, frozen=True, kw_only=True, tag_field="shape", tag="box"):
    """A box with any orientation."""

    center_m: Vector
    """In the map [m]."""
    size_m: Vector
    """Along u, v and u × v [m]."""
    u: Vector = (1.0, 0.0, 0.0)
    """Unit vectors along two edges, in the map."""
    v: Vector = (0.0, 1.0, 0.0)

    def __post_init__(self) -> None:
        _check("box", self.center_m, self.u, self.v)
        _check_lengths("box", self.size_m)


class Sphere(msgspec.Struct, frozen=True, kw_only=True, tag_field="shape", tag="sphere"):
    """A ball."""

    center_m: Vector
    """In the map [m]."""
    radius_m: float

    def __post_init__(self) -> None:
        _check("sphere", self.center_m)
        _check_lengths("sphere", (self.radius_m,))


class Prism(msgspec.Struct, frozen=True, kw_only=True, tag_field="shape", tag="prism"):
    """A polygon in a plane, extended along the normal u × v; the plane is level by default."""

    polygon_m: tuple[tuple[float, float], ...]
    """Its corners along u and v, in order, not closed [m]."""
    low_m: float
    high_m: float
    """Where it begins and ends along the normal [m]."""
    origin_m: Vector = (0.0, 0.0, 0.0)
    """Place in the map where u, v and the distance along the normal are 0 [m]."""
    u: Vector = (1.0, 0.0, 0.0)
    v: Vector = (0.0, 1.0, 0.0)

    def __post_init__(self) -> None:
        from shapely import Polygon, is_valid_reason

        corners = [x for corner in self.polygon_m for x in corner]
        _check("prism", (*self.origin_m, *corners, self.low_m, self.high_m), self.u, self.v)
        _check_lengths("prism", (self.high_m - self.low_m,))
        if not 3 <= len(self.polygon_m) <= VOLUMES.most_corners:
            raise ConfigError(
                CodedText(
                    "prism-corners", most_corners=VOLUMES.most_corners, count=len(self.polygon_m)
                )
            )
        polygon = Polygon(self.polygon_m)
        if not polygon.is_valid or polygon.area < VOLUMES.least_m2:
            raise ConfigError(CodedText("prism-crosses", polygon=str(is_valid_reason(polygon))))


class Brush(msgspec.Struct, frozen=True, kw_only=True, tag_field="shape", tag="brush"):
    """What a brush painted: all that lies within its radius of a path.

    Neighboring places are joined by a straight line if they are at most a width of the brush apart;
    farther ones are not: the pointer went from one surface to another, or was lifted.
    """

    path_m: tuple[Vector, ...]
    """Places in the map, in the order in which they were painted [m]."""
    radius_m: float
    across: Vector | None = None
    """Unit normal of the slice that was painted on: the distance to the path counts in its plane
    alone; None = round in all directions."""
    thick_m: float = 0.0
    """Of the slice, half of it on each side of its first place [m]; 0 without ``across``."""

    def __post_init__(self) -> None:
        if not 1 <= len(self.path_m) <= VOLUMES.most_places:
            raise ConfigError(
                CodedText("brush-places", most_places=VOLUMES.most_places, count=len(self.path_m))
            )
        normal = () if self.across is None else self.across
        _check("brush", (*(x for place in self.path_m for x in place), *normal))
        _check_lengths("brush", (self.radius_m, *(() if self.across is None else (self.thick_m,))))
        if self.across is None and self.thick_m != 0.0:
            raise ConfigError(CodedText("brush-thickness"))
        if self.across is not None and abs(float(np.linalg.norm(normal)) - 1.0) > VOLUMES.axes:
            raise ConfigError(CodedText("brush-normal", across=str(self.across)))
        low, high = bounds_of(self)
        _check_lengths("brush", tuple(map(float, high - low)))


Volume: TypeAlias = Box | Sphere | Prism | Brush | Clusters


def contains(volume: Volume, p_map: Array) -> NDArray[np.bool_]:
    """Which points of the map are in a volume, (N, 3) [m] -> (N,)."""
    if isinstance(volume, Sphere):
        away_m = np.linalg.norm(p_map - np.array(volume.center_m), axis=1)
        return np.asarray(away_m <= volume.radius_m)
    if isinstance(volume, Brush):
        return _painted(volume, p_map)
    if isinstance(volume, Clusters):
        return np.asarray(cluster_of(volume, p_map) >= 0)
    p = (p_map - _origin(volume)) @ _axes(volume).T
    if isinstance(volume, Box):
        return np.asarray(np.all(np.abs(p) <= np.array(volume.size_m) / 2.0, axis=1))
    from shapely import Polygon, contains_xy, prepare

    inside = (p[:, 2] >= volume.low_m) & (p[:, 2] <= volume.high_m)
    polygon = Polygon(volume.polygon_m)
    prepare(polygon)
    inside[inside] = contains_xy(polygon, p[inside, 0], p[inside, 1])
    return np.asarray(inside)


def corners_of(volume: Volume) -> Array:
    """Corners of a box around a volume, along its own axes, in the map [m], (8, 3)."""
    if isinstance(volume, Clusters):
        return cluster_corners(volume)
    if isinstance(volume, Sphere):
        low, high = np.full(3, -volume.radius_m), np.full(3, volume.radius_m)
    elif isinstance(volume, Box):
        low, high = -np.array(volume.size_m) / 2.0, np.array(volume.size_m) / 2.0
    elif isinstance(volume, Brush):
        path = (np.array(volume.path_m) - _origin(volume)) @ _axes(volume).T
        low, high = path.min(axis=0) - volume.radius_m, path.max(axis=0) + volume.radius_m
        if volume.across is not None:
            low[2], high[2] = -volume.thick_m / 2.0, volume.thick_m / 2.0
    else:
        polygon = np.array(volume.polygon_m)
        low = np.array([*polygon.min(axis=0), volume.low_m])
        high = np.array([*polygon.max(axis=0), volume.high_m])
    which = np.indices((2, 2, 2)).reshape(3, 8).T
    return np.asarray(np.where(which, high, low) @ _axes(volume) + _origin(volume))


def bounds_of(volume: Volume) -> tuple[Array, Array]:
    """Smallest and largest coordinates of a volume in the map [m], (3,) each."""
    corners = corners_of(volume)
    return corners.min(axis=0), corners.max(axis=0)


def bounds_of_parts(volume: Volume) -> tuple[Array, Array]:
    """Smallest and largest coordinates of what a volume is made of [m], (K, 3) each."""
    if isinstance(volume, Clusters):
        return cluster_bounds(volume)
    low, high = bounds_of(volume)
    return low[None], high[None]


def moved(volume: Volume, T_new_old: SE3) -> Volume:
    """The same volume in another map.

    Args:
        volume: In the old map.
        T_new_old: Pose of the old map in the new one.
    """
    if isinstance(volume, Clusters):
        return moved_clusters(volume, T_new_old)
    origin = _vector(T_new_old @ _origin(volume))
    if isinstance(volume, Sphere):
        return msgspec.structs.replace(volume, center_m=origin)
    if isinstance(volume, Brush):
        path = tuple(map(_vector, T_new_old @ np.array(volume.path_m)))
        turned = volume.across and _vector(T_new_old.R @ np.array(volume.across))
        return msgspec.structs.replace(volume, path_m=path, across=turned)
    u, v = (_vector(T_new_old.R @ np.array(axis)) for axis in (volume.u, volume.v))
    if isinstance(volume, Box):
        return msgspec.structs.replace(volume, center_m=origin, u=u, v=v)
    return msgspec.structs.replace(volume, origin_m=origin, u=u, v=v)


def _painted(brush: Brush, p_map: Array) -> NDArray[np.bool_]:
    """Which points a brush painted, (N, 3) [m] -> (N,)."""
    corners = corners_of(brush)
    near = np.all((p_map >= corners.min(axis=0)) & (p_map <= corners.max(axis=0)), axis=1)
    rows = np.flatnonzero(near)
    axes, path = _axes(brush), np.array(brush.path_m)
    p = (p_map[rows] - path[0]) @ axes.T
    path = (path - path[0]) @ axes.T
    if brush.across is not None:
        thin = np.abs(p[:, 2]) <= brush.thick_m / 2.0
        rows, p = rows[thin], p[thin]
        p[:, 2] = path[:, 2] = 0.0
    order = np.argsort(p[:, 0])
    rows, p, inside = rows[order], p[order], np.zeros(len(rows), np.bool_)
    to = path[np.minimum(np.arange(len(path)) + 1, len(path) - 1)] - path
    to[np.linalg.norm(to, axis=1) > 2.0 * brush.radius_m] = 0.0
    low, high = np.minimum(path[:, 0], path[:, 0] + to[:, 0]), np.maximum(to[:, 0], 0.0)
    begins = np.searchsorted(p[:, 0], low - brush.radius_m)
    ends = np.searchsorted(p[:, 0], path[:, 0] + high + brush.radius_m, side="right")
    for start, step, begin, end in zip(path, to, begins, ends, strict=True):
        d = p[begin:end] - start
        along = np.clip(d @ step / max(float(step @ step), 1e-18), 0.0, 1.0)
        away = d - along[:, None] * step
        inside[begin:end] |= np.einsum("ni,ni->n", away, away) <= brush.radius_m**2
    painted = np.zeros(len(p_map), np.bool_)
    painted[rows[inside]] = True
    return painted


def _origin(volume: Box | Sphere | Prism | Brush) -> Array:
    if isinstance(volume, Brush):
        return np.array(volume.path_m[0])
    return np.array(volume.origin_m if isinstance(volume, Prism) else volume.center_m)


def _axes(volume: Box | Sphere | Prism | Brush) -> Array:
    """Unit vectors u, v and u × v, rows of (3, 3)."""
    if isinstance(volume, Sphere):
        return np.eye(3)
    if isinstance(volume, Brush):
        if volume.across is None:
            return np.eye(3)
        normal = np.array(volume.across)
        u = np.cross(normal, np.eye(3)[int(np.abs(normal).argmin())])
        u /= np.linalg.norm(u)
        return np.array([u, np.cross(normal, u), normal])
    return np.array([volume.u, volume.v, np.cross(volume.u, volume.v)])


def _check(name: str, numbers: tuple[float, ...], *axes: Vector) -> None:
    every = np.array([*numbers, *(x for axis in axes for x in axis)])
    if not np.isfinite(every).all() or np.abs(every).max() > VOLUMES.farthest_m:
        raise ConfigError(CodedText("volume-finite", name=name, every=str(every.tolist())))
    if axes and np.abs(np.array(axes) @ np.array(axes).T - np.eye(2)).max() > VOLUMES.axes:
        raise ConfigError(CodedText("volume-axes", name=name, axes=str(axes)))


def _check_lengths(name: str, lengths_m: tuple[float, ...]) -> None:
    if not all(0.0 < length_m <= VOLUMES.longest_m for length_m in lengths_m):
        raise ConfigError(
            CodedText(
                "volume-size",
                name=name,
                longest_m=VOLUMES.longest_m,
                lengths_m=", ".join(f"{length_m:g} m" for length_m in lengths_m),
            )
        )


def _vector(values: Array) -> Vector:
    x, y, z = (float(value) for value in values)
    return x, y, z
