"""Deleting in two steps: a folder is moved to the trash, and removed after some time.

ROOT/.recon4/trash/<project>@<timestamp>/                a project, as it was
ROOT/.recon4/trash/recordings/<recording>@<timestamp>/   an uploaded recording
ROOT/.recon4/trash/…/.going-…                            being removed permanently
"""

from __future__ import annotations

import os
import re
import shutil
from dataclasses import dataclass
from datetime import UTC, datetime
from pathlib import Path
from typing import Literal

from recon4.locales.coded import CodedText
from recon4.review.newest_approval import APPROVALS, move_record, record_path
from recon4.store.atomic import make_folders
from recon4_app.errors import STORAGE, Conflict, NotFound, project_page

NAME = re.compile(r"(?P<project>[A-Za-z0-9][A-Za-z0-9._-]{0,63})@(?P<timestamp>\d{8}T\d{12})")
RECORDINGS = "recordings"
GOING = ".going-"
TIMESTAMP = "%Y%m%dT%H%M%S%f"


@dataclass(frozen=True, slots=True, kw_only=True)
class Deleted:
    """A project or recording in the trash."""

    id: str
    """Identifier to restore it."""
    kind: Literal["project", "recording"]
    project: str
    """Name of its folder."""
    deleted: str
    """UTC, ISO 8601."""
    goes: str
    """When it is removed permanently, UTC, ISO 8601."""


class Trash:
    """Recently deleted projects, and uploaded recordings."""

    def __init__(self, root: Path, folder: Path, *, kept_s: float) -> None:
        """Name the folders.

        Args:
            root: The folder of the projects; recordings are in `RECORDINGS` below it.
            folder: Where deleted projects are kept; recordings in `RECORDINGS` below it.
            kept_s: How long [s].
        """
        root = root.resolve()
        self._folder = folder
        self._state = folder.parent
        self._homes = {folder: root, folder / RECORDINGS: root / RECORDINGS}
        """Folder of the trash -> where its entries were."""
        self._kept_s = kept_s

    def put(self, deleted: Path) -> Deleted:
        """Move a project or recording to the trash; its name becomes free."""
        folder = next(kept for kept, home in self._homes.items() if home == deleted.parent)
        make_folders(folder)
        target = folder / f"{deleted.name}@{datetime.now(UTC).strftime(TIMESTAMP)}"
        if folder == self._folder:  # first: a new project of that name has no record
            move_record(self._state, deleted.name, target.name)
        deleted.rename(target)
        _fsync(folder)
        _fsync(self._homes[folder])
        return self._deleted(target)

    def all(self) -> list[Deleted]:
        """What is in the trash, the newest first."""
        found = [path for path in self._entries() if _is_deleted(path)]
        return sorted(map(self._deleted, found), key=lambda one: one.deleted, reverse=True)

    def folder(self, deleted_id: str) -> Path:
        """Where a deleted project or recording is kept.

        Raises:
            NotFound: If it was removed.
        """
        return self._find(deleted_id)

    def restore(self, deleted_id: str) -> str:
        """Restore a project or recording.

        Returns:
            Its name.

        Raises:
            NotFound: If it was removed.
            Conflict: If another one has that name now.
        """
        path = self._find(deleted_id)
        found, home = self._deleted(path), self._homes[path.parent]
        if (home / found.project).exists():
            raise Conflict(
                CodedText("restore-taken", kind=found.kind, name=found.project),
                remedy=project_page(found.project) if found.kind == "project" else STORAGE,
            )
        make_folders(home)
        path.rename(home / found.project)
        if path.parent == self._folder:
            move_record(self._state, path.name, found.project)
        _fsync(home)
        return found.project

    def remove(self, deleted_id: str) -> None:
        """Remove a deleted project or recording permanently.

        Raises:
            NotFound: If it was removed already.
        """
        self._remove(self._find(deleted_id))

    def sweep(self, now_s: float) -> list[str]:
        """Remove what has expired, and finish removals that an earlier server began.

        Returns:
            The names of the folders.
        """
        for path in self._entries():
            if path.name.startswith(GOING):
                shutil.rmtree(path, ignore_errors=True)
        old = [path for path in self._entries() if _is_deleted(path)]
        old = [path for path in old if _deleted_s(path) + self._kept_s < now_s]
        for path in old:
            self._remove(path)
        return [self._deleted(path).project for path in old]

    def recover(self) -> None:
        """Finish what a killed server began, so that each record of an approval has its folder.

        The record and the folder of a project are renamed one after the other. Call it before the
        records are used.
        """
        for going in self._folder.iterdir() if self._folder.exists() else ():
            if going.name.startswith(GOING):
                record_path(self._state, going.name.removeprefix(GOING)).unlink(missing_ok=True)
        for record in (self._state / APPROVALS).glob("*@*.json"):
            name = record.stem
            if not NAME.fullmatch(name) or (self._folder / name).exists():
                continue
            project = name.split("@")[0]
            home = self._homes[self._folder] / project
            if home.exists() and not record_path(self._state, project).exists():
                move_record(self._state, name, project)
            else:
                record.unlink()

    def _remove(self, path: Path) -> None:
        going = path.with_name(f"{GOING}{path.name}")
        path.rename(going)
        if path.parent == self._folder:
            record_path(self._state, path.name).unlink(missing_ok=True)
        shutil.rmtree(going, ignore_errors=True)

    def _find(self, deleted_id: str) -> Path:
        for folder in self._homes:
            if _is_deleted(folder / deleted_id) and (folder / deleted_id).is_dir():
                return folder / deleted_id
        raise NotFound(CodedText("removed-for-good"))

    def _entries(self) -> list[Path]:
        return [path for folder in self._homes if folder.exists() for path in folder.iterdir()]

    def _deleted(self, path: Path) -> Deleted:
        at_s = _deleted_s(path)
        return Deleted(
            id=path.name,
            kind="project" if path.parent == self._folder else "recording",
            project=path.name.split("@")[0],
            deleted=_iso(at_s),
            goes=_iso(at_s + self._kept_s),
        )


def _is_deleted(path: Path) -> bool:
    """Whether the name is one of ours, with a valid timestamp."""
    if not NAME.fullmatch(path.name):
        return False
    try:
        _deleted_s(path)
    except ValueError:
        return False
    return True


def _deleted_s(path: Path) -> float:
    deleted = datetime.strptime(path.name.split("@")[1], TIMESTAMP)
    return deleted.replace(tzinfo=UTC).timestamp()


def _iso(t_s: float) -> str:
    return datetime.fromtimestamp(t_s, UTC).isoformat(timespec="seconds")


def _fsync(folder: Path) -> None:
    descriptor = os.open(folder, os.O_RDONLY)
    try:
        os.fsync(descriptor)
    finally:
        os.close(descriptor)
