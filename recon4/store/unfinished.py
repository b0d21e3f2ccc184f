"""What a stage has done so far, in files that outlive its process.

A stage that takes minutes writes down its parts as it makes them. Killed, it goes on from them: it
finds them in a folder of the same key, hence of the same inputs, settings and code. They are whole
or absent (each has a checksum), and removed when the artifact is there. Outside of a runner nothing
is kept.
"""

from __future__ import annotations

import os
import shutil
import struct
import weakref
import zlib
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from contextvars import ContextVar
from pathlib import Path
from typing import BinaryIO

from recon4.errors import Cancelled

UNFINISHED = "unfinished"
"""Folder of a project, while a stage runs or after it was killed."""

_HEAD = struct.Struct("<II")
"""Size of a record, and its CRC-32."""
_folder: ContextVar[Path | None] = ContextVar("unfinished", default=None)


@contextmanager
def keeping(root: Path, stage: str, key: str) -> Iterator[None]:
    """Keep what the stage in this block has done until the block ends.

    A process that is killed, and a run that is stopped, leave it for the next one. Any other end
    removes it, and so does the same stage with another key.

    Args:
        root: The project.
        stage: Name of the stage.
        key: Key of its artifact.
    """
    top = root / UNFINISHED
    folder = top / f"{stage}-{key}"
    for other in top.glob(f"{stage}-*"):
        if other != folder:
            shutil.rmtree(other, ignore_errors=True)
    token = _folder.set(folder)
    try:
        yield
    except (Cancelled, KeyboardInterrupt):
        raise
    except BaseException:
        _remove(folder)
        raise
    else:
        _remove(folder)
    finally:
        _folder.reset(token)


def unfinished_file(name: str) -> Path | None:
    """Where the running stage keeps a part of its work; None = nothing is kept.

    Raises:
        OSError: If the folder cannot be made.
    """
    folder = _folder.get()
    if folder is None:
        return None
    folder.mkdir(parents=True, exist_ok=True)
    return folder / name


class RecordLog:
    """Records one after the other in a file; those of an earlier process come first.

    A record that is cut or damaged ends the log: it and what follows are made again.
    """

    def __init__(self, path: Path | None) -> None:
        """Open the log of a file; None = nothing is kept.

        Raises:
            OSError: If it cannot be opened.
        """
        self._file: BinaryIO | None = None
        self._earlier: list[tuple[int, int]] = []
        """First byte and size of each record of earlier processes."""
        if path is None:
            return
        self._file = path.open("r+b" if path.exists() else "w+b", buffering=0)
        weakref.finalize(self, self._file.close)
        end = 0
        while (record := _record_at(self._file, end)) is not None:
            self._earlier.append((end + _HEAD.size, len(record)))
            end += _HEAD.size + len(record)
        self._file.truncate(end)
        self._file.seek(end)

    def __len__(self) -> int:
        """Number of records of earlier processes."""
        return len(self._earlier)

    def __iter__(self) -> Iterator[bytes]:
        return (self[k] for k in range(len(self)))

    def __getitem__(self, k: int) -> bytes:
        """Record ``k`` of earlier processes."""
        first, size = self._earlier[k]
        assert self._file is not None
        return os.pread(self._file.fileno(), size, first)

    def append(self, record: bytes) -> None:
        """Add a record; what a killed process has added is there.

        Raises:
            OSError: If the disk is full.
        """
        if self._file is not None:
            self._file.write(_HEAD.pack(len(record), zlib.crc32(record, 1)))
            self._file.write(record)


def _record_at(file: BinaryIO, at: int) -> bytes | None:
    """The record that begins at a byte; None = it is cut or damaged, or there is none."""
    head = os.pread(file.fileno(), _HEAD.size, at)
    if len(head) < _HEAD.size:
        return None
    size, crc = _HEAD.unpack(head)
    if size > os.fstat(file.fileno()).st_size - at - _HEAD.size:
        return None
    record = os.pread(file.fileno(), size, at + _HEAD.size)
    return record if zlib.crc32(record, 1) == crc else None


def _remove(folder: Path) -> None:
    shutil.rmtree(folder, ignore_errors=True)
    with suppress(OSError):  # another stage left something, or nothing was kept
        folder.parent.rmdir()
