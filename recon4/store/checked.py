"""Checked artifacts: bytes are compared with the hashes in the manifest before they are used.

Results with an approval are made of such artifacts only. Blocks
(`recon4.store.hashing.BLOCK_BYTES`) are checked one by one, so a slice costs the hashing of the
blocks it reads, once per process: a checked block is not read again as long as the file has the
same inode, size and times.
"""

from __future__ import annotations

import hashlib
import json
import os
import threading
from collections import OrderedDict
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path

from recon4.errors import StoreError
from recon4.locales.coded import CodedText
from recon4.store.hashing import BLOCK_BYTES, FileDigest, files_below
from recon4.store.tuning import CHECKED_FILES

_Identity = tuple[int, int, int, int, int, str]
_checked: OrderedDict[_Identity, bytearray] = OrderedDict()
_lock = threading.Lock()


class Altered(StoreError):
    """Bytes differ from those that were written or approved."""


@dataclass(frozen=True, slots=True)
class CheckedArtifact:
    """The files of an artifact with their expected hashes."""

    folder: Path
    files: Mapping[str, FileDigest]

    @staticmethod
    def open(folder: Path, manifest_sha256: str = "") -> CheckedArtifact:
        """Read the manifest of an artifact.

        Args:
            folder: The artifact.
            manifest_sha256: Expected hash of the manifest; empty = trust the manifest (approvals
                of earlier versions of recon4 do not have its hash).

        Raises:
            Altered: If the manifest is missing or differs from the approved one.
        """
        path = folder / "manifest.json"
        try:
            data = path.read_bytes()
        except OSError as error:
            raise Altered(
                CodedText("seal-unreadable", file=_short(path), why=f"{error.strerror}")
            ) from error
        got = hashlib.sha256(data).hexdigest()
        if manifest_sha256 and got != manifest_sha256:
            raise Altered(_differs(path, manifest_sha256, got=got))
        try:
            found = json.loads(data)["files"]
            files = {str(name): FileDigest.from_json(value) for name, value in found.items()}
        except (ValueError, KeyError, TypeError, AttributeError, RecursionError) as error:
            raise Altered(
                CodedText("seal-no-manifest", file=_short(path), why=f"{error!r}")
            ) from error
        return CheckedArtifact(folder, files)

    def check(self, name: str, start: int = 0, stop: int | None = None) -> None:
        """Compare the blocks of a byte range of a file; blocks checked before are not read.

        Args:
            name: Relative name of the file, with forward slashes.
            start: First byte.
            stop: Byte after the last; None = to the end.

        Raises:
            Altered: If the file is missing, has another size, or a block has other bytes.
        """
        expected = self.files.get(name)
        if expected is None:
            raise Altered(CodedText("seal-not-in-manifest", file=_short(self.folder / name)))
        check_file(self.folder / name, expected, start, stop=stop)

    def check_all(self, seen: Callable[[int], None] = lambda length: None) -> None:
        """Compare every file, and check that there are no others.

        Args:
            seen: Called with numbers of bytes that were compared.

        Raises:
            Altered: If anything differs.
        """
        there = set(files_below(self.folder)) - {"manifest.json"}
        for name in sorted(there ^ self.files.keys()):
            state = "seal-missing" if name in self.files else "seal-surplus"
            raise Altered(CodedText(state, file=_short(self.folder / name)))
        for name, expected in self.files.items():
            for start in range(0, expected.size or 1, BLOCK_BYTES):
                self.check(name, start, start + BLOCK_BYTES)
                seen(min(BLOCK_BYTES, expected.size - start))


def check_file(
    path: Path,
    expected: FileDigest,
    start: int = 0,
    *,
    stop: int | None = None,
    remembered: bool = True,
) -> None:
    """Compare the blocks of a byte range of a file with their hashes.

    Args:
        path: The file.
        expected: Its size and hashes.
        start: First byte.
        stop: Byte after the last; None = to the end.
        remembered: Skip blocks that were compared before in this process.

    Raises:
        Altered: If the file is missing, has another size, or a block has other bytes.
    """
    try:
        descriptor = os.open(path, os.O_RDONLY | os.O_CLOEXEC)
    except OSError as error:
        raise Altered(
            CodedText("seal-unreadable", file=_short(path), why=f"{error.strerror}")
        ) from error
    try:
        size = os.fstat(descriptor).st_size
        if size != expected.size:
            raise Altered(
                CodedText("file-size", file=_short(path), expected=expected.size, got=size)
            )
        flags = _flags(descriptor, expected) if remembered else _no_flags(expected)
        if not expected.blocks:
            _check_whole(descriptor, path, expected, flags=flags)
            return
        last = min(size, stop if stop is not None else size)
        for number in range(start // BLOCK_BYTES, -(-last // BLOCK_BYTES)):
            if not flags[number]:
                _check_block(descriptor, path, expected, number=number)
                flags[number] = 1
    finally:
        os.close(descriptor)


def _check_whole(descriptor: int, path: Path, expected: FileDigest, *, flags: bytearray) -> None:
    """Compare a whole file: a small one, or one without block hashes in its manifest."""
    if flags[0]:
        return
    digest, offset = hashlib.sha256(), 0
    while block := os.pread(descriptor, BLOCK_BYTES, offset):
        digest.update(block)
        offset += len(block)
    if digest.hexdigest() != expected.sha256:
        raise Altered(_differs(path, expected.sha256, got=digest.hexdigest()))
    flags[0] = 1


def _check_block(descriptor: int, path: Path, expected: FileDigest, *, number: int) -> None:
    offset = number * BLOCK_BYTES
    block = os.pread(descriptor, BLOCK_BYTES, offset)
    wanted, got = expected.block(number), hashlib.sha256(block).digest()
    if got != wanted:
        span = (offset, offset + len(block))
        raise Altered(_differs(path, wanted.hex(), got=got.hex(), span=span))


def _flags(descriptor: int, expected: FileDigest) -> bytearray:
    """Flags of the checked blocks of exactly this file; a change time cannot be forged."""
    status = os.fstat(descriptor)
    times = (status.st_mtime_ns, status.st_ctime_ns)
    identity = (status.st_dev, status.st_ino, status.st_size, *times, expected.sha256)
    with _lock:
        flags = _checked.setdefault(identity, _no_flags(expected))
        _checked.move_to_end(identity)
        while len(_checked) > CHECKED_FILES.remembered:
            _checked.popitem(last=False)
    return flags


def _no_flags(expected: FileDigest) -> bytearray:
    return bytearray(max(1, -(-expected.size // BLOCK_BYTES)))


def _short(path: Path) -> str:
    """Part of a path for messages, from the folder ``artifacts`` or ``versions`` on."""
    parts = path.parts
    for name in ("artifacts", "versions"):
        if name in parts:
            return "/".join(parts[len(parts) - 1 - parts[::-1].index(name) :])
    return path.name


def _differs(
    path: Path, expected: str, *, got: str, span: tuple[int, int] | None = None
) -> CodedText:
    """What is said of a file, or of a span of its bytes, with another hash."""
    hashes = {"expected": expected[:16], "got": got[:16]}
    if span is None:
        return CodedText("seal-differs", file=_short(path), **hashes)
    return CodedText("seal-block-differs", file=_short(path), start=span[0], stop=span[1], **hashes)
