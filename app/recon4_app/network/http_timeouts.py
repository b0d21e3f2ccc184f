"""Deadlines of an HTTP connection: for the head of a request, its body and the time after it.

uvicorn waits forever for the end of a request's head, and accepts a head of any length. A client
that sends a byte now and then would hold its connection for nothing.
"""

from __future__ import annotations

import asyncio
from functools import partial
from typing import Any

from uvicorn.protocols.http.httptools_impl import HttpToolsProtocol

from recon4_app.network.connections import Connection, ConnectionTable, Phase
from recon4_app.network.tuning import HTTP_TIMEOUTS


class HttpTimeoutsProtocol(HttpToolsProtocol):
    """HTTP as uvicorn speaks it, with deadlines; reports the phase of its connection."""

    def __init__(
        self, *args: Any, connection: Connection, table: ConnectionTable, **options: Any
    ) -> None:
        super().__init__(*args, **options)
        self._connection, self._table = connection, table
        self._timer: asyncio.TimerHandle | None = None
        self._in_head = True
        self._head_bytes = self._body_bytes = 0
        self._reading_paused = self._head_too_long = False

    def connection_made(self, transport: asyncio.BaseTransport) -> None:
        """Start the deadline of the first head."""
        super().connection_made(transport)  # type: ignore[arg-type]
        self._start_timer(HTTP_TIMEOUTS.head_timeout_s)

    def connection_lost(self, exc: Exception | None) -> None:
        """Stop the deadlines."""
        self._stop_timer()
        super().connection_lost(exc)

    def shutdown(self) -> None:
        """Close when the server ends; with TLS a second close leaves nothing to abort."""
        if not self.transport.is_closing():
            super().shutdown()

    def data_received(self, data: bytes) -> None:
        """Parse bytes; a head that is too long ends the connection."""
        if self._in_head:
            self._head_bytes += len(data)
            if self._timer is None:
                self._start_timer(HTTP_TIMEOUTS.head_timeout_s)
        super().data_received(data)
        if self._in_head and self._head_bytes > HTTP_TIMEOUTS.max_head_bytes:
            self._reject(b"431 Request Header Fields Too Large", "head_too_long")

    def on_headers_complete(self) -> None:
        """Wait for the body."""
        size = sum(len(name) + len(value) for name, value in self.headers) + len(self.url)
        if size > HTTP_TIMEOUTS.max_head_bytes:
            self._head_too_long = True
            raise ValueError("head too long")
        self._in_head = False
        self._head_bytes = self._body_bytes = 0
        self._reading_paused = False
        self._table.move(self._connection, Phase.ACTIVE)
        self._start_timer(HTTP_TIMEOUTS.body_window_s)
        super().on_headers_complete()

    def handle_websocket_upgrade(self) -> None:
        """Leave the connection to the WebSocket, which has its own pings."""
        self._stop_timer()
        super().handle_websocket_upgrade()
        protocol = self.transport.get_protocol()
        if not getattr(protocol, "handshake_initiated", True):
            # uvicorn waits forever after a malformed opening handshake, such as one with POST.
            self._reject(b"400 Bad Request", "malformed")

    def on_body(self, body: bytes) -> None:
        """Count."""
        self._body_bytes += len(body)
        super().on_body(body)
        self._reading_paused |= self.flow.read_paused

    def on_message_complete(self) -> None:
        """Wait for nothing until the next request begins."""
        self._stop_timer()
        self._in_head, self._head_bytes = True, 0
        super().on_message_complete()
        if self.cycle is not None and self.cycle.response_complete:
            self.on_idle()

    def on_response_complete(self) -> None:
        """Become idle, or stop reading a body that is no longer needed."""
        super().on_response_complete()
        if self.transport.is_closing():
            return
        if not self._in_head:
            # Closing at once would reset the connection before the client has read the answer.
            self._stop_timer()
            self._timer = self.loop.call_later(
                HTTP_TIMEOUTS.body_window_s, partial(self._time_out, "body")
            )
        elif not self.pipeline and self.cycle.response_complete:
            self.on_idle()

    def on_idle(self) -> None:
        """Wait for the next request; uvicorn does not when a body outlives its response."""
        self._table.move(self._connection, Phase.IDLE)
        self._unset_keepalive_if_required()
        self.timeout_keep_alive_task = self.loop.call_later(
            self.timeout_keep_alive, self.timeout_keep_alive_handler
        )

    def send_400_response(self, msg: str) -> None:
        """Respond to a message that is not HTTP, or whose head is too long, and count it."""
        if self._head_too_long:
            self._reject(b"431 Request Header Fields Too Large", "head_too_long")
            return
        self._table.counts.rejected["malformed"] += 1
        super().send_400_response(msg)

    def _start_timer(self, after_s: float) -> None:
        self._stop_timer()
        self._timer = self.loop.call_later(after_s, self._check)

    def _stop_timer(self) -> None:
        if self._timer is not None:
            self._timer.cancel()
            self._timer = None

    def _check(self) -> None:
        self._timer = None
        fast_enough = self._reading_paused or self._body_bytes >= HTTP_TIMEOUTS.min_body_bytes
        if self._in_head or not fast_enough:
            self._time_out("head" if self._in_head else "body")
            return
        self._body_bytes, self._reading_paused = 0, self.flow.read_paused
        self._start_timer(HTTP_TIMEOUTS.body_window_s)

    def _time_out(self, what: str) -> None:
        self._table.counts.timeouts[what] += 1
        self._hang_up(b"408 Request Timeout")

    def _reject(self, status: bytes, reason: str) -> None:
        self._table.counts.rejected[reason] += 1
        self._hang_up(status)

    def _hang_up(self, status: bytes) -> None:
        self._stop_timer()
        if self.transport.is_closing():
            return
        if self.cycle is None or (self.cycle.response_complete and self._in_head):
            self.transport.write(b"HTTP/1.1 " + status + b"\r\nconnection: close\r\n\r\n")
        self.transport.close()
