"""Copies of the server's SQLite files, one a day, and their use when a file is damaged."""

from __future__ import annotations

import sqlite3
import stat
from collections.abc import Sequence
from contextlib import closing
from dataclasses import dataclass
from datetime import UTC, datetime
from pathlib import Path

from recon4.errors import StoreError
from recon4.locales.coded import unreadable
from recon4.store.atomic import atomic_file
from recon4.store.sqlite_files import connect
from recon4_app.tuning import STATE_COPIES

PRIVATE = stat.S_IRUSR | stat.S_IWUSR


@dataclass(frozen=True, slots=True)
class RestoredFile:
    """What became of a damaged file."""

    damage: str
    aside: str
    """Name under which the damaged file is kept; empty = there was no file."""
    day: str
    """Day of the copy that replaces it; empty = there was no intact copy."""

    def kept_as(self) -> dict[str, int | str]:
        """Values of a notice: whether the damaged file is kept, and as what."""
        return {"kept": int(bool(self.aside)), "aside": self.aside}


class StateCopies:
    """The newest copies of a SQLite file, in the folder ``backups`` beside it."""

    def __init__(self, path: Path, *, without: Sequence[str] = ()) -> None:
        """Name the file.

        Args:
            path: The file.
            without: Tables that are empty in the copies.
        """
        self._path, self._without = path, without
        self._folder = path.parent / "backups"

    def make(self, *, renew: bool = False) -> None:
        """Copy the file once a day, or replace today's copy; remove the oldest copies."""
        today = self._folder / f"{self._path.stem}-{datetime.now(UTC):%Y-%m-%d}.sqlite"
        if today.exists() and not renew:
            return
        self._folder.mkdir(exist_ok=True)
        with atomic_file(today) as part:
            with closing(connect(self._path)) as source:
                source.execute("VACUUM INTO ?", (str(part),))
            part.chmod(PRIVATE)
            with closing(connect(part)) as copy:
                for table in self._without:
                    copy.execute(f"DELETE FROM {table}")
                copy.execute("VACUUM")
        for old in self.all()[STATE_COPIES.max_copies :]:
            old.unlink()

    def damage(self) -> str:
        """What is wrong with the file, also that it is missing or empty beside copies of it."""
        if not self._path.exists() or not self._path.stat().st_size:
            empty = "it is empty" if self._path.exists() else "it is missing"
            return empty if self.all() else ""
        return integrity_error(self._path)

    def restore(self) -> RestoredFile | None:
        """Replace a damaged file by the newest intact copy; the damaged one is renamed and kept.

        Returns:
            What was done; None = nothing was damaged.
        """
        damage = self.damage()
        if not damage:
            return None
        copy = self.newest_intact()
        aside = self._put_aside()
        if copy is None:
            return RestoredFile(damage, aside, "")
        with atomic_file(self._path) as part:
            part.touch(PRIVATE)
            part.write_bytes(copy.read_bytes())
        return RestoredFile(damage, aside, copy.stem.removeprefix(f"{self._path.stem}-"))

    def newest_intact(self) -> Path | None:
        """The newest copy that can be read; None = there is none."""
        return next((copy for copy in self.all() if not _copy_error(copy)), None)

    def all(self) -> list[Path]:
        """Copies, the newest first."""
        return sorted(self._folder.glob(f"{self._path.stem}-*.sqlite"), reverse=True)

    def _put_aside(self) -> str:
        """Rename the file and what SQLite keeps beside it; its new name, empty without a file."""
        stamp = f"{datetime.now(UTC):%Y%m%dT%H%M%S%f}"
        aside = self._path.with_name(f"{self._path.name}.damaged-{stamp}")
        found = ""
        for suffix in ("", "-wal", "-shm"):  # they belong to the damaged file only
            beside = self._path.with_name(self._path.name + suffix)
            if beside.exists():
                beside.rename(aside.with_name(aside.name + suffix))
                found = aside.name
        return found


def integrity_error(path: Path) -> str:
    """The first problem of SQLite's quick check of a file; empty = none.

    Raises:
        StoreError: If the file cannot be opened.
    """
    try:
        with closing(connect(path)) as connection:
            (found,) = connection.execute("PRAGMA quick_check(1)").fetchone()
    except sqlite3.OperationalError as error:
        raise StoreError(unreadable(str(path), error)) from error
    except sqlite3.DatabaseError as error:
        return str(error)
    return "" if found == "ok" else str(found).splitlines()[0]


def _copy_error(copy: Path) -> str:
    try:
        return integrity_error(copy) if copy.stat().st_size else "it is empty"
    except StoreError as error:
        return str(error)
