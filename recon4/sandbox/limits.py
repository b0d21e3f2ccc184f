"""Limits the kernel puts on memory, time, files and threads of a process."""

from __future__ import annotations

import os
import resource
from contextlib import suppress
from pathlib import Path

from recon4.sandbox.policy import Policy


def apply_rlimits(policy: Policy) -> None:
    """Set the limits of a policy on this process and all it starts; never raises one.

    Raises:
        OSError: If the kernel refused.
    """
    _limit(resource.RLIMIT_CORE, 0)
    _limit(resource.RLIMIT_NOFILE, policy.open_files)
    if policy.memory_bytes is not None:
        _limit(resource.RLIMIT_DATA, policy.memory_bytes)
    if policy.address_space_bytes is not None:
        _limit(resource.RLIMIT_AS, policy.address_space_bytes)
    if policy.cpu_s is not None:
        _limit(resource.RLIMIT_CPU, policy.cpu_s)
    if policy.file_bytes is not None:
        _limit(resource.RLIMIT_FSIZE, policy.file_bytes)
    if not policy.processes:
        _limit(resource.RLIMIT_NPROC, _threads_of_this_user() + policy.threads)


def physical_memory_bytes() -> int:
    """Memory of this computer [bytes]."""
    return os.sysconf("SC_PAGE_SIZE") * os.sysconf("SC_PHYS_PAGES")


def _limit(what: int, most: int) -> None:
    _, hard = resource.getrlimit(what)
    if hard != resource.RLIM_INFINITY:
        most = min(most, hard)
    resource.setrlimit(what, (most, most))


def _threads_of_this_user() -> int:
    """Threads of all processes of this user: the kernel counts them together."""
    user, count = os.getuid(), 0
    for process in Path("/proc").glob("[0-9]*"):
        with suppress(OSError):
            if process.stat().st_uid == user:
                count += len(os.listdir(process / "task"))
    return count
