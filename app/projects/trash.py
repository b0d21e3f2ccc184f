"""Deleting in two steps: a project is moved to the trash, and removed after some time.

ROOT/.recon4/trash/<project>@<timestamp>/   the project, as it was
ROOT/.recon4/trash/.going-…                 being removed permanently
"""

from __future__ import annotations

import os
import re
import secrets
import shutil
from dataclasses import dataclass
from datetime import UTC, datetime
from pathlib import Path

from app.errors import Conflict, NotFound
from recon4.store.atomic import make_folders

NAME = re.compile(r"(?P<project>[A-Za-z0-9][A-Za-z0-9._-]{0,63})@(?P<timestamp>\d{8}T\d{12})")
TIMESTAMP = "%Y%m%dT%H%M%S%f"


@dataclass(frozen=True, slots=True, kw_only=True)
class Deleted:
    """A project in the trash."""

    id: str
    """Identifier to restore it."""
    project: str
    deleted: str
    """UTC, ISO 8601."""
    goes: str
    """When it is removed permanently, UTC, ISO 8601."""


class Trash:
    """Recently deleted projects."""

    def __init__(self, root: Path, folder: Path, *, kept_s: float) -> None:
        self._root = root.resolve()
        self._folder = folder
        self._kept_s = kept_s

    def put(self, project: Path) -> Deleted:
        """Move a project to the trash; its name becomes free."""
        make_folders(self._folder)
        target = self._folder / f"{project.name}@{datetime.now(UTC).strftime(TIMESTAMP)}"
        project.rename(target)
        _fsync(self._folder)
        _fsync(self._root)
        return self._deleted(target)

    def all(self) -> list[Deleted]:
        """Projects in the trash, the newest first."""
        found = [path for path in self._entries() if _is_deleted(path)]
        return sorted(map(self._deleted, found), key=lambda one: one.deleted, reverse=True)

    def restore(self, deleted_id: str) -> str:
        """Restore a project.

        Returns:
            Its name.

        Raises:
            NotFound: If it was removed.
            Conflict: If another project has that name now.
        """
        path = self._find(deleted_id)
        project = self._deleted(path).project
        if (self._root / project).exists():
            raise Conflict(f"another project {project} exists now; delete or rename it first")
        path.rename(self._root / project)
        _fsync(self._root)
        return project

    def remove(self, deleted_id: str) -> None:
        """Remove a deleted project permanently.

        Raises:
            NotFound: If it was removed already.
        """
        self._remove(self._find(deleted_id))

    def sweep(self, now_s: float) -> list[str]:
        """Remove expired projects, and finish removals that an earlier server began.

        Returns:
            The names of the projects.
        """
        for path in self._entries():
            if path.name.startswith(".going-"):
                shutil.rmtree(path, ignore_errors=True)
        old = [path for path in self._entries() if _is_deleted(path)]
        old = [path for path in old if _deleted_s(path) + self._kept_s < now_s]
        for path in old:
            self._remove(path)
        return [self._deleted(path).project for path in old]

    def _remove(self, path: Path) -> None:
        going = path.with_name(f".going-{secrets.token_hex(6)}")
        path.rename(going)
        shutil.rmtree(going, ignore_errors=True)

    def _find(self, deleted_id: str) -> Path:
        if not _is_deleted(self._folder / deleted_id) or not (self._folder / deleted_id).is_dir():
            raise NotFound("this project was removed permanently")
        return self._folder / deleted_id

    def _entries(self) -> list[Path]:
        return list(self._folder.iterdir()) if self._folder.exists() else []

    def _deleted(self, path: Path) -> Deleted:
        at_s = _deleted_s(path)
        return Deleted(
            id=path.name,
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
