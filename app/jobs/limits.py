"""What a worker may not do, set by itself before it opens anybody's file."""

from __future__ import annotations

import ctypes
import faulthandler
import logging
import os
import resource

log = logging.getLogger("recon4.job")

SHARE_OF_MEMORY = 0.7
MOST_FILES = 4096
NICENESS = 10
"""Workers stand back, so that the pages answer while they work."""
PR_SET_NO_NEW_PRIVS = 38


def allowed_memory(setting_bytes: int) -> int:
    """Memory a worker may take [bytes]: 70 % of this computer's, or less if the setting says so."""
    physical = os.sysconf("SC_PAGE_SIZE") * os.sysconf("SC_PHYS_PAGES")
    most = int(SHARE_OF_MEMORY * physical)
    return min(most, setting_bytes) if setting_bytes > 0 else most


def confine(memory_bytes: int) -> None:
    """Limit this process and its children.

    Memory is limited where it is written (``RLIMIT_DATA``), not where it is addressed: a recording
    larger than the memory is mapped and harmless.

    Args:
        memory_bytes: From `allowed_memory`.
    """
    os.nice(NICENESS)
    _limit(resource.RLIMIT_DATA, memory_bytes)
    _limit(resource.RLIMIT_NOFILE, MOST_FILES)
    _limit(resource.RLIMIT_CORE, 0)
    _no_new_privileges()
    faulthandler.enable()  # a crash in native code says where in the log


def _limit(what: int, most: int) -> None:
    _, hard = resource.getrlimit(what)
    if hard != resource.RLIM_INFINITY:
        most = min(most, hard)
    resource.setrlimit(what, (most, most))


def _no_new_privileges() -> None:
    """No program started from here gains rights its file would give it (setuid)."""
    try:
        prctl = ctypes.CDLL(None, use_errno=True).prctl
    except (OSError, AttributeError):
        return  # not Linux
    if prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0) != 0:
        log.warning("no_new_privs is not available: %s", os.strerror(ctypes.get_errno()))
