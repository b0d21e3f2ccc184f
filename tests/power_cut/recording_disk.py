"""A disk (FUSE) that passes everything on to a folder and records each operation in order.

``python -m tests.power_cut.recording_disk MOUNT BACKING LOG``. Making a folder ``.mark-TEXT`` makes
none but writes a mark into the record: what a program reported is durable by then.
"""

from __future__ import annotations

import errno
import os
import sys
from pathlib import Path
from typing import Any

import mfusepy
import msgspec.msgpack

STAT = ("st_mode", "st_size", "st_uid", "st_gid", "st_nlink", "st_ino", "st_blocks")
MARK = ".mark-"


class RecordingDisk(mfusepy.Operations):
    """Passes on; one thread, so the record has one order."""

    use_ns = True

    def __init__(self, backing: Path, log: Path) -> None:
        self._backing = str(backing)
        self._log = log.open("wb", buffering=0)

    def _at(self, path: str) -> str:
        return self._backing + path

    def _note(self, *operation: Any) -> None:
        data = msgspec.msgpack.encode(operation)
        self._log.write(len(data).to_bytes(4, "little") + data)

    # -- reading

    def getattr(self, path: str, fh: int | None = None) -> dict[str, Any]:
        found = os.lstat(self._at(path))
        times = {
            name: getattr(found, f"{name}_ns") for name in ("st_atime", "st_mtime", "st_ctime")
        }
        return {name: getattr(found, name) for name in STAT} | times

    def readdir(self, path: str, fh: int) -> list[str]:
        return [".", "..", *os.listdir(self._at(path))]

    def readlink(self, path: str) -> str:
        return os.readlink(self._at(path))

    def statfs(self, path: str) -> dict[str, int]:
        found = os.statvfs(self._at(path))
        names = ("f_bavail", "f_bfree", "f_blocks", "f_bsize", "f_ffree", "f_files", "f_frsize")
        return {name: getattr(found, name) for name in (*names, "f_namemax")}

    def read(self, path: str, size: int, offset: int, fh: int) -> bytes:
        return os.pread(fh, size, offset)

    # -- writing

    def open(self, path: str, flags: int) -> int:
        keep = flags & (os.O_RDONLY | os.O_WRONLY | os.O_RDWR)
        fh = os.open(self._at(path), os.O_RDWR if keep == os.O_WRONLY else keep)
        self._note("open", fh, path)
        if flags & os.O_TRUNC:
            os.truncate(self._at(path), 0)
            self._note("truncate", path, 0)
        return fh

    def create(self, path: str, mode: int, fi: Any = None) -> int:
        fh = os.open(self._at(path), os.O_RDWR | os.O_CREAT | os.O_TRUNC, mode)
        self._note("create", fh, path)
        return fh

    def write(self, path: str, data: bytes, offset: int, fh: int) -> int:
        written = os.pwrite(fh, data, offset)
        self._note("write", fh, offset, data[:written])
        return written

    def truncate(self, path: str, length: int, fh: int | None = None) -> int:
        os.truncate(self._at(path), length)
        self._note("truncate", path, length)
        return 0

    def release(self, path: str, fh: int) -> int:
        os.close(fh)
        return 0

    def flush(self, path: str, fh: int) -> int:
        return 0

    def fsync(self, path: str, datasync: int, fh: int) -> int:
        self._note("fsync", fh)
        return 0

    def fsyncdir(self, path: str, datasync: int, fh: int) -> int:
        self._note("fsyncdir", path)
        return 0

    def mkdir(self, path: str, mode: int) -> int:
        name = path.rpartition("/")[2]
        if name.startswith(MARK):
            self._note("mark", name.removeprefix(MARK))
            raise mfusepy.FuseOSError(errno.EEXIST)
        os.mkdir(self._at(path), mode)
        self._note("mkdir", path)
        return 0

    def rmdir(self, path: str) -> int:
        os.rmdir(self._at(path))
        self._note("remove", path)
        return 0

    def unlink(self, path: str) -> int:
        os.unlink(self._at(path))
        self._note("remove", path)
        return 0

    def rename(self, old: str, new: str, flags: int = 0) -> int:
        os.rename(self._at(old), self._at(new))
        self._note("rename", old, new)
        return 0

    def link(self, target: str, source: str) -> int:
        os.link(self._at(source), self._at(target))
        self._note("link", source, target)
        return 0

    def symlink(self, target: str, source: str) -> int:
        raise mfusepy.FuseOSError(errno.EPERM)

    def chmod(self, path: str, mode: int) -> int:
        os.chmod(self._at(path), mode)
        return 0

    def chown(self, path: str, uid: int, gid: int) -> int:
        return 0

    def utimens(self, path: str, times: Any = None) -> int:
        os.utime(self._at(path), ns=None if times is None else tuple(int(t) for t in times))
        return 0


def main() -> None:
    mount, backing, log = map(Path, sys.argv[1:4])
    mfusepy.FUSE(
        RecordingDisk(backing, log), str(mount), foreground=True, nothreads=True, hard_remove=False
    )


if __name__ == "__main__":
    main()
