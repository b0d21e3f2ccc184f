"""Which points of a map are written: by class, place and distance of neighbors."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from recon4.errors import ConfigError
from recon4.export.options import Box, ClipBox
from recon4.export.tuning import POINT_EXPORT
from recon4.geometry.se3 import Array
from recon4.locales.coded import CodedText
from recon4.mapping.tile import Columns
from recon4.model.classes import CLASSES, PointClass

EVERY_CLASS = frozenset(int(code) for code in PointClass)


@dataclass(frozen=True, slots=True, kw_only=True)
class PointSelection:
    """Which points of a map are written."""

    classes: frozenset[int] = frozenset()
    """Codes of `recon4.model.classes`; empty = those that the map delivers."""
    box_m: Box | None = None
    """Points in it, borders included, in the coordinates of the file [m]; None = all."""
    clip: tuple[ClipBox, ...] = ()
    """Points inside of all these boxes, borders included, in the map; empty = all."""
    heights_m: tuple[float, float] | None = None
    """Points from the first height to below the second, in the map [m]; None = all."""
    thin_m: float = 0.0
    """One point in each cube with this edge [m]; 0 = all. The cubes begin at the corner of each
    tile; what the map leaves out is thinned on its own."""

    def __post_init__(self) -> None:
        unknown = sorted(self.classes - EVERY_CLASS)
        if unknown:
            raise ConfigError(
                CodedText(
                    "classes-unknown", every_class=str(sorted(EVERY_CLASS)), unknown=str(unknown)
                )
            )
        if self.box_m is not None:
            _check_box(self.box_m)
        if self.clip:
            _check_clip(self.clip)
        if not (math.isfinite(self.thin_m) and 0.0 <= self.thin_m <= 100.0):
            raise ConfigError(CodedText("thinning-range", thin_m=self.thin_m))
        if 0.0 < self.thin_m < 1e-4:
            raise ConfigError(CodedText("thinning-least", thin_m=self.thin_m))

    @property
    def is_whole(self) -> bool:
        """Whether nothing of what is read is left out."""
        whole = self.classes in (frozenset(), EVERY_CLASS)
        part = self.box_m is not None or self.clip or self.heights_m is not None
        return whole and not part and not self.thin_m

    @property
    def left_out(self) -> bool:
        """Whether points are wanted that the map leaves out."""
        return any(not CLASSES[PointClass(code)].delivered for code in self.classes)

    def rows(self, columns: Columns, origin_m: Array) -> NDArray[np.intp]:
        """Rows of a tile's points that are wanted but for the box, ascending.

        Args:
            columns: ``xyz`` relative to the tile, (N, 3), and ``classification``, (N,).
            origin_m: Corner of the tile in the map [m], (3,).
        """
        kept = np.ones(len(columns["xyz"]), np.bool_)
        if self.classes:
            wanted = np.zeros(256, np.bool_)
            wanted[list(self.classes)] = True
            kept &= wanted[columns["classification"]]
        if self.heights_m is not None:
            z_m = columns["xyz"][:, 2].astype(np.float64) + origin_m[2]
            kept &= (z_m >= self.heights_m[0]) & (z_m < self.heights_m[1])
        rows = np.flatnonzero(kept)
        for box in self.clip:
            rows = rows[_inside(columns["xyz"][rows] + origin_m, box)]
        return rows[_first_of_cubes(columns["xyz"][rows], self.thin_m)] if self.thin_m else rows

    def in_box(self, xyz: Array) -> NDArray[np.bool_]:
        """Which coordinates of the file lie in the box, (N,)."""
        if self.box_m is None:
            return np.ones(len(xyz), np.bool_)
        low, high = np.array(self.box_m[:3]), np.array(self.box_m[3:])
        return np.asarray(((xyz >= low) & (xyz <= high)).all(axis=1), np.bool_)

    def may_have_inside(self, low_m: Array, high_m: Array, *, margin_m: float) -> bool:
        """Whether the clip may have points between two corners in the map, (3,) each."""
        for box in self.clip:
            reach_m = _reach(box) + margin_m
            if (low_m > box[:3] + reach_m).any() or (high_m < box[:3] - reach_m).any():
                return False
        return True

    def may_have(self, corners: Array, *, margin_m: float) -> bool:
        """Whether the box may have points between some corners in coordinates of the file."""
        if self.box_m is None:
            return True
        low, high = corners.min(axis=0) - margin_m, corners.max(axis=0) + margin_m
        return bool((high >= self.box_m[:3]).all() and (low <= self.box_m[3:]).all())


DELIVERED = PointSelection()
"""All points that the map delivers."""


def shares_text(counts: Mapping[int, int]) -> str:
    """The classes of a map with their part of all points: ``ground 12.3 %, building 70.1 %``."""
    total = sum(counts.values())
    known = [(CLASSES[PointClass(code)].title, n) for code, n in sorted(counts.items())]
    return ", ".join(f"{title} {100.0 * n / total:.1f} %" for title, n in known) or "no classes"


def _check_box(box_m: Box) -> None:
    low, high = box_m[:3], box_m[3:]
    if len(box_m) != 6 or not all(map(math.isfinite, box_m)):
        raise ConfigError(CodedText("box-numbers", box_m=str(list(box_m))))
    if any(a > b for a, b in zip(low, high, strict=True)):
        raise ConfigError(CodedText("box-order", box_m=str(list(box_m))))


def _check_clip(clip: tuple[ClipBox, ...]) -> None:
    most = POINT_EXPORT.most_clip_boxes
    if len(clip) > most:
        raise ConfigError(CodedText("clip-most", most=most, count=len(clip)))
    for box in clip:
        if len(box) != 7 or not all(map(math.isfinite, box)) or min(box[3:6]) <= 0.0:
            raise ConfigError(CodedText("clip-numbers", box=str(list(box))))


def _inside(xyz: Array, box: ClipBox) -> NDArray[np.bool_]:
    """Which points of the map lie in a turned box, (N,)."""
    c, s = math.cos(math.radians(box[6])), math.sin(math.radians(box[6]))
    x, y, z = (xyz - box[:3]).T
    across = np.abs(c * x + s * y), np.abs(c * y - s * x), np.abs(z)
    half = np.array(box[3:6]) / 2.0
    return np.asarray(np.all([one <= most for one, most in zip(across, half, strict=True)], 0))


def _reach(box: ClipBox) -> Array:
    """How far a turned box reaches from its middle along the axes of the map [m], (3,)."""
    c, s = abs(math.cos(math.radians(box[6]))), abs(math.sin(math.radians(box[6])))
    dx, dy, dz = box[3:6]
    return np.array([c * dx + s * dy, s * dx + c * dy, dz]) / 2.0


def _first_of_cubes(xyz: NDArray[np.float32], edge_m: float) -> NDArray[np.intp]:
    """The first point in each cube, ascending."""
    if not len(xyz):
        return np.empty(0, np.intp)
    cube = np.floor(xyz.astype(np.float64) / edge_m).astype(np.int64)
    cube -= cube.min(axis=0)
    bits = POINT_EXPORT.cube_bits
    keys = (cube[:, 0] << 2 * bits) | (cube[:, 1] << bits) | cube[:, 2]
    return np.sort(np.unique(keys, return_index=True)[1])
