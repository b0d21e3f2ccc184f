"""Broadcasts JSON lines over a Unix socket: messages between the processes of a capture.

Every client receives every message, in order. A client that does not read is disconnected; it
connects again and receives the initial messages. Only clients of this user (and root) are
accepted: the socket is in a private folder, has mode 0600, and the kernel reports the peer's user.
"""

from __future__ import annotations

import asyncio
import logging
import os
import socket
import struct
from collections.abc import Callable, Iterable
from contextlib import suppress
from pathlib import Path

from recon4.live.protocol import Message, ProtocolError, Request, decode_request, encode
from recon4.live.tuning import LINE_SERVER

log = logging.getLogger(__name__)


class LineServer:
    """Listens on a path; `send` broadcasts to all clients."""

    def __init__(
        self,
        *,
        initial_messages: Callable[[], Iterable[Message]],
        on_request: Callable[[Request], None],
    ) -> None:
        """Prepare.

        Args:
            initial_messages: The messages a new client receives first.
            on_request: Called with every request of a client; other lines are logged and ignored.
        """
        self._initial_messages, self._on_request = initial_messages, on_request
        self._writers: set[asyncio.StreamWriter] = set()
        self._tasks: set[asyncio.Task[None]] = set()
        self._server: asyncio.Server | None = None
        self._path = Path()

    async def listen(self, path: Path) -> None:
        """Start to accept clients."""
        with suppress(FileNotFoundError):
            path.unlink()  # left by a process that was killed
        self._path = path
        before = os.umask(0o177)  # only this user may connect
        try:
            self._server = await asyncio.start_unix_server(
                self._serve, path, limit=LINE_SERVER.longest_line
            )
        finally:
            os.umask(before)

    def send(self, message: Message) -> None:
        """Send a message to all clients."""
        line = encode(message)
        for writer in list(self._writers):
            if writer.transport.get_write_buffer_size() > LINE_SERVER.max_unread_bytes:
                writer.transport.abort()
            else:
                writer.write(line)

    async def close(self) -> None:
        """Stop; messages already sent are still delivered."""
        for writer in list(self._writers):
            with suppress(ConnectionError, TimeoutError):
                async with asyncio.timeout(2.0):
                    await writer.drain()
            writer.close()
        if self._server is not None:
            self._server.close()
            await asyncio.gather(*self._tasks, return_exceptions=True)
        with suppress(FileNotFoundError):
            self._path.unlink()

    async def _serve(self, reader: asyncio.StreamReader, writer: asyncio.StreamWriter) -> None:
        user = peer_uid(writer.get_extra_info("socket"))
        if user not in (None, 0, os.getuid()):
            log.warning("%s: refused a connection of user %s", self._path, user)
            writer.transport.abort()
            return
        task = asyncio.current_task()
        assert task is not None
        self._tasks.add(task)
        task.add_done_callback(self._tasks.discard)
        for message in self._initial_messages():
            writer.write(encode(message))
        self._writers.add(writer)
        try:
            while line := await reader.readline():
                try:
                    request = decode_request(line)
                except ProtocolError as error:  # also a request of a newer server
                    log.warning("%s: %s", self._path, error)
                else:
                    self._on_request(request)
        except (ConnectionError, ValueError):
            pass  # disconnected, or a line that is too long
        finally:
            self._writers.discard(writer)
            writer.close()


def peer_uid(connection: socket.socket) -> int | None:
    """User at the other end of a Unix socket; None if the system does not report it."""
    if not hasattr(socket, "SO_PEERCRED"):
        return None
    credentials = connection.getsockopt(
        socket.SOL_SOCKET, socket.SO_PEERCRED, struct.calcsize("3i")
    )
    user: int = struct.unpack("3i", credentials)[1]
    return user
