"""An upload: the files of one recording on their way from a browser or script to the disk."""

from __future__ import annotations

import asyncio
from dataclasses import dataclass, field
from pathlib import Path, PurePosixPath


@dataclass(slots=True, kw_only=True)
class UploadPart:
    """One file of an upload. Only the store changes it."""

    number: int
    name: str
    """As the sender calls it, with its folders."""
    path: PurePosixPath
    """As it is called on disk, below the upload's folder."""
    bytes: int
    offset: int = 0
    """Bytes that are safely on disk."""
    turn: asyncio.Lock = field(default_factory=asyncio.Lock, repr=False, compare=False)
    """Held by the request that writes to it."""

    @property
    def whole(self) -> bool:
        """Whether all of it is here."""
        return self.offset == self.bytes


@dataclass(slots=True, kw_only=True)
class Upload:
    """All files of one recording. Only the store changes it."""

    id: str
    name: str
    """As people call it."""
    files: int
    """How many there will be."""
    bytes: int
    """How large all of them are."""
    fingerprint: str
    """What the sender recognizes its files by, to go on after a break; nothing to us."""
    by: str
    """Who sends it."""
    created: str
    """UTC, ISO 8601."""
    folder: str
    """Name of the recording's folder once it is whole."""
    finished: bool = False
    parts: dict[str, UploadPart] = field(default_factory=dict)
    """Name as the sender calls it -> file."""

    @property
    def received(self) -> int:
        """Bytes that are safely on disk."""
        return self.bytes if self.finished else sum(part.offset for part in self.parts.values())

    @property
    def whole(self) -> bool:
        """Whether every announced file is here to its last byte."""
        return len(self.parts) == self.files and all(part.whole for part in self.parts.values())

    def recording(self, recordings: Path) -> Path:
        """What a job is given: the file itself when there is one, else the folder."""
        folder = recordings / self.folder
        only = next(iter(self.parts.values())) if self.files == 1 else None
        return folder / only.path if only else folder
