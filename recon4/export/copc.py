"""The map as COPC 1.0: LAZ 1.4 whose points are sorted into an octree, for viewers and QGIS.

Layout by copc.io: the info record first, the points of a node as one chunk, the list of nodes
(hierarchy) as an extended record at the end.
"""

from __future__ import annotations

import io
import struct
import tempfile
import zlib
from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import laspy
import lazrs
import numpy as np

from recon4.errors import StoreError
from recon4.export.account import PointAccount
from recon4.export.las_points import (
    add_records,
    crs_text,
    las_blocks,
    las_header,
    las_points,
    las_records,
)
from recon4.export.laz import ErrorKeepingWriter, reading_las, writing_las
from recon4.export.names import check_name
from recon4.export.octree import Cube, Key, Octree, PointFiles, Records
from recon4.export.points import CRS_OF_MAP, OutputCrs, PointSource
from recon4.export.selection import DELIVERED, PointSelection
from recon4.export.tuning import OCTREE, REREAD
from recon4.locales.coded import CodedText
from recon4.mapping.tiles import TileSet
from recon4.progress import Progress, Silent
from recon4.store.atomic import atomic_file

_INFO = struct.Struct("<5d2Q2d88x")
"""Center, half the edge and spacing of the root; place and size of the hierarchy; GPS times."""
_ENTRY = struct.Struct("<4iQ2i")
"""Key of a node; place and size of its chunk; its points."""
_EVLR = struct.Struct("<H16sHQ32s")


@dataclass(frozen=True, slots=True)
class _Chunk:
    """Points of a node in the file."""

    key: Key
    offset: int
    size: int
    points: int
    crc: int
    """CRC-32 of the records before compression."""


@dataclass(slots=True)
class _NodeWriter:
    """Writes nodes one after the other."""

    file: ErrorKeepingWriter
    compressor: Any
    chunks: list[_Chunk] = field(default_factory=list)

    def write(self, key: Key, records: Records) -> None:
        """Append a node; one without points has an entry only."""
        if not len(records):
            self.chunks.append(_Chunk(key, 0, 0, 0, 0))
            return
        packed = np.ascontiguousarray(records).view(np.uint8)
        offset = self.file.tell()
        self.compressor.compress_many(packed)
        self.compressor.finish_current_chunk()
        size = self.file.tell() - offset
        self.chunks.append(_Chunk(key, offset, size, len(records), zlib.crc32(packed.data)))


def export_copc(
    map_: Path | TileSet,
    path: Path,
    output: OutputCrs = CRS_OF_MAP,
    *,
    selection: PointSelection = DELIVERED,
    progress: Progress | None = None,
) -> int:
    """Write a map as COPC, streaming, and compare the whole file before it gets its name.

    Fields and CRS are those of `recon4.export.laz.export_laz`; coordinates are in steps of 0.1 mm.

    Args:
        map_: Artifact of the stage ``map``, or what is open of it.
        path: File to write, ``.copc.laz``.
        output: CRS of the file.
        selection: Which points are written.
        progress: Who watches.

    Returns:
        How many points were written.

    Raises:
        ConfigError: If there are no points, or the name is not one of a COPC file.
        GeoreferenceError: If the CRS is not understood, or coordinates do not fit.
        StoreError: If the file cannot be written or does not read back (`NoSpace`: disk full).
    """
    check_name(path, ".copc.laz")
    watch = progress or Silent()
    source = PointSource.of(map_, output, selection, progress=watch)
    header = las_header(source, scale_m=OCTREE.step_m)
    header.are_points_compressed = True
    meant = PointAccount(crs=crs_text(header))
    with (
        tempfile.TemporaryDirectory(prefix=f".{path.name}.", dir=path.parent) as folder,
        atomic_file(path) as temporary,
    ):
        stream = las_blocks(source, watch)
        files = PointFiles(Path(folder), header.point_format.dtype())
        times_s = _sort_into(files, stream, header, meant=meant)
        with writing_las(temporary, path.name) as file:
            chunks = _write(file, header, files, times_s=times_s, progress=watch)
        source.seal(temporary)
        with reading_las(path.name):
            _check(temporary, chunks, header, meant=meant, progress=watch)
    return meant.count


def _sort_into(
    files: PointFiles, stream: Iterator[Any], header: Any, *, meant: PointAccount
) -> tuple[float, float]:
    """Sort all points by cubes, and count them in the header; first and last GPS time [s]."""
    low_s, high_s = np.inf, -np.inf
    header.partial_reset()
    for block in stream:
        points = las_points(block, header, las_records(len(block.xyz), header), account=meant)
        header.grow(points)
        low_s = min(low_s, float(points.gps_time.min()))
        high_s = max(high_s, float(points.gps_time.max()))
        files.add(points.array)
    return low_s, high_s


def _write(
    file: ErrorKeepingWriter,
    header: Any,
    files: PointFiles,
    *,
    times_s: tuple[float, float],
    progress: Progress,
) -> list[_Chunk]:
    """Write header, nodes and hierarchy."""
    low, high = (
        np.rint((corner - header.offsets) / header.scales).astype(np.int64)
        for corner in (header.mins, header.maxs)
    )
    cube = Cube.around(low, high)
    extra_bytes = header.point_format.num_extra_bytes
    compression = lazrs.LazVlr.new_for_compression(header.point_format.id, extra_bytes, True)
    known = laspy.vlrs.known
    info = laspy.VLR("copc", 1, "COPC info", bytes(_INFO.size))
    header.vlrs.insert(0, info)
    header.vlrs.append(known.LasZipVlr(compression.record_data()))
    header.write_to(file)
    writer = _NodeWriter(file, lazrs.LasZipCompressor(file, compression))
    writer.compressor.reserve_offset_to_chunk_table()  # else the first chunk would begin with it
    progress.start("octree", header.point_count, "points")
    tree = Octree(cube, writer.write, progress)
    tree.build(files.place(cube))
    writer.compressor.done()
    file.seek(0, io.SEEK_END)
    header.start_of_first_evlr, header.number_of_evlrs = file.tell(), 1
    place = _write_hierarchy(file, writer.chunks)
    info.record_data = _info(cube, header, place=place, times_s=times_s)
    file.seek(0)
    header.write_to(file, ensure_same_size=True)
    file.flush()
    return writer.chunks


def _write_hierarchy(file: ErrorKeepingWriter, chunks: list[_Chunk]) -> tuple[int, int]:
    """Append the list of nodes; where it begins and how long it is [bytes]."""
    entries = b"".join(
        _ENTRY.pack(*chunk.key, chunk.offset, chunk.size, chunk.points)
        for chunk in sorted(chunks, key=lambda chunk: chunk.key)
    )
    head = _EVLR.pack(0, b"copc", 1000, len(entries), b"COPC hierarchy")
    file.write(head)
    start = file.tell()
    file.write(entries)
    return start, len(entries)


def _info(
    cube: Cube, header: Any, *, place: tuple[int, int], times_s: tuple[float, float]
) -> bytes:
    half_m = 2.0**cube.bits / 2.0 * OCTREE.step_m
    center = (np.array(cube.low) + 2.0 ** (cube.bits - 1)) * header.scales + header.offsets
    return _INFO.pack(*center, half_m, 2.0 * half_m / 2**OCTREE.side_bits, *place, *times_s)


def _check(
    path: Path, chunks: list[_Chunk], header: Any, *, meant: PointAccount, progress: Progress
) -> None:
    """Read every node back, and compare all with what was written and meant.

    Raises:
        StoreError: If it differs.
    """
    found = PointAccount()
    progress.start("compare", meant.count, "points")
    with path.open("rb") as file:
        read = laspy.CopcReader(file)
        found.crs = crs_text(read.header)
        compression = header.vlrs.get("LasZipVlr")[0].record_data
        for chunk in chunks:
            file.seek(chunk.offset)
            packed = np.empty(chunk.points * header.point_format.size, np.uint8)
            lazrs.decompress_points_with_chunk_table(
                file.read(chunk.size), compression, packed, [(chunk.points, chunk.size)]
            )
            if chunk.points and zlib.crc32(packed.data) != chunk.crc:
                raise StoreError(CodedText("reread-node", file=path.name, key=str(chunk.key)))
            add_records(found, packed.view(header.point_format.dtype()), read.header)
            progress.advance(chunk.points)
    listed = sum(node.point_count for node in read.root_page.entries.values())
    if not found.count == listed == read.header.point_count:
        raise StoreError(
            CodedText(
                "reread-nodes",
                file=path.name,
                nodes=found.count,
                listed=str(listed),
                point_count=str(read.header.point_count),
                expected=meant.count,
            )
        )
    meant.compare(found, path.name, within_m=OCTREE.step_m / 2.0 + REREAD.bounds_m)
