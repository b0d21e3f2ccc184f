"""Times and limits of child processes that compute."""

from __future__ import annotations

from msgspec import Struct


class ChildPriority(Struct, frozen=True, kw_only=True):
    """Child processes that compute."""

    background_nice: int = 10
    """Niceness of work for which nobody waits."""


CHILD_PRIORITY = ChildPriority()


class ChildLimits(Struct, frozen=True, kw_only=True):
    """What a child process may use."""

    max_file_bytes: int = 64 << 30
    """Largest file that it writes."""
    max_memory_bytes: int = 8 << 30
    """Private memory of a child; memory-mapped files do not count."""


CHILD_LIMITS = ChildLimits()


class QueueFairness(Struct, frozen=True, kw_only=True):
    """Order of the work that waits."""

    max_passed: int = 8
    """A large call that was passed by this many small ones counts as small, so that it is
    served."""


FAIRNESS = QueueFairness()


class PoolMessageLimits(Struct, frozen=True, kw_only=True):
    """Answers of child processes."""

    max_result_bytes: int = 256 << 20
    """Largest result."""
    max_message: int = 20_000
    """Longest text of an error."""


POOL_MESSAGES = PoolMessageLimits()


class PoolTimes(Struct, frozen=True, kw_only=True):
    """How long work may take."""

    interactive_limit_s: float = 120.0
    """Work for which a person waits [s] …"""
    background_limit_s: float = 1800.0
    """Limit of background calls [s]: a reference of gigabytes takes minutes."""
    grace_s: float = 2.0
    """Time an interactive call may continue after its client left [s]: ending a child with a loaded
    map costs more."""
    max_kept: int = 4
    """Most idle children that are kept with their open maps."""
    spare_after_s: float = 5.0
    """After the last start of a child the next one is prepared in advance."""


POOL_TIMES = PoolTimes()
