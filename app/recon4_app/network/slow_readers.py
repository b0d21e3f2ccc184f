"""Clients that do not read sent data: a download, a viewer, the last bytes of a response.

The transport's buffer alone does not show it: the kernel holds some megabytes more, so that a slow
but living client takes nothing from the buffer for a minute. What the client acknowledged does.
"""

from __future__ import annotations

import asyncio
import socket
import struct
from dataclasses import dataclass

from recon4_app.network.tuning import SLOW_READERS

TCP_INFO_BYTES = 128
BYTES_ACKED = struct.Struct("=120xQ")
"""``tcpi_bytes_acked`` in the ``struct tcp_info`` of Linux, since 4.1."""


@dataclass(slots=True, eq=False)
class ReaderWatch:
    """Reading rate of one client."""

    sock: socket.socket
    transport: asyncio.Transport
    _since_s: float | None = None
    """When data began to wait in the present window; None = nothing waits."""
    _acked: int = 0
    """Bytes that the client had acknowledged then."""

    @property
    def closed(self) -> bool:
        """Whether there is nothing left to watch."""
        return self.sock.fileno() < 0

    def stalled(self, now_s: float) -> bool:
        """Whether the client read too little for too long.

        Args:
            now_s: Of a monotonic clock.
        """
        if self.transport.get_write_buffer_size() == 0:
            self._since_s = None
            return False
        if self._since_s is None:
            self._since_s, self._acked = now_s, bytes_acked(self.sock)
            return False
        if now_s - self._since_s < SLOW_READERS.read_window_s:
            return False
        acked = bytes_acked(self.sock)
        enough = acked - self._acked >= SLOW_READERS.min_read_bytes
        self._since_s, self._acked = now_s, acked
        return not enough


def bytes_acked(sock: socket.socket) -> int:
    """Bytes that the client has acknowledged since the connection began."""
    info = sock.getsockopt(socket.IPPROTO_TCP, socket.TCP_INFO, TCP_INFO_BYTES)
    acked: int = BYTES_ACKED.unpack_from(info)[0]
    return acked
