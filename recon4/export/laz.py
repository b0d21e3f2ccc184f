"""The map as LAZ 1.4.

lazrs keeps a pool of threads that does not survive a fork: a worker process that writes LAZ must be
spawned.
"""

from __future__ import annotations

import io
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import laspy
import lazrs  # type: ignore[import-untyped]
import numpy as np
from numpy.typing import NDArray

from recon4.errors import StoreError
from recon4.export.las_points import crs_text, las_blocks, las_header, las_points, las_records
from recon4.export.names import check_name
from recon4.export.points import CRS_OF_MAP, Block, OutputCrs, PointSource
from recon4.export.tuning import LAZ
from recon4.mapping.tiles import TileSet
from recon4.progress import Progress
from recon4.store.atomic import atomic_file


@dataclass(slots=True)
class _WrittenBounds:
    """What the file must turn out to hold."""

    count: int = 0
    low: NDArray[np.int64] = field(default_factory=lambda: np.full(3, np.iinfo(np.int64).max))
    high: NDArray[np.int64] = field(default_factory=lambda: np.full(3, np.iinfo(np.int64).min))
    first: Any = None
    last: Any = None

    def add(self, points: Any) -> None:
        """Add some points, as records of the file."""
        axes = points.X, points.Y, points.Z
        self.count += len(points)
        self.low = np.minimum(self.low, [steps.min() for steps in axes])
        self.high = np.maximum(self.high, [steps.max() for steps in axes])
        self.last = points.array[-1].copy()
        self.first = points.array[0].copy() if self.first is None else self.first


class ErrorKeepingWriter(io.BufferedWriter):
    """Keeps the error of a failed write, because lazrs does not report it."""

    write_error: OSError | None = None

    def write(self, data: Any) -> int:
        try:
            return super().write(data)
        except OSError as error:
            self.write_error = error
            raise


def export_laz(
    map_: Path | TileSet,
    path: Path,
    output: OutputCrs = CRS_OF_MAP,
    *,
    all_points: bool = False,
    progress: Progress | None = None,
) -> int:
    """Write a map as LAZ, streaming, and check the file before it gets its name.

    Intensity is the raw one; ``ring``, ``frame_id`` and those of `OPTIONAL` are extra bytes,
    the point source is the sensor's row + 1, the return number is 2 for a further echo. Times
    are adjusted standard GPS time, or seconds of the recording's clock if that is not UTC.

    Args:
        map_: Artifact of the stage ``map``, or what is open of it.
        path: File to write, ``.laz``.
        output: CRS of the file.
        all_points: Also the points that the map leaves out (`recon4.model.classes`).
        progress: Who watches.

    Returns:
        How many points were written.

    Raises:
        ConfigError: If the map has no points, or the name is not one of a LAZ file.
        GeoreferenceError: If the CRS is not understood, or coordinates do not fit.
        StoreError: If the file cannot be written or does not read back (`NoSpace`: disk full).
    """
    check_name(path, ".laz")
    source = PointSource.of(map_, output, all_points=all_points)
    header = las_header(source, scale_m=LAZ.scale_m)
    stream = las_blocks(source, progress)
    with atomic_file(path) as temporary, ErrorKeepingWriter(io.FileIO(temporary, "wb")) as file:
        try:
            written = _write(file, header, stream)
            file.flush()
            _check(temporary, written, header)
        except (laspy.errors.LaspyException, lazrs.LazrsError) as error:
            if file.write_error:
                raise file.write_error from error
            raise StoreError(f"cannot write {path}: {error}") from error
    return written.count


def _write(file: ErrorKeepingWriter, header: Any, stream: Iterable[Block]) -> _WrittenBounds:
    written = _WrittenBounds()
    with laspy.open(
        file,
        mode="w",
        header=header,
        laz_backend=laspy.LazBackend.LazrsParallel,
        closefd=False,
    ) as out:
        for points in _together(stream, header):
            out.write_points(points)
            written.add(points)
    return written


def _together(stream: Iterable[Block], header: Any) -> Iterator[Any]:
    """Records of many blocks at a time, of which each thread compresses a part.

    They are valid until the next ones.
    """
    records, filled = las_records(LAZ.together, header), 0
    of = header.point_format, header.scales, header.offsets
    for block in stream:
        count = len(block.xyz)
        if filled + count > len(records):
            yield laspy.ScaleAwarePointRecord(records[:filled], *of)
            filled = 0
        las_points(block, header, records[filled : filled + count])
        filled += count
    if filled:
        yield laspy.ScaleAwarePointRecord(records[:filled], *of)


def _check(path: Path, written: _WrittenBounds, header: Any) -> None:
    """Read back count, bounds, CRS, and the first and last point.

    Raises:
        StoreError: If the file differs from what was written.
    """
    with laspy.open(path) as file:
        found = file.header
        if found.point_count != written.count:
            raise StoreError(
                f"{path.name} reads back wrong: {found.point_count} points, "
                f"expected {written.count}"
            )
        low = np.rint((found.mins - header.offsets) / LAZ.scale_m)
        high = np.rint((found.maxs - header.offsets) / LAZ.scale_m)
        first = file.read_points(1).array[0]
        file.seek(written.count - 1)
        last = file.read_points(1).array[0]
        pairs = {
            "bounds": ((*written.low, *written.high), (*low, *high)),
            "CRS": (crs_text(header), crs_text(found)),
            "first point": (written.first.tobytes(), first.tobytes()),
            "last point": (written.last.tobytes(), last.tobytes()),
        }
    for what, (expected, got) in pairs.items():
        if expected != got:
            raise StoreError(
                f"{path.name} reads back wrong: {what}: expected {expected}, got {got}"
            )
