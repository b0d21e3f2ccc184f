"""An octree of points for COPC: each point in one node, coarse nodes sample what is below them.

Points go through files, one for each cube of 2^`OctreeTuning.bucket_bits` steps; a cube with more
points than fit into memory is split again. Then the tree is built from the deepest nodes up: a node
takes from its children one point of each of its 2^`OctreeTuning.side_bits` cells along each edge.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from recon4.export.tuning import OCTREE
from recon4.progress import Progress

Cell = tuple[int, int, int]
Steps = NDArray[np.int64]
Records = NDArray[np.void]
"""Point records with the fields X, Y and Z in steps."""


class Key(NamedTuple):
    """Place of a node: level, and its index in the cubes of that level."""

    level: int
    x: int
    y: int
    z: int

    def child(self, octant: int) -> Key:
        """One of the eight nodes below, by the upper half along x (1), y (2) and z (4)."""
        x, y, z = octant & 1, octant >> 1 & 1, octant >> 2
        return Key(self.level + 1, 2 * self.x + x, 2 * self.y + y, 2 * self.z + z)

    def above(self, level: int) -> Key:
        """The node of a coarser level, or itself, that it lies in."""
        up = self.level - level
        return Key(level, self.x >> up, self.y >> up, self.z >> up)


@dataclass(frozen=True, slots=True)
class Cube:
    """The root: steps from ``low`` on, 2^bits of them along each edge."""

    low: Cell
    bits: int

    @staticmethod
    def around(low: NDArray[np.int64], high: NDArray[np.int64]) -> Cube:
        """The smallest cube around these steps whose nodes fit with the files of points."""
        start = np.int64(low) >> OCTREE.bucket_bits << OCTREE.bucket_bits
        edge = int((np.int64(high) - start).max()) + 1
        return Cube(_triple(start), max(OCTREE.bucket_bits, (edge - 1).bit_length()))

    def steps(self, records: Records) -> Steps:
        """Steps of points from its lowest corner, (N, 3)."""
        steps = np.stack([records[axis] for axis in "XYZ"], axis=1).astype(np.int64)
        return steps - np.array(self.low)


class PointFiles:
    """The points of a map on disk, one file for each cube."""

    def __init__(self, folder: Path, dtype: np.dtype[np.void]) -> None:
        self._folder, self._dtype = folder, dtype
        self._cells: set[Cell] = set()

    def add(self, records: Records) -> None:
        """Append points to the files of their cubes."""
        cells = np.stack([records[axis] for axis in "XYZ"], axis=1) >> OCTREE.bucket_bits
        for cell, rows in _groups(cells.astype(np.int64)):
            self._append(cell, records[rows])

    def place(self, cube: Cube) -> dict[Key, Path]:
        """The files, by the nodes of a root."""
        level = cube.bits - OCTREE.bucket_bits
        low = [axis >> OCTREE.bucket_bits for axis in cube.low]
        return {
            Key(level, *(at - first for at, first in zip(cell, low, strict=True))): self._path(cell)
            for cell in self._cells
        }

    def _append(self, cell: Cell, records: Records) -> None:
        with self._path(cell).open("ab") as file:
            file.write(np.ascontiguousarray(records).data)
        self._cells.add(cell)

    def _path(self, cell: Cell) -> Path:
        return self._folder / "{}_{}_{}".format(*cell)


@dataclass(slots=True)
class Octree:
    """Builds a tree and hands out each node once, all of its children before it.

    Args:
        cube: The root.
        dtype: Of the point records.
        write: Takes a node and its points; a node without points has points below it.
        progress: Counts the points that were handed out.
    """

    cube: Cube
    dtype: np.dtype[np.void]
    write: Callable[[Key, Records], None]
    progress: Progress
    _inner: set[Key] = field(default_factory=set)
    """Nodes with nodes below them that were written."""

    def build(self, files: dict[Key, Path]) -> None:
        """Build it from the points in files, which are removed."""
        root = Key(0, 0, 0, 0)
        self._write(root, self._node(root, files))

    def _node(self, key: Key, files: dict[Key, Path]) -> Records:
        """Points of a node; all below it is written."""
        if key in files:
            return self._from_file(key, files.pop(key))
        below: dict[Key, dict[Key, Path]] = {}
        for found, path in files.items():
            below.setdefault(found.above(key.level + 1), {})[found] = path
        return self._sampled(key, [(k, self._node(k, part)) for k, part in sorted(below.items())])

    def _from_file(self, key: Key, path: Path) -> Records:
        fits = path.stat().st_size <= OCTREE.points_in_memory * self.dtype.itemsize
        if not fits and not self._at_end(key):
            return self._node(key, self._split(key, path))
        records = np.fromfile(path, self.dtype)
        path.unlink()
        return self._grown(key, records, self.cube.steps(records), rows=np.arange(len(records)))

    def _split(self, key: Key, path: Path) -> dict[Key, Path]:
        """The files of the eight nodes below a file that is too large, which is removed."""
        made: dict[Key, Path] = {}
        with path.open("rb") as file:
            while len(part := np.fromfile(file, self.dtype, OCTREE.points_in_memory)):
                for octant, rows in self._octants(key, self.cube.steps(part)):
                    child = key.child(octant)
                    made[child] = path.with_name(f"{path.name}.{octant}")
                    with made[child].open("ab") as out:
                        out.write(np.ascontiguousarray(part[rows]).data)
        path.unlink()
        return made

    def _grown(
        self, key: Key, records: Records, steps: Steps, *, rows: NDArray[np.intp]
    ) -> Records:
        """Points of a node of those in some rows; all below it is written."""
        if len(rows) <= OCTREE.points_of_leaf or self._at_end(key):
            return records[rows]
        inside = steps[rows]
        own = self._first_of_cells(key, inside)
        rest = np.flatnonzero(~own)
        for octant, part in self._octants(key, inside[rest]):
            child = key.child(octant)
            self._write(child, self._grown(child, records, steps, rows=rows[rest[part]]))
        return records[rows[own]]

    def _sampled(self, key: Key, parts: list[tuple[Key, Records]]) -> Records:
        """Sample the points of a node from its children, and write what is left of these."""
        taken = []
        steps = self.cube.steps(np.concatenate([records for _, records in parts]))
        own = self._first_of_cells(key, steps)
        for child, records in parts:
            mine, own = own[: len(records)], own[len(records) :]
            taken.append(records[mine])
            self._write(child, records[~mine])
        return np.concatenate(taken)

    def _write(self, key: Key, records: Records) -> None:
        if len(records) or key in self._inner:
            self._inner.add(key.above(key.level - 1))
            self.write(key, records)
            self.progress.advance(len(records))

    def _at_end(self, key: Key) -> bool:
        return key.level >= self.cube.bits - OCTREE.side_bits

    def _octants(self, key: Key, steps: Steps) -> Iterator[tuple[int, NDArray[np.intp]]]:
        """Rows of the points in each of the eight nodes below a node that has any."""
        octants = (steps >> (self.cube.bits - key.level - 1) & 1) @ np.array([1, 2, 4])
        for octant in range(8):
            rows = np.flatnonzero(octants == octant)
            if len(rows):
                yield octant, rows

    def _first_of_cells(self, key: Key, steps: Steps) -> NDArray[np.bool_]:
        """Mark the first point in each cell of a node, (N,)."""
        bits = OCTREE.side_bits
        cells = steps >> (self.cube.bits - key.level - bits) & ((1 << bits) - 1)
        found = np.unique(cells @ np.array([1, 1 << bits, 1 << 2 * bits]), return_index=True)[1]
        first = np.zeros(len(steps), np.bool_)
        first[found] = True
        return first


def _groups(cells: NDArray[np.int64]) -> Iterator[tuple[Cell, NDArray[np.intp]]]:
    """Each cell of (N, 3) that occurs, and the rows of its points in their order."""
    keys = cells @ np.array([1 << 42, 1 << 21, 1])  # indices have less than 21 bits
    order = np.argsort(keys, kind="stable")
    starts = np.flatnonzero(np.diff(keys[order], prepend=keys[order[0]] - 1))
    for rows in np.split(order, starts[1:]):
        yield _triple(cells[rows[0]]), rows


def _triple(values: Any) -> Cell:
    x, y, z = map(int, values)
    return x, y, z
