"""The table of open connections: limits, which one is closed for a new one, and counters.

Anyone who can reach the port can open connections and send nothing. Rejecting at the limit would
lock all others out, so a new connection replaces the oldest one that has not completed a request
head, then the oldest one that is idle between requests. A connection with a request in progress is
never closed for another.
"""

from __future__ import annotations

import math
import resource
from collections import Counter
from collections.abc import Callable, Iterator
from contextlib import suppress
from dataclasses import dataclass, field
from enum import StrEnum

from recon4_app.access.login.login_backoff import network
from recon4_app.network.tuning import CONNECTIONS


class Phase(StrEnum):
    """Phase of a connection."""

    WAITING = "waiting"
    """Has not completed the head of its first request: silent, in the TLS handshake, or slow."""
    ACTIVE = "active"
    """A request or a WebSocket is in progress."""
    IDLE = "idle"
    """Between two requests."""


@dataclass(slots=True)
class ConnectionCounts:
    """What happened to connections since the server started."""

    accepted: int = 0
    rejected: Counter[str] = field(default_factory=Counter)
    """Closed without a request, by reason: a limit, no TLS, a failed handshake, malformed HTTP."""
    evicted: Counter[str] = field(default_factory=Counter)
    """Closed to make room for a new connection, by the phase they were in."""
    accept_errors: Counter[str] = field(default_factory=Counter)
    """Failures of ``accept``, by the name of the error, such as ``EMFILE``."""
    timeouts: Counter[str] = field(default_factory=Counter)
    """Deadlines missed: ``handshake``, ``head``, ``body``, ``response``."""


@dataclass(slots=True, eq=False)
class Connection:
    """One accepted connection."""

    address: str
    """Of the client; for IPv6 its network, since one household has 2^64 addresses."""
    accepted_s: float = 0.0
    """Time of accepting, on a monotonic clock [s]."""
    abort: Callable[[], None] = lambda: None
    """Closes it at once."""
    phase: Phase = Phase.WAITING


@dataclass(frozen=True, slots=True)
class ConnectionLimits:
    """Limits of open connections."""

    total: int
    per_address: int

    @classmethod
    def within(cls, total: int, *, per_address: int, files: int) -> ConnectionLimits:
        """The limits a process can keep that may open that many files.

        Args:
            total: Connections wanted in all.
            per_address: Connections wanted for one address.
            files: ``RLIMIT_NOFILE`` of the process.
        """
        possible = max(
            (files - CONNECTIONS.reserved_files) // CONNECTIONS.files_per_connection,
            CONNECTIONS.fewest_connections,
        )
        total = min(total, possible)
        return cls(total, min(per_address, max(total // 2, 1)))


class _Queue:
    """Connections of one address, or of all, by phase; each phase with the oldest first."""

    def __init__(self) -> None:
        self.by_phase: dict[Phase, dict[Connection, None]] = {phase: {} for phase in Phase}

    def __len__(self) -> int:
        return sum(map(len, self.by_phase.values()))

    def expendable(self) -> Connection | None:
        """The connection to close for a new one; None if all have a request in progress."""
        for phase in (Phase.WAITING, Phase.IDLE):
            if self.by_phase[phase]:
                return next(iter(self.by_phase[phase]))
        return None


class ConnectionTable:
    """All open connections of a server."""

    def __init__(self, limits: ConnectionLimits) -> None:
        self.limits = limits
        self.counts = ConnectionCounts()
        self._all = _Queue()
        self._by_address: dict[str, _Queue] = {}

    def __len__(self) -> int:
        return len(self._all)

    def __iter__(self) -> Iterator[Connection]:
        return iter([one for queue in self._all.by_phase.values() for one in queue])

    def open_in(self, phase: Phase) -> int:
        """Number of connections in a phase."""
        return len(self._all.by_phase[phase])

    def admit(self, connection: Connection) -> bool:
        """Add a new connection; at a limit another one is closed for it.

        Returns:
            False if it must be closed, because none of the others can be.
        """
        self.counts.accepted += 1
        own = self._by_address.get(connection.address)
        if own is not None and len(own) >= self.limits.per_address and not self._evict(own):
            self.counts.rejected["address_limit"] += 1
            return False
        if len(self) >= self.limits.total and not self._evict(self._all):
            self.counts.rejected["total_limit"] += 1
            return False
        self._by_address.setdefault(connection.address, _Queue())
        for queue in self._queues(connection):
            queue.by_phase[connection.phase][connection] = None
        return True

    def make_room(self, *, accepted_before_s: float = math.inf) -> bool:
        """Close the least active connection; False if there is none.

        Args:
            accepted_before_s: Younger connections are left alone: their request may be on its way.
        """
        return self._evict(self._all, accepted_before_s)

    def move(self, connection: Connection, phase: Phase) -> None:
        """Note that a connection enters a phase; it becomes the youngest there."""
        if phase is connection.phase or connection not in self._all.by_phase[connection.phase]:
            return
        for queue in self._queues(connection):
            del queue.by_phase[connection.phase][connection]
            queue.by_phase[phase][connection] = None
        connection.phase = phase

    def remove(self, connection: Connection) -> None:
        """Forget a connection that is closed; it may have been removed before."""
        if connection not in self._all.by_phase[connection.phase]:
            return
        for queue in self._queues(connection):
            del queue.by_phase[connection.phase][connection]
        if not self._by_address[connection.address]:
            del self._by_address[connection.address]

    def _queues(self, connection: Connection) -> tuple[_Queue, _Queue]:
        return self._all, self._by_address[connection.address]

    def _evict(self, queue: _Queue, accepted_before_s: float = math.inf) -> bool:
        victim = queue.expendable()
        if victim is None or victim.accepted_s >= accepted_before_s:
            return False
        self.counts.evicted[victim.phase] += 1
        self.remove(victim)
        victim.abort()
        return True


def client_network(address: str) -> str:
    """The network by which connections are counted."""
    return network(address.partition("%")[0])  # a link-local address names its interface


def raise_file_limit() -> None:
    """Raise the soft limit of open files to the hard limit, where the system grants it."""
    soft, hard = resource.getrlimit(resource.RLIMIT_NOFILE)
    if soft != hard:
        with suppress(OSError, ValueError):  # some systems name a hard limit they do not grant
            resource.setrlimit(resource.RLIMIT_NOFILE, (hard, hard))


def open_file_limit() -> int:
    """The limit of open files of this process."""
    return resource.getrlimit(resource.RLIMIT_NOFILE)[0]
