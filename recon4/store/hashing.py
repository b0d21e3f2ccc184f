"""SHA-256 of files and folders, streamed."""

from __future__ import annotations

import base64
import hashlib
import json
import os
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any, NotRequired, TypedDict

import numpy as np
from numpy.typing import NDArray

from recon4.progress import Progress

BLOCK_BYTES = 1 << 20
"""Files are hashed as a whole and in blocks of this size, so that parts can be checked [bytes]."""
CHAIN_START = "0" * 64
"""What the first row of a hash chain has in place of the hash of the row before it."""


class FileEntry(TypedDict):
    """A file in a manifest, as JSON."""

    bytes: int
    sha256: str
    blocks: NotRequired[str]
    """See `FileDigest.to_json`."""


@dataclass(frozen=True, slots=True)
class FileDigest:
    """Size and SHA-256 of a file and of each of its blocks."""

    size: int
    """Bytes of the file."""
    sha256: str
    """Of the whole file, as hex."""
    blocks: bytes
    """SHA-256 of all blocks, concatenated; empty for a file of at most one block."""

    @staticmethod
    def of(path: Path, seen: Callable[[int], None] = lambda length: None) -> FileDigest:
        """Hash a file; ``seen`` is called with the length of every block read [bytes]."""
        whole, blocks, size = hashlib.sha256(), bytearray(), 0
        with path.open("rb") as file:
            while block := file.read(BLOCK_BYTES):
                whole.update(block)
                blocks += hashlib.sha256(block).digest()
                size += len(block)
                seen(len(block))
        return FileDigest(size, whole.hexdigest(), bytes(blocks) if size > BLOCK_BYTES else b"")

    @staticmethod
    def from_json(value: FileEntry) -> FileDigest:
        """Parse the result of `to_json`; manifests of earlier versions have no blocks.

        Raises:
            KeyError, TypeError, ValueError: If the value is invalid.
        """
        blocks = base64.b64decode(value.get("blocks", ""), validate=True)
        size, sha256 = int(value["bytes"]), str(value["sha256"])
        if blocks and len(blocks) != -(-size // BLOCK_BYTES) * hashlib.sha256().digest_size:
            raise ValueError(f"{len(blocks)} bytes of block hashes do not fit {size} bytes")
        return FileDigest(size, sha256, blocks)

    def to_json(self) -> FileEntry:
        """Plain JSON values; the blocks as base64, 44 characters per MiB."""
        record: FileEntry = {"bytes": self.size, "sha256": self.sha256}
        if self.blocks:
            record["blocks"] = base64.b64encode(self.blocks).decode()
        return record

    def block(self, number: int) -> bytes:
        """SHA-256 of one block."""
        if not self.blocks:
            return bytes.fromhex(self.sha256)
        return self.blocks[
            number * hashlib.sha256().digest_size : (number + 1) * hashlib.sha256().digest_size
        ]


def hash_file(path: Path, seen: Callable[[int], None] | None = None) -> str:
    """SHA-256 of a file's bytes, as hex.

    Args:
        path: The file.
        seen: Called with the length of every block read [bytes].
    """
    digest = hashlib.sha256()
    with path.open("rb") as file:
        while block := file.read(BLOCK_BYTES):
            digest.update(block)
            if seen is not None:
                seen(len(block))
    return digest.hexdigest()


def hash_shown(path: Path, progress: Progress) -> str:
    """SHA-256 of a file's bytes, as hex, as a piece of work of its own."""
    progress.start(f"hash {path.name}", path.stat().st_size, "B")
    return hash_file(path, progress.advance)


def hash_json(value: object) -> str:
    """SHA-256 of a JSON value, independent of the order of keys."""
    text = json.dumps(value, sort_keys=True, separators=(",", ":"), allow_nan=False)
    return hashlib.sha256(text.encode()).hexdigest()


def hash_arrays(arrays: Mapping[str, NDArray[Any]]) -> str:
    """SHA-256 of named arrays, as hex: of names, types, shapes and every bit of the values."""
    digest = hashlib.sha256()
    for name, array in sorted(arrays.items()):
        digest.update(json.dumps([name, array.dtype.str, array.shape]).encode())
        digest.update(np.ascontiguousarray(array).tobytes())
    return digest.hexdigest()


def files_below(folder: Path) -> list[str]:
    """Relative names of all files below a folder, sorted, with forward slashes."""
    found = [Path(root, name) for root, _, names in os.walk(folder) for name in names]
    return sorted(path.relative_to(folder).as_posix() for path in found)


def size_of(path: Path) -> int:
    """Bytes of a file, or of all files below a folder."""
    if path.is_dir():
        return sum((path / name).stat().st_size for name in files_below(path))
    return path.stat().st_size
