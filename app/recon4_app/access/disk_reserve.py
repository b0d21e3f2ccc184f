"""Disk space that is kept for the audit log and for signing in.

What is done is in the audit log, and its entry is written after the deed. On a full disk it could
not be. So some megabytes are kept in a file of their own, and given up bit by bit where the disk is
full: a person can still sign in and delete what takes space, and the log has it. When they are used
up, too, whatever would change something is refused before it is done.
"""

from __future__ import annotations

import os
from contextlib import suppress
from pathlib import Path

from recon4.locales.coded import CodedText
from recon4_app.access.tuning import RESERVE
from recon4_app.errors import NoRoom

RESERVE_FILE = "audit.room"


class Reserve:
    """The reserved space of one server."""

    def __init__(self, state: Path) -> None:
        """Look after a reserve; no file is made yet.

        Args:
            state: The folder of the server's own files.
        """
        self._state, self._file = state, state / RESERVE_FILE

    def require(self) -> None:
        """Have enough for the entry of an action that is about to be done.

        Raises:
            NoRoom: If the reserve is used up and the disk still full.
        """
        if self._size() < RESERVE.needed_bytes:
            self._fill()
        if self._size() < RESERVE.needed_bytes:
            raise self._full()

    def give_way(self) -> None:
        """Give up as much as a transaction needs, if the disk is full.

        Raises:
            NoRoom: If that is not enough.
        """
        missing = RESERVE.needed_bytes - self._free()
        if missing <= 0:
            return
        with suppress(FileNotFoundError):
            os.truncate(self._file, max(0, self._size() - missing))
        if self._free() < RESERVE.needed_bytes:
            raise self._full()

    def _fill(self) -> None:
        file = os.open(self._file, os.O_WRONLY | os.O_CREAT | os.O_CLOEXEC, 0o600)
        try:
            before = os.fstat(file).st_size
            with suppress(OSError):
                os.lseek(file, before, os.SEEK_SET)
                os.write(file, bytes(RESERVE.reserve_bytes - before))
            if (
                os.fstat(file).st_size < RESERVE.reserve_bytes
            ):  # no room for all: others need it more
                os.ftruncate(file, before)
        finally:
            os.close(file)

    def _size(self) -> int:
        with suppress(OSError):
            return self._file.stat().st_size
        return 0

    def _free(self) -> int:
        disk = os.statvfs(self._state)
        blocks = disk.f_bfree if os.geteuid() == 0 else disk.f_bavail
        return blocks * disk.f_frsize

    def _full(self) -> NoRoom:
        return NoRoom(CodedText("disk-full-entirely", folder=str(self._state.parent)))
