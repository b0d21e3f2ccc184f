"""What a tile has in cells of some centimeters: mean place, intensity and normal."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, fields

import numpy as np
from numpy.typing import NDArray

from recon4.geometry.se3 import Array
from recon4.mapping.tiles import Tile, TileSet
from recon4.slices.tuning_targets import TARGET_CELLS


@dataclass(frozen=True, slots=True, eq=False)
class TargetCells:
    """Cells of a tile that have points, N of them."""

    xyz: Array
    """Mean place in the map [m], (N, 3)."""
    value: Array
    """Mean intensity, (N,)."""
    brightest: Array
    """Largest intensity, (N,)."""
    normal: Array
    """Mean normal, towards the sensors, length up to 1, (N, 3); zero = the map has none."""
    count: Array
    """Points, (N,)."""
    block: NDArray[np.intp]
    """Which block each cell is of, 0 to B - 1, (N,)."""

    def part(self, rows: NDArray[np.intp]) -> TargetCells:
        """Some of the cells."""
        columns = {name: getattr(self, name)[rows] for name in _COLUMNS}
        return TargetCells(**columns)

    @staticmethod
    def joined(parts: Sequence[TargetCells]) -> TargetCells:
        """The cells of several tiles, whose blocks stay apart."""
        first = np.cumsum([0, *(int(one.block.max(initial=-1)) + 1 for one in parts)])
        columns = {
            name: np.concatenate([getattr(one, name) for one in parts])
            for name in _COLUMNS
            if name != "block"
        }
        block = [one.block + start for one, start in zip(parts, first, strict=False)]
        return TargetCells(block=np.concatenate(block), **columns)

    def contrast(self) -> Array:
        """Brightest minus darkest cell of its block, in the brightest, of each cell (N,)."""
        count = int(self.block.max(initial=-1)) + 1
        low, high = np.full(count, np.inf), np.zeros(count)
        np.minimum.at(low, self.block, self.value)
        np.maximum.at(high, self.block, self.value)
        found: Array = ((high - low) / np.maximum(high, 1.0))[self.block]
        return found

    def flatness(self) -> Array:
        """Length of the mean normal of its block, of each cell (N,); 1 = flat."""
        count = int(self.block.max(initial=-1)) + 1
        unit = _unit(self.normal)
        total = np.stack(
            [np.bincount(self.block, unit[:, k], minlength=count) for k in range(3)], axis=1
        )
        cells = np.maximum(np.bincount(self.block, minlength=count), 1)
        found: Array = (np.linalg.norm(total, axis=1) / cells)[self.block]
        return found


_COLUMNS = tuple(one.name for one in fields(TargetCells))


def value_field(tiles: TileSet) -> str:
    """The intensities of a map: normalized, else raw."""
    return "intensity_normalized" if "intensity_normalized" in tiles.fields else "intensity"


def usual_intensity(tiles: TileSet, quantile: float) -> float:
    """A quantile of the intensities of a map, by an even sample; 0 if it has no points."""
    name = value_field(tiles)
    parts = [tile.read([name], limit=TARGET_CELLS.sampled)[name] for tile in tiles if len(tile)]
    return float(np.quantile(np.concatenate(parts), quantile)) if parts else 0.0


def cells_of(tile: Tile, value: str) -> TargetCells:
    """The cells of a tile; ``value`` names the intensities."""
    has_normal = "normal" in tile.fields
    found = tile.read(["xyz", value, *(["normal"] if has_normal else [])])
    xyz, values = found["xyz"].astype(np.float64), found[value].astype(np.float64)
    key = _keys(xyz, TARGET_CELLS.cell_m)
    _, first, row = np.unique(key, return_index=True, return_inverse=True)
    count = np.bincount(row).astype(np.float64)

    def mean(column: Array) -> Array:
        return np.asarray(np.bincount(row, column) / count)

    middle = np.stack([mean(xyz[:, k]) for k in range(3)], axis=1)
    normal = np.zeros_like(middle)
    if has_normal:
        given = np.nan_to_num(found["normal"].astype(np.float64))
        normal = np.stack([mean(given[:, k]) for k in range(3)], axis=1)
    brightest = np.zeros(len(count))
    np.maximum.at(brightest, row, values)
    blocks = _keys(xyz[first], TARGET_CELLS.cell_m * TARGET_CELLS.blocks)
    _, block = np.unique(blocks, return_inverse=True)
    return TargetCells(middle + tile.origin_m, mean(values), brightest, normal, count, block)


def _keys(xyz: Array, cell_m: float) -> NDArray[np.int64]:
    """One number for the cell of each point, (N, 3) -> (N,)."""
    ijk = np.floor(xyz / cell_m).astype(np.int64)
    ijk -= ijk.min(axis=0) if len(ijk) else 0
    size = ijk.max(axis=0, initial=0) + 1
    keys: NDArray[np.int64] = (ijk[:, 0] * size[1] + ijk[:, 1]) * size[2] + ijk[:, 2]
    return keys


def _unit(v: Array) -> Array:
    length = np.linalg.norm(v, axis=1)[:, None]
    return np.asarray(np.where(length > 0.0, v / np.maximum(length, 1e-12), 0.0))
