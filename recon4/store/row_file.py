"""Rows of bytes in a file that several threads read and write; what was written can be kept."""

from __future__ import annotations

import os
import struct
import tempfile
import weakref
import zlib
from pathlib import Path

_HEAD = struct.Struct("<QI")
"""Number of bytes of a row, and their CRC-32."""


class RowFile:
    """A file with a fixed number of rows of limited size, each absent until it is written.

    A process that is killed leaves a row whole or damaged; a damaged one is absent.
    """

    def __init__(
        self, count: int, row_bytes: int, *, scratch: Path, kept: Path | None = None
    ) -> None:
        """Take the space of all rows.

        Args:
            count: Number of rows.
            row_bytes: Most bytes of a row.
            scratch: Folder of an unnamed file, which is gone with this object.
            kept: A file of this name in place of it, which stays; one with rows of the same number
                and size is read.

        Raises:
            OSError: If the disk is full.
        """
        self._size = _HEAD.size + row_bytes
        if kept is None:
            self._file = tempfile.TemporaryFile(dir=scratch)  # noqa: SIM115
        else:
            self._file = open(kept, "r+b" if kept.exists() else "w+b")  # noqa: SIM115
        weakref.finalize(self, self._file.close)
        whole = count * self._size
        if os.fstat(self._file.fileno()).st_size != whole:
            self._file.truncate(0)
        os.posix_fallocate(self._file.fileno(), 0, max(whole, 1))
        self._file.truncate(whole)
        self._length = [-1] * count

    def has(self, row: int) -> bool:
        """Whether the row was written, by this process or by an earlier one."""
        if self._length[row] < 0:
            self._look_up(row)
        return self._length[row] >= 0

    def write(self, row: int, data: bytes) -> None:
        """Write a row; threads may write different ones."""
        head = _HEAD.pack(len(data), zlib.crc32(data, 1))
        os.pwrite(self._file.fileno(), head + data, row * self._size)
        self._length[row] = len(data)

    def read(self, row: int, *, start: int = 0, size: int | None = None) -> bytes:
        """A part of a row that was written: up to ``size`` bytes, None = all, from ``start`` on."""
        length = max(self._length[row] - start, 0)
        count = length if size is None else min(size, length)
        return os.pread(self._file.fileno(), count, row * self._size + _HEAD.size + start)

    def _look_up(self, row: int) -> None:
        """Take a row that is there and undamaged."""
        at = row * self._size
        length, crc = _HEAD.unpack(os.pread(self._file.fileno(), _HEAD.size, at))
        if crc and length <= self._size - _HEAD.size:
            data = os.pread(self._file.fileno(), length, at + _HEAD.size)
            if len(data) == length and zlib.crc32(data, 1) == crc:
                self._length[row] = length
