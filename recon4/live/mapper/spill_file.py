"""Spill file: points that are rarely needed are in a file, not in memory."""

from __future__ import annotations

import os
import tempfile
import weakref
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from recon4.errors import NoSpace


class SpillFile:
    """An unnamed temporary file that disappears with the process."""

    def __init__(self, folder: Path | None = None) -> None:
        """Create the file.

        Args:
            folder: Its folder; None = the system's temporary folder.
        """
        self._file, name = tempfile.mkstemp(dir=folder)
        os.unlink(name)
        weakref.finalize(self, os.close, self._file)
        self._end = 0

    def put(self, points: NDArray[np.float32]) -> slice:
        """Append points (N, 3); returns the byte range to read them with `get`.

        Raises:
            NoSpace, OSError: If the disk is full.
        """
        data = np.ascontiguousarray(points).tobytes()
        if os.pwrite(self._file, data, self._end) < len(data):
            raise NoSpace("no space for the place index")
        where = slice(self._end, self._end + len(data))
        self._end = where.stop
        return where

    def get(self, where: slice) -> NDArray[np.float32]:
        """Read the points of a byte range, (N, 3)."""
        data = os.pread(self._file, where.stop - where.start, where.start)
        return np.frombuffer(data, np.float32).reshape(-1, 3)
