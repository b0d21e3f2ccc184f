"""Backups of the queue, one a day, and their use when the queue is damaged."""

from __future__ import annotations

import logging
import sqlite3
from contextlib import closing
from datetime import UTC, datetime
from pathlib import Path

from recon4.errors import StoreError
from recon4.store.atomic import atomic_file
from recon4.store.sqlite_files import connect

log = logging.getLogger(__name__)

MAX_BACKUPS = 7


class Backups:
    """The newest copies of a SQLite file, in the folder ``backups`` beside it."""

    def __init__(self, path: Path) -> None:
        self._path = path
        self._folder = path.parent / "backups"

    def make(self) -> None:
        """Copy the file once a day; remove the oldest copies."""
        today = self._folder / f"{self._path.stem}-{datetime.now(UTC):%Y-%m-%d}.sqlite"
        if today.exists():
            return
        self._folder.mkdir(exist_ok=True)
        with atomic_file(today) as part, closing(connect(self._path)) as source:
            source.execute("VACUUM INTO ?", (str(part),))
        for old in self._all()[MAX_BACKUPS:]:
            old.unlink()

    def repair(self) -> str:
        """Replace a damaged file by the newest intact backup; the damaged one is renamed and kept.

        Returns:
            A notice about what was restored and lost; empty when nothing was damaged.
        """
        if not self._path.exists() or (damage := integrity_error(self._path)) == "":
            return ""
        stamp = f"{datetime.now(UTC):%Y%m%dT%H%M%S%f}"
        aside = self._path.with_name(f"{self._path.name}.damaged-{stamp}")
        self._path.rename(aside)
        for suffix in ("-wal", "-shm"):  # they belong to the damaged file only
            beside = self._path.with_name(self._path.name + suffix)
            if beside.exists():
                beside.rename(aside.with_name(aside.name + suffix))
        notice = f"The list of jobs was damaged ({damage}); it is kept as {aside.name}. "
        notice += self._restore()
        log.error(notice)
        return notice

    def _restore(self) -> str:
        for copy in self._all():
            if integrity_error(copy) == "":
                with atomic_file(self._path) as part:
                    part.write_bytes(copy.read_bytes())
                day = copy.stem.removeprefix(f"{self._path.stem}-")
                return (
                    f"The backup of {day} replaces it: jobs started later are no longer listed. "
                    "Projects and recordings are unchanged; start such a job again and it "
                    "continues after its last finished stage."
                )
        return (
            "There is no intact backup, so the list is empty. Projects and recordings are "
            "unchanged; start a job again and it continues after its last finished stage."
        )

    def _all(self) -> list[Path]:
        """Copies, the newest first."""
        return sorted(self._folder.glob(f"{self._path.stem}-*.sqlite"), reverse=True)


def integrity_error(path: Path) -> str:
    """The first problem of SQLite's quick check of a file; empty = none.

    Raises:
        StoreError: If the file cannot be opened.
    """
    try:
        with closing(connect(path)) as connection:
            (found,) = connection.execute("PRAGMA quick_check(1)").fetchone()
    except sqlite3.OperationalError as error:
        raise StoreError(f"{path} cannot be read: {error}") from error
    except sqlite3.DatabaseError as error:
        return str(error)
    return "" if found == "ok" else str(found).splitlines()[0]
