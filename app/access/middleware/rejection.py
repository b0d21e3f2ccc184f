"""Turning a request or WebSocket away, and noting it."""

from __future__ import annotations

import asyncio
import json
from dataclasses import dataclass, field

from starlette.requests import HTTPConnection
from starlette.types import Receive, Scope, Send

from app.access.audit import audit


@dataclass(frozen=True, slots=True)
class Rejection:
    """Why a request is turned away."""

    status: int
    error: str
    """Name of the error, as in `app.errors`."""
    detail: str
    headers: dict[str, str] = field(default_factory=dict)


async def answer(refusal: Rejection, scope: Scope, receive: Receive, send: Send) -> None:
    """Say no."""
    if scope["type"] == "websocket":
        await receive()
        await send({"type": "websocket.close", "code": 1008, "reason": refusal.detail})
        return
    body = json.dumps({"error": refusal.error, "detail": refusal.detail}).encode()
    headers = {"content-type": "application/json", "content-length": str(len(body))}
    raw = [
        (name.lower().encode(), text.encode()) for name, text in (headers | refusal.headers).items()
    ]
    await send({"type": "http.response.start", "status": refusal.status, "headers": raw})
    await send({"type": "http.response.body", "body": body})


async def note(scope: Scope, refusal: Rejection) -> None:
    """Put it into the audit log."""
    what = f"{scope.get('method', 'WebSocket')} {scope['path']}: {refusal.detail}"
    connection = HTTPConnection(scope)
    await asyncio.to_thread(audit, connection, "request", what, outcome="refused")
