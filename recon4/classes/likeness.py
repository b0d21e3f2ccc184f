"""All things like one: clusters of a class whose evidence is that of a cluster a person picked."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from recon4.classes.clusters import ClusterEvidence, cells_of_class, connected, evidence, keys_at
from recon4.classes.tuning import LIKENESS
from recon4.errors import ConfigError, StoreError
from recon4.geometry.se3 import Array
from recon4.locales.coded import CodedText
from recon4.mapping.cell_runs import cell_numbers
from recon4.mapping.class_corrections import ClassVolumes
from recon4.mapping.tiles import TileSet
from recon4.model.alike import Alike, AlikeCluster, PickedThing
from recon4.model.cell_clusters import CellCluster
from recon4.model.class_corrections import Reclassified
from recon4.model.tuning import CLUSTERS

Vector = tuple[float, float, float]


def find_alike(tiles: TileSet, picked: PickedThing, before: Sequence[Reclassified] = ()) -> Alike:
    """Find all clusters like the one at a place.

    Args:
        tiles: The map.
        picked: The place, and the class that is looked for.
        before: Corrections that are not in this map yet and apply first.

    Raises:
        ConfigError: If no such point is there, or the cluster is too large for a correction.
        StoreError: If the points of the map have no classes, or it cannot be read.
    """
    if "classification" not in tiles.fields:
        raise StoreError(CodedText("classes-missing"))
    pending = ClassVolumes.of(before)
    place, code = _nearest(tiles, picked, pending)
    cells = cells_of_class(tiles, code, pending)
    cluster = connected(cells.key)
    mine = int(cluster[np.searchsorted(cells.key, keys_at(place[None], LIKENESS.cell_m)[0])])
    found = evidence(tiles, cells, cluster)
    different = differences(found, mine)
    rows = np.flatnonzero(different <= CLUSTERS.most_different)
    rows = rows[np.argsort(different[rows], kind="stable")]
    rows = np.concatenate([[mine], rows[rows != mine]])
    clusters = _columns(cells.key, cluster, rows)
    room = np.cumsum([len(one.columns) for one in clusters]) <= CLUSTERS.most_columns
    many = min(int(room.sum()), CLUSTERS.most)
    if not many:
        raise ConfigError(CodedText("like-too-large", points=int(found.points[mine])))
    chosen = zip(clusters[:many], rows[:many].tolist(), strict=True)
    return Alike(
        of=code,
        edge_m=LIKENESS.cell_m,
        clusters=tuple(_described(one, found, k, different=different[k]) for one, k in chosen),
        left_out=len(rows) - many,
    )


def differences(found: ClusterEvidence, mine: int) -> Array:
    """How different clusters are from one of them, (K,); what is unknown of either says nothing."""
    parts = [np.abs(np.log(found.cells / found.cells[mine])) / np.log(LIKENESS.cells_ratio)]
    for extent in (found.high, found.long_m, found.wide_m):
        usual = max(LIKENESS.length_ratio * extent[mine], LIKENESS.least_length_m)
        parts.append(np.abs(extent - extent[mine]) / usual)
    for values, usual in (
        (found.over_ground_m, LIKENESS.over_ground_m),
        (found.planarity, LIKENESS.planarity),
        (found.seen_through, LIKENESS.seen_through),
    ):
        parts.append(np.nan_to_num(np.abs(values - values[mine]) / usual))
    return np.asarray(np.max(parts, axis=0))


def _nearest(tiles: TileSet, picked: PickedThing, pending: ClassVolumes) -> tuple[Array, int]:
    """The nearest point that the picked thing can be of [m], (3,), and its class.

    Raises:
        ConfigError: If none is near.
    """
    at = np.array(picked.place_m)
    best, place, code = LIKENESS.reach_m, None, 0
    for tile in (*tiles, *tiles.only_strays()):
        away = np.maximum(np.maximum(np.array(tile.low_m) - at, at - np.array(tile.high_m)), 0.0)
        if np.linalg.norm(away) > LIKENESS.reach_m:
            continue
        columns = tile.read(["xyz", "classification"])
        p_map = columns["xyz"].astype(np.float64) + tile.origin_m
        near = np.flatnonzero(np.all(np.abs(p_map - at) <= LIKENESS.reach_m, axis=1))
        classes = columns["classification"][near].copy()
        pending.apply(classes, p_map[near])
        ours = np.isin(classes, picked.classes)
        near, classes = near[ours], classes[ours]
        if len(near):
            distance = np.linalg.norm(p_map[near] - at, axis=1)
            k = int(distance.argmin())
            if distance[k] < best:
                best, place, code = float(distance[k]), p_map[near[k]], int(classes[k])
    if place is None:
        raise ConfigError(CodedText("like-nothing-there"))
    return place, code


def _columns(
    key: NDArray[np.int64], cluster: NDArray[np.int32], rows: NDArray[np.intp]
) -> list[CellCluster]:
    """Some clusters as columns of cells."""
    order = np.argsort(cluster, kind="stable")
    starts = np.searchsorted(cluster[order], rows)
    stops = np.searchsorted(cluster[order], rows, side="right")
    return [_one(cell_numbers(key[order[a:b]])) for a, b in zip(starts, stops, strict=True)]


def _one(numbers: NDArray[np.int64]) -> CellCluster:
    """A cluster of cells, by their numbers in ascending order, (C, 3)."""
    low = numbers.min(axis=0)
    numbers = numbers - low
    step = np.diff(numbers, axis=0)
    ends = np.flatnonzero((step[:, :2] != 0).any(axis=1) | (step[:, 2] != 1))
    first, last = np.append(0, ends + 1), np.append(ends, len(numbers) - 1)
    columns = np.column_stack([numbers[first], numbers[last, 2]]).tolist()
    return CellCluster(
        origin_m=_vector(low * LIKENESS.cell_m + LIKENESS.shift_m),
        columns=tuple((i, j, a, b) for i, j, a, b in columns),
    )


def _described(
    one: CellCluster, found: ClusterEvidence, k: int, *, different: float
) -> AlikeCluster:
    over_m, seen = float(found.over_ground_m[k]), float(found.seen_through[k])
    return AlikeCluster(
        cluster=one,
        points=int(found.points[k]),
        low_m=_vector(found.low_m[k]),
        high_m=_vector(found.high_m[k]),
        difference=round(float(different), 3),
        over_ground_m=None if np.isnan(over_m) else round(over_m, 2),
        planarity=round(float(found.planarity[k]), 3),
        seen_through=None if np.isnan(seen) else round(seen, 3),
    )


def _vector(values: Array) -> Vector:
    x, y, z = (round(float(value), 6) for value in values)
    return x, y, z
