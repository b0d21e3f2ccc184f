"""Where the server listens: the socket, the certificate, the HTTP protocol."""

from __future__ import annotations

import asyncio
import fcntl
import os
import socket
from collections.abc import Callable, Iterator
from contextlib import contextmanager

import uvicorn
from fastapi import FastAPI

from app.access.certificate import Certificate, made_certificate, own_certificate
from app.access.guard import Hosts
from app.access.hosts import LOOPBACK, own_names
from app.access.patience import PatientProtocol
from app.settings import ServerSettings
from recon4.errors import StoreError
from recon4.store.atomic import make_folders


class AnnouncingServer(uvicorn.Server):
    """Says when it listens."""

    def __init__(self, config: uvicorn.Config, ready: Callable[[], None]) -> None:
        super().__init__(config)
        self._ready = ready

    async def startup(self, sockets: list[socket.socket] | None = None) -> None:
        """Start, then say so."""
        await super().startup(sockets)
        self._ready()

    async def shutdown(self, sockets: list[socket.socket] | None = None) -> None:
        """End; who still takes nothing when the patience is over is hung up on."""
        await super().shutdown(sockets)
        for connection in list(self.server_state.connections):
            connection.transport.abort()
        await asyncio.sleep(0)  # the sockets close on the loop's next round


def uvicorn_config(app: FastAPI, certificate: Certificate | None = None) -> uvicorn.Config:
    """How the application is run, in tests too; with a certificate only TLS is spoken."""
    context = certificate.context() if certificate is not None else None
    return uvicorn.Config(
        app,
        http=PatientProtocol,
        log_level="warning",
        access_log=False,
        proxy_headers=False,  # nobody stands in between: such headers are made up
        ws_max_size=1 << 20,
        ws_per_message_deflate=False,  # costs 0.3 s of processor time a million points
        timeout_graceful_shutdown=2,  # event streams never end by themselves
        server_header=False,
        ssl_context_factory=(lambda config, default: context) if context is not None else None,
    )


def hosts_of(settings: ServerSettings) -> Hosts:
    """Host names the server answers to."""
    if not settings.lan:
        return Hosts(LOOPBACK)
    names = {name.lower() for name in settings.names}
    return Hosts(own_names() | names, by_address=True)


def certificate_of(settings: ServerSettings) -> Certificate | None:
    """The certificate to listen with; None = without TLS.

    Raises:
        ConfigError: If the user's own is none.
    """
    if not settings.lan:
        return None
    if settings.tls_certificate is not None and settings.tls_key is not None:
        return own_certificate(settings.tls_certificate, settings.tls_key)
    return made_certificate(settings.state / "tls", hosts_of(settings).names)


def presented_fingerprint(settings: ServerSettings) -> str | None:
    """SHA-256 of the certificate this server shows; None = it speaks no TLS."""
    if not settings.lan:
        return None
    chain = settings.tls_certificate or settings.state / "tls" / "certificate.pem"
    return Certificate(chain, chain, own=False).fingerprint()


@contextmanager
def only_one(settings: ServerSettings) -> Iterator[None]:
    """Hold the folder: two servers would start every job twice.

    Raises:
        StoreError: If another server holds it.
    """
    make_state(settings)
    lock = os.open(settings.state / "server.lock", os.O_RDWR | os.O_CREAT | os.O_CLOEXEC, 0o600)
    try:
        try:
            fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError as error:
            raise StoreError(f"another server runs on {settings.root}; use that one") from error
        yield
    finally:
        os.close(lock)


def make_state(settings: ServerSettings) -> None:
    """The folder of the server's own files, for nobody but its user."""
    make_folders(settings.state, 0o700)
    settings.state.chmod(0o700)


@contextmanager
def private_files(wanted: bool) -> Iterator[None]:
    """Files made meanwhile, those of workers too, are for nobody but the server's user."""
    before = os.umask(0o077) if wanted else None
    try:
        yield
    finally:
        if before is not None:
            os.umask(before)


@contextmanager
def listening(settings: ServerSettings) -> Iterator[socket.socket]:
    """The socket to listen on.

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
                f"port {settings.port} is in use ({error.strerror}); choose another with --port"
            ) from error
        yield listener


def urls(settings: ServerSettings, listener: socket.socket) -> list[str]:
    """Where browsers find the server, the best first."""
    name, port = listener.getsockname()[:2]
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
