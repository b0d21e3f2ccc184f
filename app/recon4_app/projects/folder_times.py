"""Times and sizes of the files of a project folder."""

from __future__ import annotations

import os
from datetime import UTC, datetime
from pathlib import Path

from recon4.review.approved import VERSIONS
from recon4.review.newest_approval import record_path
from recon4.review.trusted_keys import STATE, TRUSTED_KEYS

FileStamp = tuple[int, int, int]
"""Modification time [ns], inode and size [bytes]: a file that replaced another one differs in two
of them, also if the clock of the file system has not moved on."""
Stamp = tuple[FileStamp | None, ...]


def stamp_of(folder: Path) -> Stamp:
    """Stamps of the files of a card; None for a missing one.

    The first three say when it was updated, the others whether its approval was.
    """
    root, state = str(folder), str(folder.parent / STATE)
    names = ("project.json", "summary.json", "artifacts", "decisions.sqlite", VERSIONS)
    found = [_stamp(f"{root}/{name}") for name in names]
    if found[0] is None:
        return (None,)
    found.append(_stamp(f"{state}/{TRUSTED_KEYS}"))
    found.append(_stamp(str(record_path(folder.parent / STATE, folder.name))))
    if found[4] is not None:
        found += [_stamp(str(path)) for path in sorted(folder.glob(f"{VERSIONS}/*/approval.json"))]
    return tuple(found)


def _stamp(path: str) -> FileStamp | None:
    try:
        status = os.stat(path)
    except OSError:
        return None
    return status.st_mtime_ns, status.st_ino, status.st_size


def weigh(folder: Path) -> tuple[int, float]:
    """Bytes below a folder, and modification time of its newest file [s].

    A file with several names (hard links) counts once.
    """
    sizes: dict[tuple[int, int], int] = {}
    changed_s = 0.0
    for parent, _, names in os.walk(folder):
        for name in names:
            try:
                status = os.stat(os.path.join(parent, name), follow_symlinks=False)
            except FileNotFoundError:
                continue  # a running job removes files
            sizes[status.st_dev, status.st_ino] = status.st_size
            if not name.startswith("ledger"):  # reading modifies it too
                changed_s = max(changed_s, status.st_mtime)
    return sum(sizes.values()), changed_s


def iso(t_s: float) -> str:
    """UTC, ISO 8601; the start of 1970 for a time out of range."""
    try:
        return datetime.fromtimestamp(t_s, UTC).isoformat(timespec="seconds")
    except (ValueError, OverflowError, OSError):
        return datetime.fromtimestamp(0, UTC).isoformat(timespec="seconds")
