"""Times and sizes of the files of a project folder."""

from __future__ import annotations

import os
from datetime import UTC, datetime
from pathlib import Path

from recon4.review.approved import VERSIONS
from recon4.review.newest_approval import record_path
from recon4.review.trusted_keys import STATE, TRUSTED_KEYS

Stamp = tuple[int | None, ...]


def stamp_of(folder: Path) -> Stamp:
    """Modification times of the files of a card [ns]; None for a missing one.

    The first three say when it was updated, the others whether its approval was.
    """
    names = ("project.json", "summary.json", "artifacts", "decisions.sqlite", VERSIONS)
    state = folder.parent / STATE
    judging = (state / TRUSTED_KEYS, record_path(state, folder.name))
    approvals = sorted(folder.glob(f"{VERSIONS}/*/approval.json"))
    paths = (*(folder / n for n in names), *judging, *approvals)
    return tuple(_changed_ns(path) for path in paths)


def _changed_ns(path: Path) -> int | None:
    try:
        return path.stat().st_mtime_ns
    except OSError:
        return None


def weigh(folder: Path) -> tuple[int, float]:
    """Bytes below a folder, and modification time of its newest file [s]."""
    size, changed_s = 0, 0.0
    for parent, _, names in os.walk(folder):
        for name in names:
            try:
                status = os.stat(os.path.join(parent, name), follow_symlinks=False)
            except FileNotFoundError:
                continue  # a running job removes files
            size += status.st_size
            if not name.startswith("ledger"):  # reading modifies it too
                changed_s = max(changed_s, status.st_mtime)
    return size, changed_s


def iso(t_s: float) -> str:
    """UTC, ISO 8601; the start of 1970 for a time out of range."""
    try:
        return datetime.fromtimestamp(t_s, UTC).isoformat(timespec="seconds")
    except (ValueError, OverflowError, OSError):
        return datetime.fromtimestamp(0, UTC).isoformat(timespec="seconds")
