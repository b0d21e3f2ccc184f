"""An upload: the files of one recording, sent by a browser or script."""

from __future__ import annotations

import asyncio
from dataclasses import dataclass, field
from pathlib import Path, PurePosixPath


@dataclass(slots=True, kw_only=True)
class UploadPart:
    """One file of an upload. Only the store changes it."""

    number: int
    name: str
    """Name at the sender, with its folders."""
    path: PurePosixPath
    """Path on disk, below the upload's folder."""
    bytes: int
    offset: int = 0
    """Bytes that are durably on disk."""
    turn: asyncio.Lock = field(default_factory=asyncio.Lock, repr=False, compare=False)
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
    parts: dict[str, UploadPart] = field(default_factory=dict)
    """Name at the sender -> file."""

    @property
    def received(self) -> int:
        """Bytes that are durably on disk, of all files."""
        return self.bytes if self.finished else sum(part.offset for part in self.parts.values())

    @property
    def whole(self) -> bool:
        """Whether every announced file is complete."""
        return len(self.parts) == self.files and all(part.whole for part in self.parts.values())

    def recording(self, recordings: Path) -> Path:
        """The path for a job: the file itself if there is only one, else the folder."""
        folder = recordings / self.folder
        only = next(iter(self.parts.values())) if self.files == 1 else None
        return folder / only.path if only else folder
