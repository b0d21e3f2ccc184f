"""Uploads on disk, so that they survive the browser, the server and a power cut.

    ROOT/.recon4/uploads/<id>/upload.json     the announcement
    ROOT/.recon4/uploads/<id>/parts/<n>.json  one a file, written when it is announced
    ROOT/.recon4/uploads/<id>/data/…          the bytes so far; a file's length is its offset
    ROOT/recordings/<name>-<id>/…             `data` when it is complete, read-only from then on

Everything in a response is durably on disk before it is sent (fsync). The server process is the
only writer.
"""

from __future__ import annotations

import logging
import os
import re
import secrets
import shutil
import threading
import time
from contextlib import suppress
from dataclasses import fields
from datetime import UTC, datetime
from pathlib import Path, PurePosixPath
from typing import Any

from recon4.errors import StoreError
from recon4.locales.coded import CodedText
from recon4.store.atomic import make_folders, sweep, write_json
from recon4.store.json_files import read_object
from recon4.untrusted.names import visible
from recon4_app.errors import STORAGE, BadRequest, NoRoom, NotFound, TooLarge, TooMany
from recon4_app.settings import ServerSettings
from recon4_app.uploads.model import Upload, UploadedFile
from recon4_app.uploads.names import another, safe_path, slug

log = logging.getLogger(__name__)

_PLAIN = {"str": str, "int": int, "bool": bool}
_NOT_STORED = ("announced", "changed_s")
UPLOAD_ID = re.compile(r"[0-9a-f]{12}")
UPLOADED = re.compile(r"[A-Za-z0-9][A-Za-z0-9._+-]{0,60}-[0-9a-f]{12}")
"""Name of a folder that an upload became."""


class UploadStore:
    """All uploads of a server; thread-safe."""

    def __init__(self, settings: ServerSettings) -> None:
        self._settings = settings
        self._folder = settings.state / "uploads"
        self.recordings = settings.root.resolve() / "recordings"
        self._lock = threading.Lock()
        self._uploads: dict[str, Upload] = {}
        self._damaged: dict[str, str] = {}
        """Folders that cannot be read -> why."""
        self._read()

    # -- used by routes

    def all(self) -> list[Upload]:
        """All uploads, the newest first; finished ones too, until they are swept."""
        with self._lock:
            found = sorted(self._uploads.values(), key=lambda u: u.created, reverse=True)
        return found

    def notices(self) -> list[str]:
        """For users: the uploads that cannot be resumed, because their files are damaged."""
        with self._lock:
            damaged = list(self._damaged.items())
        return [
            CodedText("notice-upload", upload=name, damage=why, folder=str(self._folder / name))
            for name, why in damaged
        ]

    def get(self, upload_id: str) -> Upload:
        """One upload.

        Raises:
            NotFound: If there is none, or it was removed.
        """
        with self._lock:
            if upload_id not in self._uploads:
                raise NotFound(CodedText("upload-unknown", upload=upload_id[:32]))
            return self._uploads[upload_id]

    def file(self, file_id: str) -> tuple[Upload, UploadedFile]:
        """One file of an upload, by the last part of its URL.

        Raises:
            NotFound: If there is none.
        """
        upload_id, _, number = file_id.partition("-")
        upload = self.get(upload_id)
        for file in upload.listed:
            if str(file.number) == number:
                return upload, file
        raise NotFound(CodedText("upload-file-unknown", number=number[:16], upload=upload_id))

    def begin(self, name: str, *, files: int, total: int, fingerprint: str, by: str) -> Upload:
        """Announce a recording.

        Raises:
            TooLarge: If it is larger than the server accepts.
            TooMany: If too many uploads are unfinished.
            NoRoom: If the disk has too little space.
        """
        with self._lock:
            self._refuse_too_much(total)
            upload_id = secrets.token_hex(6)
            upload = Upload(
                id=upload_id,
                name=name,
                files=files,
                bytes=total,
                fingerprint=fingerprint,
                by=by,
                created=datetime.now(UTC).isoformat(timespec="seconds"),
                folder=f"{slug(name)}-{upload_id}",
            )
            folder = self._folder / upload_id
            make_folders(folder / "parts")
            make_folders(folder / "data")
            self._note(upload)
            fsync(self._folder)
            self._uploads[upload_id] = upload
            return upload

    def add(self, upload: Upload, name: str, *, length: int) -> UploadedFile:
        """Announce a file of an upload; announced twice, it is the same file.

        Raises:
            BadRequest: If the name is not valid, or there are more files than announced.
            NoRoom: If the disk is full.
        """
        with self._lock:
            if name in upload.announced and upload.announced[name].bytes == length:
                return upload.announced[name]
            self._refuse_surplus(upload, name, length)
            taken = {str(file.path).lower() for file in upload.announced.values()}
            path = another(safe_path(name), taken)
            file = UploadedFile(number=len(upload.announced), name=name, path=path, bytes=length)
            data = self._data(upload, file)
            try:
                make_folders(data.parent)
                os.close(os.open(data, os.O_WRONLY | os.O_CREAT | os.O_EXCL, 0o600))
                fsync(data.parent)
                note = {"name": name, "path": str(path), "bytes": length}
                write_json(self._folder / upload.id / "parts" / f"{file.number}.json", note)
            except (FileExistsError, NotADirectoryError) as error:
                raise BadRequest(CodedText("upload-file-and-folder", name=name[:100])) from error
            upload.announced[name] = file
            upload.changed_s = time.time()
            return file

    def data(self, upload: Upload, file: UploadedFile) -> Path:
        """The path of a file's bytes."""
        return self._data(upload, file)

    def finish(self, upload: Upload) -> None:
        """Make a recording of a complete upload; idempotent."""
        with self._lock:
            if upload.finished or not upload.whole:
                return
            data, target = self._folder / upload.id / "data", self.recordings / upload.folder
            make_folders(self.recordings)
            if data.exists():
                for path in data.rglob("*"):
                    path.chmod(0o755 if path.is_dir() else 0o444)  # a recording is never changed
                data.rename(target)
                fsync(self.recordings)
            upload.finished, upload.changed_s = True, time.time()
            self._note(upload)

    def remove(self, upload: Upload) -> None:
        """Remove an upload; a finished recording stays."""
        with self._lock:
            self._uploads.pop(upload.id, None)
            folder = self._folder / upload.id
            if folder.exists():
                gone = folder.with_name(f"gone-{upload.id}-{secrets.token_hex(3)}")
                folder.rename(gone)
                fsync(self._folder)
                shutil.rmtree(gone, ignore_errors=True)

    def forget(self, folder: str) -> None:
        """Remove the announcement of a recording that was deleted: sent again, it is a new one."""
        for upload in self.all():
            if upload.finished and upload.folder == folder:
                self.remove(upload)

    def expires(self, upload: Upload) -> float:
        """When an upload is removed unless more data arrive [s since 1970]."""
        return upload.changed_s + self._settings.upload_stale_s

    def sweep(self, now_s: float) -> list[str]:
        """Remove uploads without new data for a long time.

        Returns:
            Their ids.
        """
        stale = [upload for upload in self.all() if self.expires(upload) < now_s]
        for upload in stale:
            if not upload.finished:
                log.info("upload %s of %s expired: removed", upload.id, upload.by)
            self.remove(upload)
        return [upload.id for upload in stale] + self._sweep_damaged(now_s)

    def _sweep_damaged(self, now_s: float) -> list[str]:
        with self._lock:
            folders = [self._folder / name for name in self._damaged]
            stale = [f for f in folders if _newest_s(f) + self._settings.upload_stale_s < now_s]
            for folder in stale:
                shutil.rmtree(folder, ignore_errors=True)
                log.info("damaged upload %s expired: removed", folder.name)
                del self._damaged[folder.name]
        return [folder.name for folder in stale]

    # -- room

    def _refuse_too_much(self, total: int) -> None:
        settings = self._settings
        if total > settings.max_upload_bytes:
            raise TooLarge(
                CodedText(
                    "upload-too-large",
                    size_bytes=total,
                    limit_bytes=settings.max_upload_bytes,
                )
            )
        still_open = [upload for upload in self._uploads.values() if not upload.finished]
        if len(still_open) >= settings.max_open_uploads:
            raise TooMany(
                CodedText("uploads-too-many", count=len(still_open)),
                remedy=STORAGE,
            )
        promised = sum(upload.bytes - upload.received for upload in still_open)
        free = shutil.disk_usage(self._settings.root).free - promised
        room = free - settings.free_disk_reserve_bytes
        if room < total:
            raise NoRoom(CodedText("upload-no-room", room_bytes=max(0, room), size_bytes=total))

    def _refuse_surplus(self, upload: Upload, name: str, length: int) -> None:
        announced_bytes = sum(file.bytes for file in upload.announced.values())
        if (
            upload.finished
            or name in upload.announced
            or len(upload.announced) >= upload.files
            or announced_bytes + length > upload.bytes
        ):
            raise BadRequest(
                CodedText(
                    "upload-not-announced",
                    name=name[:100],
                    length=length,
                    files=upload.files,
                    bytes=upload.bytes,
                )
            )

    # -- files

    def _data(self, upload: Upload, file: UploadedFile) -> Path:
        return self._folder / upload.id / "data" / file.path

    def _note(self, upload: Upload) -> None:
        facts = {
            f.name: getattr(upload, f.name) for f in fields(upload) if f.name not in _NOT_STORED
        }
        write_json(self._folder / upload.id / "upload.json", facts)

    def _read(self) -> None:
        """Read the uploads of an earlier server, and finish removals that it began."""
        make_folders(self._folder)
        for folder in sorted(self._folder.iterdir()):
            if not UPLOAD_ID.fullmatch(folder.name):
                shutil.rmtree(folder, ignore_errors=True)  # removal was begun
                continue
            if not _was_announced(folder):  # killed before the response was sent
                shutil.rmtree(folder, ignore_errors=True)
                continue
            try:
                upload = self._read_one(folder)
            except (OSError, ValueError, TypeError, KeyError, StoreError) as error:
                log.warning("upload %s is damaged and ignored: %s", folder.name, error)
                self._damaged[folder.name] = visible(f"{type(error).__name__}: {error}")
                continue
            self._uploads[upload.id] = upload
            self.finish(upload)
            if upload.finished and not (self.recordings / upload.folder).exists():
                self.remove(upload)  # its recording was deleted

    def _read_one(self, folder: Path) -> Upload:
        upload = _upload(read_object(folder / "upload.json"))
        moved = upload.finished or not (folder / "data").exists()
        sweep(folder / "parts")
        for path in sorted((folder / "parts").glob("*.json"), key=lambda p: int(p.stem)):
            note = read_object(path)
            note |= {"number": int(path.stem), "path": PurePosixPath(note["path"])}
            file = UploadedFile(**note)
            file.offset = file.bytes if moved else self._data(upload, file).stat().st_size
            upload.announced[file.name] = file
        known = {self._data(upload, file) for file in upload.announced.values()}
        for path in (folder / "data").rglob("*"):
            if not path.is_dir() and path not in known:
                path.unlink()  # killed while it was announced: it has no bytes yet
        upload.changed_s = _newest_s(folder)
        return upload


def _was_announced(folder: Path) -> bool:
    """Whether the response with an upload's id may have been sent."""
    return (folder / "upload.json").exists() or any((folder / "parts").glob("[0-9]*.json"))


def _upload(facts: dict[str, Any]) -> Upload:
    """An upload from its file; invisible characters of an earlier version's name are escaped.

    Raises:
        TypeError, ValueError: If a field is missing, unknown or of another type.
    """
    upload = Upload(**facts)
    for fact in fields(Upload):
        if fact.type in _PLAIN and type(getattr(upload, fact.name)) is not _PLAIN[str(fact.type)]:
            raise TypeError(f"{fact.name}: expected {fact.type}, got {facts[fact.name]!r}"[:200])
    upload.name = visible(upload.name)
    return upload


def _newest_s(folder: Path) -> float:
    """Time of the newest change in a folder [s since 1970]; 0 if there is none."""
    times = [0.0]
    for path in (folder, *folder.rglob("*")):
        with suppress(OSError):
            times.append(path.lstat().st_mtime)
    return max(times)


def fsync(path: Path) -> None:
    """Make a file or folder durable."""
    descriptor = os.open(path, os.O_RDONLY)
    try:
        os.fsync(descriptor)
    finally:
        os.close(descriptor)
