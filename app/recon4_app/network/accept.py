"""The accept loop: takes connections from the listening socket and starts their protocol.

asyncio's own loop has no limit on connections, keeps a TLS connection that sends nothing for 60 s
with 256 KiB of buffer, and logs a traceback for each ``accept`` that fails for want of a file
descriptor, thousands of times a second.
"""

from __future__ import annotations

import asyncio
import contextlib
import errno
import socket
import ssl
from collections.abc import Callable
from functools import partial

from recon4_app.network.connections import Connection, ConnectionTable, client_network
from recon4_app.network.slow_readers import ReaderWatch
from recon4_app.network.tuning import ACCEPT

EXHAUSTED = frozenset({errno.EMFILE, errno.ENFILE, errno.ENOBUFS, errno.ENOMEM})
TLS_HANDSHAKE_RECORD = b"\x16"
"""First byte of every TLS connection."""


class AcceptedSocket(socket.socket):
    """A connection's socket that reports when it is closed, from any code."""

    __slots__ = ("on_close",)

    on_close: Callable[[], None]

    def close(self) -> None:
        """Close, and report it."""
        super().close()
        self.on_close()


class Acceptor:
    """Accepts the connections of one listening socket; for uvicorn it is an `asyncio.Server`."""

    def __init__(
        self,
        listener: socket.socket,
        table: ConnectionTable,
        *,
        protocol: Callable[[Connection], asyncio.Protocol],
        context: ssl.SSLContext | None,
    ) -> None:
        """Prepare.

        Args:
            listener: Bound, not listening yet.
            table: Counts and limits connections.
            protocol: Makes the protocol of an admitted connection.
            context: For TLS; None = without.
        """
        self._listener, self._table = listener, table
        self._protocol, self._context = protocol, context
        self._loop = asyncio.get_running_loop()
        self._connecting: set[asyncio.Task[None]] = set()
        self._watches: set[ReaderWatch] = set()
        self._timers: dict[Callable[[], None], asyncio.TimerHandle] = {}

    def start(self) -> None:
        """Accept from now on."""
        self._listener.setblocking(False)
        self._listener.listen(ACCEPT.backlog)
        self._resume()
        self._later(ACCEPT.sweep_s, self._sweep)

    def close(self) -> None:
        """Accept no more; connections without a request end."""
        self._loop.remove_reader(self._listener)
        for timer in self._timers.values():
            timer.cancel()
        while self._table.make_room():
            pass

    async def wait_closed(self) -> None:
        """Wait for the handshakes that `close` ended."""
        await asyncio.gather(*self._connecting, return_exceptions=True)

    def _later(self, after_s: float, action: Callable[[], None]) -> None:
        self._timers[action] = self._loop.call_later(after_s, action)

    def _resume(self) -> None:
        self._loop.add_reader(self._listener, self._accept)

    def _accept(self) -> None:
        for _ in range(ACCEPT.accepts_a_round):
            try:
                accepted, address = self._listener.accept()
            except (BlockingIOError, InterruptedError):
                return
            except OSError as error:
                if self._failed(error):
                    return
                continue
            sock = AcceptedSocket(fileno=accepted.detach())
            self._admit(sock, client_network(address[0]))

    def _failed(self, error: OSError) -> bool:
        """Count a failed ``accept``; whether to leave waiting connections to the kernel.

        Without the pause the kernel would report them again at once: a busy loop.
        """
        number = error.errno or 0
        self._table.counts.accept_errors[errno.errorcode.get(number, str(number))] += 1
        if number not in EXHAUSTED:
            return False  # this client went before it was accepted
        self._table.make_room(accepted_before_s=self._loop.time() - ACCEPT.spared_s)
        self._loop.remove_reader(self._listener)
        self._later(ACCEPT.accept_pause_s, self._resume)
        return True

    def _admit(self, sock: AcceptedSocket, address: str) -> None:
        connection = Connection(address, accepted_s=self._loop.time())
        sock.on_close = partial(self._table.remove, connection)
        sock.setblocking(False)
        if not self._table.admit(connection):
            sock.close()
        elif self._context is None:
            self._connect(sock, connection)
        else:
            self._await_first_byte(sock, connection)

    def _await_first_byte(self, sock: AcceptedSocket, connection: Connection) -> None:
        """Make asyncio's buffers for TLS only when the client has sent something."""

        def end(counter: str) -> None:
            timer.cancel()
            self._loop.remove_reader(sock)
            if counter:
                self._table.counts.rejected[counter] += 1
            sock.close()

        def late() -> None:
            self._table.counts.timeouts["handshake"] += 1
            end("")

        def readable() -> None:
            try:
                first = sock.recv(1, socket.MSG_PEEK)
            except (BlockingIOError, InterruptedError):
                return
            except OSError:
                first = b""
            if first != TLS_HANDSHAKE_RECORD:
                end("not_tls" if first else "no_request")
                return
            timer.cancel()
            self._loop.remove_reader(sock)
            self._connect(sock, connection, left_s=max(timer.when() - self._loop.time(), 0.1))

        timer = self._loop.call_later(ACCEPT.handshake_timeout_s, late)
        connection.abort = partial(end, "")
        self._loop.add_reader(sock, readable)

    def _connect(
        self, sock: AcceptedSocket, connection: Connection, *, left_s: float | None = None
    ) -> None:
        connection.abort = partial(_shut_down, sock)
        task = self._loop.create_task(self._connected(sock, connection, left_s))
        self._connecting.add(task)
        task.add_done_callback(self._connecting.discard)

    async def _connected(
        self, sock: AcceptedSocket, connection: Connection, left_s: float | None
    ) -> None:
        """Hand the socket to asyncio, which closes it in every case."""
        secure = self._context is not None
        counts = self._table.counts
        try:
            transport, _ = await self._loop.connect_accepted_socket(
                lambda: self._protocol(connection),
                sock,
                ssl=self._context,
                ssl_handshake_timeout=left_s if secure else None,
                ssl_shutdown_timeout=ACCEPT.shutdown_timeout_s if secure else None,
            )
        except ConnectionAbortedError:  # what asyncio raises for a late handshake
            counts.timeouts["handshake"] += 1
        except OSError:  # ssl.SSLError is one
            counts.rejected["handshake"] += 1
        else:
            if sock.fileno() < 0:  # asyncio reports no error when the client went in between
                counts.rejected["handshake"] += self._context is not None
                return
            connection.abort = transport.abort
            self._watches.add(ReaderWatch(sock, transport))

    def _sweep(self) -> None:
        """Abort the connections of clients that do not read."""
        now_s = self._loop.time()
        self._watches = {watch for watch in self._watches if not watch.closed}
        for watch in self._watches:
            if watch.stalled(now_s):
                self._table.counts.timeouts["response"] += 1
                watch.transport.abort()
        self._later(ACCEPT.sweep_s, self._sweep)


def _shut_down(sock: socket.socket) -> None:
    """End a connection that is being set up: asyncio notices, and cleans up."""
    with contextlib.suppress(OSError):
        sock.shutdown(socket.SHUT_RDWR)
