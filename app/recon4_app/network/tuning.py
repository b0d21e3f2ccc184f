"""Times and limits of connections."""

from __future__ import annotations

from msgspec import Struct


class AcceptTuning(Struct, frozen=True, kw_only=True):
    """Connections that begin."""

    handshake_timeout_s: float = 10.0
    """Longest TLS handshake, from accepting the connection [s]."""
    shutdown_timeout_s: float = 5.0
    """Longest wait for a TLS client to confirm the end of the connection [s]."""
    backlog: int = 2048
    """Connections the kernel keeps until they are accepted."""
    accepts_a_round: int = 64
    """Connections accepted in one round of the event loop."""
    accept_pause_s: float = 0.25
    """Pause of accepting after file descriptors or memory ran out [s]."""
    spared_s: float = 1.0
    """A connection this young is not closed when file descriptors run out [s]."""
    sweep_s: float = 5.0
    """Interval of the search for clients that do not read [s]."""


ACCEPT = AcceptTuning()


class ConnectionBudget(Struct, frozen=True, kw_only=True):
    """How many connections there may be."""

    reserved_files: int = 128
    """File descriptors kept for databases, children and files that are being sent."""
    files_per_connection: int = 2
    """The socket, and a file or a viewer's socket behind it."""
    fewest_connections: int = 16
    """There may always be this many."""


CONNECTIONS = ConnectionBudget()


class HttpTimeouts(Struct, frozen=True, kw_only=True):
    """Slow requests."""

    head_timeout_s: float = 10.0
    """Longest time for the head of a request, from its first byte [s]."""
    max_head_bytes: int = 1 << 16
    """Largest head of a request."""
    body_window_s: float = 30.0
    """In every stretch of this time [s] …"""
    min_body_bytes: int = 3_000_000
    """This much of a body arrives in `body_window_s` unless we ourselves stop reading: 100 kB/s."""
    keep_alive_s: int = 5
    """An idle connection is closed after this long [s]."""


HTTP_TIMEOUTS = HttpTimeouts()


class PingTimes(Struct, frozen=True, kw_only=True):
    """Signs of life of WebSockets."""

    ping_interval_s: float = 20.0
    """Time between two [s]."""
    ping_timeout_s: float = 20.0
    """Interval of WebSocket pings, and time after which one without a pong is closed [s]."""


PINGS = PingTimes()


class SlowReaderLimits(Struct, frozen=True, kw_only=True):
    """Clients that hardly read."""

    read_window_s: float = 30.0
    """In every stretch of this time [s] …"""
    min_read_bytes: int = 60_000
    """Least bytes that a client with waiting data reads in `read_window_s`: 2 kB/s."""


SLOW_READERS = SlowReaderLimits()


class StreamRefusal(Struct, frozen=True, kw_only=True):
    """Streams of a client."""

    retry_after_s: float = 10.0
    """Who is refused may come again after this time [s]."""
    longest_reason_bytes: int = 123
    """Longest reason of a closed WebSocket (RFC 6455, 5.5.1)."""


STREAMS = StreamRefusal()
