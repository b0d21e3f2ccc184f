"""How much space each project takes, and what of it can be freed."""

from __future__ import annotations

import os
from collections.abc import Sequence
from pathlib import Path

from recon4.archive.kept_files import KEPT_FOLDERS, state_of, sweep_kept
from recon4.archive.space import ARTIFACTS, Freeable, free_space, stored_parts
from recon4.errors import StoreError
from recon4.locales.coded import CodedText
from recon4.review.approved import VERSIONS
from recon4.review.trusted_keys import STATE
from recon4_app.errors import Conflict, project_page
from recon4_app.jobs.model import JobState
from recon4_app.jobs.space import size_below
from recon4_app.jobs.store import JobStore
from recon4_app.projects.folder_times import Stamp, stamp_of
from recon4_app.projects.store import ProjectStore
from recon4_app.storage.model import ProjectSpace

_Kept = tuple[tuple[Stamp, Sequence[int]], ProjectSpace]


class ProjectSpaces:
    """Sizes of finished projects; files of a project that changes are counted for every answer."""

    def __init__(self, projects: ProjectStore, jobs: JobStore) -> None:
        self._projects, self._jobs = projects, jobs
        self._kept: dict[str, _Kept] = {}

    def all(self) -> list[ProjectSpace]:
        """The space of all projects, in the order of the list."""
        active = self._jobs.in_state(JobState.QUEUED, JobState.RUNNING)
        changing, cards = {job.project for job in active}, self._projects.all()
        for gone in self._kept.keys() - {card.id for card in cards}:
            self._kept.pop(gone, None)
        return [
            self._of(self._projects.root / card.id, stays=card.finished and card.id not in changing)
            for card in cards
        ]

    def free(self, project_id: str, chosen: Sequence[Freeable]) -> ProjectSpace:
        """Remove what can be made again.

        Raises:
            NotFound: If there is no such project.
            Conflict: If a job of it waits or runs, or another process writes to it.
            StoreError: If an approval cannot be read, or a file not be removed.
        """
        folder = self._projects.folder(project_id)
        if self._jobs.is_used(project_id):
            raise Conflict(
                CodedText("project-has-job", project=project_id),
                remedy=project_page(project_id),
            )
        free_space(folder, chosen)
        self.sweep_kept()
        return space_of(folder)

    def sweep_kept(self) -> list[str]:
        """Remove what is kept of maps that no project has any more."""
        root = self._projects.root
        return sweep_kept(root / STATE, {path.name for path in root.glob(f"*/{ARTIFACTS}/*")})

    def _of(self, folder: Path, *, stays: bool) -> ProjectSpace:
        # A finished project's files are made under other names and renamed: its folders change.
        kept_of_maps = (state_of(folder) / name for name in KEPT_FOLDERS)
        folders = (folder, folder / ARTIFACTS, folder / VERSIONS, *kept_of_maps)
        key = (stamp_of(folder), [_changed_ns(one) for one in folders])
        kept = self._kept.get(folder.name)
        if stays and kept is not None and kept[0] == key:
            return kept[1]
        found = space_of(folder)
        self._kept[folder.name] = (key, found)
        return found


def space_of(folder: Path) -> ProjectSpace:
    """The space of a project; nothing of a damaged one can be freed."""
    try:
        parts = stored_parts(folder)
    except (StoreError, OSError):
        return ProjectSpace(id=folder.name, bytes=size_below(folder), freeable={})
    freeable = dict.fromkeys(Freeable, 0)
    for part in parts:
        if part.freeable is not None:
            freeable[part.freeable] += part.bytes
    return ProjectSpace(
        id=folder.name,
        bytes=sum(part.bytes for part in parts),
        freeable={what: size for what, size in freeable.items() if size},
    )


def _changed_ns(folder: Path) -> int:
    try:
        return os.stat(folder).st_mtime_ns
    except FileNotFoundError:
        return 0
