"""A TCP proxy before a server: the link a test can cut, and count what came over it."""

from __future__ import annotations

import asyncio
import contextlib
import threading
from collections.abc import Iterator
from contextlib import contextmanager

from tests.deadlines import HANG_S


class Cuttable:
    """Forwards every connection to a port of this computer, until it is cut."""

    def __init__(self, port: int) -> None:
        self._to = port
        self._cut = False
        self._writers: set[asyncio.StreamWriter] = set()
        self._loop = asyncio.new_event_loop()
        self._stop, self._flows = asyncio.Event(), asyncio.Event()
        self._flows.set()
        self.received = 0
        """Bytes that came from the server."""
        self.port = 0

    @property
    def url(self) -> str:
        return f"http://127.0.0.1:{self.port}"

    def cut(self) -> None:
        """Break what is open and let nothing through."""
        self._call(self._break)

    def restore(self) -> None:
        """Let connections through again."""
        self._cut = False

    def hold(self) -> None:
        """Pass nothing on, as when a cable is pulled out; connections stay open."""
        self._call(self._flows.clear)

    def release(self) -> None:
        """Pass on what was held, and what comes."""
        self._call(self._flows.set)

    def _break(self) -> None:
        self._cut = True
        for writer in self._writers:
            writer.transport.abort()

    def _call(self, act) -> None:
        done = threading.Event()
        self._loop.call_soon_threadsafe(lambda: (act(), done.set()))
        assert done.wait(10.0)

    async def _run(self, ready: threading.Event) -> None:
        server = await asyncio.start_server(self._connected, "127.0.0.1", 0)
        self.port = server.sockets[0].getsockname()[1]
        ready.set()
        async with server:
            await self._stop.wait()
            self._break()

    async def _connected(self, reader, writer) -> None:
        if self._cut:
            writer.transport.abort()
            return
        self._writers.add(writer)
        there_reader, there_writer = await asyncio.open_connection("127.0.0.1", self._to)
        if self._cut:  # meanwhile
            there_writer.transport.abort()
            return
        self._writers.add(there_writer)
        with contextlib.suppress(ConnectionError):
            await asyncio.gather(
                self._pump(reader, there_writer, counted=False),
                self._pump(there_reader, writer, counted=True),
            )
        self._writers -= {writer, there_writer}

    async def _pump(self, reader, writer, *, counted: bool) -> None:
        while data := await reader.read(1 << 16):
            self.received += len(data) if counted else 0
            await self._flows.wait()
            writer.write(data)
            await writer.drain()
        writer.close()


@contextmanager
def cuttable(port: int) -> Iterator[Cuttable]:
    """A link to a port."""
    link, ready = Cuttable(port), threading.Event()
    thread = threading.Thread(target=link._loop.run_until_complete, args=(link._run(ready),))
    thread.start()
    try:
        assert ready.wait(10.0)
        yield link
    finally:
        link._loop.call_soon_threadsafe(link._stop.set)
        thread.join(HANG_S)
        link._loop.close()
