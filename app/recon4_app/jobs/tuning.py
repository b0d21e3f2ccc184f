"""Times and limits of jobs and their workers."""

from __future__ import annotations

from msgspec import Struct


class CompilingTimes(Struct, frozen=True, kw_only=True):
    """Compilation of the kernels."""

    within_s: float = 1800.0
    """It is given up after this time [s]."""
    beat_every_s: float = 1.0
    """It gives a sign of life this often [s]."""
    niceness: int = 10
    """It gives way to all other work."""


COMPILING_TIMES = CompilingTimes()


class EventLimits(Struct, frozen=True, kw_only=True):
    """Events of a job."""

    every_s: float = 0.25
    """Shortest interval of writing progress and of checking for a request to stop [s]."""
    max_bytes: int = 4 << 20
    """Read at a time."""


EVENT_LIMITS = EventLimits()


class JobFileLimits(Struct, frozen=True, kw_only=True):
    """Files of a job."""

    kept_bytes: int = 64 << 10
    """Bytes at the end of its log that are kept."""
    max_log_bytes: int = 256 << 10
    """Longest log."""
    max_reply_bytes: int = 64 << 10
    """Largest answer of a worker."""


JOB_FILES = JobFileLimits()


class WorkerLimits(Struct, frozen=True, kw_only=True):
    """What a worker may use."""

    memory_fraction: float = 0.7
    """Part of the memory of the machine."""
    max_files: int = 4096
    """Open files."""
    max_cpu_s: int = 96 * 3600
    """Of all threads together; a day of recording takes less."""
    min_file_bytes: int = 1 << 30
    """Smallest limit of the size of a file."""
    niceness: int = 10
    """Workers run at low priority, so that the pages stay responsive."""


WORKER_LIMITS = WorkerLimits()


class JobStreamTimes(Struct, frozen=True, kw_only=True):
    """Events as a stream."""

    longest_quiet_s: float = 15.0
    """Longest interval between two messages of an event stream [s]."""


JOB_STREAM = JobStreamTimes()


class EstimateTuning(Struct, frozen=True, kw_only=True):
    """The remaining time of a run."""

    known_after_s: float = 2.0
    known_after: float = 0.02
    """The remaining time is given after this time [s] and this fraction of the run."""


ESTIMATES = EstimateTuning()


class SilenceTuning(Struct, frozen=True, kw_only=True):
    """Workers that give no sign of life."""

    computing_factor: float = 10.0
    """One that computes may be silent this many times as long."""


SILENCE = SilenceTuning()


class SpaceTuning(Struct, frozen=True, kw_only=True):
    """Space that a job needs."""

    times_the_input: int = 12
    """Multiframes, the map and what is made on the way to it take at most this multiple of the
    recording's bytes: 10 at the end of an office of 25 s (docs/studies/storage.md)."""


SPACE = SpaceTuning()


class SupervisorTimes(Struct, frozen=True, kw_only=True):
    """The supervisor of workers."""

    look_every_s: float = 0.25
    """It looks at them this often [s]."""


SUPERVISOR_TIMES = SupervisorTimes()


class OrderingTuning(Struct, frozen=True, kw_only=True):
    """Jobs whose parts workers make."""

    every_s: float = 0.5
    """Who works is written at most this often [s]."""
    tested_within_s: float = 120.0
    """Longest time of a test of the workers [s]."""


ORDERING = OrderingTuning()
