"""Corrections of classes by people: counted in a map before they are made, and led into the next.

A correction is a volume in the frame of the map that a person looked at. It keeps where the body
was when it measured some of the points, its anchors: by their poses in another map of the same walk
the volume follows its points, or does not apply where they no longer lie together. Of clusters each
one has anchors of its own: they lie anywhere in the map, and move apart with it.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

import msgspec
import numpy as np
from numpy.typing import NDArray

from recon4.classes.tuning import CORRECTIONS
from recon4.errors import StoreError
from recon4.geometry.se3 import SE3, Array, align_points
from recon4.locales.coded import CodedText
from recon4.mapping.class_corrections import ClassVolume, ClassVolumes
from recon4.mapping.tile import Columns
from recon4.mapping.tiles import Tile, TileSet
from recon4.mapping.tuning import TILES
from recon4.model.cell_clusters import CellCluster, Clusters, cluster_of, moved_cluster
from recon4.model.class_corrections import Anchor, ClassCorrection, Reclassified
from recon4.model.classes import CLASSES, PointClass
from recon4.model.trajectory import Times, Trajectory
from recon4.model.volumes import Volume, bounds_of, contains, corners_of, moved


@dataclass(frozen=True, slots=True, eq=False)
class CountedPoints:
    """What a correction would change in a map."""

    changed: dict[int, int]
    """Class now -> how many points change."""
    inside: dict[int, int]
    """Class now -> how many points are in the volume, those that the map leaves out as well."""
    t_ns: Times
    """Times of some of the points that change, every tenth of a second at most once [ns], (T,)."""
    away_m: float
    """From the volume to the bounds of the map; 0 = they meet [m]."""
    clusters_ns: tuple[Times, ...] = ()
    """The same as ``t_ns`` for each cluster of the volume; empty for other volumes."""

    @property
    def points(self) -> int:
        """How many points change."""
        return sum(self.changed.values())

    def why_none(self, what: Reclassified) -> CodedText | None:
        """Why no point changes; None if one does."""
        if self.changed:
            return None
        if self.away_m > 0.0:
            return CodedText("class-no-points-near", away_m=self.away_m)
        if not self.inside:
            return CodedText("class-no-points")
        if {*self.inside} == {what.to}:
            return CodedText("class-already", title=CLASSES[PointClass(what.to)].title)
        there = ";".join(
            f"{CLASSES[PointClass(one)].title}:{count}" for one, count in self.inside.items()
        )
        return CodedText("class-not-corrected", there=there)


@dataclass(frozen=True, slots=True)
class PlacedCorrection:
    """A correction in another map of the walk."""

    what: Reclassified | None
    """With its volume where the points now are; None = they no longer lie together."""
    moved_m: float
    """How far the points have moved at most [m]."""
    apart_m: float
    """How far they have moved against each other [m]; infinite = the walk no longer has them."""
    lost: int = 0
    """Clusters of it that are left out, because their points no longer lie together."""


def count_points(
    tiles: TileSet, what: Reclassified, before: Sequence[Reclassified] = ()
) -> CountedPoints:
    """Count what a correction would change.

    Args:
        tiles: The map.
        what: The correction, in its frame.
        before: Corrections that are not in this map yet and apply first.

    Raises:
        StoreError: If the points of the map have no classes, or it cannot be read.
    """
    if "classification" not in tiles.fields:
        raise StoreError(CodedText("classes-missing"))
    new, pending = ClassVolume.of(what), ClassVolumes.of(before)
    changed, inside = np.zeros(256, np.int64), np.zeros(256, np.int64)
    slots: list[NDArray[np.int64]] = [np.empty((0, 2), np.int64)]
    for tile, columns in _parts_in(tiles, new):
        p_map = columns["xyz"].astype(np.float64) + tile.origin_m
        part_of = _parts_of(what.volume, p_map)
        within = part_of >= 0
        classes = columns["classification"][within].copy()
        pending.apply(classes, p_map[within])
        inside += np.bincount(classes, minlength=256)
        hit = new.changes[classes]
        changed += np.bincount(classes[hit], minlength=256)
        slot = columns["t_ns"][within][hit] // CORRECTIONS.slot_ns
        slots.append(np.unique(np.stack([part_of[within][hit], slot], axis=1), axis=0))
    found = np.unique(np.concatenate(slots), axis=0)
    many = len(what.volume.clusters) if isinstance(what.volume, Clusters) else 0
    return CountedPoints(
        _counted(changed),
        _counted(inside),
        _middles_ns(found),
        _away_m(tiles, what.volume),
        tuple(_middles_ns(found[found[:, 0] == k]) for k in range(many)),
    )


def correction_of(
    what: Reclassified, counted: CountedPoints, trajectory: Trajectory, *, map_key: str
) -> ClassCorrection:
    """A correction as the journal keeps it.

    Args:
        what: In the frame of the map.
        counted: What it changes there, one point at least.
        trajectory: ``T_map_body`` of that map.
        map_key: Its key.
    """
    t_ns = _some(counted.t_ns, CORRECTIONS.anchors, trajectory)
    if isinstance(what.volume, Clusters):
        led = [
            msgspec.structs.replace(one, seen_ns=tuple(times.tolist()))
            for one, found in zip(what.volume.clusters, counted.clusters_ns, strict=True)
            if len(times := _some(found, CORRECTIONS.cluster_anchors, trajectory))
        ]
        what = replace(what, volume=Clusters(clusters=tuple(led), edge_m=what.volume.edge_m))
        t_ns = np.unique(np.array([t for one in led for t in one.seen_ns], np.int64))
    poses = trajectory.at(t_ns)
    anchors = tuple(
        Anchor(t_ns=int(t), T_map_body=(*map(float, pose.t), *map(float, pose.quat_xyzw())))
        for t, pose in zip(t_ns, (poses[k] for k in range(len(t_ns))), strict=True)
    )
    return ClassCorrection(what=what, points=counted.points, map_key=map_key, anchors=anchors)


def _some(t_ns: Times, most: int, trajectory: Trajectory) -> Times:
    """Times spread over those given, within a trajectory, (T,)."""
    rows = np.unique(np.linspace(0, len(t_ns) - 1, min(most, len(t_ns))).round().astype(np.intp))
    return np.unique(np.clip(t_ns[rows], trajectory.t_ns[0], trajectory.t_ns[-1]))


def place_correction(correction: ClassCorrection, trajectory: Trajectory) -> PlacedCorrection:
    """Lead a correction into a map.

    Args:
        correction: In the frame of the map that the person looked at.
        trajectory: ``T_map_body`` of the map that is made.
    """
    t_ns = np.array([one.t_ns for one in correction.anchors], np.int64)
    if not len(trajectory) or t_ns[0] < trajectory.t_ns[0] or t_ns[-1] > trajectory.t_ns[-1]:
        return PlacedCorrection(None, np.inf, np.inf)
    places = np.array([one.T_map_body for one in correction.anchors])
    T_new_old = trajectory.at(t_ns) @ SE3.from_quat(places[:, 3:], places[:, :3]).inverse()
    volume = correction.what.volume
    if isinstance(volume, Clusters):
        return _place_clusters(correction.what, volume, T_new_old, t_ns=t_ns)
    T, moved_m, apart_m = _led(corners_of(volume), T_new_old)
    if apart_m > CORRECTIONS.apart_m:
        return PlacedCorrection(None, moved_m, apart_m)
    if moved_m < CORRECTIONS.still_m:
        return PlacedCorrection(correction.what, moved_m, apart_m)
    return PlacedCorrection(replace(correction.what, volume=moved(volume, T)), moved_m, apart_m)


def _place_clusters(
    what: Reclassified, volume: Clusters, T_new_old: SE3, *, t_ns: Times
) -> PlacedCorrection:
    """Lead each cluster by its own anchors; those that came apart are left out."""
    kept: list[CellCluster] = []
    ways: list[tuple[float, float]] = []
    lost: list[tuple[float, float]] = []
    for one in volume.clusters:
        mine = T_new_old[np.isin(t_ns, one.seen_ns)]
        alone = Clusters(clusters=(one,), edge_m=volume.edge_m)
        T, moved_m, apart_m = _led(corners_of(alone), mine)
        if apart_m > CORRECTIONS.apart_m:
            lost.append((moved_m, apart_m))
            continue
        kept.append(one if moved_m < CORRECTIONS.still_m else moved_cluster(one, T))
        ways.append((moved_m, apart_m))
    moved_m, apart_m = np.max(ways or lost, axis=0).tolist()
    if not kept:
        return PlacedCorrection(None, moved_m, apart_m, len(lost))
    placed = replace(what, volume=Clusters(clusters=tuple(kept), edge_m=volume.edge_m))
    return PlacedCorrection(placed, moved_m, apart_m, len(lost))


def _led(corners: Array, T_new_old: SE3) -> tuple[SE3, float, float]:
    """Where anchors lead the corners of a volume: the motion, how far they move and come apart."""
    wide = _wide(corners)
    there = np.array([T_new_old[k] @ wide for k in range(len(T_new_old))])
    T = align_points(there.mean(axis=0), wide)
    apart_m = float(np.linalg.norm(there - T @ wide, axis=2).max())
    return T, float(np.linalg.norm(there - wide, axis=2).max()), apart_m


def _parts_of(volume: Volume, p_map: Array) -> NDArray[np.int64]:
    """Number of the cluster of each point, 0 in other volumes, -1 outside, (N,)."""
    if isinstance(volume, Clusters):
        return cluster_of(volume, p_map)
    return contains(volume, p_map).astype(np.int64) - 1


def _middles_ns(found: NDArray[np.int64]) -> Times:
    """Middles of the slots in rows of part and slot, each once [ns], (T,)."""
    return np.unique(found[:, 1]) * CORRECTIONS.slot_ns + CORRECTIONS.slot_ns // 2


def _parts_in(tiles: TileSet, one: ClassVolume) -> Iterator[tuple[Tile, Columns]]:
    """What is stored of the tiles that a volume meets, with what the map leaves out."""
    for tile in tiles:
        parts = [tile] if len(tile) else []
        if tile.strays:
            parts.append(tile.stray_part(tiles.tile_m))
        for part in parts:
            low_m, high_m = np.array(part.low_m), np.array(part.high_m)
            if one.meets(low_m - TILES.margin_m, high_m + TILES.margin_m):
                yield part, part.read(["xyz", "classification", "t_ns"])


def _counted(counts: NDArray[np.int64]) -> dict[int, int]:
    return {int(k): int(counts[k]) for k in np.flatnonzero(counts)}


def _away_m(tiles: TileSet, volume: Volume) -> float:
    """Distance from the box around a volume to that around the map [m]."""
    (low, high), (first, last) = bounds_of(volume), tiles.bounds_m
    between = np.maximum(np.maximum(first - high, low - last), 0.0)
    return float(np.linalg.norm(between)) if np.isfinite(between).all() else 0.0


def _wide(corners: Array) -> Array:
    """Corners farther apart, so that those of a thin volume determine its turn."""
    middle = corners.mean(axis=0)
    low, high = corners.min(axis=0), corners.max(axis=0)
    half = np.maximum((high - low) / 2.0, CORRECTIONS.wide_m)
    return np.asarray(middle + half * (2.0 * np.indices((2, 2, 2)).reshape(3, 8).T - 1.0))
