"""Relays a browser's WebSocket to the project's viewer; only known message types pass.

viser has no login, and executes messages such as "open a public tunnel". So it listens on a private
Unix socket and is reached only through this relay, after `OriginMiddleware` has checked host and
origin.
"""

from __future__ import annotations

import asyncio
import contextlib
import logging
import time
from pathlib import Path

import msgspec.msgpack
from fastapi import APIRouter, WebSocket, WebSocketDisconnect
from websockets.asyncio.client import ClientConnection, unix_connect
from websockets.exceptions import ConnectionClosed, InvalidHandshake
from websockets.typing import Subprotocol

from app.access.people import Permission, person
from app.deps import parts
from app.errors import AppError, TooMany, ViewerFailed
from app.network.streams import TOO_MANY
from app.viewer.pool import ViewerPool

router = APIRouter()
log = logging.getLogger(__name__)

LOOKING = frozenset(
    {
        "ViewerCameraMessage",
        "ScenePointerMessage",
        "SceneNodeClickMessage",
        "GuiUpdateMessage",
        "GuiButtonHoldMessage",
        "GuiFormSubmitMessage",
        "GuiFormDirtyMessage",
        "GuiCloseModalMessage",
        "CommandTriggerMessage",
        "LocalStorageGetItemResponseMessage",
    }
)
"""Messages of people who may look: they change only that person's own view."""
REVIEWING = frozenset(
    {
        "SceneNodeDragMessage",
        "TransformControlsUpdateMessage",
        "TransformControlsDragStartMessage",
        "TransformControlsDragEndMessage",
    }
)
"""Messages that move objects: of people who may review."""

MAX_MESSAGE_BYTES = 1 << 16
"""Longer messages from a browser are dropped."""
MESSAGES_A_SECOND = 120.0
"""Most messages read from a browser per second; a moving camera sends 60 per second."""
BURST = 240
"""Most messages at once."""
ATTEMPTS = 3
"""Most starts of a viewer for one connection."""
STALLED_S = 30.0
"""A browser that reads nothing for this long is disconnected [s]."""
STALLED = 4408
"""Close code: the browser read nothing for too long."""


@router.websocket("/projects/{project_id}/viewer")
async def relay(browser: WebSocket, project_id: str) -> None:
    """Connect a browser to the viewer of a project."""
    server = parts(browser)
    who = person(browser)
    offered = [Subprotocol(name) for name in browser.scope["subprotocols"]]
    try:
        with server.viewers.sockets.place(browser):
            folder = server.projects.folder(project_id)
            viewer = await _viewer(server.viewers, folder, offered)
            try:
                await browser.accept(subprotocol=viewer.subprotocol)
                await _pump(browser, viewer, may_review=who.may(Permission.REVIEW))
            finally:
                await viewer.close()
    except TooMany as error:
        await browser.accept(subprotocol=offered[0] if offered else None)
        await browser.close(TOO_MANY, reason=str(error)[:120])
    except AppError as error:
        log.warning("%s", error)
        await browser.close(1008, reason=str(error)[:120])


async def _viewer(
    viewers: ViewerPool, project: Path, offered: list[Subprotocol]
) -> ClientConnection:
    """Connect to the viewer of a project; a viewer that was killed is started again."""
    for _ in range(ATTEMPTS):
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
    raise ViewerFailed(f"the viewer of {project.name} ends as soon as it starts")


async def _pump(browser: WebSocket, viewer: ClientConnection, *, may_review: bool) -> None:
    """Relay messages in both directions until one side closes; then close the other."""
    directions = {
        asyncio.create_task(_from_browser(browser, viewer, may_review=may_review)),
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


async def _from_browser(browser: WebSocket, viewer: ClientConnection, *, may_review: bool) -> None:
    rate = Rate(MESSAGES_A_SECOND, BURST)
    while (message := await browser.receive())["type"] == "websocket.receive":
        data = message.get("bytes")
        if data is None or not passes(data, may_review=may_review):
            continue
        if (wait_s := rate.wait_s(time.monotonic())) > 0.0:
            await asyncio.sleep(wait_s)  # unread messages then delay their sender only
        try:
            await viewer.send(data)
        except ConnectionClosed:
            return


async def _to_browser(browser: WebSocket, viewer: ClientConnection) -> None:
    code = 1012
    try:
        async for data in viewer:
            whole = data if isinstance(data, bytes) else data.encode()
            async with asyncio.timeout(STALLED_S):
                await browser.send_bytes(whole)
    except WebSocketDisconnect:
        return
    except TimeoutError:
        log.warning("a browser read nothing for %.0f s: disconnected", STALLED_S)
        code = STALLED
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


def passes(data: bytes, *, may_review: bool) -> bool:
    """Whether a browser's message may reach viser, which reads it with the same decoder."""
    if len(data) > MAX_MESSAGE_BYTES:
        log.warning("dropped a message of %d bytes from a browser", len(data))
        return False
    try:
        message = msgspec.msgpack.decode(data)
    except (msgspec.DecodeError, RecursionError):
        return False
    kind = message.get("type") if isinstance(message, dict) else None
    if not isinstance(kind, str) or not allowed(kind, may_review):
        log.warning("dropped a message of kind %.40r from a browser", kind)
        return False
    return True


def allowed(message_type: str, may_review: bool) -> bool:
    """Whether a person may send messages of a type; sharing, uploads and unknown ones never."""
    return message_type in LOOKING or (may_review and message_type in REVIEWING)
