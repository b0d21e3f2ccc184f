"""Rejecting a request or WebSocket, and writing that to the audit log."""

from __future__ import annotations

import asyncio
import json
from dataclasses import dataclass, field

from starlette.requests import HTTPConnection
from starlette.types import Receive, Scope, Send

from recon4.locales.coded import CodedText
from recon4_app.access.audit import audit
from recon4_app.pages import language_of


@dataclass(frozen=True, slots=True)
class Rejection:
    """Why a request is rejected."""

    status: int
    error: str
    """Name of the error, as in `recon4_app.errors`."""
    detail: CodedText
    headers: dict[str, str] = field(default_factory=dict)

    async def answer(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Send the rejection as the response, or close the WebSocket."""
        if scope["type"] == "websocket":
            await receive()
            await send({"type": "websocket.close", "code": 1008, "reason": self.detail})
            return
        language = language_of(HTTPConnection(scope))
        body = json.dumps(
            {
                "error": self.error,
                "detail": self.detail.said(language),
                "code": self.detail.code,
                **({"values": dict(self.detail.values)} if self.detail.values else {}),
            }
        ).encode()
        headers = {"content-type": "application/json", "content-length": str(len(body))}
        raw = [
            (name.lower().encode(), text.encode())
            for name, text in (headers | self.headers).items()
        ]
        await send({"type": "http.response.start", "status": self.status, "headers": raw})
        await send({"type": "http.response.body", "body": body})


async def note(scope: Scope, rejection: Rejection) -> None:
    """Write a rejection to the audit log."""
    what = f"{scope.get('method', 'WebSocket')} {scope['path']}: {rejection.detail}"
    connection = HTTPConnection(scope)
    await asyncio.to_thread(audit, connection, "request", what, outcome="refused")
