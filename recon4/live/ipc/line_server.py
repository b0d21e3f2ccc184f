"""JSON lines over a Unix socket: how the processes of a capture talk.

Everybody connected hears everything said, in order. A listener that does not listen is let go:
it connects again and is told what is so by then. Only this user (and root) is answered: the socket
lies in a folder closed to others, has mode 0600, and the kernel is asked who connected.
"""

from __future__ import annotations

import asyncio
import json
import logging
import os
import socket
import struct
from collections.abc import Callable, Iterable
from contextlib import suppress
from pathlib import Path
from typing import Any

MOST_UNHEARD_BYTES = 16 << 20
"""A whole preview and the way of an hour are 5 MB."""
_LONGEST_LINE = 1 << 16

log = logging.getLogger(__name__)


class LineServer:
    """Listens on a path; `send` reaches all who are connected."""

    def __init__(
        self,
        *,
        initial_messages: Callable[[], Iterable[dict[str, Any]]],
        hear: Callable[[dict[str, Any]], None],
    ) -> None:
        """Make it.

        Args:
            initial_messages: What a new listener is told first.
            hear: Called with every whole line that is a JSON object; others are ignored.
        """
        self._greet, self._receive_line = initial_messages, hear
        self._writers: set[asyncio.StreamWriter] = set()
        self._listeners: set[asyncio.Task[None]] = set()
        self._server: asyncio.Server | None = None
        self._path = Path()

    async def listen(self, path: Path) -> None:
        """Start."""
        with suppress(FileNotFoundError):
            path.unlink()  # of a process that was killed
        self._path = path
        before = os.umask(0o177)  # only this user may connect, from the first moment
        try:
            self._server = await asyncio.start_unix_server(self._serve, path, limit=_LONGEST_LINE)
        finally:
            os.umask(before)

    def send(self, message: dict[str, Any]) -> None:
        """Tell everybody."""
        line = json.dumps(message, separators=(",", ":")).encode() + b"\n"
        for writer in list(self._writers):
            if writer.transport.get_write_buffer_size() > MOST_UNHEARD_BYTES:
                writer.transport.abort()
            else:
                writer.write(line)

    async def close(self) -> None:
        """Stop; what was said is still delivered."""
        for writer in list(self._writers):
            with suppress(ConnectionError, TimeoutError):
                await asyncio.wait_for(writer.drain(), 2.0)
            writer.close()
        if self._server is not None:
            self._server.close()
            await asyncio.gather(*self._listeners, return_exceptions=True)
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
        self._listeners.add(task)
        task.add_done_callback(self._listeners.discard)
        for said in self._greet():
            writer.write(json.dumps(said, separators=(",", ":")).encode() + b"\n")
        self._writers.add(writer)
        try:
            while line := await reader.readline():
                message = _object(line)
                if message is not None:
                    self._receive_line(message)
        except (ConnectionError, ValueError):
            pass  # gone, or no line of ours
        finally:
            self._writers.discard(writer)
            writer.close()


def peer_uid(connection: socket.socket) -> int | None:
    """User at the other end of a Unix socket; None where the kernel does not tell (not Linux)."""
    if not hasattr(socket, "SO_PEERCRED"):
        return None
    credentials = connection.getsockopt(
        socket.SOL_SOCKET, socket.SO_PEERCRED, struct.calcsize("3i")
    )
    user: int = struct.unpack("3i", credentials)[1]
    return user


def _object(line: bytes) -> dict[str, Any] | None:
    try:
        message = json.loads(line)
    except ValueError:
        return None
    return message if isinstance(message, dict) else None
