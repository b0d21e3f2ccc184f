"""What the stage ``map`` has done, for a process that goes on after one that was killed."""

from __future__ import annotations

import shutil
from collections import Counter
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import asdict, dataclass
from pathlib import Path
from tempfile import TemporaryDirectory

import msgspec
import numpy as np

from recon4.mapping.buckets import TileBuckets
from recon4.mapping.cell_runs import CellRuns
from recon4.mapping.tile_writer import PackedTile, TileBlock, TileRow
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


class _Made(msgspec.Struct, array_like=True):
    """A tile in the log."""

    row: TileRow
    count: int
    blocks: list[tuple[int, list[bytes], list[int]]]
    """Points, fields and widths."""
    removed: dict[str, int]
    corrected: dict[int, int]
    classes: dict[int, int]


class MadeTiles:
    """Tiles in the order in which they are made, compressed."""

    def __init__(self) -> None:
        """Take up those of an earlier process."""
        self._log = RecordLog(unfinished_file("tiles"))

    def __len__(self) -> int:
        """Number of tiles that an earlier process has made."""
        return len(self._log)

    def earlier(self) -> Iterator[tuple[PackedTile, TileCounts]]:
        """Those tiles."""
        for record in self._log:
            made = msgspec.msgpack.decode(record, type=_Made)
            # Bounds and times of the blocks are in the row already.
            nothing = [0.0] * 3, [0.0] * 3, (0, 0)
            blocks = [TileBlock(*block, *nothing) for block in made.blocks]
            counts = (made.removed, made.corrected, made.classes)
            yield (
                PackedTile(made.row, made.count, blocks),
                TileCounts(*(Counter(one) for one in counts)),  # type: ignore[arg-type]
            )

    def kept(self, made: tuple[PackedTile, TileCounts]) -> tuple[PackedTile, TileCounts]:
        """Note a tile, and return it."""
        tile, counts = made
        numbers = (counts.removed, counts.corrected, counts.classes)
        row = asdict(tile.row)
        record = _Made(
            TileRow(**row),
            tile.count,
            [(block.count, block.data, block.width) for block in tile.blocks],
            *({key: int(n) for key, n in one.items()} for one in numbers),  # type: ignore[arg-type]
        )
        self._log.append(msgspec.msgpack.encode(record))
        return made
