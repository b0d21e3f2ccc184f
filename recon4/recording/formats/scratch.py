"""Temporary copies that a later start finds and removes, should their owner have been killed.

Every copy lies in a folder of its own below one folder of the user; the owner holds a lock on it,
which the kernel releases however the owner ends.
"""

from __future__ import annotations

import os
import shutil
import tempfile
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from recon4.errors import NoSpace, StoreError
from recon4.locales.coded import CodedText
from recon4.store.locks import open_lock_file, try_lock, wait_for_lock

_LOCK = "lock"
_UNLOCKED_S = 3600.0
"""A folder without a lock that is older has lost its owner between two system calls."""
_RESERVE_BYTES = 1 << 30
"""Space that stays free on the disk."""


@contextmanager
def scratch_folder(needed_bytes: int) -> Iterator[Path]:
    """Give a folder for temporary files that is removed at the end, or at a later start.

    Args:
        needed_bytes: How much will be written at least.

    Raises:
        NoSpace: If the disk has less, or less than 1 GiB would be left.
        StoreError: If the folder of the user is not theirs alone.
    """
    base = _base()
    sweep_scratch()
    free = shutil.disk_usage(base).free
    if free < needed_bytes + _RESERVE_BYTES:
        raise NoSpace(
            CodedText(
                "scratch-no-room",
                base=str(base),
                needed_bytes=needed_bytes + _RESERVE_BYTES,
                free_bytes=free,
            )
        )
    folder = Path(tempfile.mkdtemp(dir=base))
    lock = open_lock_file(folder / _LOCK)
    try:
        wait_for_lock(lock)
        yield folder
    finally:
        shutil.rmtree(folder, ignore_errors=True)
        os.close(lock)


def keep_scratch_folder() -> Path:
    """Give a folder for temporary files until this process ends; a later start removes it.

    Raises:
        StoreError: If the folder of the user is not theirs alone.
    """
    folder = Path(tempfile.mkdtemp(dir=_base()))
    wait_for_lock(open_lock_file(folder / _LOCK))  # held until the process ends
    return folder


def sweep_scratch() -> int:
    """Remove what killed processes left behind; gives the number of folders removed."""
    removed = 0
    base = _base_path()
    if not base.is_dir():
        return 0
    for folder in base.iterdir():
        if folder.is_dir() and not folder.is_symlink() and _is_abandoned(folder):
            shutil.rmtree(folder, ignore_errors=True)
            removed += 1
    return removed


def _is_abandoned(folder: Path) -> bool:
    try:
        lock = os.open(folder / _LOCK, os.O_RDWR)
    except OSError:
        return _age_s(folder) > _UNLOCKED_S  # else it is being created or removed by its owner
    try:
        return try_lock(lock)
    except OSError:
        return False
    finally:
        os.close(lock)


def _age_s(folder: Path) -> float:
    try:
        return time.time() - folder.stat().st_mtime
    except OSError:
        return 0.0


def _base_path() -> Path:
    return Path(tempfile.gettempdir()) / f"recon4-scratch-{os.getuid()}"


def _base() -> Path:
    """The folder of all temporary copies of this user.

    Raises:
        StoreError: If other users can write there.
    """
    base = _base_path()
    base.mkdir(mode=0o700, exist_ok=True)
    status = base.lstat()
    if base.is_symlink() or status.st_uid != os.getuid() or status.st_mode & 0o077:
        raise StoreError(CodedText("scratch-not-own", base=str(base)))
    return base
