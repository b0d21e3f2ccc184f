"""What takes space on the disk of the projects; deletes recordings and what can be made again."""

from __future__ import annotations

import logging
import shutil
from collections.abc import Iterator
from datetime import UTC, datetime
from pathlib import Path

from recon4.archive.space import Freeable, free_space, stored_parts
from recon4.errors import StoreError
from recon4.locales.coded import CodedText
from recon4.store.project import SUMMARY
from recon4.untrusted.names import visible
from recon4_app.deps import ServerParts
from recon4_app.errors import Conflict, NotFound, project_page
from recon4_app.jobs.model import JobState
from recon4_app.jobs.space import size_below
from recon4_app.projects.trash import Deleted
from recon4_app.storage.model import ProjectStorage, StorageView, StoredItem
from recon4_app.uploads.store import UPLOADED

log = logging.getLogger(__name__)


def read_storage(server: ServerParts) -> StorageView:
    """Everything in the folder of the projects with its size; reads the size of every file."""
    disk = shutil.disk_usage(server.settings.root)
    items = [*_projects(server), *_recordings(server), *_uploads(server), *_deleted(server)]
    listed_state = sum(item.bytes for item in items if item.kind in ("upload", "deleted"))
    return StorageView(
        disk_bytes=disk.total,
        free_bytes=disk.free,
        items=tuple(sorted(items, key=lambda item: item.bytes, reverse=True)),
        server_bytes=max(0, size_below(server.settings.state) - listed_state),
    )


def delete_recording(server: ServerParts, name: str) -> Deleted:
    """Move an uploaded recording to the trash.

    Raises:
        NotFound: If no upload became a recording of that name.
        Conflict: If a job that waits or runs reads it.
    """
    folder = server.uploads.recordings / name
    if not UPLOADED.fullmatch(name) or not folder.is_dir() or folder.is_symlink():
        raise NotFound(CodedText("recording-unknown", name=name[:64]))
    for job in server.jobs.in_state(JobState.QUEUED, JobState.RUNNING):
        if any(Path(path).is_relative_to(folder) for path in job.inputs.recordings):
            raise Conflict(
                CodedText("recording-in-use", project=job.project),
                remedy=project_page(job.project),
            )
    deleted = server.trash.put(folder)
    server.uploads.forget(name)
    return deleted


def read_project_storage(server: ServerParts, project_id: str) -> ProjectStorage:
    """What takes the space of a project.

    Raises:
        NotFound: If there is none of that name.
        StoreError: If its ledger is damaged, or an approval cannot be read.
    """
    parts = stored_parts(server.projects.folder(project_id))
    return ProjectStorage(parts=parts, keep_earlier_s=server.settings.keep_earlier_s)


def free_expired(server: ServerParts, now_s: float) -> list[str]:
    """Free what only earlier runs of projects needed, some time after the last run of each.

    Returns:
        The projects of which something was removed.
    """
    if not server.settings.keep_earlier_s:
        return []
    cards = [card for card in server.projects.all() if not server.jobs.is_busy(card.id)]
    return [card.id for card in cards if _free_expired(server, card.id, now_s)]


def _free_expired(server: ServerParts, project_id: str, now_s: float) -> bool:
    try:
        folder = server.projects.folder(project_id)
        ran_s = (folder / SUMMARY).stat().st_mtime
        if ran_s + server.settings.keep_earlier_s > now_s:
            return False
        # Opening a project changes its files: only if there is something.
        if not any(part.freeable == Freeable.EARLIER for part in stored_parts(folder)):
            return False
        return bool(free_space(folder, [Freeable.EARLIER]))
    except (NotFound, FileNotFoundError):
        return False  # deleted meanwhile, or not finished
    except StoreError as error:
        log.warning("earlier runs of %s stay: %s", project_id, error)
        return False


def _projects(server: ServerParts) -> Iterator[StoredItem]:
    for card in server.projects.all():
        size = size_below(server.settings.root / card.id)
        yield StoredItem(kind="project", id=card.id, name=card.name, bytes=size)


def _recordings(server: ServerParts) -> Iterator[StoredItem]:
    folder = server.uploads.recordings
    jobs = server.jobs.latest().values()
    known = {card.id: card.name for card in server.projects.all()}
    for path in sorted(folder.iterdir()) if folder.is_dir() else ():
        if not UPLOADED.fullmatch(path.name) or path.is_symlink():
            continue
        used_by = tuple(
            known[job.project]
            for job in jobs
            if job.project in known
            and any(Path(one).is_relative_to(path) for one in job.inputs.recordings)
        )
        yield StoredItem(
            kind="recording",
            id=path.name,
            name=visible(path.name[:-13]),
            bytes=size_below(path),
            used_by=used_by,
        )


def _uploads(server: ServerParts) -> Iterator[StoredItem]:
    for upload in server.uploads.all():
        if not upload.finished:
            expires = datetime.fromtimestamp(server.uploads.expires(upload), UTC)
            yield StoredItem(
                kind="upload",
                id=upload.id,
                name=upload.name,
                bytes=upload.received,
                expires=expires.isoformat(timespec="seconds"),
            )


def _deleted(server: ServerParts) -> Iterator[StoredItem]:
    for one in server.trash.all():
        size = size_below(server.trash.folder(one.id))
        yield StoredItem(kind="deleted", id=one.id, name=one.project, bytes=size, expires=one.goes)
