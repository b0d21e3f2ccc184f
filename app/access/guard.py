"""Who may talk to the server: host names, origins, headers. Pure ASGI, before everything else.

A page of another site open in the operator's browser can send requests to localhost and open
WebSockets; a name that points to 127.0.0.1 can even make them look same-site (DNS rebinding).
So the host must be one of ours, and whatever changes something must come from our own page.
"""

from __future__ import annotations

import json
from dataclasses import dataclass
from urllib.parse import urlsplit

from starlette.datastructures import Headers, MutableHeaders
from starlette.types import ASGIApp, Message, Receive, Scope, Send

from app.access.people import Person, Role

SAFE_METHODS = frozenset({"GET", "HEAD", "OPTIONS"})

PAGE_POLICY = (
    "default-src 'self'; img-src 'self' data: blob:; object-src 'none'; base-uri 'none'; "
    "form-action 'self'; frame-ancestors 'self'"
)
"""Content security policy of whatever does not bring its own."""

HEADERS = {
    "Content-Security-Policy": PAGE_POLICY,
    "X-Content-Type-Options": "nosniff",
    "Referrer-Policy": "no-referrer",
    "Cross-Origin-Opener-Policy": "same-origin",
    "Cross-Origin-Resource-Policy": "same-origin",
    "Permissions-Policy": "camera=(), microphone=(), geolocation=()",
    "Cache-Control": "no-cache",
}


LOCAL = Person("local", Role.ADMIN)
"""Whoever sits at this computer, when the server listens on loopback only."""


@dataclass(frozen=True, slots=True)
class Refusal:
    """Why a request is turned away."""

    status: int
    detail: str


class Guard:
    """Turns away foreign hosts and origins; adds the security headers."""

    def __init__(self, app: ASGIApp, *, hosts: frozenset[str]) -> None:
        self._app = app
        self._hosts = hosts

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        if scope["type"] not in ("http", "websocket"):
            await self._app(scope, receive, send)
            return
        refusal = judge(scope, self._hosts)
        if refusal is None:
            scope.setdefault("state", {})["person"] = LOCAL
            await self._app(scope, receive, _with_headers(send))
        elif scope["type"] == "websocket":
            await receive()
            await send({"type": "websocket.close", "code": 1008, "reason": refusal.detail})
        else:
            await _answer(refusal, _with_headers(send))


def judge(scope: Scope, hosts: frozenset[str]) -> Refusal | None:
    """The refusal of a request, None if it may pass.

    Args:
        scope: The ASGI scope of a request or WebSocket.
        hosts: Host names (without port) the server answers to.
    """
    headers = Headers(scope=scope)
    named = headers.getlist("host")
    if len(named) != 1 or hostname(named[0]) not in hosts:
        return Refusal(400, "this server does not answer to that host name")
    origins = headers.getlist("origin")
    if scope["type"] == "websocket":
        allowed = len(origins) == 1 and same_origin(origins[0], named[0])
    elif scope["method"] in SAFE_METHODS:
        allowed = True
    elif origins:
        allowed = len(origins) == 1 and same_origin(origins[0], named[0])
    else:
        # Browsers always send Origin or Sec-Fetch-Site with these; scripts send neither.
        allowed = headers.get("sec-fetch-site", "same-origin") == "same-origin"
    return None if allowed else Refusal(403, "requests from other sites are not accepted")


def hostname(host: str) -> str:
    """The name in a ``Host`` header, in lower case, without its port; empty if malformed."""
    try:
        parts = urlsplit(f"//{host}")
        _ = parts.port
    except ValueError:
        return ""
    malformed = parts.username is not None or parts.path or parts.query or parts.fragment
    return "" if malformed else parts.hostname or ""


def same_origin(origin: str, host: str) -> bool:
    """Whether a page of this origin was served under this ``Host`` header."""
    return origin.lower() in (f"http://{host.lower()}", f"https://{host.lower()}")


def _with_headers(send: Send) -> Send:
    async def send_with_headers(message: Message) -> None:
        if message["type"] in ("http.response.start", "websocket.http.response.start"):
            headers = MutableHeaders(scope=message)
            for name, value in HEADERS.items():
                headers.setdefault(name, value)
        await send(message)

    return send_with_headers


async def _answer(refusal: Refusal, send: Send) -> None:
    body = json.dumps({"error": "Refused", "detail": refusal.detail}).encode()
    headers = [(b"content-type", b"application/json")]
    await send({"type": "http.response.start", "status": refusal.status, "headers": headers})
    await send({"type": "http.response.body", "body": body})
