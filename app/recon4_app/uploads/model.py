"""An upload: the files of one recording, sent by a browser or script."""

from __future__ import annotations

import asyncio
import time
from dataclasses import dataclass, field
from pathlib import Path, PurePosixPath


@dataclass(slots=True, kw_only=True)
class UploadedFile:
    """One file of an upload. Only the store changes it."""

    number: int
    name: str
    """Name at the sender, with its folders."""
    path: PurePosixPath
    """Path on disk, below the upload's folder."""
    bytes: int
    offset: int = 0
    """Bytes that are durably on disk."""
    lock: asyncio.Lock = field(default_factory=asyncio.Lock, repr=False, compare=False)
    """Held by the request that writes to it."""

    @property
    def whole(self) -> bool:
        """Whether all its bytes are on disk."""
        return self.offset == self.bytes


@dataclass(slots=True, kw_only=True)
class Upload:
    """All files of one recording. Only the store changes it."""

    id: str
    name: str
    """Display name."""
    files: int
    """Number of announced files."""
    bytes: int
    """Size of all files."""
    fingerprint: str
    """By which the sender recognizes its files, to resume; not used by the server."""
    by: str
    """Person who sends it."""
    created: str
    """UTC, ISO 8601."""
    folder: str
    """Name of the recording's folder when it is complete."""
    finished: bool = False
    announced: dict[str, UploadedFile] = field(default_factory=dict)
    """Name at the sender -> file."""
    changed_s: float = field(default_factory=time.time)
    """When a file was announced or bytes arrived [s since 1970]; not stored, files have times."""

    @property
    def listed(self) -> list[UploadedFile]:
        """The announced files; a copy, because other threads announce more meanwhile."""
        return list(self.announced.values())

    @property
    def received(self) -> int:
        """Bytes that are durably on disk, of all files."""
        return self.bytes if self.finished else sum(file.offset for file in self.listed)

    @property
    def whole(self) -> bool:
        """Whether every announced file is complete."""
        files = self.listed
        return len(files) == self.files and all(file.whole for file in files)

    def recording(self, recordings: Path) -> Path:
        """The path for a job: the file itself if there is only one, else the folder."""
        folder = recordings / self.folder
        only = self.listed[0] if self.files == 1 else None
        return folder / only.path if only else folder
