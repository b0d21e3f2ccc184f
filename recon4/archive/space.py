"""What takes the space of a project, and what of it can be freed.

What can be freed is made again by processing the recording once more: keys of artifacts follow from
their inputs, so only what was freed is computed. Artifacts of an approved map always stay.
"""

from __future__ import annotations

import os
import shutil
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from enum import StrEnum
from functools import partial
from pathlib import Path

from recon4.archive.kept_files import KEPT, kept_files, state_of
from recon4.errors import StoreError
from recon4.locales.coded import CodedText
from recon4.review.approved import VERSIONS
from recon4.review.trusted_keys import STATE
from recon4.store.atomic import is_temporary, temporary_beside
from recon4.store.checked import Altered
from recon4.store.hashing import files_below
from recon4.store.json_files import read_object
from recon4.store.project import Project, read_artifacts, read_description, read_stages
from recon4.store.seal import changing
from recon4.store.unfinished import UNFINISHED

ARTIFACTS = "artifacts"


class Freeable(StrEnum):
    """Why a part of a project can be freed."""

    EARLIER = "earlier"
    """Of earlier runs with other settings or decisions, damaged, or left by a killed run."""
    FRAMES = "frames"
    """The points as recorded: needed by new decisions, by the views of pairs and of multiframes."""
    MAP = "map"
    """The tiles of the map: needed by viewer, slices, exports and evaluation. Its LAZ stays."""


class Kept(StrEnum):
    """Why an artifact stays."""

    APPROVED = "approved"
    """An approval needs it."""
    BEING_WRITTEN = "being-written"
    """A run writes it now."""
    UNKNOWN = "unknown"
    """No stage accounts for it."""


@dataclass(frozen=True, slots=True)
class StoredPart:
    """Some files of a project."""

    name: str
    """Relative, with forward slashes: an artifact, or a file or folder of the project."""
    what: str
    """Name of the stage, or of the file or folder."""
    bytes: int
    """Without files that an earlier part has, too (hard links)."""
    freeable: Freeable | None
    """None = it stays."""
    why: str = ""
    """Why an artifact stays; empty = nothing keeps it, or it is small."""
    kept: Kept | None = None
    """The same for programs."""
    version: int | None = None
    """The newest approved version that needs it."""


def stored_parts(root: Path) -> tuple[StoredPart, ...]:
    """What takes space in a project, the largest first.

    Raises:
        StoreError: If the folder is not a project or its ledger is damaged.
    """
    read_description(root)
    approved = _approved(root)
    stages = {row.key: row.stage for row in read_stages(root)}
    current = {folder.name for folder in read_artifacts(root).values()}
    seen: set[tuple[int, int]] = set()
    parts = [_file(path, seen) for path in sorted(root.iterdir()) if path.name != ARTIFACTS]
    folders = (root / ARTIFACTS).iterdir() if (root / ARTIFACTS).is_dir() else ()
    for path in sorted(folders):
        key, size = path.name, _size(path, seen)
        part = partial(StoredPart, f"{ARTIFACTS}/{key}", stages.get(key, _unknown(key)), size)
        if key in approved:
            parts.append(
                part(None, f"approved, version {approved[key]}", Kept.APPROVED, approved[key])
            )
        elif is_temporary(key):
            parts.append(part(None, "a run writes it", Kept.BEING_WRITTEN))
        elif key not in stages and not _is_damaged(key):
            parts.append(part(None, "no stage accounts for it", Kept.UNKNOWN))
        else:
            parts.append(part(_reason(stages.get(key, ""), key in current)))
    if kept := _kept(root, seen):
        parts.append(StoredPart(f"../{STATE}", KEPT, kept, None))
    return tuple(sorted(parts, key=lambda part: (-part.bytes, part.name)))


def free_space(root: Path, chosen: Iterable[Freeable]) -> tuple[StoredPart, ...]:
    """Remove what can be freed; returns what was removed.

    Args:
        root: The project; no other process may have it open.
        chosen: What is freed.

    Raises:
        Altered: If an approval cannot be read: what it needs is not known.
        StoreError: If the project is in use or cannot be written.
    """
    wanted = set(chosen)
    with Project.open(root) as project:
        parts = [part for part in stored_parts(root) if part.freeable in wanted]
        for part in parts:
            _remove(project, part)
    return tuple(parts)


def _remove(project: Project, part: StoredPart) -> None:
    """Remove an artifact: killed at any time, it is there as a whole or not at all."""
    path = project.root / part.name
    gone = temporary_beside(path)
    try:
        if part.name == UNFINISHED:  # nothing refers to it; a run makes it again
            shutil.rmtree(path)
            return
        with changing(project.root, part.name, compared=False):
            path.rename(gone)
        project.ledger.forget(path.name)
        shutil.rmtree(gone)
    except OSError as error:
        raise StoreError(
            CodedText("free-failed", part=part.name, why=str(error.strerror))
        ) from error


def _reason(stage: str, is_current: bool) -> Freeable | None:
    if not is_current:
        return Freeable.EARLIER
    return {"frames": Freeable.FRAMES, "map": Freeable.MAP}.get(stage)


def _approved(root: Path) -> dict[str, int]:
    """Key of each artifact that an approval names -> its newest version.

    Raises:
        Altered: If an approval cannot be read.
    """
    found: dict[str, int] = {}
    for path in sorted((root / VERSIONS).glob("[0-9]*/approval.json")):
        try:
            statement = read_object(path)["statement"]
            version, keys = int(statement["version"]), list(statement["artifacts"].values())
        except (StoreError, KeyError, TypeError, ValueError, AttributeError) as error:
            where = path.relative_to(root).as_posix()
            raise Altered(CodedText("free-unknown", where=where)) from error
        found |= {str(key): max(version, found.get(str(key), 0)) for key in keys}
    return found


def _is_damaged(key: str) -> bool:
    return key.startswith("damaged-")


def _unknown(key: str) -> str:
    """What a folder is that no stage made."""
    if is_temporary(key):
        return "unfinished artifact"
    return "damaged artifact" if _is_damaged(key) else "not of recon4"


def _kept(root: Path, seen: set[tuple[int, int]]) -> int:
    """Bytes that a server keeps of the maps of a project."""
    artifacts = root / ARTIFACTS
    own = (path for key, path in kept_files(state_of(root)) if (artifacts / key).is_dir())
    return sum(_size(path, seen) for path in own)


def _file(path: Path, seen: set[tuple[int, int]]) -> StoredPart:
    freeable = Freeable.EARLIER if path.name == UNFINISHED else None
    return StoredPart(path.name, path.name, _size(path, seen), freeable)


def _size(path: Path, seen: set[tuple[int, int]]) -> int:
    """Bytes of a file, or of all files below a folder, that were not seen yet."""
    size = 0
    for one in _files(path):
        try:
            status = os.stat(one, follow_symlinks=False)
        except FileNotFoundError:
            continue  # a running job removes files
        if (status.st_dev, status.st_ino) not in seen:
            seen.add((status.st_dev, status.st_ino))
            size += status.st_size
    return size


def _files(path: Path) -> Iterator[Path]:
    if path.is_dir() and not path.is_symlink():
        yield from (path / name for name in files_below(path))
    else:
        yield path
