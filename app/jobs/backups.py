"""Copies of the queue, one a day, and what is done when the queue is found damaged."""

from __future__ import annotations

import logging
import sqlite3
from contextlib import closing
from datetime import UTC, datetime
from pathlib import Path

from recon4.errors import StoreError
from recon4.store.atomic import atomic_file

log = logging.getLogger(__name__)

KEPT = 7


class Backups:
    """The newest copies of a SQLite file, in the folder ``backups`` beside it."""

    def __init__(self, path: Path) -> None:
        self._path = path
        self._folder = path.parent / "backups"

    def make(self) -> None:
        """Copy the file as it is now, once a day; the oldest copies go."""
        today = self._folder / f"{self._path.stem}-{datetime.now(UTC):%Y-%m-%d}.sqlite"
        if today.exists():
            return
        self._folder.mkdir(exist_ok=True)
        with atomic_file(today) as part, closing(sqlite3.connect(self._path)) as source:
            source.execute("VACUUM INTO ?", (str(part),))
        for old in self._all()[KEPT:]:
            old.unlink()

    def repair(self) -> str:
        """Put the newest whole copy in the place of a damaged file, which is kept aside.

        Returns:
            What was done and lost, in words; empty when nothing was damaged.
        """
        if not self._path.exists() or (damage := damage_of(self._path)) == "":
            return ""
        stamp = f"{datetime.now(UTC):%Y%m%dT%H%M%S%f}"
        aside = self._path.with_name(f"{self._path.name}.damaged-{stamp}")
        self._path.rename(aside)
        for suffix in ("-wal", "-shm"):  # they belong to the damaged file only
            beside = self._path.with_name(self._path.name + suffix)
            if beside.exists():
                beside.rename(aside.with_name(aside.name + suffix))
        notice = f"The list of jobs was damaged ({damage}); it lies aside as {aside.name}. "
        notice += self._restore()
        log.error(notice)
        return notice

    def _restore(self) -> str:
        for copy in self._all():
            if damage_of(copy) == "":
                with atomic_file(self._path) as part:
                    part.write_bytes(copy.read_bytes())
                day = copy.stem.removeprefix(f"{self._path.stem}-")
                return (
                    f"The copy of {day} is in its place: jobs started after it are not listed any "
                    "more. Projects and recordings are untouched; start such a job again and it "
                    "goes on after its last finished stage."
                )
        return (
            "There is no whole copy, so the list begins anew. Projects and recordings are "
            "untouched; start a job again and it goes on after its last finished stage."
        )

    def _all(self) -> list[Path]:
        """Copies, the newest first."""
        return sorted(self._folder.glob(f"{self._path.stem}-*.sqlite"), reverse=True)


def damage_of(path: Path) -> str:
    """What SQLite finds wrong with a file; empty = nothing.

    Raises:
        StoreError: If it cannot be looked at.
    """
    try:
        with closing(sqlite3.connect(path)) as connection:
            (found,) = connection.execute("PRAGMA quick_check(1)").fetchone()
    except sqlite3.OperationalError as error:
        raise StoreError(f"{path} cannot be read: {error}") from error
    except sqlite3.DatabaseError as error:
        return str(error)
    return "" if found == "ok" else str(found).splitlines()[0]
