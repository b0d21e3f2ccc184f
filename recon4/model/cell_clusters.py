"""Clusters of cells in a map: the volume of a thing, as cubes that its points lie in."""

from __future__ import annotations

import msgspec
import numpy as np
from numpy.typing import NDArray

from recon4.errors import ConfigError
from recon4.geometry.se3 import SE3, Array
from recon4.locales.coded import CodedText
from recon4.model.tuning import CLUSTERS, VOLUMES

Vector = tuple[float, float, float]


class CellCluster(msgspec.Struct, frozen=True, kw_only=True):
    """Cubes of one thing, in columns along u × v."""

    origin_m: Vector
    """Corner of the cube 0, 0, 0 in the map [m]."""
    columns: tuple[tuple[int, int, int, int], ...]
    """Number along u, number along v, first and last number along u × v, of each column."""
    u: Vector = (1.0, 0.0, 0.0)
    """Unit vectors along two edges of the cubes, in the map."""
    v: Vector = (0.0, 1.0, 0.0)
    seen_ns: tuple[int, ...] = ()
    """Times of the anchors that lead it into another map [ns]; empty before it is decided."""


class Clusters(msgspec.Struct, frozen=True, kw_only=True, tag_field="shape", tag="clusters"):
    """Things that are alike, each as the cubes that its points lie in."""

    clusters: tuple[CellCluster, ...]
    edge_m: float
    """Of a cube [m]."""

    def __post_init__(self) -> None:
        _check_counts(self)
        if not CLUSTERS.least_m <= self.edge_m <= CLUSTERS.most_m:
            raise ConfigError(
                CodedText(
                    "clusters-edge",
                    least_m=CLUSTERS.least_m,
                    most_m=CLUSTERS.most_m,
                    got_m=self.edge_m,
                )
            )
        for one in self.clusters:
            axes = np.array([one.u, one.v])
            numbers = np.array([*one.origin_m, *one.u, *one.v])
            if not np.isfinite(numbers).all() or np.abs(numbers).max() > VOLUMES.farthest_m:
                raise ConfigError(CodedText("clusters-finite", got=str(numbers.tolist())))
            if np.abs(axes @ axes.T - np.eye(2)).max() > VOLUMES.axes:
                raise ConfigError(CodedText("clusters-axes", u=str(one.u), v=str(one.v)))
            cells = np.array(one.columns, np.int64)
            if np.abs(cells).max() >= CLUSTERS.most_number or np.any(cells[:, 3] < cells[:, 2]):
                raise ConfigError(CodedText("clusters-columns"))


def _check_counts(volume: Clusters) -> None:
    columns = sum(len(one.columns) for one in volume.clusters)
    if not 1 <= len(volume.clusters) <= CLUSTERS.most or columns > CLUSTERS.most_columns:
        raise ConfigError(
            CodedText(
                "clusters-many",
                most=CLUSTERS.most,
                most_columns=CLUSTERS.most_columns,
                got=len(volume.clusters),
                columns=columns,
            )
        )
    if not all(one.columns for one in volume.clusters):
        raise ConfigError(CodedText("clusters-empty"))


def cluster_of(volume: Clusters, p_map: Array) -> NDArray[np.int64]:
    """Number of the first cluster that each point is in, -1 = none, (N, 3) [m] -> (N,)."""
    found = np.full(len(p_map), -1, np.int64)
    if not len(p_map):
        return found
    low, high = p_map.min(axis=0), p_map.max(axis=0)
    lows, highs = cluster_bounds(volume)
    for k in np.flatnonzero(np.all((lows <= high) & (highs >= low), axis=1)).tolist():
        near = np.all((p_map >= lows[k]) & (p_map <= highs[k]), axis=1) & (found < 0)
        rows = np.flatnonzero(near)
        found[rows[_inside(volume.clusters[k], volume.edge_m, p_map[rows])]] = k
    return found


def cluster_bounds(volume: Clusters) -> tuple[Array, Array]:
    """Smallest and largest coordinates of each cluster in the map [m], (C, 3) each."""
    corners = np.array([_corners(one, volume.edge_m) for one in volume.clusters])
    return corners.min(axis=1), corners.max(axis=1)


def cluster_corners(volume: Clusters) -> Array:
    """Corners of a box along the axes of the map around all clusters [m], (8, 3)."""
    lows, highs = cluster_bounds(volume)
    which = np.indices((2, 2, 2)).reshape(3, 8).T
    return np.where(which, highs.max(axis=0), lows.min(axis=0))


def moved_clusters(volume: Clusters, T_new_old: SE3) -> Clusters:
    """The same in another map, as `recon4.model.volumes.moved`."""
    return msgspec.structs.replace(
        volume, clusters=tuple(moved_cluster(one, T_new_old) for one in volume.clusters)
    )


def moved_cluster(one: CellCluster, T_new_old: SE3) -> CellCluster:
    """A cluster in another map."""
    u, v = (_vector(T_new_old.R @ np.array(axis)) for axis in (one.u, one.v))
    origin = _vector(T_new_old @ np.array(one.origin_m))
    return msgspec.structs.replace(one, origin_m=origin, u=u, v=v)


def _inside(one: CellCluster, edge_m: float, p_map: Array) -> NDArray[np.bool_]:
    columns = np.array(one.columns, np.int64)
    keys = _keys(columns[:, 0], columns[:, 1], columns[:, 2])
    order = np.argsort(keys)
    keys, columns = keys[order], columns[order]
    i, j, k = np.floor((p_map - np.array(one.origin_m)) @ _axes(one).T / edge_m).astype(np.int64).T
    row = np.maximum(np.searchsorted(keys, _keys(i, j, k), side="right") - 1, 0)
    a, b, first, last = columns[row].T
    return np.asarray((a == i) & (b == j) & (first <= k) & (k <= last))


def _keys(i: NDArray[np.int64], j: NDArray[np.int64], k: NDArray[np.int64]) -> NDArray[np.int64]:
    wide = np.int64(4 * CLUSTERS.most_number)
    return np.asarray((i * wide + j) * wide + k)


def _corners(one: CellCluster, edge_m: float) -> Array:
    columns = np.array(one.columns, np.float64)
    low = columns[:, :3].min(axis=0) * edge_m
    high = (columns[:, [0, 1, 3]].max(axis=0) + 1.0) * edge_m
    which = np.indices((2, 2, 2)).reshape(3, 8).T
    return np.asarray(np.where(which, high, low) @ _axes(one) + np.array(one.origin_m))


def _axes(one: CellCluster) -> Array:
    return np.array([one.u, one.v, np.cross(one.u, one.v)])


def _vector(values: Array) -> Vector:
    x, y, z = (float(value) for value in values)
    return x, y, z
