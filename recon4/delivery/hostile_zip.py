"""Reads ZIP files of unknown origin: what could harm is refused before a byte is unpacked."""

from __future__ import annotations

import stat
import struct
import zipfile
from collections.abc import Iterator
from contextlib import contextmanager
from enum import IntEnum, IntFlag
from os import SEEK_END
from pathlib import Path
from typing import BinaryIO, cast

from recon4.delivery.tuning import DELIVERIES
from recon4.errors import CorruptFile
from recon4.locales.coded import CodedText
from recon4.untrusted.bounded import open_regular
from recon4.untrusted.limits import LIMITS
from recon4.untrusted.names import visible

_METHODS = {zipfile.ZIP_STORED, zipfile.ZIP_DEFLATED}
_LOCAL = struct.Struct("<4s5H3I2H")
"""Before the name of an entry (APPNOTE 4.3.7)."""
_END = struct.Struct("<4s4H2IH")
"""The last bytes of a ZIP file without a comment (APPNOTE 4.3.16)."""
_END_SIGNATURE = b"PK\x05\x06"
_RESERVED = set('\\:*?"<>|')
"""In no name of a file that other systems can write."""


class ZipField(IntEnum):
    """Values of fields."""

    COUNT_IN_ZIP64 = 0xFFFF
    SIZE_IN_ZIP64 = 0xFFFFFFFF
    """What it is, a field of ZIP64 says."""


class ZipFlag(IntFlag):
    """Flags of an entry."""

    ENCRYPTED = 1
    DESCRIPTOR = 1 << 3
    """Checksum and sizes follow its bytes."""
    UTF_8 = 1 << 11
    """Its name is UTF-8, else code page 437."""


@contextmanager
def open_zip(path: Path) -> Iterator[tuple[zipfile.ZipFile, dict[str, zipfile.ZipInfo]]]:
    """Open a ZIP file; its entries by name.

    Raises:
        CorruptFile: If it is none, is damaged, or has names that lead outside or appear twice,
            links, folders, encrypted or overlapping entries, or entries that expand too much.
    """
    with open_regular(path) as file:
        try:
            archive = zipfile.ZipFile(file)
        except (zipfile.BadZipFile, ValueError, OSError, NotImplementedError) as error:
            raise CorruptFile(
                CodedText("zip-expected", file=path.name, why=visible(str(error)))
            ) from error
        with archive:
            entries = archive.infolist()
            if len(entries) > DELIVERIES.max_files:
                raise CorruptFile(
                    CodedText(
                        "zip-many",
                        file=path.name,
                        max_files=DELIVERIES.max_files,
                        count=len(entries),
                    )
                )
            for entry in entries:
                if wrong := _harm(entry):
                    name = visible(entry.orig_filename, most=100)
                    raise CorruptFile(
                        CodedText("zip-refused", file=path.name, name=name, wrong=wrong)
                    )
            _refuse_same(path, entries)
            _refuse_hidden(path, entries, archive)
            yield archive, {entry.filename: entry for entry in entries}


def blocks_of(
    archive: zipfile.ZipFile, entry: zipfile.ZipInfo, *, most: int, where: str
) -> Iterator[bytes]:
    """The bytes of an entry, a block at a time, with its checksum compared at its end.

    Args:
        archive: Open.
        entry: Of it.
        most: No more bytes are unpacked.
        where: Name of the ZIP file, for errors.

    Raises:
        CorruptFile: If it is damaged or longer than it may be.
    """
    count = 0
    try:
        with archive.open(entry) as file:
            while block := file.read(DELIVERIES.block_bytes):
                count += len(block)
                if count > most:
                    raise CorruptFile(
                        CodedText("zip-large", where=where, filename=entry.filename, most=most)
                    )
                yield block
    except CorruptFile:
        raise
    except Exception as error:  # whatever damaged compressed data leads to
        text = visible(str(error), most=200)
        raise CorruptFile(
            CodedText("zip-unpack", where=where, filename=entry.filename, text=text)
        ) from error


def unsafe_name(name: str) -> str:
    """Why a name is none of a file in a delivery; empty = it is one."""
    if not name or len(name) > LIMITS.name or visible(name, most=len(name)) != name:
        return CodedText("zip-name-invisible")
    if name.startswith("/") or any(part in ("", ".", "..") for part in name.split("/")):
        return CodedText("zip-name-outside")
    if _RESERVED & set(name):
        return CodedText("zip-name-reserved")
    return ""


def _harm(entry: zipfile.ZipInfo) -> str:
    """Why an entry is refused; empty = it is a plain file."""
    kind = stat.S_IFMT(entry.external_attr >> 16)
    if entry.orig_filename != entry.filename:
        return CodedText("zip-name-separator")
    if entry.is_dir() or kind not in (0, stat.S_IFREG):
        return CodedText("zip-no-file")
    if entry.flag_bits & ZipFlag.ENCRYPTED:
        return CodedText("zip-encrypted")
    if entry.compress_type not in _METHODS:
        return CodedText("zip-compression", number=entry.compress_type)
    most = LIMITS.expansion * entry.compress_size + LIMITS.free_bytes
    if entry.file_size > most:
        return CodedText("zip-expands", packed=entry.compress_size, size=entry.file_size)
    return unsafe_name(entry.filename)


def _refuse_same(path: Path, entries: list[zipfile.ZipInfo]) -> None:
    """Refuse names that are the same, or would be on a system that ignores case."""
    seen: set[str] = set()
    for entry in entries:
        folded = entry.filename.casefold()
        if folded in seen:
            raise CorruptFile(CodedText("zip-twice", file=path.name, filename=entry.filename))
        seen.add(folded)


def _refuse_hidden(path: Path, entries: list[zipfile.ZipInfo], archive: zipfile.ZipFile) -> None:
    """Refuse entries with the same bytes, and bytes that belong to no entry."""
    if archive.comment:
        raise CorruptFile(CodedText("zip-comment", file=path.name))
    file = cast(BinaryIO, archive.fp)
    ends = {0}
    for entry in sorted(entries, key=lambda one: one.header_offset):
        if wrong := _wrong_start(entry.header_offset, ends):
            name = visible(entry.filename)
            raise CorruptFile(CodedText("zip-entry", file=path.name, name=name, wrong=wrong))
        size = _packed_size(path, file, entry)
        ends = {entry.header_offset + size + more for more in _trailers(entry)}
    if wrong := _wrong_start(archive.start_dir, ends):
        raise CorruptFile(CodedText("zip-list", file=path.name, wrong=wrong))
    file.seek(-_END.size, SEEK_END)
    signature, *disks, here, every, _, _, comment = _END.unpack(file.read(_END.size))
    counts = {here, every} - {ZipField.COUNT_IN_ZIP64}
    if signature != _END_SIGNATURE or comment or any(disks) or counts - {len(entries)}:
        raise CorruptFile(CodedText("zip-end", file=path.name))


def _wrong_start(start: int, ends: set[int]) -> str:
    """What is wrong of something that begins elsewhere than where the entry before it ends."""
    if start < min(ends):
        return CodedText("zip-overlap")
    return "" if start in ends else CodedText("zip-gap")


def _packed_size(path: Path, file: BinaryIO, entry: zipfile.ZipInfo) -> int:
    """Bytes of an entry with its header, which says what the list at the end says."""
    file.seek(entry.header_offset)
    head = file.read(_LOCAL.size)
    if len(head) < _LOCAL.size:
        raise CorruptFile(CodedText("zip-beyond", file=path.name, filename=visible(entry.filename)))
    _, _, flags, method, _, _, *sums, name_bytes, extra_bytes = _LOCAL.unpack(head)
    listed = (entry.CRC, entry.compress_size, entry.file_size)
    alike = all(a in (b, ZipField.SIZE_IN_ZIP64) for a, b in zip(sums, listed, strict=True))
    described = flags & ZipFlag.DESCRIPTOR
    if (flags, method) != (entry.flag_bits, entry.compress_type) or not (alike or described):
        raise CorruptFile(
            CodedText("zip-differs", file=path.name, filename=visible(entry.filename))
        )
    return _LOCAL.size + int(name_bytes) + int(extra_bytes) + entry.compress_size


def _trailers(entry: zipfile.ZipInfo) -> tuple[int, ...]:
    """How many bytes may follow an entry: a data descriptor (APPNOTE 4.3.9), or none."""
    return (12, 16, 20, 24) if entry.flag_bits & ZipFlag.DESCRIPTOR else (0,)
