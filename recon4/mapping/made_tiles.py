"""What the stage ``map`` has done, for a process that goes on after one that was killed."""

from __future__ import annotations

import shutil
from collections import Counter
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from tempfile import TemporaryDirectory

import msgspec
import numpy as np

from recon4.mapping.buckets import TileBuckets
from recon4.mapping.cell_runs import CellRuns
from recon4.mapping.tile_writer import PackedTile
from recon4.model.trajectory import Times
from recon4.store.atomic import atomic_file
from recon4.store.unfinished import RecordLog, unfinished_file

_PLACED = "placed"
"""File in the folder of buckets that says that all points are in them."""


@dataclass(frozen=True, slots=True, eq=False)
class TileCounts:
    """What became of the points of a tile, or of all."""

    removed: Counter[str]
    corrected: Counter[int]
    """Number of a correction of classes -> how many points it changed."""
    classes: Counter[int]
    """Code of a class -> how many points have it."""


class _PlacedPoints(msgspec.Struct):
    """Contents of the file `_PLACED`."""

    tiles: list[tuple[tuple[int, int, int], list[int]]]
    """Each with the records of its runs."""
    cells: list[int]
    """Cells of each run."""
    starts: bytes
    """Of the multiframes [ns], int64."""


@contextmanager
def placing_folder(out: Path) -> Iterator[Path]:
    """Folder for placed points: in ``out``, or where it outlives the process.

    Of a process that was killed before it had placed all, nothing is left.
    """
    kept = unfinished_file("buckets")
    if kept is None:
        with TemporaryDirectory(dir=out, prefix="buckets-") as folder:
            yield Path(folder)
        return
    if not (kept / _PLACED).exists():
        shutil.rmtree(kept, ignore_errors=True)
        kept.mkdir()
    yield kept


def keep_placed(folder: Path, buckets: TileBuckets, cells: CellRuns, *, starts: Times) -> None:
    """Note that all points are in the folder.

    Args:
        folder: That of `placing_folder`.
        buckets: All written.
        cells: Written by this.
        starts: Of the multiframes [ns], (F,).
    """
    cells.flush()
    placed = _PlacedPoints(list(buckets.counts.items()), cells.rows, starts.tobytes())
    with atomic_file(folder / _PLACED) as temporary:
        temporary.write_bytes(msgspec.msgpack.encode(placed))


def take_placed(folder: Path, buckets: TileBuckets, cells: CellRuns) -> Times | None:
    """Go on with what an earlier process has placed: starts [ns]; None = it has not placed all."""
    path = folder / _PLACED
    if not path.exists():
        return None
    placed = msgspec.msgpack.decode(path.read_bytes(), type=_PlacedPoints)
    buckets.take({tile: counts for tile, counts in placed.tiles})
    cells.take(placed.cells)
    return np.frombuffer(placed.starts, np.int64)


Finished = tuple[PackedTile, TileCounts]
"""A tile as it will be stored, and what became of its points."""


@dataclass(frozen=True, slots=True)
class _Made:
    """A finished tile in a file."""

    packed: PackedTile
    removed: dict[str, int]
    corrected: dict[int, int]
    classes: dict[int, int]


def made_bytes(made: Finished) -> bytes:
    """A finished tile as a file of this process, or of a worker, keeps it."""
    packed, counts = made
    return msgspec.msgpack.encode(_Made(packed, counts.removed, counts.corrected, counts.classes))


def made_of(data: bytes) -> Finished:
    """The tile of `made_bytes`.

    Raises:
        msgspec.DecodeError: If these are other bytes.
    """
    made = msgspec.msgpack.decode(data, type=_Made)
    counts = TileCounts(Counter(made.removed), Counter(made.corrected), Counter(made.classes))
    return made.packed, counts


class MadeTiles:
    """Tiles in the order in which they are made, compressed."""

    def __init__(self) -> None:
        """Take up those of an earlier process."""
        self._log = RecordLog(unfinished_file("tiles"))

    def __len__(self) -> int:
        """Number of tiles that an earlier process has made."""
        return len(self._log)

    def earlier(self) -> Iterator[Finished]:
        """Those tiles."""
        return map(made_of, self._log)

    def kept(self, made: Finished) -> Finished:
        """Note a tile, and return it."""
        self._log.append(made_bytes(made))
        return made
