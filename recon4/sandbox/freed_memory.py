"""Memory that a process no longer needs, returned to the system instead of being kept for later."""

from __future__ import annotations

import ctypes
import re
from collections.abc import Iterator
from contextlib import suppress
from enum import IntEnum
from pathlib import Path

from recon4.sandbox.tuning import CONFINEMENT

_MAPPINGS = Path("/proc/self/smaps")
_LIBRARY = re.compile(r"\.so[.\d]*$")


class _Mallopt(IntEnum):
    """Parameters of glibc's ``mallopt``."""

    MMAP_THRESHOLD = -3
    TRIM_THRESHOLD = -1
    ARENA_MAX = -8


class _Advice(IntEnum):
    """Advice of ``madvise``."""

    DONTNEED = 4


def return_freed_memory(above: int = CONFINEMENT.returned_block_bytes) -> None:
    """Return what is free now, and from now on large blocks as they are freed.

    By default glibc keeps blocks of up to 32 MiB once one as large was freed, in an arena of each
    thread: a third of the memory of a map. Smaller blocks at the end of the heap are kept, up to
    `ConfinementTuning.kept_bytes`. Threads that start from now on share one arena: what one leaves
    free another may use. Pages of libraries that were read are returned, too; what is needed of
    them again comes from the cache of the system. Without effect with another C library.

    Args:
        above: Blocks of this size or more are returned [bytes].
    """
    libc = ctypes.CDLL(None)
    if hasattr(libc, "mallopt") and hasattr(libc, "malloc_trim"):
        libc.mallopt(_Mallopt.MMAP_THRESHOLD, above)
        libc.mallopt(_Mallopt.TRIM_THRESHOLD, CONFINEMENT.kept_bytes)
        libc.mallopt(_Mallopt.ARENA_MAX, CONFINEMENT.arenas)
        libc.malloc_trim(0)
        for begin, size in _unwritten():
            libc.madvise(ctypes.c_void_p(begin), ctypes.c_size_t(size), _Advice.DONTNEED)


def _unwritten() -> Iterator[tuple[int, int]]:
    """First address and size of each mapping of a library whose pages are all as in its file.

    It may not be written, and none of its pages was when it could be, as those that the loader
    fills with addresses are. A library stays where it is; another file may be unmapped by a thread
    meanwhile, and its addresses belong to something else.
    """
    lines: list[str] = []
    with suppress(OSError):  # not Linux, or hidden from a confined process
        lines = _MAPPINGS.read_text(errors="replace").splitlines()
    span, mode = "", ""
    for line in lines:
        words = line.split(maxsplit=5)
        if not words[0].endswith(":"):
            of_library = len(words) > 5 and _LIBRARY.search(words[5])
            span, mode = (words[0], words[1]) if of_library else ("", "")
        elif words[0] == "Anonymous:" and span and "w" not in mode and words[1] == "0":
            begin, end = (int(address, 16) for address in span.split("-"))
            yield begin, end - begin
