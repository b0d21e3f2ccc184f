"""Requests of the tools to the server that they run in, as the caller of the assistant.

They pass everything that a request from the network passes: host, token, rate limit, role, audit
log. So a tool can do nothing that a program with the same token could not do by the HTTP API.
"""

from __future__ import annotations

import asyncio
from collections.abc import AsyncIterator, Iterator
from contextlib import contextmanager, suppress
from contextvars import ContextVar

import anyio
import httpx2
from starlette.requests import HTTPConnection
from starlette.types import Message, Scope

from recon4_app.assistant.http_client import ServerClient
from recon4_app.assistant.tuning import ASSISTANT
from recon4_app.network.behind import prefix_of

_CALLER: ContextVar[HTTPConnection] = ContextVar("caller")
_PASSED_ON = frozenset({b"host", b"authorization", b"user-agent", b"accept-language"})
"""Headers of the assistant's request that the tools' requests carry."""


@contextmanager
def acting_for(caller: HTTPConnection) -> Iterator[None]:
    """Make the requests of tools within this context those of a caller."""
    token = _CALLER.set(caller)
    try:
        yield
    finally:
        _CALLER.reset(token)


class CallerClient(ServerClient):
    """The HTTP API of this server, for the caller of each tool."""

    def __init__(self) -> None:
        super().__init__("http://localhost/", transport=_AppTransport())

    @property
    def url(self) -> str:
        """Address by which the caller reaches this server."""
        caller = _CALLER.get()
        host = caller.headers["host"]
        return f"{caller.scope['scheme']}://{host}{prefix_of(caller.scope)}/"


class _AppTransport(httpx2.AsyncBaseTransport):
    """Calls the application instead of a network; responses are read as they come."""

    async def handle_async_request(self, request: httpx2.Request) -> httpx2.Response:
        caller = _CALLER.get()
        exchange = _Exchange(_scope_of(request, caller.scope), await request.aread())
        status, headers = await exchange.begin(caller)
        return httpx2.Response(status, headers=headers, stream=exchange)


class _Exchange(httpx2.AsyncByteStream):
    """One request of the application, and the body of its response."""

    def __init__(self, scope: Scope, body: bytes) -> None:
        self._scope, self._body = scope, [body]
        self._start: asyncio.Future[Message] = asyncio.get_running_loop().create_future()
        self._pieces: asyncio.Queue[bytes | None] = asyncio.Queue(ASSISTANT.waiting_pieces)
        self._running: asyncio.Task[None] | None = None

    async def begin(self, caller: HTTPConnection) -> tuple[int, list[tuple[bytes, bytes]]]:
        """Status and headers of the response, as soon as they are there."""
        self._running = asyncio.create_task(self._run(caller))
        try:
            start = await asyncio.shield(self._start)
        except BaseException:
            await self.aclose()
            raise
        return start["status"], list(start.get("headers", []))

    async def __aiter__(self) -> AsyncIterator[bytes]:
        while (piece := await self._pieces.get()) is not None:
            yield piece

    async def aclose(self) -> None:
        """End the request, also one that would go on for ever."""
        assert self._running is not None
        self._running.cancel()
        with anyio.CancelScope(shield=True), suppress(asyncio.CancelledError, Exception):
            await self._running

    async def _run(self, caller: HTTPConnection) -> None:
        try:
            await caller.app(self._scope, self._receive, self._send)
        except Exception as error:  # the framework has logged it
            if not self._start.done():
                self._start.set_exception(httpx2.ReadError(type(error).__name__))
        await self._pieces.put(None)

    async def _receive(self) -> Message:
        if not self._body:
            await asyncio.Event().wait()  # the client leaves by `aclose`
        return {"type": "http.request", "body": self._body.pop(), "more_body": False}

    async def _send(self, message: Message) -> None:
        if message["type"] == "http.response.start":
            self._start.set_result(message)
        elif message["type"] == "http.response.body" and message.get("body"):
            await self._pieces.put(message["body"])


def _scope_of(request: httpx2.Request, caller: Scope) -> Scope:
    own = [(name.lower(), value) for name, value in request.headers.raw]
    own = [(name, value) for name, value in own if name not in _PASSED_ON]
    passed = [(name, value) for name, value in caller["headers"] if name in _PASSED_ON]
    prefix = prefix_of(caller)
    path = prefix + request.url.path
    return {
        **{name: caller[name] for name in ("asgi", "http_version", "scheme", "client", "server")},
        "type": "http",
        "method": request.method,
        "path": path,
        "raw_path": path.encode(),
        "root_path": prefix,
        "query_string": request.url.query,
        "headers": passed + own,
        "state": {},
    }
