"""Compares two maps as a whole: common frame, M3C2, and what is written of it."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Literal

import numpy as np

from recon4.comparison.common_frame import MapSide, Relation, relate
from recon4.comparison.m3c2 import differences
from recon4.comparison.records import (
    ComparedMap,
    CoreDifferences,
    DifferenceTally,
    M3C2Scales,
    MapDifferences,
)
from recon4.errors import ConfigError
from recon4.geometry.se3 import SE3
from recon4.locales.coded import CodedText
from recon4.mapping.tile import DEVIATION
from recon4.progress import Progress
from recon4.slices.align import align_by_icp
from recon4.slices.reference import Reference

Sink = Callable[[Iterator[CoreDifferences]], None]
"""Writes core points while they are computed, and takes all of them."""


@dataclass(frozen=True, slots=True, eq=False)
class MapPair:
    """Two maps in one frame."""

    first: MapSide
    """The map with the core points."""
    second: MapSide
    """The map that is compared with it."""
    relation: Relation

    @staticmethod
    def of(first: MapSide, second: MapSide, *, align: bool) -> MapPair:
        """Two maps, related by what they state or by an alignment.

        Args:
            first: The map with the core points.
            second: The map that is compared with it.
            align: Lay the second on the first by ICP (`recon4.slices.align`).

        Raises:
            ConfigError: If they have no common frame, or ICP does not align them.
            GeoreferenceError: If their systems cannot be transformed.
        """
        return MapPair(first, second, common_frame(first, second, align=align))

    def scales(self, core_spacing_m: float) -> M3C2Scales:
        """Sizes that suit the voxels of both."""
        voxels_m = self.first.tiles.notes.voxel_m, self.second.tiles.notes.voxel_m
        return M3C2Scales.of_maps(voxels_m, core_spacing_m=core_spacing_m)


def compare_maps(
    pair: MapPair, sink: Sink, *, scales: M3C2Scales, progress: Progress
) -> MapDifferences:
    """Compare two maps.

    Args:
        pair: The maps.
        sink: Writes the core points.
        scales: Sizes.
        progress: Counts tiles.

    Raises:
        Altered: If a map was approved and is not what was approved.
        ConfigError: If a size is out of range.
        StoreError: If a map is damaged, or what is written cannot be written.
    """
    first, second, relation = pair.first, pair.second, pair.relation
    tally = DifferenceTally()

    def counted() -> Iterator[CoreDifferences]:
        parts = differences(
            first.tiles, second.tiles, relation.T_a_b, scales=scales, progress=progress
        )
        for part in parts:
            tally.add(part)
            yield part

    sink(counted())
    return MapDifferences(
        first=_compared(first),
        second=_compared(second),
        relation=relation.text,
        T_a_b=np.round(relation.T_a_b.matrix(), 9).tolist(),
        scales=scales,
        counts=tally.counts(),
        distances=tally.figures(),
    )


def common_frame(first: MapSide, second: MapSide, *, align: bool) -> Relation:
    """The relation of two maps, by what they state or by ICP.

    Raises:
        ConfigError: If they have none, or ICP does not align them.
        GeoreferenceError: If their systems cannot be transformed.
    """
    relation = relate(first, second)
    if align:
        return _aligned(first, second, relation.T_a_b if relation else SE3.identity())
    if relation is None:
        raise ConfigError(CodedText("compare-no-frame", first=first.name, second=second.name))
    return relation


def _aligned(first: MapSide, second: MapSide, start: SE3) -> Relation:
    other = Reference(second.name, Path(), start, tiles=second.tiles)
    fit = align_by_icp(first.tiles, other, rng=np.random.default_rng(1))
    text = CodedText("compare-aligned", how=fit.description)
    return Relation(fit.T_map_reference, text)


def _compared(side: MapSide) -> ComparedMap:
    stated: Literal["stated", "usual"] = "stated" if DEVIATION in side.tiles.fields else "usual"
    return ComparedMap(name=side.name, key=side.key, points=len(side.tiles), registration=stated)
