"""Readers of reference clouds: PLY, PCD, LAS/LAZ, E57, PTX, XYZ/CSV, piece by piece.

Files of unknown origin: call these in a child process. Sizes are checked before a decoder sees them
(`recon4.recording.formats.las_check`), but the decoders of LAZ and E57 are not ours.
"""

from __future__ import annotations

import os
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Literal

import numpy as np

from recon4.errors import CorruptFile, RecordingError, UnknownFormat
from recon4.geometry.se3 import Array
from recon4.locales.coded import CodedText
from recon4.recording.formats.cloud_crs import StatedCrs, geographic_crs, stated_crs
from recon4.recording.formats.cloud_files import cloud_chunks, cloud_fields, cloud_rows
from recon4.recording.formats.cloud_headers import HEADER_BYTES, HEADER_FORMATS, header_format
from recon4.recording.formats.e57_points import E57Points
from recon4.recording.formats.las_records import (
    CHUNK,
    MAX_POINTS,
    las_points,
    refuse_many,
    refuse_promise,
)
from recon4.recording.formats.ptx_points import ptx_points
from recon4.recording.limits import LIMITS
from recon4.recording.tables.clouds import TEXT_SUFFIXES, TextCloud
from recon4.recording.tables.coordinates import AS_THE_TABLE_SAYS, ColumnChoice
from recon4.untrusted.bounded import open_regular


@dataclass(frozen=True, slots=True, eq=False)
class CloudSource:
    """A reference cloud that is being read."""

    chunks: Iterator[Array]
    """Points in the coordinates and the unit of the file, float64 (N, 3) at a time; of a text they
    are in meters. Geographic ones are longitude and latitude in degrees, and height."""
    stated: StatedCrs
    """CRS and units of these coordinates, as far as the file states them."""
    columns: str
    """How the columns of a text were read; empty = the file is no text."""


def open_cloud(
    path: Path, choice: ColumnChoice = AS_THE_TABLE_SAYS, *, place: Array | None = None
) -> CloudSource:
    """Open a reference cloud.

    Args:
        path: The file.
        choice: What a person says of the columns of a text.
        place: Easting and northing of the map [m], (2,), if the file may be in its CRS.

    Raises:
        ConfigError: With a question, if the columns of a text are not certain.
        CorruptFile: If the bytes do not match the format, or coordinates are not finite.
        UnknownFormat: If no reader knows it.
        RecordingError: If it cannot be opened or is too large.
    """
    head = _head(path)
    if not head:
        raise UnknownFormat(CodedText("file-empty", name=path.name))
    columns, stated = "", StatedCrs()
    kind = _kind(head, path)
    if kind == "las":
        chunks, stated = _las(path), stated_crs(path)
    elif kind == "e57":
        chunks, stated = _e57(path), stated_crs(path)
    elif kind == "ptx":
        chunks = ptx_points(path)
    elif kind == "table":
        chunks = _table(path)
    elif kind == "text":
        text = TextCloud.open(path, choice, place=place)
        chunks, columns = text.chunks(), text.columns.description
        stated = geographic_crs() if text.columns.geographic else StatedCrs()
    else:
        names = ", ".join([*(one.name for one in HEADER_FORMATS), "LAS, LAZ, E57, PTX"])
        raise UnknownFormat(CodedText("reference-format", file=path.name, names=names))
    return CloudSource(_checked(chunks, path.name), stated, columns)


def read_points(path: Path, choice: ColumnChoice = AS_THE_TABLE_SAYS) -> Iterator[Array]:
    """Points of a reference cloud in its own coordinates, float64 (N, 3) at a time.

    Raises:
        ConfigError, CorruptFile, UnknownFormat, RecordingError: As `open_cloud`.
    """
    return open_cloud(path, choice).chunks


def is_text(path: Path) -> bool:
    """Whether a file is a cloud as text, whose columns have to be known.

    Raises:
        RecordingError: If it cannot be opened.
    """
    return _kind(_head(path), path) == "text"


def _kind(head: bytes, path: Path) -> Literal["las", "e57", "ptx", "table", "text", ""]:
    """Kind of a cloud by its first bytes, of a text by its ending."""
    if head[:4] == b"LASF":
        return "las"
    if head[:8] == b"ASTM-E57":
        return "e57"
    if header_format(head) is not None:
        return "table"
    if path.suffix.lower() == ".ptx":
        return "ptx"
    return "text" if path.suffix.lower() in TEXT_SUFFIXES else ""


def _head(path: Path) -> bytes:
    with open_regular(path, failure=RecordingError) as file:
        size = os.fstat(file.fileno()).st_size
        head = file.read(HEADER_BYTES)
    if size > LIMITS.cloud_file_bytes:
        raise RecordingError(
            CodedText(
                "reference-large",
                file=path.name,
                size=size >> 30,
                cloud_file_bytes=LIMITS.cloud_file_bytes >> 30,
            )
        )
    return head


def _checked(chunks: Iterator[Array], name: str) -> Iterator[Array]:
    count = 0
    for chunk in chunks:
        if not np.isfinite(chunk).all():
            bad = int((~np.isfinite(chunk).all(axis=1)).sum())
            raise CorruptFile(CodedText("reference-not-finite", name=name, bad=bad))
        if len(chunk) and np.abs(chunk).max() > 1e8:
            raise CorruptFile(CodedText("reference-not-meters", name=name))
        count += len(chunk)
        if count > MAX_POINTS:
            raise RecordingError(
                CodedText("reference-many", name=name, max_points=MAX_POINTS // 10**6)
            )
        yield chunk
    if not count:
        raise CorruptFile(CodedText("reference-no-points", name=name))


def _table(path: Path) -> Iterator[Array]:
    fields = cloud_fields(path)
    missing = [axis for axis in "xyz" if axis not in fields]
    if missing:
        raise CorruptFile(
            CodedText(
                "reference-column",
                file=path.name,
                missing=str(missing),
                fields=str(sorted(fields)[:20]),
            )
        )
    refuse_many(cloud_rows(path), path.name)
    for table in cloud_chunks(path):
        yield np.column_stack([table[axis] for axis in "xyz"]).astype(np.float64)


def _las(path: Path) -> Iterator[Array]:
    for points in las_points(path):
        yield np.column_stack([points.x, points.y, points.z]).astype(np.float64)


def _e57(path: Path) -> Iterator[Array]:
    points = E57Points(path)
    refuse_many(points.promised, path.name)
    refuse_promise(path, points.promised)
    yield from points.chunks(CHUNK)
