"""Ledger of finished stages in a SQLite file; changes are durable when a call returns."""

from __future__ import annotations

import sqlite3
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import astuple, dataclass, fields
from pathlib import Path

from recon4.errors import StoreError
from recon4.locales.coded import CodedText, text_of
from recon4.store.atomic import raise_if_full
from recon4.store.formats import FORMATS
from recon4.store.sqlite_files import (
    connect,
    connect_read_only,
    connect_to_read,
    create_whole,
    make_durable,
    merge_log,
)

_PAGE_BYTES = 512
"""The smallest page of SQLite."""
_SCHEMA = """
CREATE TABLE stages (
    key TEXT PRIMARY KEY,
    stage TEXT NOT NULL,
    version INTEGER NOT NULL,
    finished TEXT NOT NULL,
    seconds REAL NOT NULL,
    cpu_seconds REAL NOT NULL,
    peak_bytes INTEGER NOT NULL
);
CREATE TABLE current (stage TEXT PRIMARY KEY, key TEXT NOT NULL REFERENCES stages (key));
CREATE TABLE hashes (
    path TEXT PRIMARY KEY, size INTEGER NOT NULL, mtime_ns INTEGER NOT NULL, sha256 TEXT NOT NULL
);
"""
_CREATE = f"BEGIN; {_SCHEMA} PRAGMA user_version = {FORMATS.ledger}; COMMIT;"


@dataclass(frozen=True, slots=True)
class FinishedStage:
    """Record of a finished stage with a complete artifact."""

    key: str
    """Name of its folder below ``artifacts/``."""
    stage: str
    version: int
    """Version of the stage's code."""
    finished: str
    """When, ISO 8601 UTC."""
    seconds: float
    """Wall clock time it took [s]."""
    cpu_seconds: float
    """Processor time, children included [s]."""
    peak_bytes: int
    """Largest resident memory of the process or one of its children [bytes]."""


class Ledger:
    """The ledger of a project. One process writes; any number may read concurrently (WAL)."""

    def __init__(self, path: Path, *, read_only: bool = False) -> None:
        """Open or create a ledger.

        Args:
            path: The file.
            read_only: Write nothing, not even SQLite's own files, so that a process without write
                permission can read; a missing file reads as an empty one.

        Raises:
            StoreError: If the file is damaged, of another version, or cannot be opened.
        """
        self.path = path
        if path.is_file() and 0 < path.stat().st_size < _PAGE_BYTES:
            # SQLite takes a file of a few bytes for a new one.
            raise StoreError(CodedText("ledger-cut", file=str(path), size=path.stat().st_size))
        with self._errors():
            if not read_only:
                create_whole(path, _CREATE)
            self._db = _read_only(path) if read_only else connect(path)
        try:
            self._prepare(read_only=read_only and path.exists())
        except BaseException:
            self._db.close()
            raise

    def _prepare(self, *, read_only: bool) -> None:
        with self._errors():
            if not read_only:
                make_durable(self._db)
            self._db.execute("PRAGMA foreign_keys = ON")
            (found,) = self._db.execute("PRAGMA quick_check").fetchone()
            if found != "ok":
                raise sqlite3.DatabaseError(found)
            (version,) = self._db.execute("PRAGMA user_version").fetchone()
            if version == 0 and not read_only:
                self._db.executescript(_CREATE)
        if version not in {0, FORMATS.ledger}:
            raise StoreError(
                CodedText(
                    "ledger-version", file=str(self.path), version=version, known=FORMATS.ledger
                )
            )

    @contextmanager
    def _errors(self) -> Iterator[None]:
        try:
            yield
        # UnicodeDecodeError: damaged text in a page, or in SQLite's own message about one.
        except (sqlite3.Error, UnicodeDecodeError) as error:
            raise_if_full(error, self.path)
            raise StoreError(
                CodedText("ledger-damaged", file=str(self.path), why=text_of(error))
            ) from error

    # -- stages

    def add(self, row: FinishedStage) -> None:
        """Record a finished stage."""
        with self._errors():
            self._db.execute("INSERT OR REPLACE INTO stages VALUES (?,?,?,?,?,?,?)", astuple(row))

    def find(self, key: str) -> FinishedStage | None:
        """The stage with this key, if it is finished."""
        with self._errors():
            row = self._db.execute(f"{_SELECT} WHERE key = ?", (key,)).fetchone()
        return FinishedStage(*row) if row else None

    def forget(self, key: str) -> None:
        """Delete the record of a stage whose artifact no longer exists."""
        with self._errors():
            self._db.execute("DELETE FROM current WHERE key = ?", (key,))
            self._db.execute("DELETE FROM stages WHERE key = ?", (key,))

    def stages(self) -> list[FinishedStage]:
        """All finished stages in the order they finished."""
        with self._errors():
            rows = self._db.execute(f"{_SELECT} ORDER BY finished, rowid").fetchall()
        return [FinishedStage(*row) for row in rows]

    def set_current(self, stage: str, key: str) -> None:
        """Set which artifact of a stage belongs to the latest run."""
        with self._errors():
            self._db.execute("INSERT OR REPLACE INTO current VALUES (?,?)", (stage, key))

    def clear_current(self, stage: str) -> None:
        """Record that the latest run has no artifact of a stage."""
        with self._errors():
            self._db.execute("DELETE FROM current WHERE stage = ?", (stage,))

    def current(self) -> dict[str, str]:
        """Stage name -> key of its artifact in the latest run."""
        with self._errors():
            return dict(self._db.execute("SELECT stage, key FROM current").fetchall())

    # -- hashes of input files

    def cached_hash(self, path: Path) -> str | None:
        """Stored SHA-256 of an input file with unchanged size and modification time, or None."""
        status = path.stat()
        with self._errors():
            row = self._db.execute(
                "SELECT sha256 FROM hashes WHERE path = ? AND size = ? AND mtime_ns = ?",
                (_text_of(path), status.st_size, status.st_mtime_ns),
            ).fetchone()
        return row[0] if row else None

    def remember_hash(self, path: Path, sha256: str) -> None:
        """Store the hash of an input file, so that a large recording is hashed once."""
        status = path.stat()
        with self._errors():
            self._db.execute(
                "INSERT OR REPLACE INTO hashes VALUES (?,?,?,?)",
                (_text_of(path), status.st_size, status.st_mtime_ns, sha256),
            )

    # -- closing

    def settle(self) -> bool:
        """Move the write-ahead log into the file; False = a reader prevented it."""
        with self._errors():
            return merge_log(self._db)

    def close(self) -> None:
        """Close the file; closing twice is allowed."""
        self._db.close()

    def __enter__(self) -> Ledger:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()


_SELECT = f"SELECT {', '.join(f.name for f in fields(FinishedStage))} FROM stages"


def _text_of(path: Path) -> str:
    """Absolute path, with bytes that are no UTF-8 escaped: a column holds text only."""
    return str(path.resolve()).encode(errors="backslashreplace").decode()


def _read_only(path: Path) -> sqlite3.Connection:
    """A connection that creates no file; without a write-ahead log it opens it as immutable."""
    if not path.exists():
        return connect(":memory:")
    if path.with_name(f"{path.name}-wal").exists():
        return connect_to_read(path)
    return connect_read_only(path, immutable=True)
