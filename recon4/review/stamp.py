"""Writes the approval into result files.

The file is copied with one added record; its own content is not changed.
"""

from __future__ import annotations

import json
import shutil
import struct
import zlib
from collections.abc import Callable
from dataclasses import dataclass, fields, replace
from pathlib import Path
from typing import BinaryIO

from recon4.errors import StoreError
from recon4.locales.coded import CodedText
from recon4.report.approval import approved_block, replace_block
from recon4.review.tuning import STAMPS
from recon4.store.atomic import atomic_file

NO_VERDICT = "unknown"
"""Verdict in the approval of a map whose run worked none out."""
VLR_USER = b"recon4"
VLR_RECORD = 1
_VLR = struct.Struct("<H16sHH32s")
_EVLR = struct.Struct("<H16sHQ32s")
_POINTS_AT, _EVLRS_AT = 96, 235
_PNG_HEADER_BYTES = 8 + 25
"""Signature and header chunk."""
_HEADER_BYTES = 375
"""Of LAS 1.4, the only version `recon4.export.laz` writes."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Stamp:
    """The approval as stored in a file."""

    version: int
    who: str
    role: str
    time: str
    """UTC, ISO 8601."""
    hash: str
    """SHA-256 of the signed statement in ``versions/<version>/approval.json``."""
    verdict: str = ""
    """On the map (`Usability`), or `NO_VERDICT`; empty before statement format 3."""
    why: str = ""
    """The signer's reason or remark; empty before statement format 3."""

    def to_json(self) -> dict[str, object]:
        """Plain JSON values, without the fields that are empty."""
        values = {field.name: getattr(self, field.name) for field in fields(self)}
        return {name: value for name, value in values.items() if value != ""}

    def json_line(self, most: int | None = None) -> str:
        """JSON in ASCII on one line; of more than ``most`` bytes the end of the reason is left out.

        The whole reason stands in the signed statement, whose hash is in the line.
        """
        line = json.dumps(self.to_json())
        if most is None or len(line) <= most or not self.why:
            return line
        left = len(self.why.removesuffix("…")) - 1 - (len(line) - most) // STAMPS.escape_bytes
        return replace(self, why=self.why[: max(left, 0)] + "…" * (left > 0)).json_line(most)


def stamp_file(source: Path, target: Path, stamp: Stamp) -> None:
    """Copy a result file and add its approval; source and target may be the same.

    Raises:
        StoreError: If this file format has no place for it, or the file cannot be written.
    """
    write = _WRITERS.get(target.suffix)
    if write is None:
        raise StoreError(CodedText("stamp-target", target=target.name))
    with source.open("rb") as read, atomic_file(target) as temporary, temporary.open("wb") as file:
        write(read, file, stamp)


def _laz(source: BinaryIO, target: BinaryIO, stamp: Stamp) -> None:
    """Insert a variable length record with user id ``recon4``; later offsets are shifted.

    COPC states where its nodes are, and what comes first: there the record is the last one.
    """
    header = bytearray(source.read(_HEADER_BYTES))
    if len(header) < _HEADER_BYTES or header[:4] != b"LASF" or header[25] != 4:
        raise StoreError(CodedText("stamp-laz"))
    text = stamp.json_line().encode()
    record = _VLR.pack(0, VLR_USER, VLR_RECORD, len(text), b"approval") + text
    points_at, count = struct.unpack_from("<II", header, _POINTS_AT)
    evlrs_at, evlrs = struct.unpack_from("<QI", header, _EVLRS_AT)
    records = source.read(points_at - _HEADER_BYTES)
    if records[2:7] == b"copc\0":
        struct.pack_into("<I", header, _EVLRS_AT + 8, evlrs + 1)
        target.write(header + records)
        shutil.copyfileobj(source, target, 1 << 20)
        target.write(_EVLR.pack(0, VLR_USER, VLR_RECORD, len(text), b"approval") + text)
        return
    struct.pack_into("<II", header, _POINTS_AT, points_at + len(record), count + 1)
    if evlrs:
        struct.pack_into("<Q", header, _EVLRS_AT, evlrs_at + len(record))
    target.write(header + records + record)
    (table_at,) = struct.unpack("<q", source.read(8))
    target.write(struct.pack("<q", table_at + len(record) if table_at >= 0 else table_at))
    shutil.copyfileobj(source, target, 1 << 20)


def _after_first_line(
    prefix: str, *, lines: int = 1, most: int | None = None
) -> Callable[[BinaryIO, BinaryIO, Stamp], None]:
    def write(source: BinaryIO, target: BinaryIO, stamp: Stamp) -> None:
        for _ in range(lines):
            target.write(source.readline())
        target.write(f"{prefix} recon4 approval {stamp.json_line(most)}\n".encode("ascii"))
        shutil.copyfileobj(source, target, 1 << 20)

    return write


def _comment_first(source: BinaryIO, target: BinaryIO, stamp: Stamp) -> None:
    target.write(f"# recon4 approval {stamp.json_line()}\n".encode("ascii"))
    shutil.copyfileobj(source, target, 1 << 20)


def _png(source: BinaryIO, target: BinaryIO, stamp: Stamp) -> None:
    """A text chunk with the keyword ``recon4 approval`` after the header chunk."""
    header = source.read(_PNG_HEADER_BYTES)
    if len(header) < _PNG_HEADER_BYTES or header[:8] != b"\x89PNG\r\n\x1a\n":
        raise StoreError(CodedText("stamp-png"))
    body = b"tEXtrecon4 approval\0" + stamp.json_line().encode("ascii")
    target.write(header + struct.pack(">I", len(body) - 4) + body)
    target.write(struct.pack(">I", zlib.crc32(body)))
    shutil.copyfileobj(source, target, 1 << 20)


def _dxf(source: BinaryIO, target: BinaryIO, stamp: Stamp) -> None:
    """A comment (group 999) before the first section."""
    target.write(f"999\nrecon4 approval {stamp.json_line()}\n".encode("ascii"))
    shutil.copyfileobj(source, target, 1 << 20)


def _json(source: BinaryIO, target: BinaryIO, stamp: Stamp) -> None:
    if source.read(1) != b"{":
        raise StoreError(CodedText("stamp-json"))
    target.write(f'{{"approval": {stamp.json_line()}, '.encode("ascii"))
    shutil.copyfileobj(source, target, 1 << 20)


def _html(source: BinaryIO, target: BinaryIO, stamp: Stamp) -> None:
    block = approved_block(stamp.to_json())
    target.write(replace_block(source.read().decode("utf-8"), block).encode("utf-8"))


_WRITERS: dict[str, Callable[[BinaryIO, BinaryIO, Stamp], None]] = {
    ".laz": _laz,
    # rply, of Open3D and CloudCompare, refuses a comment before the format.
    ".ply": _after_first_line("comment", lines=2, most=STAMPS.ply_line_bytes),
    ".g2o": _after_first_line("#"),
    ".pcd": _after_first_line("#"),
    ".xyz": _after_first_line("//"),
    ".csv": _after_first_line("#"),
    ".dxf": _dxf,
    ".tum": _comment_first,
    ".yaml": _comment_first,
    ".png": _png,
    ".json": _json,
    ".html": _html,
}
