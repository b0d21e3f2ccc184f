"""Atomic writes of files and folders.

A file is written under a temporary name in the same folder, fsynced and renamed, and the folder is
fsynced. After a crash at any time either the old or the new state exists, never a partial one.
"""

from __future__ import annotations

import errno
import json
import os
import re
import secrets
import shutil
import sqlite3
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

from recon4.errors import NoSpace, StoreError
from recon4.locales.coded import CodedText

_TEMPORARY = re.compile(r"\.tmp-[0-9a-f]{12}-.+")
_FULL = {errno.ENOSPC, errno.EDQUOT, errno.EFBIG}
_NUMPY_SHORT_WRITE = re.compile(r"\d+ requested and \d+ written")
"""Message of numpy, without an error number, if the disk becomes full in ``ndarray.tofile``."""


@contextmanager
def atomic_file(path: Path) -> Iterator[Path]:
    """Yield a temporary path with the same suffix; at the end it is renamed to ``path``.

    If the block raises, the temporary file is removed and an older ``path`` is unchanged.

    Raises:
        NoSpace: If the disk is full.
        StoreError: If the path cannot be written.
    """
    temporary = temporary_beside(path)
    try:
        yield temporary
        fsync(temporary)
        os.replace(temporary, path)
        fsync(path.parent)
    except OSError as error:
        raise_if_full(error, path)
        raise StoreError(
            CodedText("cannot-write", name=str(path), why=error.strerror or str(error))
        ) from error
    except Exception as error:
        raise_if_full(error, path)
        raise
    finally:
        with suppress(OSError):  # already renamed, or removed later by `sweep`
            temporary.unlink()


@contextmanager
def atomic_folder(path: Path) -> Iterator[Path]:
    """Yield an empty temporary folder; at the end it is renamed to ``path``.

    If the block raises, the temporary folder is removed. ``path`` must not exist yet.

    Raises:
        NoSpace: If the disk is full.
        StoreError: If the path cannot be written.
    """
    temporary = temporary_beside(path)
    try:  # a signal may come as soon as the folder is there
        _make_temporary(temporary, path)
        yield temporary
        _fsync_tree(temporary)
        os.rename(temporary, path)
        fsync(path.parent)
    except Exception as error:
        raise_if_full(error, path)
        raise
    finally:
        shutil.rmtree(temporary, ignore_errors=True)


def make_folders(path: Path, mode: int = 0o777) -> None:
    """Create a folder and its parents, as ``mkdir -p``, durable when this returns.

    Without the fsync of the parent, a power failure removes a new folder with all fsynced files in
    it.

    Args:
        path: The folder; nothing happens if it exists.
        mode: Mode of ``path``; its parents get the default one.

    Raises:
        OSError: If a folder cannot be created.
    """
    if path.is_dir():
        return
    make_folders(path.parent)
    path.mkdir(mode, exist_ok=True)
    fsync(path.parent)


def write_text(path: Path, text: str) -> None:
    """Write a text file atomically."""
    with atomic_file(path) as temporary:
        temporary.write_text(text, "utf-8")


def write_private(path: Path, data: bytes) -> None:
    """Write a file that only its owner may read, atomically: keys, tokens."""
    with atomic_file(path) as temporary:
        descriptor = os.open(temporary, os.O_WRONLY | os.O_CREAT | os.O_EXCL, 0o600)
        with os.fdopen(descriptor, "wb") as file:
            file.write(data)


def write_json(path: Path, value: object) -> None:
    """Write a JSON file atomically: indented, keys in the given order, no NaN."""
    write_text(path, json.dumps(value, indent=1, allow_nan=False, ensure_ascii=False) + "\n")


def copy_file(source: Path, target: Path) -> None:
    """Copy a file atomically."""
    with atomic_file(target) as temporary:
        shutil.copyfile(source, temporary)


def link_file(source: Path, target: Path) -> None:
    """Give a file that never changes a second name, atomically; copy it where that is impossible.

    A confined process may not link between folders.
    """
    with atomic_file(target) as temporary:
        try:
            os.link(source, temporary)
        except OSError:
            shutil.copyfile(source, temporary)


def is_temporary(name: str) -> bool:
    """Whether a file or folder of this name is being written, or was when its process died."""
    return _TEMPORARY.fullmatch(name) is not None


def sweep(folder: Path) -> list[str]:
    """Remove temporary files and folders of killed recon4 processes; nothing else.

    Only one process at a time writes in a project, so every temporary name is an orphan.

    Returns:
        The names removed.
    """
    orphans = sorted(entry for entry in folder.iterdir() if is_temporary(entry.name))
    for orphan in orphans:
        if orphan.is_dir() and not orphan.is_symlink():
            shutil.rmtree(orphan)
        else:
            orphan.unlink()
    return [orphan.name for orphan in orphans]


def raise_if_full(error: BaseException, path: Path) -> None:
    """Raise `NoSpace` if an error was caused by a full disk.

    Raises:
        NoSpace: If the error, or one it came from, is a full disk (or quota, or size limit).
    """
    if is_full(error):
        from recon4.locales.coded import CodedText  # a program starts without it

        raise NoSpace(CodedText("job-disk-full", file=str(path))) from error


def is_full(error: BaseException) -> bool:
    """Whether an error, or one it came from, is a full disk (or quota, or size limit)."""
    cause: BaseException | None = error
    while cause is not None:
        if _is_no_space(cause):
            return True
        cause = cause.__cause__ or cause.__context__
    return False


def _is_no_space(error: BaseException) -> bool:
    if isinstance(error, OSError):
        return error.errno in _FULL or bool(_NUMPY_SHORT_WRITE.search(str(error)))
    return isinstance(error, sqlite3.OperationalError) and "full" in str(error)


def temporary_beside(path: Path) -> Path:
    """A free name beside a file or folder; `sweep` removes what is left under it."""
    return path.with_name(f".tmp-{secrets.token_hex(6)}-{path.name}")


def _make_temporary(folder: Path, path: Path) -> None:
    try:
        folder.mkdir()
    except OSError as error:
        raise_if_full(error, path)
        raise StoreError(
            CodedText("cannot-write", name=str(path.parent), why=str(error.strerror))
        ) from error


def _fsync_tree(folder: Path) -> None:
    for root, _, names in os.walk(folder):
        for name in names:
            fsync(Path(root, name))
        fsync(Path(root))


def fsync(path: Path) -> None:
    """Have the system write a file or folder to the disk."""
    descriptor = os.open(path, os.O_RDONLY)
    try:
        os.fsync(descriptor)
    finally:
        os.close(descriptor)
