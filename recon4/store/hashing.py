"""SHA-256 of files and folders, streamed."""

from __future__ import annotations

import hashlib
import json
import os
from collections.abc import Callable
from pathlib import Path

_BLOCK = 1 << 20


def hash_file(path: Path, seen: Callable[[int], None] | None = None) -> str:
    """SHA-256 of a file's bytes, as hex.

    Args:
        path: The file.
        seen: Told the length of every block read [bytes].
    """
    digest = hashlib.sha256()
    with path.open("rb") as file:
        while block := file.read(_BLOCK):
            digest.update(block)
            if seen is not None:
                seen(len(block))
    return digest.hexdigest()


def hash_json(value: object) -> str:
    """SHA-256 of a JSON value: equal values have equal hashes, whatever their key order."""
    text = json.dumps(value, sort_keys=True, separators=(",", ":"), allow_nan=False)
    return hashlib.sha256(text.encode()).hexdigest()


def files_below(folder: Path) -> list[str]:
    """Relative names of all files below a folder, sorted, with forward slashes."""
    found = [Path(root, name) for root, _, names in os.walk(folder) for name in names]
    return sorted(path.relative_to(folder).as_posix() for path in found)


def size_of(path: Path) -> int:
    """Bytes of a file, or of all files below a folder."""
    if path.is_dir():
        return sum((path / name).stat().st_size for name in files_below(path))
    return path.stat().st_size
