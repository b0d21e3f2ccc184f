"""Measure resources used: seconds, processor seconds, peak memory."""

from __future__ import annotations

import resource
import time
from pathlib import Path

_STATUS = Path("/proc/self/status")
_CLEAR = Path("/proc/self/clear_refs")


class Meter:
    """Measures resources used since its creation.

    Peak memory is the largest resident set of this process since then, or of a child that ended,
    including the pages of memory-mapped frames. If the system cannot reset its peak (not Linux),
    it is the peak since the process started.
    """

    def __init__(self) -> None:
        _reset_peak()
        self._wall, self._cpu = time.perf_counter(), _cpu_seconds()

    @property
    def seconds(self) -> float:
        """Wall clock time so far [s]."""
        return time.perf_counter() - self._wall

    @property
    def cpu_seconds(self) -> float:
        """Processor time so far, ended children included [s]."""
        return _cpu_seconds() - self._cpu

    @property
    def peak_bytes(self) -> int:
        """Peak resident memory so far [bytes]."""
        return max(_own_peak(), resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss * 1024)


def _cpu_seconds() -> float:
    used = [resource.getrusage(who) for who in (resource.RUSAGE_SELF, resource.RUSAGE_CHILDREN)]
    return sum(u.ru_utime + u.ru_stime for u in used)


def _reset_peak() -> None:
    try:
        _CLEAR.write_text("5")
    except OSError:
        return  # the peak then counts from the start of the process, as documented


def _own_peak() -> int:
    try:
        lines = _STATUS.read_text().splitlines()
    except OSError:
        lines = []
    for line in lines:
        if line.startswith("VmHWM:"):
            return int(line.split()[1]) * 1024
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * 1024
