"""An octree of points for COPC: each point in one node, coarse nodes sample what is below them.

Points go through compressed files, one for each cube of 2^`OctreeTuning.bucket_bits` steps; a cube
with more points than fit into memory is split again. Then the tree is built from the deepest nodes
up: a node takes from its children one point of each of its 2^`OctreeTuning.side_bits` cells along
each edge.
"""

from __future__ import annotations

import struct
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from recon4.export.tuning import OCTREE
from recon4.kernels.octree import by_octant, first_of_cells
from recon4.progress import Progress
from recon4.store.compressed import compress, expand

Cell = tuple[int, int, int]
Steps = NDArray[np.int32]
Rows = NDArray[np.int32]
Marks = NDArray[np.bool_]
Records = NDArray[np.void]
"""Point records with the fields X, Y and Z in steps."""
_FRAME = struct.Struct("<2I")
"""Head of a frame of a file: its points, its bytes."""


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
        """Steps of points from its lowest corner, axis by axis, (3, N)."""
        steps = np.empty((3, len(records)), np.int32)
        for axis, low in enumerate(self.low):
            steps[axis] = records["XYZ"[axis]] - np.int64(low)
        return steps


@dataclass(slots=True)
class PointFile:
    """Points on disk, as compressed frames: the same byte of all records of a frame together."""

    path: Path
    dtype: np.dtype[np.void]
    points: int = 0

    def append(self, records: Records) -> None:
        """Add points behind those that are there."""
        frame = compress(np.ascontiguousarray(_bytes_of(records).T).data)
        with self.path.open("ab") as file:
            file.write(_FRAME.pack(len(records), len(frame)) + frame)
        self.points += len(records)

    def frames(self) -> Iterator[Records]:
        """The points in their order, some at a time; the file is removed when all are read."""
        for packed in self._frames():
            yield np.ascontiguousarray(packed.T).reshape(-1).view(self.dtype)

    def read(self) -> Records:
        """All points in their order; the file is removed."""
        records, at = np.empty(self.points, self.dtype), 0
        for packed in self._frames():
            _bytes_of(records)[at : at + packed.shape[1]] = packed.T
            at += packed.shape[1]
        return records

    def _frames(self) -> Iterator[NDArray[np.uint8]]:
        size = self.dtype.itemsize
        with self.path.open("rb") as file:
            while head := file.read(_FRAME.size):
                count, length = _FRAME.unpack(head)
                frame = expand(file.read(length), count * size, self.path.name)
                yield np.frombuffer(frame, np.uint8).reshape(size, count)
        self.path.unlink()


class PointFiles:
    """The points of a map on disk, one file for each cube."""

    def __init__(self, folder: Path, dtype: np.dtype[np.void]) -> None:
        self._folder, self._dtype = folder, dtype
        self._files: dict[Cell, PointFile] = {}
        self._waiting: list[Records] = []

    def add(self, records: Records) -> None:
        """Append points to the files of their cubes, many at once."""
        self._waiting.append(records)
        if sum(map(len, self._waiting)) >= OCTREE.together:
            self._store()

    def place(self, cube: Cube) -> dict[Key, PointFile]:
        """The files, by the nodes of a root."""
        self._store()
        level = cube.bits - OCTREE.bucket_bits
        low = [axis >> OCTREE.bucket_bits for axis in cube.low]
        return {
            Key(level, *(at - first for at, first in zip(cell, low, strict=True))): file
            for cell, file in self._files.items()
        }

    def _store(self) -> None:
        if not self._waiting:
            return
        records = np.concatenate(self._waiting)
        self._waiting.clear()
        cells = np.stack([records[axis] for axis in "XYZ"], axis=1) >> OCTREE.bucket_bits
        for cell, rows in _groups(cells.astype(np.int64)):
            path = self._folder / "{}_{}_{}".format(*cell)
            self._files.setdefault(cell, PointFile(path, self._dtype)).append(_taken(records, rows))


@dataclass(slots=True)
class Octree:
    """Builds a tree and hands out each node once, all of its children before it.

    Args:
        cube: The root.
        write: Takes a node and its points; a node without points has points below it.
        progress: Counts the points that were handed out.
    """

    cube: Cube
    write: Callable[[Key, Records], None]
    progress: Progress
    _inner: set[Key] = field(default_factory=set)
    """Nodes with nodes below them that were written."""

    def build(self, files: dict[Key, PointFile]) -> None:
        """Build it from the points in files, which are removed."""
        root = Key(0, 0, 0, 0)
        self._write(root, self._node(root, files))

    def _node(self, key: Key, files: dict[Key, PointFile]) -> Records:
        """Points of a node; all below it is written."""
        if key in files:
            return self._from_file(key, files.pop(key))
        below: dict[Key, dict[Key, PointFile]] = {}
        for found, path in files.items():
            below.setdefault(found.above(key.level + 1), {})[found] = path
        return self._sampled(key, [(k, self._node(k, part)) for k, part in sorted(below.items())])

    def _from_file(self, key: Key, file: PointFile) -> Records:
        if file.points > OCTREE.points_in_memory and not self._at_end(key):
            return self._node(key, self._split(key, file))
        records = file.read()
        steps = self.cube.steps(records)
        return self._grown(key, records, steps, rows=np.arange(len(records), dtype=np.int32))

    def _split(self, key: Key, file: PointFile) -> dict[Key, PointFile]:
        """The files of the eight nodes below a file that is too large, which is removed."""
        made: dict[Key, PointFile] = {}
        for part in file.frames():
            rows = np.arange(len(part), dtype=np.int32)
            for child, inside in self._below(key, self.cube.steps(part), rows):
                path = file.path.with_name(f"{file.path.name}.{len(made)}")
                made.setdefault(child, PointFile(path, file.dtype)).append(_taken(part, inside))
        return made

    def _grown(self, key: Key, records: Records, steps: Steps, *, rows: Rows) -> Records:
        """Points of a node of those in some rows; all below it is written."""
        if len(rows) <= OCTREE.points_of_leaf or self._at_end(key):
            return _taken(records, rows)
        own = self._first_of_cells(key, steps, rows)
        for child, below in self._below(key, steps, rows, left_out=own):
            self._write(child, self._grown(child, records, steps, rows=below))
        return _taken(records, rows[own])

    def _sampled(self, key: Key, parts: list[tuple[Key, Records]]) -> Records:
        """Sample the points of a node from its children, and write what is left of these."""
        taken = []
        steps = self.cube.steps(np.concatenate([records for _, records in parts]))
        own = self._first_of_cells(key, steps, np.arange(steps.shape[1], dtype=np.int32))
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

    def _below(
        self, key: Key, steps: Steps, rows: Rows, *, left_out: Marks | None = None
    ) -> Iterator[tuple[Key, Rows]]:
        """Each of the eight nodes below a node that has rows, and its rows."""
        none = np.zeros(len(rows), np.bool_) if left_out is None else left_out
        out = np.empty_like(rows)
        begins = by_octant(steps, rows, self.cube.bits - key.level - 1, none, out)
        for octant in range(8):
            if begins[octant + 1] > begins[octant]:
                yield key.child(octant), out[begins[octant] : begins[octant + 1]]

    def _first_of_cells(self, key: Key, steps: Steps, rows: Rows) -> Marks:
        """Mark the first row in each cell of a node, (M,)."""
        first = np.empty(len(rows), np.bool_)
        low_bit = self.cube.bits - key.level - OCTREE.side_bits
        first_of_cells(steps, rows, low_bit, OCTREE.side_bits, first)
        return first


def _bytes_of(records: Records) -> NDArray[np.uint8]:
    """The same memory as bytes, (N, B)."""
    return records.view(np.uint8).reshape(len(records), -1)


def _taken(records: Records, rows: NDArray[np.integer[Any]]) -> Records:
    """Some records, seven times as fast as by an index of records."""
    return np.take(_bytes_of(records), rows, axis=0).reshape(-1).view(records.dtype)


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
