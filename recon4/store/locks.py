"""File locks (flock). The kernel releases a lock when its process ends, also when it is killed."""

from __future__ import annotations

import fcntl
import os
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path


def open_lock_file(path: Path, mode: int = 0o600) -> int:
    """Open a lock file, created if missing; closing the descriptor releases its lock.

    Raises:
        OSError: If it cannot be opened.
    """
    return os.open(path, os.O_RDWR | os.O_CREAT | os.O_CLOEXEC, mode)


def wait_for_lock(descriptor: int) -> None:
    """Lock an open file exclusively; wait while another process has the lock."""
    fcntl.flock(descriptor, fcntl.LOCK_EX)


def try_lock(descriptor: int) -> bool:
    """Lock an open file exclusively; False if another process has the lock.

    Raises:
        OSError: If the file system has no locks.
    """
    try:
        fcntl.flock(descriptor, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except BlockingIOError:
        return False
    return True


@contextmanager
def locked_folder(folder: Path) -> Iterator[None]:
    """Lock a folder, as long as its file system has locks, so that `is_abandoned` denies it."""
    descriptor = os.open(folder, os.O_RDONLY | os.O_CLOEXEC)
    try:
        with suppress(OSError):
            wait_for_lock(descriptor)
        yield
    finally:
        os.close(descriptor)


def is_abandoned(folder: Path) -> bool:
    """Whether no process has the lock of a `locked_folder`; not if that cannot be said."""
    try:
        descriptor = os.open(folder, os.O_RDONLY | os.O_CLOEXEC)
    except OSError:
        return False
    try:
        return try_lock(descriptor)
    except OSError:
        return False
    finally:
        os.close(descriptor)


@contextmanager
def trying_lock(path: Path) -> Iterator[int | None]:
    """Yield the descriptor of a lock that is held until the end; None if another process has it.

    Raises:
        OSError: If the file cannot be opened, or the file system has no locks.
    """
    descriptor = open_lock_file(path)
    try:
        yield descriptor if try_lock(descriptor) else None
    finally:
        os.close(descriptor)
