"""Back up a folder of projects with the server's state while it runs, and restore it.

A backup is a folder of files by their SHA-256 and one list a backup of which file is which:

    objects/ab/abcdef…            bytes, read-only, named by their hash
    2026-11-22T08-00-00Z.json     name, size, hash, mode of every file; the list's own hash

So a second backup into the same folder adds what changed only. SQLite files are copied by SQLite
itself, at one moment each; artifacts and versions never change. Files that a running job is just
making are not taken, and are counted.
"""

from __future__ import annotations

import os
import re
import secrets
import shutil
import sqlite3
import stat
import time
from collections.abc import Iterator
from contextlib import closing
from dataclasses import asdict, dataclass
from pathlib import Path, PurePosixPath

from recon4.archive.listing import BackedUpFile, BackupListing, Entries, newest, read_list
from recon4.errors import ConfigError, NoSpace, StoreError
from recon4.locales.coded import CodedText
from recon4.progress import Progress, track
from recon4.review.trusted_keys import SIGNING_KEY, STATE, TRUSTED_KEYS
from recon4.store.atomic import atomic_file, fsync, raise_if_full, write_json
from recon4.store.formats import FORMATS
from recon4.store.hashing import hash_file, hash_json
from recon4.store.project import is_project
from recon4.store.seal import LOCK, OPEN, SEALS, TURN, Seal, read_seals, seals_text
from recon4.store.sqlite_files import connect, connect_read_only
from recon4.store.unfinished import UNFINISHED

SECRETS = (
    SIGNING_KEY,
    TRUSTED_KEYS,
    "access.sqlite",
    "tls",
    "cluster",
    "metrics.token",
    "backups/access-",
)
"""Beginnings of the names of files that are secret, or say whom the server trusts: keys, password
hashes, sessions, the token of the metrics; also copies of them and damaged ones. Backed up and
restored only on request, so that a foreign backup makes no key and no token valid."""
_DERIVED = ("thumbnails", "slices", "viewers", "clones", "trash", "index")
_TEMPORARY = re.compile(
    r"\.(tmp|slice|going)-.*|buckets-.*|\.lock|server\.lock|lock|pid|heartbeat|audit\.room"
)
_BESIDE_SQLITE = ("-wal", "-shm", "-journal")
_MAX_TRIES = 5


@dataclass(frozen=True, slots=True)
class BackedUp:
    """Summary of a backup."""

    path: Path
    """Path of the listing."""
    files: int
    bytes: int
    """Size of all files."""
    new_bytes: int
    """Size of the files that no earlier backup in the folder has."""
    left_out: tuple[str, ...]
    """Files of a running job that changed or disappeared while they were copied."""
    damaged: tuple[str, ...]
    """Files that differed from their seal when copied; the backup has them as found."""


def back_up(root: Path, out: Path, *, with_keys: bool, progress: Progress) -> BackedUp:
    """Copy projects, recordings and the server's state, and compare every byte written.

    Args:
        root: A folder of projects, or one project.
        out: Folder of backups; made when missing; not below ``root``.
        with_keys: Also the signing key, the people with their passwords' hashes, and TLS keys.
        progress: Counts files.

    Raises:
        ConfigError: If ``root`` is neither, or ``out`` lies in it.
        StoreError: If a file cannot be read or written (`NoSpace`: disk full), or reads back wrong.
    """
    _check_places(root, out)
    objects = out / "objects"
    try:
        objects.mkdir(parents=True, exist_ok=True, mode=0o700)
        names = sorted(_names(root, with_keys=with_keys))
        before = _seals_below(root, names)
        taken, left_out, new_bytes = _copy_all(root, names, objects, progress=progress)
        damaged = _settle_seals(root, before, taken, objects=objects)
        path = _write_list(out, taken, left_out, with_keys=with_keys)
    except OSError as error:
        raise_if_full(error, out)
        raise StoreError(
            CodedText("cannot-write", name=str(out), why=error.strerror or str(error))
        ) from error
    check_backup(path, progress)
    total = sum(entry.bytes for entry in taken.values())
    return BackedUp(path, len(taken), total, new_bytes, tuple(left_out), tuple(damaged))


def restore(backup: Path, root: Path, *, with_keys: bool, progress: Progress) -> int:
    """Restore a backup into an empty folder; nothing is left there if a byte differs.

    Args:
        backup: The list of a backup, or the folder of backups: then the newest.
        root: Folder that is missing or empty.
        with_keys: Also keys and people; the backup must hold them.
        progress: Counts files.

    Returns:
        How many files were written.

    Raises:
        ConfigError: If ``root`` is not empty, or keys are requested and missing.
        StoreError: If the backup is damaged, or the folder cannot be written (`NoSpace`: full).
    """
    path, root = newest(backup), root.resolve()
    listing = read_list(path)
    if root.exists() and any(root.iterdir()):
        raise ConfigError(CodedText("restore-not-empty", root=str(root)))
    if with_keys and not listing.with_keys:
        raise ConfigError(CodedText("restore-no-keys", file=path.name))
    files = {n: e for n, e in listing.files.items() if with_keys or not _is_secret(n)}
    _check_room(root, sum(entry.bytes for entry in files.values()))
    check_backup(path, progress)
    # A name that nobody knows before: in a folder that others may write, a link could wait there.
    building = root.with_name(f".tmp-restore-{root.name}-{secrets.token_hex(8)}")
    try:
        building.mkdir(parents=True)
        for name, entry in track(files.items(), progress, what="restore", unit="files"):
            _put(path.parent / "objects", building, name, entry=entry)
        if root.exists():
            root.rmdir()
        building.rename(root)
    except OSError as error:
        raise_if_full(error, root)
        raise StoreError(
            CodedText("cannot-write", name=str(root), why=error.strerror or str(error))
        ) from error
    finally:
        shutil.rmtree(building, ignore_errors=True)
    return len(files)


def _check_room(root: Path, needed: int) -> None:
    """Refuse before terabytes are read that cannot be written, as of a sparse file."""
    there = next(folder for folder in (root, *root.absolute().parents) if folder.is_dir())
    free = shutil.disk_usage(there).free
    if needed > free:
        raise NoSpace(
            CodedText(
                "restore-no-room",
                root=str(root),
                needed=needed / 1e9,
                free=free / 1e9,
            )
        )


def check_backup(path: Path, progress: Progress) -> None:
    """Read every byte of a backup and compare it.

    Raises:
        StoreError: If a file is missing or has other bytes.
    """
    objects = path.parent / "objects"
    sizes = {entry.sha256: entry.bytes for entry in read_list(path).files.values()}
    for sha256 in track(sorted(sizes), progress, what="compare", unit="files", total=len(sizes)):
        place = _place(objects, sha256)
        if place.is_file() and (found := place.stat().st_size) != sizes[sha256]:
            raise StoreError(
                CodedText("backup-size", place=str(place), sizes=sizes[sha256], found=found)
            )
        got = hash_file(place) if place.is_file() else "no file"
        if got != sha256:
            raise StoreError(CodedText("backup-hash", place=str(place), sha256=sha256, got=got))


def _check_places(root: Path, out: Path) -> None:
    if not is_project(root) and not (root / STATE).is_dir():
        raise ConfigError(CodedText("backup-no-server", root=str(root)))
    if out.resolve().is_relative_to(root.resolve()):
        raise ConfigError(CodedText("backup-inside", out=str(out), root=str(root)))


def _names(root: Path, *, with_keys: bool) -> Iterator[str]:
    """Files to copy, relative to the root."""
    for parent, folders, names in os.walk(root):
        place = Path(parent).relative_to(root)
        folders[:] = [
            name
            for name in folders
            if not _TEMPORARY.fullmatch(name) and not _made_again(root, place / name)
        ]
        for name in names:
            relative = (place / name).as_posix()
            if _TEMPORARY.fullmatch(name) or name in (LOCK, TURN) or _is_beside(name):
                continue
            if not with_keys and _is_secret(relative):
                continue
            if stat.S_ISREG((root / relative).lstat().st_mode):
                yield relative


def _made_again(root: Path, folder: Path) -> bool:
    """Whether a server, or the next run of a project, makes what is in a folder again."""
    if folder.name == UNFINISHED:
        return is_project(root / folder.parent)
    return folder.parent == Path(STATE) and folder.name in _DERIVED


def _is_beside(name: str) -> bool:
    return any(name.endswith(f".sqlite{suffix}") for suffix in _BESIDE_SQLITE)


def _is_secret(name: str) -> bool:
    """Whether it belongs to `SECRETS`, of whatever server below the root.

    A disk may ignore the case of letters, and dots and blanks at the end of a name.
    """
    parts = [part.casefold().rstrip(" .") for part in PurePosixPath(name).parts]
    below = ("/".join(parts[k + 1 :]) for k, part in enumerate(parts) if part == STATE)
    return any(rest.startswith(SECRETS) for rest in below)


def _copy_all(
    root: Path, names: list[str], objects: Path, *, progress: Progress
) -> tuple[Entries, list[str], int]:
    """Copy files; returns their entries, the names of those that changed, and new bytes."""
    taken: Entries = {}
    left_out: list[str] = []
    new_bytes = 0
    for name in track(names, progress, what="back up", unit="files", total=len(names)):
        copied = _copy(root / name, objects)
        if copied is None:
            left_out.append(name)
            continue
        taken[name], added = copied
        new_bytes += added
    return taken, left_out, new_bytes


def _copy(path: Path, objects: Path) -> tuple[BackedUpFile, int] | None:
    """Copy a file under its hash: its entry and new bytes; None = it changed meanwhile."""
    for _ in range(_MAX_TRIES):
        temporary = objects / f".tmp-{secrets.token_hex(6)}"
        try:
            before, mode = _identity(path), stat.S_IMODE(path.stat().st_mode)
            by_sqlite = _copy_bytes(path, temporary)
            if by_sqlite or _identity(path) == before:
                return _keep(temporary, objects, mode)
        except FileNotFoundError:
            return None
        finally:
            temporary.unlink(missing_ok=True)
    return None


def _keep(temporary: Path, objects: Path, mode: int) -> tuple[BackedUpFile, int]:
    """Move a copy to its place and sync it to the disk."""
    sha256, size = hash_file(temporary), temporary.stat().st_size
    place = _place(objects, sha256)
    new = not place.exists()
    if new:
        place.parent.mkdir(exist_ok=True)
        temporary.chmod(0o400)
        fsync(temporary)
        os.replace(temporary, place)
        fsync(place.parent)
    return BackedUpFile(size, sha256, mode), size if new else 0


def _copy_bytes(source: Path, target: Path) -> bool:
    """Copy a file; returns True for a live SQLite file, which SQLite copies."""
    log = source.with_name(f"{source.name}-wal")
    if source.suffix != ".sqlite" or not (log.exists() and log.stat().st_size):
        shutil.copyfile(source, target)
        return False
    try:
        with (
            closing(connect_read_only(source)) as read,
            closing(connect(target)) as written,
        ):
            read.backup(written)
    except sqlite3.Error as error:
        raise StoreError(CodedText("backup-copy", source=str(source), why=str(error))) from error
    return True


def _seals_below(root: Path, names: list[str]) -> dict[str, dict[str, Seal]]:
    """Folder -> its seals."""
    folders = [PurePosixPath(n).parent.as_posix() for n in names if n.endswith(SEALS)]
    return {folder: read_seals(root / folder) for folder in folders}


def _settle_seals(
    root: Path, before: dict[str, dict[str, Seal]], taken: Entries, *, objects: Path
) -> list[str]:
    """Adapt the seals in the backup to its files; returns the damaged files.

    A file that changed between its seal and its copy is ``open`` in the backup.
    """
    damaged = []
    for folder, first in before.items():
        last = read_seals(root / folder)
        settled: dict[str, Seal] = {}
        for name in first.keys() | last.keys():
            full = (PurePosixPath(folder) / name).as_posix()
            if full not in taken:
                continue
            seals = (last.get(name, OPEN), first.get(name, OPEN))
            got = taken[full].sha256
            fits = [seal for seal in seals if seal.get("sha256") == got]
            settled[name] = fits[0] if fits else OPEN
            if not fits and OPEN not in seals and seals[0] == seals[1]:
                settled[name] = seals[0]
                damaged.append(full)
        path = objects / f".tmp-{secrets.token_hex(6)}"
        path.write_text(seals_text(settled), "utf-8")
        list_name = (PurePosixPath(folder) / SEALS).as_posix()
        taken[list_name], _ = _keep(path, objects, 0o644)
        path.unlink(missing_ok=True)
    return damaged


def _identity(path: Path) -> tuple[int, int, int]:
    status = path.stat()
    return status.st_ino, status.st_size, status.st_mtime_ns


def _place(objects: Path, sha256: str) -> Path:
    if not re.fullmatch(r"[0-9a-f]{64}", sha256):
        raise StoreError(CodedText("backup-no-hash", sha256=sha256[:80]))
    return objects / sha256[:2] / sha256


def _write_list(out: Path, files: Entries, left_out: list[str], *, with_keys: bool) -> Path:
    timestamp = time.strftime("%Y-%m-%dT%H-%M-%SZ", time.gmtime())
    path, number = out / f"{timestamp}.json", 1
    while path.exists():
        path, number = out / f"{timestamp}-{number}.json", number + 1
    body = asdict(
        BackupListing(
            format=FORMATS.backup,
            made=timestamp,
            with_keys=with_keys,
            left_out=left_out,
            files=files,
        )
    )
    write_json(path, body | {"sha256": hash_json(body)})
    return path


def _put(objects: Path, building: Path, name: str, *, entry: BackedUpFile) -> None:
    target, sha256 = building / name, entry.sha256
    target.parent.mkdir(parents=True, exist_ok=True)
    if target.exists():
        raise StoreError(CodedText("restore-same-name", name=name[:100]))
    with atomic_file(target) as temporary:
        shutil.copyfile(_place(objects, sha256), temporary)
        if (got := hash_file(temporary)) != sha256:
            raise StoreError(CodedText("backup-hash", place=name, sha256=sha256, got=got))
        temporary.chmod(_restored_mode(name, entry.mode))


def _restored_mode(name: str, mode: int) -> int:
    """Permissions of a restored file: its owner reads it, others never write it, none runs it."""
    return 0o400 | (mode & (0o600 if _is_secret(name) else 0o644))


def to_json(found: BackedUp) -> dict[str, object]:
    """Plain JSON values."""
    return {**asdict(found), "path": str(found.path)}
