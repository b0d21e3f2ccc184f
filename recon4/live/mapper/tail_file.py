"""Tail file: a file that is read while it is written."""

from __future__ import annotations

import io
import threading
from pathlib import Path


class WriteProgress:
    """Number of readable bytes of a growing file; set by the writer, awaited by the reader."""

    def __init__(self) -> None:
        self._news = threading.Condition()
        self._bytes = 0
        self._complete = False

    def reached(self, size: int) -> None:
        """Set the number of readable bytes."""
        with self._news:
            self._bytes = max(self._bytes, size)
            self._news.notify_all()

    def complete(self) -> None:
        """Mark the file as complete."""
        with self._news:
            self._complete = True
            self._news.notify_all()

    def wait_beyond(self, offset: int) -> int:
        """Wait for more than ``offset`` readable bytes or the end; returns the readable bytes."""
        with self._news:
            self._news.wait_for(lambda: self._bytes > offset or self._complete)
            return self._bytes


class TailFile(io.RawIOBase):
    """A file whose ``read`` waits for bytes not written yet. Forward only."""

    def __init__(self, path: Path, growth: WriteProgress) -> None:
        super().__init__()
        self._file = path.open("rb")
        self._growth = growth

    def readable(self) -> bool:
        """True."""
        return True

    def read(self, size: int = -1, /) -> bytes:
        """Read 1 to ``size`` bytes; none only at the end of the complete file."""
        at = self._file.tell()
        ready = self._growth.wait_beyond(at) - at
        return self._file.read(ready if size < 0 else min(size, ready)) if ready > 0 else b""

    def seek(self, offset: int, whence: int = io.SEEK_SET, /) -> int:
        """Go to an offset that was written."""
        return self._file.seek(offset, whence)

    def close(self) -> None:
        """Close the file."""
        self._file.close()
        super().close()
