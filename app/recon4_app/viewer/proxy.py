"""Relays a browser's WebSocket to the project's viewer; only checked messages pass.

viser has no login, and executes messages such as "open a public tunnel". So it listens on a private
Unix socket and is reached only through this relay, after `OriginMiddleware` has checked host and
origin. What passes (`viewer.browser_messages`) changes only the sender's own view, so everybody
who may look may send it.
"""

from __future__ import annotations

import asyncio
import contextlib
import logging
import time
from pathlib import Path

from fastapi import APIRouter, WebSocket, WebSocketDisconnect
from websockets.asyncio.client import ClientConnection, unix_connect
from websockets.exceptions import ConnectionClosed, InvalidHandshake
from websockets.typing import Subprotocol

from recon4.locales.coded import CodedText
from recon4_app.deps import parts
from recon4_app.errors import AppError, TooMany, ViewerFailed
from recon4_app.network.close_codes import CloseCode, close_reason
from recon4_app.viewer.browser_messages import RefusedMessage, checked
from recon4_app.viewer.pool import ViewerPool
from recon4_app.viewer.tuning import RELAY

router = APIRouter()
log = logging.getLogger(__name__)


@router.websocket("/projects/{project_id}/viewer")
async def relay(browser: WebSocket, project_id: str) -> None:
    """Connect a browser to the viewer of a project."""
    server = parts(browser)
    offered = [Subprotocol(name) for name in browser.scope["subprotocols"]]
    try:
        with server.viewers.sockets.place(browser):
            folder = server.projects.folder(project_id)
            viewer = await _viewer(server.viewers, folder, offered)
            try:
                await browser.accept(subprotocol=viewer.subprotocol)
                await _pump(browser, viewer)
            finally:
                await viewer.close()
    except TooMany as error:
        await browser.accept(subprotocol=offered[0] if offered else None)
        await browser.close(CloseCode.TOO_MANY, reason=close_reason(error, browser))
    except AppError as error:
        log.warning("%s", error)
        await browser.close(1008, reason=close_reason(error, browser))


async def _viewer(
    viewers: ViewerPool, project: Path, offered: list[Subprotocol]
) -> ClientConnection:
    """Connect to the viewer of a project; a viewer that was killed is started again."""
    for _ in range(RELAY.attempts):
        socket = await viewers.socket(project)
        try:
            return await unix_connect(
                str(socket),
                "ws://viewer/",
                subprotocols=offered or None,
                max_size=None,  # a process of our own
                compression=None,
                ping_interval=None,
                max_queue=2,
            )
        except (OSError, InvalidHandshake) as error:
            log.warning("viewer of %s: %s", project.name, error)
            await viewers.give_up(project, socket)
    raise ViewerFailed(CodedText("viewer-ends", project=project.name))


async def _pump(browser: WebSocket, viewer: ClientConnection) -> None:
    """Relay messages in both directions until one side closes; then close the other."""
    directions = {
        asyncio.create_task(_from_browser(browser, viewer)),
        asyncio.create_task(_to_browser(browser, viewer)),
    }
    try:
        done, _ = await asyncio.wait(directions, return_when=asyncio.FIRST_COMPLETED)
        for task in done:
            task.result()
    finally:
        for task in directions:
            task.cancel()
        await asyncio.gather(*directions, return_exceptions=True)


async def _from_browser(browser: WebSocket, viewer: ClientConnection) -> None:
    rate, dropped = Rate(RELAY.messages_a_second, RELAY.burst), Dropped()
    try:
        while (message := await browser.receive())["type"] == "websocket.receive":
            if (wait_s := rate.wait_s(time.monotonic())) > 0.0:
                await asyncio.sleep(wait_s)  # unread messages then delay their sender only
            try:
                data = checked(message.get("bytes") or b"")
            except RefusedMessage as error:
                dropped.add(error)
                continue
            await viewer.send(data)
    except ConnectionClosed:
        return
    finally:
        dropped.report()


class Dropped:
    """Counts the dropped messages of one browser; logs the first, and at the end how many more."""

    def __init__(self) -> None:
        self._count = 0

    def add(self, error: RefusedMessage) -> None:
        """Count a message."""
        self._count += 1
        if self._count == 1:
            log.warning("dropped a message from a browser: %r", str(error))

    def report(self) -> None:
        """Log how many more there were."""
        if self._count > 1:
            log.warning("dropped %d more messages from that browser", self._count - 1)


async def _to_browser(browser: WebSocket, viewer: ClientConnection) -> None:
    code = 1012
    try:
        async for data in viewer:
            whole = data if isinstance(data, bytes) else data.encode()
            async with asyncio.timeout(RELAY.stalled_s):
                await browser.send_bytes(whole)
    except WebSocketDisconnect:
        return
    except TimeoutError:
        log.warning("a browser read nothing for %.0f s: disconnected", RELAY.stalled_s)
        code = CloseCode.STALLED
    except ConnectionClosed:
        log.info("viewer connection lost")
    with contextlib.suppress(TimeoutError):
        async with asyncio.timeout(1.0):
            await browser.close(code)


class Rate:
    """Rate limit of reading messages: a token bucket."""

    def __init__(self, a_second: float, burst: int) -> None:
        self._a_second, self._burst = a_second, float(burst)
        self._tokens = self._burst
        self._at_s: float | None = None

    def wait_s(self, now_s: float) -> float:
        """Take a token; time to wait before using it [s]."""
        since_s = 0.0 if self._at_s is None else now_s - self._at_s
        self._at_s = now_s
        self._tokens = min(self._tokens + since_s * self._a_second, self._burst) - 1.0
        return max(-self._tokens / self._a_second, 0.0)
