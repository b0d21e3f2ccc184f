"""Relays a browser's WebSocket to the project's viewer, letting through only what is known.

viser asks nobody who they are, and obeys messages such as "open a public tunnel": so it listens
on loopback and is reached only through here, after the `Guard` has checked host and origin.
"""

from __future__ import annotations

import asyncio
import logging

import msgspec.msgpack
from fastapi import APIRouter, WebSocket, WebSocketDisconnect
from websockets.asyncio.client import ClientConnection, connect
from websockets.exceptions import ConnectionClosed
from websockets.typing import Subprotocol

from app.deps import parts
from app.errors import AppError

router = APIRouter()
log = logging.getLogger(__name__)

ALLOWED = frozenset(
    {
        "ViewerCameraMessage",
        "ScenePointerMessage",
        "SceneNodeClickMessage",
        "SceneNodeDragMessage",
        "TransformControlsUpdateMessage",
        "TransformControlsDragStartMessage",
        "TransformControlsDragEndMessage",
        "GuiUpdateMessage",
        "GuiButtonHoldMessage",
        "GuiFormSubmitMessage",
        "GuiFormDirtyMessage",
        "GuiCloseModalMessage",
        "CommandTriggerMessage",
        "GetRenderResponseMessage",
    }
)
"""What a browser may send. Sharing, uploads and everything unknown are dropped."""

MAX_MESSAGE_BYTES = 1 << 16
"""Longer messages from the browser are dropped; a rendered picture may be larger."""


@router.websocket("/projects/{project_id}/viewer")
async def relay(browser: WebSocket, project_id: str) -> None:
    """Connect a browser with the viewer of a project."""
    server = parts(browser)
    try:
        port = await server.viewers.port(server.projects.folder(project_id))
    except AppError as error:
        log.warning("%s", error)
        await browser.close(1008, reason=str(error)[:120])
        return
    offered = [Subprotocol(name) for name in browser.scope["subprotocols"]]
    viewer = connect(
        f"ws://127.0.0.1:{port}",
        subprotocols=offered or None,
        max_size=None,  # it is ours; a scene comes as one message of many megabytes
        compression=None,
        ping_interval=None,
        max_queue=2,
        proxy=None,
    )
    async with viewer as upstream:
        await browser.accept(subprotocol=upstream.subprotocol)
        await _pump(browser, upstream)


async def _pump(browser: WebSocket, viewer: ClientConnection) -> None:
    """Carry messages both ways until one side leaves; then tell the other."""
    ways = {
        asyncio.create_task(_from_browser(browser, viewer)),
        asyncio.create_task(_to_browser(browser, viewer)),
    }
    try:
        done, _ = await asyncio.wait(ways, return_when=asyncio.FIRST_COMPLETED)
        for way in done:
            way.result()
    finally:
        for way in ways:
            way.cancel()
        await asyncio.gather(*ways, return_exceptions=True)


async def _from_browser(browser: WebSocket, viewer: ClientConnection) -> None:
    while (message := await browser.receive())["type"] == "websocket.receive":
        data = message.get("bytes")
        if data is not None and allowed(data):
            try:
                await viewer.send(data)
            except ConnectionClosed:
                return


async def _to_browser(browser: WebSocket, viewer: ClientConnection) -> None:
    try:
        async for data in viewer:
            await browser.send_bytes(data if isinstance(data, bytes) else data.encode())
    except WebSocketDisconnect:
        return
    except ConnectionClosed:
        log.info("viewer connection lost")
    await browser.close(1012)


def allowed(data: bytes) -> bool:
    """Whether a browser's message may reach viser, which reads it with the same decoder."""
    try:
        message = msgspec.msgpack.decode(data)
    except (msgspec.DecodeError, RecursionError):
        return False
    kind = message.get("type") if isinstance(message, dict) else None
    if not isinstance(kind, str) or kind not in ALLOWED:
        log.warning("dropped a message of kind %.40r from a browser", kind)
        return False
    return len(data) <= MAX_MESSAGE_BYTES or kind == "GetRenderResponseMessage"
