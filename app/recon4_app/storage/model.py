"""What takes space on the disk of the projects."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

from recon4.archive.space import Freeable, StoredPart

StoredKind = Literal["project", "recording", "upload", "deleted"]


@dataclass(frozen=True, slots=True, kw_only=True)
class StoredItem:
    """A project, an uploaded recording, an unfinished upload, or something in the trash."""

    kind: StoredKind
    id: str
    """What a request to remove it names."""
    name: str
    """Display name."""
    bytes: int
    used_by: tuple[str, ...] = ()
    """Of a recording: projects that were made from it."""
    expires: str = ""
    """When it is removed, UTC, ISO 8601; empty = it stays."""


@dataclass(frozen=True, slots=True, kw_only=True)
class StorageView:
    """What takes space, the largest first."""

    disk_bytes: int
    free_bytes: int
    items: tuple[StoredItem, ...]
    server_bytes: int
    """State of the server: queue, logs, backups, caches."""


@dataclass(frozen=True, slots=True, kw_only=True)
class ProjectSpace:
    """How much space a project takes."""

    id: str
    bytes: int
    """Without files that it has twice (hard links)."""
    freeable: dict[Freeable, int]
    """What can be freed, because processing the recording makes it again -> its size [bytes]."""


@dataclass(frozen=True, slots=True, kw_only=True)
class ProjectStorage:
    """What takes the space of a project."""

    parts: tuple[StoredPart, ...]
    """The largest first."""
    keep_earlier_s: float
    """What only earlier runs needed is freed this long after the last one [s]; 0 = never."""
