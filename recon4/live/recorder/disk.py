"""Predicts when the disk is full, from the change of its free space."""

from __future__ import annotations

import shutil
from collections import deque
from collections.abc import Callable
from pathlib import Path

from recon4.live.protocol import DiskState
from recon4.live.recorder.tuning import DISK


class DiskWatch:
    """Follows the free space of a disk.

    All programs that fill the disk count: the multiframes of the mapper take several times the
    space of the recording.
    """

    def __init__(
        self,
        folder: Path,
        *,
        least_free_bytes: int,
        free_bytes: Callable[[Path], int] = lambda folder: shutil.disk_usage(folder).free,
    ) -> None:
        """Prepare.

        Args:
            folder: A folder on the disk.
            least_free_bytes: The disk counts as full below this.
            free_bytes: Returns the free space of a folder.
        """
        self._folder, self._least, self._free_bytes = folder, least_free_bytes, free_bytes
        self._seen: deque[tuple[float, int]] = deque()
        self.state = DiskState()
        """As of the last update."""

    def update(self, now_s: float) -> None:
        """Read the free space.

        Args:
            now_s: A monotonic time [s].
        """
        try:
            free = self._free_bytes(self._folder)
        except OSError:  # unplugged: the writer reports it
            self.state = DiskState()
            return
        self._seen.append((now_s, free))
        while now_s - self._seen[0][0] > DISK.trend_s:
            self._seen.popleft()
        since_s, before = self._seen[0]
        left_s = None
        if now_s - since_s >= DISK.sure_after_s:
            per_s = (before - free) / (now_s - since_s)
            left_s = (free - self._least) / per_s if per_s > DISK.min_per_s else None
        self.state = DiskState(
            free_bytes=free,
            left_s=None if left_s is None else round(left_s),
            enough=free > self._least,
        )
