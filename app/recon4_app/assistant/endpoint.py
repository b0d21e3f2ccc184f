"""The tools over HTTP: the MCP servers of a recon4 server, made when an assistant first comes.

Streamable HTTP without sessions: each request stands alone and is judged by its token. There is
no session that could be taken over, fixed or left open.
"""

from __future__ import annotations

import asyncio
from importlib.util import find_spec
from typing import TYPE_CHECKING

from starlette.requests import Request
from starlette.responses import Response
from starlette.types import Receive, Scope, Send

from recon4.locales.coded import CodedText
from recon4_app.assistant.tuning import ASSISTANT
from recon4_app.errors import NotFound
from recon4_app.network.streams import StreamLimits, Streams

if TYPE_CHECKING:
    from mcp.server.streamable_http_manager import StreamableHTTPSessionManager

CALLS = StreamLimits(max_streams=64, max_per_person=8, max_per_address=32, reserved_for_capture=0)
"""Requests of assistants at a time: one that watches a job lasts for minutes."""


class AssistantEndpoint:
    """Answers requests of assistants; one for those who only look, one for those who act."""

    def __init__(self) -> None:
        self.calls = Streams("assistant calls", CALLS)
        self._managers: dict[bool, StreamableHTTPSessionManager] = {}
        self._running: list[asyncio.Task[None]] = []
        self._lock = asyncio.Lock()

    async def response(self, request: Request, *, allow_write: bool) -> Response:
        """The response to a message of an assistant.

        Args:
            request: The message; its caller is the one for whom the tools act.
            allow_write: Whether there are tools that start, stop and decide.

        Raises:
            NotFound: If the packages for assistants are not installed.
        """
        if find_spec("mcp") is None or find_spec("httpx2") is None:
            raise NotFound(CodedText("assistant-missing"))
        async with self._lock:
            if allow_write not in self._managers:
                self._managers[allow_write] = await self._start(allow_write=allow_write)
        return _Answer(self._managers[allow_write], self.calls)

    async def close(self) -> None:
        """End all requests of assistants."""
        for task in self._running:
            task.cancel()
        await asyncio.gather(*self._running, return_exceptions=True)

    async def _start(self, *, allow_write: bool) -> StreamableHTTPSessionManager:
        manager = await asyncio.to_thread(_manager, allow_write=allow_write)
        ready = asyncio.get_running_loop().create_future()
        self._running.append(asyncio.create_task(_serve(manager, ready)))
        await ready
        return manager


class _Answer(Response):
    """Has the answer written by the library, while it takes a place among the calls."""

    def __init__(self, manager: StreamableHTTPSessionManager, calls: Streams) -> None:
        super().__init__()
        self._manager, self._calls = manager, calls

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        with self._calls.place(Request(scope)):
            await self._manager.handle_request(scope, receive, send)


async def _serve(manager: StreamableHTTPSessionManager, ready: asyncio.Future[None]) -> None:
    try:
        async with manager.run():
            ready.set_result(None)
            await asyncio.Event().wait()
    except Exception as error:
        if ready.done():
            raise
        ready.set_exception(error)


def _manager(*, allow_write: bool) -> StreamableHTTPSessionManager:
    """Imports the SDK, which takes a second: only where assistants come."""
    from mcp.server.transport_security import TransportSecuritySettings

    from recon4_app.assistant.in_process import CallerClient
    from recon4_app.assistant.server import make_http_server

    server = make_http_server(CallerClient(), allow_write=allow_write)
    server.streamable_http_app(
        stateless_http=True,
        max_request_body_size=ASSISTANT.max_message_bytes,
        # `OriginMiddleware` has judged host and origin
        transport_security=TransportSecuritySettings(enable_dns_rebinding_protection=False),
    )
    return server.session_manager
