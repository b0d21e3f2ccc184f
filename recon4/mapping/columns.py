"""Columns of a map on disk: compressed blocks of rows, one file per field.

    <field>.zst    the blocks of a field, one after the other (`recon4.mapping.tile_packing`)
    blocks.npy     of each block: the row after its last, and the byte after it in every field

The blocks of a field can be read one by one: those of some rows, and only of the fields needed.
"""

from __future__ import annotations

import threading
from collections import OrderedDict, deque
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import product
from pathlib import Path
from typing import Any, Protocol

import numpy as np
from numpy.typing import NDArray

from recon4.errors import StoreError
from recon4.mapping.sensor_paths import SensorPaths
from recon4.mapping.threads import Each, in_turn
from recon4.mapping.tile import FIELDS, Columns
from recon4.mapping.tile_order import Rows, places_of, spatial_order_of
from recon4.mapping.tile_packing import FIELD_PACKING, PackedField, unpack
from recon4.mapping.tuning import TILES
from recon4.store.arrays import load_array
from recon4.store.checked import CheckedArtifact

BLOCKS = "blocks.npy"
PATHS = "paths.npz"


class TileColumns(Protocol):
    """The columns of a map, however they are stored."""

    @property
    def folder(self) -> Path:
        """``tiles`` in the artifact."""

    @property
    def fields(self) -> tuple[str, ...]:
        """Names of those that are stored."""

    @property
    def paths(self) -> SensorPaths:
        """Where the sensors were."""

    def read(
        self, names: Sequence[str], rows: slice, *, checked: CheckedArtifact | None = None
    ) -> Columns:
        """Some rows of some fields.

        Args:
            names: Of fields.
            rows: Of all tiles; any positive step.
            checked: Hashes that their bytes must match before they are used.

        Raises:
            Altered: If they do not match.
            StoreError: If they cannot be read or are damaged.
        """

    def read_in_space(
        self,
        names: Sequence[str],
        rows: slice,
        *,
        checked: CheckedArtifact | None = None,
        each: Each = in_turn,
    ) -> Columns:
        """All rows of a part of a tile, neighbors one after the other; otherwise as `read`.

        Threads may be given for the fields and their blocks.
        """


def index_dtype(fields: Sequence[str]) -> np.dtype[Any]:
    """One row of `BLOCKS`: ``stop`` counts rows, ``end`` bytes; ``width`` is of a number."""
    many = (len(fields),)
    return np.dtype([("stop", "<i8"), ("end", "<i8", many), ("width", "<i8", many)])


@dataclass(frozen=True, slots=True, eq=False)
class PackedColumns:
    """The columns of a map in blocks."""

    folder: Path
    """``tiles``"""
    fields: tuple[str, ...]
    index: NDArray[np.void]
    """Of `index_dtype`, (B,)."""
    parts: NDArray[np.int64]
    """Where the parts of the tiles begin and the last one ends: points, stray returns, (P + 1,)."""
    paths: SensorPaths
    kept: KeptBlocks
    position_step_m: float = TILES.position_step_m
    """Steps of positions; in maps of earlier versions other ones [m]."""

    @staticmethod
    def open(
        folder: Path,
        fields: Sequence[str],
        parts: NDArray[np.int64],
        *,
        checked: CheckedArtifact | None = None,
        kept_bytes: int = 0,
    ) -> PackedColumns:
        """Open the columns that a `TileWriter` left.

        Args:
            folder: ``tiles``
            fields: Their names, in the order of the index.
            parts: See the field.
            checked: Hashes that the index and the paths must match.
            kept_bytes: Memory for blocks that may be needed again.

        Raises:
            Altered: If they do not match.
            StoreError: If something is missing, or the files do not fit each other.
        """
        for name in fields:
            if name not in FIELD_PACKING:
                raise StoreError(
                    f"tiles.json: unknown field {name!r}; known: {list(FIELD_PACKING)}"
                )
        if checked is not None:
            checked.check(f"tiles/{BLOCKS}")
            checked.check(f"tiles/{PATHS}")
        index = load_array(folder / BLOCKS, index_dtype(fields))
        _check_index(folder, fields, index, parts=parts)
        paths = SensorPaths.load(folder / PATHS)
        return PackedColumns(folder, tuple(fields), index, parts, paths, KeptBlocks(kept_bytes))

    def read(
        self, names: Sequence[str], rows: slice, *, checked: CheckedArtifact | None = None
    ) -> Columns:
        """See `TileColumns.read`."""
        found = _room(_needed(names), len(range(rows.start, rows.stop, rows.step or 1)))
        at = 0
        for block, taken in self._blocks(rows):
            count = len(range(taken.start, taken.stop, taken.step))
            at_once = self.kept.none and count == self._count(block)
            order = self.order(block) if at_once else None
            for name, values in found.items():
                part = values[at : at + count]
                self._check(name, block, checked)
                if order is not None:
                    self._unpack(name, block, rows=order, out=part)
                else:
                    part[:] = self._block(name, block)[taken]
            at += count
        return self._with_times(found, names)

    def read_in_space(
        self,
        names: Sequence[str],
        rows: slice,
        *,
        checked: CheckedArtifact | None = None,
        each: Each = in_turn,
    ) -> Columns:
        """See `TileColumns.read_in_space`."""
        found = _room(_needed(names), rows.stop - rows.start)
        places = {block: places_of(*self._within(block)) for block, _ in self._blocks(rows)}

        def parts() -> Iterator[tuple[str, int]]:
            # Field by field: the rows of one fit into the processor's cache.
            for part in product(found, places):
                self._check(*part, checked)
                yield part

        def unpack_part(part: tuple[str, int]) -> None:
            name, block = part
            self._unpack(name, block, rows=places[block], out=found[name])

        deque(each(unpack_part, parts()), maxlen=0)
        return self._with_times(found, names)

    def _with_times(self, found: Columns, names: Sequence[str]) -> Columns:
        if "t_ns" in names:
            found["t_ns"] += self.paths.began_ns(found["frame_id"])
        return {name: found[name] for name in names}

    def _blocks(self, rows: slice) -> Iterator[tuple[int, slice]]:
        """The blocks that some rows are in, each with the rows of it."""
        step, at = rows.step or 1, rows.start
        stops = self.index["stop"]
        while at < rows.stop:
            block = int(np.searchsorted(stops, at, side="right"))
            first = int(stops[block - 1]) if block else 0
            stop = min(int(stops[block]), rows.stop)
            yield block, slice(at - first, stop - first, step)
            at += -(-(stop - at) // step) * step

    def _block(self, name: str, block: int) -> NDArray[Any]:
        """All rows of a field in a block, unpacked if they are not kept."""

        def make() -> NDArray[Any]:
            made = _room([name], self._count(block))[name]
            order = self.kept.get(("", block), lambda: self.order(block))
            self._unpack(name, block, rows=order, out=made)
            return made

        return self.kept.get((name, block), make)

    def blocks(self, start: int, stop: int) -> Iterator[tuple[int, int]]:
        """Numbers of the blocks that some rows are in, each with the first of these rows."""
        for block, rows in self._blocks(slice(start, stop)):
            yield block, rows.start + (int(self.index["stop"][block - 1]) if block else 0)

    def unpacked(self, block: int, names: Sequence[str]) -> Columns:
        """Some fields of a block as they are packed, in spatial order: not ``t_ns``."""
        found = _room(names, self._count(block))
        every = np.arange(self._count(block), dtype=np.int32)
        for name, values in found.items():
            self._unpack(name, block, rows=every, out=values)
        return found

    def packed(self, name: str, block: int) -> PackedField:
        """A field of a block as it is stored.

        Raises:
            StoreError: If it cannot be read.
        """
        where = f"{self.folder.name}/{name}.zst"
        first, stop = self._bytes(name, block)
        try:
            with (self.folder / f"{name}.zst").open("rb", buffering=0) as opened:
                opened.seek(first)
                data = opened.read(stop - first)
        except OSError as error:
            raise StoreError(f"{where} cannot be read: {error.strerror}") from error
        width = int(self.index["width"][block, self.fields.index(name)])
        step = self.position_step_m if name == "xyz" else FIELD_PACKING[name].step
        return PackedField(data, width, step)

    def _unpack(self, name: str, block: int, *, rows: Rows, out: NDArray[Any]) -> None:
        """Unpack a field of a block to some rows."""
        where = f"{self.folder.name}/{name}.zst: block {block}"
        unpack(name, self.packed(name, block), rows=rows, out=out, where=where)

    def _check(self, name: str, block: int, checked: CheckedArtifact | None) -> None:
        if checked is not None:
            checked.check(f"tiles/{name}.zst", *self._bytes(name, block))

    def _bytes(self, name: str, block: int) -> tuple[int, int]:
        """First byte of a block of a field, and the one after its last."""
        ends = self.index["end"][:, self.fields.index(name)]
        return int(ends[block - 1]) if block else 0, int(ends[block])

    def order(self, block: int) -> Rows:
        """Rows of a block in spatial order."""
        return spatial_order_of(*self._within(block))

    def _count(self, block: int) -> int:
        _, first, stop = self._within(block)
        return stop - first

    def _within(self, block: int) -> tuple[int, int, int]:
        """Rows of the part of a tile that a block lies in; its first there, and after its last."""
        stops = self.index["stop"]
        first, stop = int(stops[block - 1]) if block else 0, int(stops[block])
        part = int(np.searchsorted(self.parts, first, side="right")) - 1
        begin, end = self.parts[part : part + 2].tolist()
        return end - begin, first - begin, stop - begin


class KeptBlocks:
    """Unpacked blocks that may be needed again; the least recently used are removed first.

    People who look at a part of a map read it many times: slices, chunks of detail, clicks.
    """

    def __init__(self, most_bytes: int) -> None:
        self._most = most_bytes
        self._bytes = 0
        self._kept: OrderedDict[tuple[str, int], NDArray[Any]] = OrderedDict()
        self._lock = threading.Lock()

    @property
    def none(self) -> bool:
        """Whether nothing may be kept."""
        return not self._most

    def get(self, key: tuple[str, int], make: Callable[[], NDArray[Any]]) -> NDArray[Any]:
        """A field of a block, unpacked if it is not kept."""
        with self._lock:
            if key in self._kept:
                self._kept.move_to_end(key)
                return self._kept[key]
        made = make()
        with self._lock:
            if key not in self._kept and made.nbytes <= self._most:
                self._kept[key] = made
                self._bytes += made.nbytes
            while self._bytes > self._most:
                self._bytes -= self._kept.popitem(last=False)[1].nbytes
        return made


def _needed(names: Sequence[str]) -> list[str]:
    """Fields that others are read from: times are counted from the start of a multiframe."""
    return [*names, *(["frame_id"] if "t_ns" in names and "frame_id" not in names else [])]


def _room(names: Sequence[str], count: int) -> Columns:
    shapes: Mapping[str, tuple[str, int]] = {name: FIELDS[name] for name in names}
    return {
        name: np.empty((count, width) if width > 1 else count, dtype)
        for name, (dtype, width) in shapes.items()
    }


def _check_index(
    folder: Path, fields: Sequence[str], index: NDArray[np.void], *, parts: NDArray[np.int64]
) -> None:
    """Check that blocks follow each other and fill the map and the files.

    Raises:
        StoreError: If they do not.
    """
    where = f"{folder.name}/{BLOCKS}"
    stops, ends = index["stop"], index["end"]
    good = (np.diff(stops, prepend=0) > 0) & (np.diff(ends, axis=0, prepend=0) > 0).all(axis=1)
    good &= ((index["width"] >= 1) & (index["width"] <= 8)).all(axis=1)
    if not good.all():
        row = int(np.argmin(good))
        raise StoreError(f"{where}: row {row}: expected the block after the last, got {index[row]}")
    last = int(stops[-1]) if len(index) else 0
    if last != parts[-1]:
        raise StoreError(f"{where}: expected blocks of {parts[-1]} points, got {last}")
    # The order of a block's rows is that of the part of a tile that it lies in.
    whole = np.isin(parts, [0, *stops.tolist()])
    if not whole.all() or np.any(np.diff(parts) < 0):
        raise StoreError(
            f"{where}: expected tiles of whole blocks, got one to point {parts[np.argmin(whole)]}"
        )
    for column, name in enumerate(fields):
        path = folder / f"{name}.zst"
        expected = int(ends[-1, column]) if len(index) else 0
        found = path.stat().st_size if path.is_file() else -1
        if found != expected:
            raise StoreError(
                f"{folder.name}/{path.name}: expected {expected} bytes of {len(index)} blocks, "
                f"got {found if found >= 0 else 'no file'}"
            )
