"""Corrections of classes, applied to the points of a map: as it is made, or as it is."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from recon4.geometry.se3 import Array
from recon4.mapping.tile import TilePlaces
from recon4.mapping.tile_packing import as_stored
from recon4.mapping.tuning import TILES
from recon4.model.class_corrections import Reclassified
from recon4.model.classes import CLASSES
from recon4.model.volumes import Volume, bounds_of, bounds_of_parts, contains


@dataclass(frozen=True, slots=True, eq=False)
class ClassVolume:
    """A correction, ready for many points."""

    volume: Volume
    to: int
    low_m: Array
    high_m: Array
    """Bounds of the volume in the map, (3,)."""
    changes: NDArray[np.bool_]
    """Whether it changes points of each class, (256,)."""
    parts_m: tuple[Array, Array]
    """Bounds of what the volume is made of, (K, 3) each."""

    @staticmethod
    def of(what: Reclassified) -> ClassVolume:
        """Prepare a correction; a point that has the new class already is not changed."""
        delivered = [int(one) for one, facts in CLASSES.items() if facts.delivered]
        changed = {*(what.only or delivered)} - {what.to}
        return ClassVolume.changing(what.volume, what.to, sorted(changed))

    @staticmethod
    def changing(volume: Volume, to: int, classes: Sequence[int]) -> ClassVolume:
        """Points of some classes in a volume get another one.

        Args:
            volume: In the map.
            to: Code of the new class.
            classes: Codes of those that are changed.
        """
        low_m, high_m = bounds_of(volume)
        changes = np.zeros(256, np.bool_)
        changes[list(classes)] = True
        return ClassVolume(volume, to, low_m, high_m, changes, bounds_of_parts(volume))

    def meets(self, low_m: Array, high_m: Array) -> bool:
        """Whether a box in the map may have points of it, (3,) each [m]."""
        lows, highs = self.parts_m
        return bool(np.any(np.all((lows <= high_m) & (highs >= low_m), axis=1)))

    def of_points(self, p_map: Array, classes: NDArray[np.uint8]) -> NDArray[np.bool_]:
        """Which points it changes, (N, 3) [m] and (N,) -> (N,)."""
        return np.asarray(contains(self.volume, p_map) & self.changes[classes])


@dataclass(frozen=True, slots=True, eq=False)
class ClassVolumes:
    """The corrections of a map, in the order in which they apply."""

    steps: tuple[ClassVolume, ...]

    @staticmethod
    def of(corrections: Iterable[Reclassified]) -> ClassVolumes:
        """Prepare corrections."""
        return ClassVolumes(tuple(map(ClassVolume.of, corrections)))

    def apply(self, classes: NDArray[np.uint8], p_map: Array) -> None:
        """Correct the classes of points of a map.

        Args:
            classes: Changed in place, (N,).
            p_map: Where the points are [m], (N, 3).
        """
        for one in self.steps:
            classes[one.of_points(p_map, classes)] = one.to

    def apply_to_tile(
        self, classes: NDArray[np.uint8], rows: NDArray[np.intp], places: TilePlaces
    ) -> Counter[int]:
        """Correct the classes of the points of a tile that is being made.

        Whether a point is in a volume is decided by its place as the finished map has it, so that
        what is counted there is what is changed here.

        Args:
            classes: Of all records; changed in place, (N,).
            rows: Records that the tile keeps, (M,).
            places: Of the records.

        Returns:
            Number of a correction -> how many points it changed.
        """
        counts: Counter[int] = Counter()
        if not len(rows):
            return counts
        p = places.measured[rows]
        least, most = p.min(axis=0) + places.origin_m, p.max(axis=0) + places.origin_m
        for k, one in enumerate(self.steps):
            if not one.meets(least - TILES.margin_m, most + TILES.margin_m):
                continue
            low = one.low_m - places.origin_m - TILES.margin_m
            high = one.high_m - places.origin_m + TILES.margin_m
            near = one.changes[classes[rows]] & np.all((p >= low) & (p <= high), axis=1)
            for part in _parts(rows[near]):
                # As they are read from the map.
                stored = as_stored("xyz", places.in_map(part)).astype(np.float32)
                inside = part[one.of_points(stored + places.origin_m, classes[part])]
                classes[inside] = one.to
                counts[k] += len(inside)
        return counts


def _parts(rows: NDArray[np.intp]) -> list[NDArray[np.intp]]:
    """Rows in parts whose columns fit into memory."""
    return np.split(rows, range(TILES.block, len(rows), TILES.block))
