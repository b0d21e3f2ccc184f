"""Reading a file that is still being written, with the reader of finished files."""

from __future__ import annotations

import io
import threading
from pathlib import Path


class WriteProgress:
    """How far a file is safe to read; said by the writer, waited for by the reader."""

    def __init__(self) -> None:
        self._news = threading.Condition()
        self._bytes = 0
        self._complete = False

    def reached(self, size: int) -> None:
        """So many bytes can be read."""
        with self._news:
            self._bytes = max(self._bytes, size)
            self._news.notify_all()

    def complete(self) -> None:
        """Nothing more will come."""
        with self._news:
            self._complete = True
            self._news.notify_all()

    def wait_beyond(self, offset: int) -> int:
        """Bytes that can be read; more than ``offset``, or the end has come."""
        with self._news:
            self._news.wait_for(lambda: self._bytes > offset or self._complete)
            return self._bytes


class TailFile(io.RawIOBase):
    """A file whose ``read`` waits for what is not written yet. Only forward."""

    def __init__(self, path: Path, growth: WriteProgress) -> None:
        super().__init__()
        self._file = path.open("rb")
        self._growth = growth

    def readable(self) -> bool:
        """Yes."""
        return True

    def read(self, size: int = -1, /) -> bytes:
        """At most ``size`` bytes, at least one; none only at the end."""
        at = self._file.tell()
        ready = self._growth.wait_beyond(at) - at
        return self._file.read(ready if size < 0 else min(size, ready)) if ready > 0 else b""

    def seek(self, offset: int, whence: int = io.SEEK_SET, /) -> int:
        """Go to a place that was written."""
        return self._file.seek(offset, whence)

    def close(self) -> None:
        """Close the file."""
        self._file.close()
        super().close()
