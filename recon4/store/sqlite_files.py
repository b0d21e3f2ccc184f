"""SQLite files of our own: connections, and the settings that make a commit durable."""

from __future__ import annotations

import sqlite3
from pathlib import Path
from typing import Any

BUSY_S = 10.0
"""Longest wait for another writer [s]."""


def connect(path: Path | str, *, busy_s: float = BUSY_S) -> sqlite3.Connection:
    """Open a file to read and write, created if missing; transactions are explicit.

    Raises:
        sqlite3.Error: If it cannot be opened.
    """
    return sqlite3.connect(path, isolation_level=None, timeout=busy_s)


def connect_read_only(path: Path, *, immutable: bool = False) -> sqlite3.Connection:
    """Open a file to read; it is never created.

    Args:
        path: The file.
        immutable: Without locks and files beside it: no process writes to it.

    Raises:
        sqlite3.Error: If it cannot be opened.
    """
    options = "mode=ro&immutable=1" if immutable else "mode=ro"
    uri = f"{path.resolve().as_uri()}?{options}"
    return sqlite3.connect(uri, isolation_level=None, timeout=BUSY_S, uri=True)


def make_durable(connection: Any) -> None:
    """Make commits survive a power cut: write-ahead log, synced at every commit.

    Args:
        connection: A connection of `sqlite3`, or of a pool that wraps one.
    """
    connection.execute("PRAGMA journal_mode = WAL").close()
    sync_commits(connection)


def sync_commits(connection: Any) -> None:
    """Sync at every commit and checkpoint, whatever the journal mode."""
    connection.execute("PRAGMA synchronous = FULL").close()


def merge_log(connection: sqlite3.Connection) -> bool:
    """Move the write-ahead log into the file itself; False if a reader prevented it."""
    (busy, _, _) = connection.execute("PRAGMA wal_checkpoint(TRUNCATE)").fetchone()
    return not busy
