"""How long and how much the server listens to a connection before it hangs up.

uvicorn waits for the end of a request's head forever, and takes a head of any length. A sender
that dribbles would hold its connection for nothing, two hundred of them all there are.
"""

from __future__ import annotations

import asyncio
from typing import Any

from uvicorn.protocols.http.httptools_impl import HttpToolsProtocol

HEAD_WITHIN_S = 10.0
"""The head of a request is here by then, from the first byte [s]."""
LONGEST_HEAD_BYTES = 1 << 16
BODY_LOOKED_AT_EVERY_S = 30.0
LEAST_BODY_BYTES = 3_000_000
"""So much of a body comes in that time unless we ourselves hold it up: 100 kB/s."""


class PatientProtocol(HttpToolsProtocol):
    """HTTP as uvicorn speaks it, with deadlines."""

    def __init__(self, *args: Any, **options: Any) -> None:
        super().__init__(*args, **options)
        self._timer: asyncio.TimerHandle | None = None
        self._in_head = True
        self._head_bytes = self._body_bytes = 0
        self._held_up = False

    def connection_made(self, transport: asyncio.BaseTransport) -> None:
        """Wait for the head from now on."""
        super().connection_made(transport)  # type: ignore[arg-type]
        self._arm(HEAD_WITHIN_S)

    def connection_lost(self, exc: Exception | None) -> None:
        """Nothing to wait for any more."""
        self._disarm()
        super().connection_lost(exc)

    def shutdown(self) -> None:
        """The server ends. With TLS a second goodbye would leave nothing to hang up on."""
        if not self.transport.is_closing():
            super().shutdown()

    def data_received(self, data: bytes) -> None:
        """Take in bytes; a head too long ends the connection."""
        if self._in_head:
            self._head_bytes += len(data)
            if self._timer is None:
                self._arm(HEAD_WITHIN_S)
        super().data_received(data)
        if self._in_head and self._head_bytes > LONGEST_HEAD_BYTES:
            self._hang_up(b"431 Request Header Fields Too Large")

    def on_headers_complete(self) -> None:
        """The head is here: wait for the body."""
        size = sum(len(name) + len(value) for name, value in self.headers) + len(self.url)
        if size > LONGEST_HEAD_BYTES:
            raise ValueError("head too long")
        self._in_head = False
        self._head_bytes = self._body_bytes = 0
        self._held_up = False
        self._arm(BODY_LOOKED_AT_EVERY_S)
        super().on_headers_complete()
        if self.parser.should_upgrade():  # the WebSocket has its own pings
            self._disarm()

    def on_body(self, body: bytes) -> None:
        """Count."""
        self._body_bytes += len(body)
        super().on_body(body)
        self._held_up |= self.flow.read_paused

    def on_message_complete(self) -> None:
        """Wait for nothing until the next request begins."""
        self._disarm()
        self._in_head, self._head_bytes = True, 0
        super().on_message_complete()

    def _arm(self, after_s: float) -> None:
        self._disarm()
        self._timer = self.loop.call_later(after_s, self._look)

    def _disarm(self) -> None:
        if self._timer is not None:
            self._timer.cancel()
            self._timer = None

    def _look(self) -> None:
        self._timer = None
        fast_enough = self._held_up or self._body_bytes >= LEAST_BODY_BYTES
        if self._in_head or not fast_enough:
            self._hang_up(b"408 Request Timeout")
            return
        self._body_bytes, self._held_up = 0, self.flow.read_paused
        self._arm(BODY_LOOKED_AT_EVERY_S)

    def _hang_up(self, status: bytes) -> None:
        self._disarm()
        if self.transport.is_closing():
            return
        if self.cycle is None or self.cycle.response_complete:
            self.transport.write(b"HTTP/1.1 " + status + b"\r\nconnection: close\r\n\r\n")
        self.transport.close()
