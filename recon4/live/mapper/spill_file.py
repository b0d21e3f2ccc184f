"""Points that are seldom needed wait in a file, not in memory."""

from __future__ import annotations

import os
import tempfile
import weakref
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from recon4.errors import NoSpace


class SpillFile:
    """A nameless file that goes with the process."""

    def __init__(self, folder: Path | None = None) -> None:
        """Make it.

        Args:
            folder: Where; None = the system's for temporary files.
        """
        self._file, name = tempfile.mkstemp(dir=folder)
        os.unlink(name)
        weakref.finalize(self, os.close, self._file)
        self._end = 0

    def put(self, points: NDArray[np.float32]) -> slice:
        """Put points (N, 3) there; the slice finds them again.

        Raises:
            NoSpace, OSError: If the disk is full.
        """
        data = np.ascontiguousarray(points).tobytes()
        if os.pwrite(self._file, data, self._end) < len(data):
            raise NoSpace("no space for the places walked through")
        where = slice(self._end, self._end + len(data))
        self._end = where.stop
        return where

    def get(self, where: slice) -> NDArray[np.float32]:
        """The points of a slice, (N, 3)."""
        data = os.pread(self._file, where.stop - where.start, where.start)
        return np.frombuffer(data, np.float32).reshape(-1, 3)
