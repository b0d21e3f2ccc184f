"""Freed memory returned to the system instead of being kept for later."""

from __future__ import annotations

import ctypes
from enum import IntEnum

from recon4.sandbox.tuning import CONFINEMENT


class _Mallopt(IntEnum):
    """Parameters of glibc's ``mallopt``."""

    MMAP_THRESHOLD = -3
    TRIM_THRESHOLD = -1


def return_freed_memory() -> None:
    """Return what is free now, and from now on blocks of 4 MiB or more as they are freed.

    By default glibc keeps blocks of up to 32 MiB once one as large was freed, in an arena of each
    thread: a third of the memory of a map. Smaller blocks at the end of the heap are kept, up to
    `ConfinementTuning.kept_bytes`. Without effect with another C library.
    """
    libc = ctypes.CDLL(None)
    if hasattr(libc, "mallopt") and hasattr(libc, "malloc_trim"):
        libc.mallopt(_Mallopt.MMAP_THRESHOLD, CONFINEMENT.returned_block_bytes)
        libc.mallopt(_Mallopt.TRIM_THRESHOLD, CONFINEMENT.kept_bytes)
        libc.malloc_trim(0)
