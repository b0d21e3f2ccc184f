"""SQLite files of our own: connections, and the settings that make a commit durable."""

from __future__ import annotations

import os
import shutil
import sqlite3
import tempfile
from contextlib import closing
from pathlib import Path
from typing import Any

from recon4.store.atomic import temporary_beside
from recon4.store.tuning import SQLITE


def connect(path: Path | str, *, busy_s: float = SQLITE.busy_s) -> sqlite3.Connection:
    """Open a file to read and write, created if missing; transactions are explicit.

    Raises:
        sqlite3.Error: If it cannot be opened.
    """
    return sqlite3.connect(path, isolation_level=None, timeout=busy_s)


def create_whole(path: Path, schema: str) -> None:
    """Create a file with its tables, unless it exists: nobody ever sees it without them.

    A reader that comes while another process creates a file would find no table in it, as in a
    damaged one.

    Raises:
        sqlite3.Error: If it cannot be created.
    """
    if path.exists():
        return
    made = temporary_beside(path)
    try:
        with closing(connect(made)) as db:
            db.executescript(schema)
        os.link(made, path)  # fails if another process was faster; its file stays
    except FileExistsError:
        pass
    except OSError:  # a disk without hard links
        with closing(connect(path)) as db:
            db.executescript(schema)
    finally:
        made.unlink(missing_ok=True)


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
    return sqlite3.connect(uri, isolation_level=None, timeout=SQLITE.busy_s, uri=True)


def connect_to_read(path: Path) -> sqlite3.Connection:
    """Open an existing file to read, also on read-only media and full disks.

    SQLite keeps files beside a file with a write-ahead log, even to read it. Where it cannot make
    them, the file is opened as immutable, or with its log as a copy in memory.

    Raises:
        sqlite3.Error: If it cannot be opened.
    """
    if has_room_beside(path):
        return connect_read_only(path)
    log = path.with_name(f"{path.name}-wal")
    if not log.exists() or not log.stat().st_size:
        return connect_read_only(path, immutable=True)
    return _copy_with_log(path, log)


def has_room_beside(path: Path) -> bool:
    """Whether SQLite can make the files it keeps beside a file, even to read it.

    Where a command is confined (`recon4.sandbox`), only the attempt tells.
    """
    try:
        tempfile.TemporaryFile(dir=path.parent).close()
    except OSError:
        return False
    disk = os.statvfs(path.parent)
    return disk.f_bavail * disk.f_frsize >= SQLITE.room_beside_bytes


def _copy_with_log(path: Path, log: Path) -> sqlite3.Connection:
    try:
        with tempfile.TemporaryDirectory(prefix="recon4-") as folder:
            for one in (path, log):
                shutil.copyfile(one, Path(folder, one.name))
            with closing(connect(Path(folder, path.name))) as whole:
                copy = connect(":memory:")
                whole.backup(copy)
    except OSError as error:
        raise sqlite3.OperationalError(f"its log cannot be read here: {error}") from error
    return copy


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
