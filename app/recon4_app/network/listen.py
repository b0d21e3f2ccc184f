"""Listening: the socket, the certificate, the HTTP protocol."""

from __future__ import annotations

import asyncio
import os
import socket
import sys
from collections.abc import Callable, Iterator
from contextlib import ExitStack, contextmanager
from dataclasses import replace
from pathlib import Path
from tempfile import TemporaryDirectory

import uvicorn
from fastapi import FastAPI

from recon4.errors import ConfigError, StoreError
from recon4.locales.coded import CodedText
from recon4.store.atomic import make_folders
from recon4.store.locks import trying_lock
from recon4_app.access.middleware.origin import Hosts
from recon4_app.network.accept import Acceptor
from recon4_app.network.certificate import Certificate, made_certificate, own_certificate
from recon4_app.network.connections import (
    Connection,
    ConnectionLimits,
    ConnectionTable,
    open_file_limit,
)
from recon4_app.network.hosts import LOOPBACK, own_names
from recon4_app.network.http_timeouts import HttpTimeoutsProtocol
from recon4_app.network.tuning import HTTP_TIMEOUTS, PINGS
from recon4_app.settings import ServerSettings


class AnnouncingServer(uvicorn.Server):
    """uvicorn with our accept loop; calls back when it listens."""

    def __init__(self, config: uvicorn.Config, ready: Callable[[], None]) -> None:
        super().__init__(config)
        self._ready = ready
        self._table = connections_of(config)
        self._state = getattr(config.app, "state", None)

    def end(self) -> None:
        """Request the end: everything is shut down in order. Callable from a signal handler."""
        self.should_exit = True

    @contextmanager
    def capture_signals(self) -> Iterator[None]:
        """Leave signals to `recon4.system.stopping`: uvicorn raises them again at its end."""
        yield

    async def startup(self, sockets: list[socket.socket] | None = None) -> None:
        """Start, accept connections, then call ``ready``.

        Raises:
            StoreError: If the application has a reason not to start.
        """
        await self.lifespan.startup()
        if self.lifespan.should_exit:
            sys.exit(uvicorn.config.STARTUP_FAILURE)
        if (refusal := getattr(self._state, "refusal", None)) is not None:
            await self.lifespan.shutdown()
            raise refusal
        self.servers = []
        for listener in sockets or ():
            acceptor = Acceptor(
                listener, self._table, protocol=self._protocol, context=self.config.ssl
            )
            acceptor.start()
            self.servers.append(acceptor)  # type: ignore[arg-type]  # closed and waited for
        self.started = True
        if not self.should_exit:
            self._ready()

    async def shutdown(self, sockets: list[socket.socket] | None = None) -> None:
        """End; connections that are still open after the graceful time are aborted."""
        if (parts := getattr(self._state, "parts", None)) is not None:
            parts.supervisor.end_news()
        await super().shutdown(sockets)
        for connection in self._table:
            connection.abort()
        await asyncio.sleep(0)  # the sockets close on the loop's next round

    def _protocol(self, connection: Connection) -> asyncio.Protocol:
        return HttpTimeoutsProtocol(
            self.config,
            self.server_state,
            self.lifespan.state,
            connection=connection,
            table=self._table,
        )


def connections_of(config: uvicorn.Config) -> ConnectionTable:
    """The connection table that `create_app` made; of another application a table of its own."""
    if isinstance(config.app, FastAPI):
        table: ConnectionTable = config.app.state.connections
        return table
    return ConnectionTable(ConnectionLimits.within(1024, per_address=256, files=open_file_limit()))


def uvicorn_config(app: FastAPI, certificate: Certificate | None = None) -> uvicorn.Config:
    """Configuration of uvicorn, in tests too; with a certificate only TLS is accepted."""
    context = certificate.context() if certificate is not None else None
    return uvicorn.Config(
        app,
        http=HttpTimeoutsProtocol,
        log_level="warning",
        log_config=None,  # `recon4_app.logs` writes what uvicorn logs, too
        access_log=False,
        proxy_headers=False,  # there is no proxy: such headers are forged
        ws_max_size=1 << 20,
        ws_ping_interval=PINGS.ping_interval_s,
        ws_ping_timeout=PINGS.ping_timeout_s,
        ws_per_message_deflate=False,  # costs 0.3 s of processor time a million points
        timeout_keep_alive=HTTP_TIMEOUTS.keep_alive_s,
        timeout_graceful_shutdown=2,
        server_header=False,
        ssl_context_factory=(lambda config, default: context) if context is not None else None,
    )


def hosts_of(settings: ServerSettings) -> Hosts:
    """Host names the server accepts."""
    if settings.behind is not None:
        return Hosts(frozenset({settings.behind.host}))
    if not settings.lan:
        return Hosts(LOOPBACK)
    names = {name.lower() for name in settings.allowed_hosts}
    return Hosts(own_names() | names, by_address=True)


def certificate_of(settings: ServerSettings) -> Certificate | None:
    """The certificate to listen with; None = without TLS.

    Raises:
        ConfigError: If the user's own is not valid.
    """
    if not settings.lan:
        return None
    if settings.tls_certificate is not None and settings.tls_key is not None:
        return own_certificate(settings.tls_certificate, settings.tls_key)
    return made_certificate(settings.state / "tls", hosts_of(settings).names)


def presented_fingerprint(settings: ServerSettings) -> str | None:
    """SHA-256 fingerprint of this server's certificate; None = without TLS."""
    if not settings.lan:
        return None
    chain = settings.tls_certificate or settings.state / "tls" / "certificate.pem"
    return Certificate(chain, chain, own=False).fingerprint()


@contextmanager
def own_files(settings: ServerSettings) -> Iterator[ServerSettings]:
    """Lock the server's folder; with a root that cannot be written, one that is temporary.

    Raises:
        ConfigError: If the root cannot be written and people have to sign in.
        StoreError: If another server has the lock.
    """
    with ExitStack() as stack:
        stack.enter_context(private_files(settings.login))
        if not os.access(settings.root, os.W_OK):
            if settings.login:
                raise ConfigError(CodedText("server-read-only", root=str(settings.root)))
            folder = stack.enter_context(TemporaryDirectory(prefix="recon4-state-"))
            settings = replace(settings, state_folder=Path(folder))
        stack.enter_context(only_one(settings))
        yield settings


@contextmanager
def only_one(settings: ServerSettings) -> Iterator[None]:
    """Lock the server's folder: two servers would start every job twice.

    Raises:
        StoreError: If another server has the lock.
    """
    make_state(settings)
    with trying_lock(settings.state / "server.lock") as lock:
        if lock is None:
            raise StoreError(CodedText("server-other", root=str(settings.root)))
        yield


def make_state(settings: ServerSettings) -> None:
    """Create the folder of the server's own files, accessible to its user only.

    Raises:
        StoreError: If it belongs to another user, or cannot be made.
    """
    try:
        make_folders(settings.state, 0o700)
        settings.state.chmod(0o700)
    except OSError as error:
        raise StoreError(
            CodedText("server-state", state=str(settings.state), why=str(error.strerror))
        ) from error


@contextmanager
def private_files(wanted: bool) -> Iterator[None]:
    """Make new files, those of workers too, accessible to the server's user only."""
    before = os.umask(0o077) if wanted else None
    try:
        yield
    finally:
        if before is not None:
            os.umask(before)


@contextmanager
def listening(settings: ServerSettings) -> Iterator[socket.socket]:
    """Bind the socket to listen on.

    Raises:
        StoreError: If it cannot listen there.
    """
    family = socket.AF_INET6 if ":" in settings.host else socket.AF_INET
    # asyncio turns Nagle's delay (40 ms an answer) off only where the protocol is named
    with socket.socket(family, socket.SOCK_STREAM, socket.IPPROTO_TCP) as listener:
        listener.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        try:
            listener.bind((settings.host, settings.port))
        except OSError as error:
            raise StoreError(
                CodedText("server-port", port=settings.port, why=str(error.strerror))
            ) from error
        yield listener


def urls(settings: ServerSettings, listener: socket.socket) -> list[str]:
    """URLs of the server, the best first."""
    name, port = listener.getsockname()[:2]
    if settings.behind is not None:
        return [settings.behind.url]
    scheme = "https" if settings.lan else "http"
    names = [name]
    if name in ("0.0.0.0", "::"):
        own = own_names() - LOOPBACK
        addresses = sorted(one for one in own if one[0].isdigit() or ":" in one)
        names = [*addresses, socket.gethostname().lower(), "localhost"]
    return [
        f"{scheme}://[{one}]:{port}/" if ":" in one else f"{scheme}://{one}:{port}/"
        for one in names
    ]
