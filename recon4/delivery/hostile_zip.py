"""Reads ZIP files of unknown origin: what could harm is refused before a byte is unpacked."""

from __future__ import annotations

import stat
import zipfile
from collections.abc import Iterator
from contextlib import contextmanager
from enum import IntFlag
from pathlib import Path

from recon4.delivery.tuning import DELIVERIES
from recon4.errors import CorruptFile
from recon4.untrusted.bounded import open_regular
from recon4.untrusted.limits import LIMITS
from recon4.untrusted.names import visible

_METHODS = {zipfile.ZIP_STORED, zipfile.ZIP_DEFLATED}
_RESERVED = set('\\:*?"<>|')
"""In no name of a file that other systems can write."""


class ZipFlag(IntFlag):
    """Flags of an entry."""

    ENCRYPTED = 1
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
            raise CorruptFile(f"{path.name}: expected a ZIP file: {visible(str(error))}") from error
        with archive:
            entries = archive.infolist()
            if len(entries) > DELIVERIES.max_files:
                raise CorruptFile(
                    f"{path.name}: expected at most {DELIVERIES.max_files} files, "
                    f"got {len(entries)}"
                )
            for entry in entries:
                if wrong := _harm(entry):
                    name = visible(entry.orig_filename, most=100)
                    raise CorruptFile(f"{path.name}: {name!r} is refused: {wrong}")
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
                        f"{where}: {entry.filename}: expected at most {most} bytes, got more"
                    )
                yield block
    except CorruptFile:
        raise
    except Exception as error:  # whatever damaged compressed data leads to
        text = visible(str(error), most=200)
        raise CorruptFile(f"{where}: {entry.filename} cannot be unpacked: {text}") from error


def unsafe_name(name: str) -> str:
    """Why a name is none of a file in a delivery; empty = it is one."""
    if not name or len(name) > LIMITS.name or visible(name, most=len(name)) != name:
        return "its name is empty, too long or has invisible characters"
    if name.startswith("/") or any(part in ("", ".", "..") for part in name.split("/")):
        return "its name leads outside"
    if _RESERVED & set(name):
        return "its name has characters that stand for something else on other systems"
    return ""


def _harm(entry: zipfile.ZipInfo) -> str:
    """Why an entry is refused; empty = it is a plain file."""
    kind = stat.S_IFMT(entry.external_attr >> 16)
    if entry.orig_filename != entry.filename:
        return "its name holds a NUL or a separator of another system"
    if entry.is_dir() or kind not in (0, stat.S_IFREG):
        return "expected a file, got a folder, a link or a device"
    if entry.flag_bits & ZipFlag.ENCRYPTED:
        return "it is encrypted"
    if entry.compress_type not in _METHODS:
        return f"its compression, number {entry.compress_type}, is not stored or deflated"
    most = LIMITS.expansion * entry.compress_size + LIMITS.free_bytes
    if entry.file_size > most:
        return f"it expands from {entry.compress_size} to {entry.file_size} bytes"
    return unsafe_name(entry.filename)


def _refuse_same(path: Path, entries: list[zipfile.ZipInfo]) -> None:
    """Refuse names that are the same, or would be on a system that ignores case."""
    seen: set[str] = set()
    for entry in entries:
        folded = entry.filename.casefold()
        if folded in seen:
            raise CorruptFile(f"{path.name}: {entry.filename!r} is in it twice")
        seen.add(folded)


def _refuse_hidden(path: Path, entries: list[zipfile.ZipInfo], archive: zipfile.ZipFile) -> None:
    """Refuse entries with the same bytes, and bytes of no entry before the first one."""
    if archive.comment:
        raise CorruptFile(f"{path.name}: expected no comment at its end")
    end = 0
    for entry in sorted(entries, key=lambda one: one.header_offset):
        if entry.header_offset < end or (not end and entry.header_offset):
            raise CorruptFile(f"{path.name}: {entry.filename!r} overlaps with another entry")
        encoding = "utf-8" if entry.flag_bits & ZipFlag.UTF_8 else "cp437"
        name_bytes = len(entry.orig_filename.encode(encoding, "surrogateescape"))
        end = entry.header_offset + DELIVERIES.local_header_bytes + name_bytes + entry.compress_size
    if end > archive.start_dir:
        raise CorruptFile(f"{path.name}: an entry reaches into the list at its end")
