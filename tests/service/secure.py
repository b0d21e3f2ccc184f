"""Servers with TLS and login for tests, and people who sign in to them."""

from __future__ import annotations

import asyncio
import ssl
from collections.abc import Iterator
from contextlib import AbstractContextManager, contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any
from unittest.mock import patch
from urllib.parse import urlsplit

import httpx
from anyio.from_thread import BlockingPortal, start_blocking_portal
from argon2 import PasswordHasher
from websockets.asyncio.client import ClientConnection, connect
from websockets.typing import Subprotocol

from recon4_app.access.login import passwords
from recon4_app.access.login.login_service import open_access
from recon4_app.access.people import Role
from tests.deadlines import HANG_S
from tests.service.running import Running, server_thread

PASSWORD = "three green owls dance"
CHEAP = PasswordHasher(time_cost=1, memory_cost=8, parallelism=1)
"""What a hash costs is tested in ``tests/unit/app/test_access_passwords.py``."""
ROLES = {"vera": Role.VIEWER, "otto": Role.OPERATOR, "rita": Role.REVIEWER, "anna": Role.ADMIN}
"""Name -> role of all people on the servers of tests."""


@dataclass(frozen=True)
class Socket:
    """A WebSocket over TLS, for a test that waits for it.

    The blocking client of websockets reads and writes one TLS connection in two threads, which
    OpenSSL does not allow: one handshake in a thousand hangs. Here one thread does both.
    """

    portal: BlockingPortal
    connection: ClientConnection

    def send(self, data: bytes | str) -> None:
        self.portal.call(self.connection.send, data)

    def recv(self, timeout: float) -> bytes | str:
        return self.portal.call(asyncio.wait_for, self.connection.recv(), timeout)


@dataclass(frozen=True)
class Secure:
    """A running server with login."""

    running: Running

    @property
    def url(self) -> str:
        return self.running.url

    @property
    def root(self) -> Path:
        return self.running.root

    @property
    def host(self) -> str:
        return urlsplit(self.url).netloc

    def trust(self) -> ssl.SSLContext:
        """Trusts the server's made certificate and no other."""
        return ssl.create_default_context(cafile=self.root / ".recon4" / "tls" / "certificate.pem")

    def client(self, **options: Any) -> httpx.Client:
        """A client that has not signed in."""
        return httpx.Client(base_url=self.url, verify=self.trust(), timeout=HANG_S, **options)

    @contextmanager
    def signed_in(self, name: str, password: str = PASSWORD) -> Iterator[httpx.Client]:
        """A client that has signed in; every request carries the token."""
        with self.client() as client:
            answer = client.post("/api/login", json={"name": name, "password": password})
            assert answer.status_code == 200, answer.text
            client.headers["X-Recon4-Token"] = answer.json()["token"]
            yield client

    @contextmanager
    def websocket(self, path: str, client: httpx.Client, **options: Any) -> Iterator[Socket]:
        """A WebSocket with the cookies of a client."""
        cookies = "; ".join(f"{name}={value}" for name, value in client.cookies.items())
        given = {"origin": self.url, "additional_headers": {"Cookie": cookies} if cookies else {}}
        opening = connect(
            f"wss://{self.host}{path}",
            ssl=self.trust(),
            compression=None,
            max_size=None,
            proxy=None,
            open_timeout=HANG_S,  # a viewer that it starts takes long on a busy computer
            **{**given, **options},
        )
        with (
            start_blocking_portal() as portal,
            portal.wrap_async_context_manager(opening) as connection,
        ):
            yield Socket(portal, connection)

    def viewer(self, client: httpx.Client, **options: Any) -> AbstractContextManager[Socket]:
        """The viewer's WebSocket of the project ``office``."""
        import viser

        protocol = Subprotocol(f"viser-v{viser.__version__}")
        path = "/projects/office/viewer"
        return self.websocket(path, client, subprotocols=[protocol], **options)


@contextmanager
def secure_server(root: Path, **settings: Any) -> Iterator[Secure]:
    """A server with TLS, login, and the accounts of `ROLES`; its passwords are hashed cheaply."""
    state = root / ".recon4"
    state.mkdir(exist_ok=True)
    with patch.object(passwords, "HASHER", CHEAP):
        access = open_access(state, login=True)
        if not access.accounts.all():
            for name, role in ROLES.items():
                access.accounts.add(name, role, PASSWORD)
        access.close()
        with server_thread(root, lan=True, **settings) as running:
            yield Secure(running)
