"""Freed memory returned to the system instead of being kept for later."""

from __future__ import annotations

import ctypes

from recon4.sandbox.tuning import CONFINEMENT

_MMAP_THRESHOLD, _TRIM_THRESHOLD = -3, -1
"""``M_MMAP_THRESHOLD`` and ``M_TRIM_THRESHOLD`` of glibc's ``mallopt``."""


def return_freed_memory() -> None:
    """Return what is free now, and from now on blocks of 4 MiB or more as they are freed.

    By default glibc keeps blocks of up to 32 MiB once one as large was freed, in an arena of each
    thread: a third of the memory of a map. Smaller blocks at the end of the heap are kept, up to
    `ConfinementTuning.kept_bytes`. Without effect with another C library.
    """
    libc = ctypes.CDLL(None)
    if hasattr(libc, "mallopt") and hasattr(libc, "malloc_trim"):
        libc.mallopt(_MMAP_THRESHOLD, CONFINEMENT.returned_block_bytes)
        libc.mallopt(_TRIM_THRESHOLD, CONFINEMENT.kept_bytes)
        libc.malloc_trim(0)
