"""Checks of host names and origins, and security headers. Pure ASGI, before the application.

A page of another site in a user's browser can send requests here and open WebSockets. A name
that points to this computer can even make them look same-site (DNS rebinding). So the host must be
one of ours, and every change must come from our own page. With a login, only the login itself is
answered without a session.
"""

from __future__ import annotations

from dataclasses import dataclass
from urllib.parse import urlsplit

from starlette.datastructures import Headers, MutableHeaders
from starlette.types import ASGIApp, Message, Receive, Scope, Send

from recon4.locales.coded import CodedText
from recon4_app.access.middleware.rejection import Rejection, note
from recon4_app.access.middleware.session import SessionMiddleware
from recon4_app.access.people import NOBODY, SAFE_METHODS, Person
from recon4_app.network.behind import route_path

PAGE_POLICY = (
    "default-src 'self'; img-src 'self' data: blob:; object-src 'none'; base-uri 'none'; "
    "form-action 'self'; frame-ancestors 'self'"
)
"""Content security policy of responses that do not set their own."""

HEADERS = {
    "Content-Security-Policy": PAGE_POLICY,
    "X-Content-Type-Options": "nosniff",
    "Referrer-Policy": "no-referrer",
    "Cross-Origin-Opener-Policy": "same-origin",
    "Cross-Origin-Resource-Policy": "same-origin",
    "Permissions-Policy": "camera=(), microphone=(), geolocation=()",
    "Cache-Control": "no-cache",
}
PRIVATE = {"Cache-Control": "no-store"}
"""Responses of the API are cached by no browser where people sign in."""
PINNED = {"Strict-Transport-Security": "max-age=31536000"}
"""Only with a certificate that browsers trust: with another they would lock people out."""


@dataclass(frozen=True, slots=True)
class Hosts:
    """``Host`` headers the server accepts."""

    names: frozenset[str]
    """Host names and addresses, lower case, without port."""
    by_address: bool = False
    """Also accept the address a connection came to, which no foreign name can be."""

    def accepts(self, name: str, scope: Scope) -> bool:
        """Whether a request with this host name is accepted."""
        came_to = (scope.get("server") or ("",))[0]
        return name in self.names or (self.by_address and bool(name) and name == came_to)


class OriginMiddleware:
    """Rejects foreign hosts and origins and callers without a session; adds security headers."""

    def __init__(
        self,
        app: ASGIApp,
        *,
        hosts: Hosts,
        local: Person | None,
        pinned: bool = False,
    ) -> None:
        """Wrap an application.

        Args:
            app: The application.
            hosts: Host names it accepts.
            local: Who every caller is; None = people sign in.
            pinned: Whether browsers may insist on TLS from now on.
        """
        self._app = app if local else SessionMiddleware(app)
        self._hosts = hosts
        self._local = local or NOBODY
        self._headers = HEADERS | (PINNED if pinned else {})

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        if scope["type"] not in ("http", "websocket"):
            await self._app(scope, receive, send)
            return
        send = self._with_headers(scope, send)
        scope.setdefault("state", {}).update(person=self._local, signed_in_s=0.0)
        if (rejection := judge(scope, self._hosts)) is None:
            await self._app(scope, receive, send)
        else:
            await note(scope, rejection)
            await rejection.answer(scope, receive, send)

    def _with_headers(self, scope: Scope, send: Send) -> Send:
        private = self._local is NOBODY and route_path(scope).startswith("/api/")
        wanted = self._headers | (PRIVATE if private else {})

        async def send_with_headers(message: Message) -> None:
            if message["type"] in ("http.response.start", "websocket.http.response.start"):
                headers = MutableHeaders(scope=message)
                for name, value in wanted.items():
                    headers.setdefault(name, value)
            await send(message)

        return send_with_headers


def judge(scope: Scope, hosts: Hosts) -> Rejection | None:
    """The rejection of a request, None if it may pass.

    Args:
        scope: The ASGI scope of a request or WebSocket.
        hosts: The host names the server accepts.
    """
    headers = Headers(scope=scope)
    named = headers.getlist("host")
    if len(named) != 1 or not hosts.accepts(hostname(named[0]), scope):
        return Rejection(400, "Refused", CodedText("other-host"))
    origins = headers.getlist("origin")
    secure = scope["scheme"] in ("https", "wss")
    if scope["type"] == "websocket" or origins:
        allowed = len(origins) == 1 and same_origin(origins[0], named[0], secure=secure)
    else:
        # Browsers always send Origin or Sec-Fetch-Site with these; scripts send neither.
        allowed = headers.get("sec-fetch-site", "same-origin") == "same-origin"
    if scope["type"] == "http" and scope["method"] in SAFE_METHODS:
        allowed = allowed or _is_navigation(scope, headers)
    if allowed:
        return None
    return Rejection(403, "Refused", CodedText("other-site"))


def _is_navigation(scope: Scope, headers: Headers) -> bool:
    """Whether a request that another site caused is a person who follows a link to a page.

    A page of another site may not make the server compute: an image, a frame, a download or a
    redirect to ``/api/`` would start an export, and cookies are not even needed on loopback.
    Browsers without Sec-Fetch-Site (before 2023) send neither header; nor do scripts.
    """
    site = headers.get("sec-fetch-site")
    if site is None:
        return not headers.getlist("origin")
    if site in ("same-origin", "none"):
        return True
    link = headers.get("sec-fetch-mode") == "navigate"
    page = headers.get("sec-fetch-dest") == "document"
    return link and page and not route_path(scope).startswith("/api/")


def hostname(host: str) -> str:
    """The name in a ``Host`` header, in lower case, without its port; empty if malformed."""
    try:
        parts = urlsplit(f"//{host}")
        _ = parts.port
    except ValueError:
        return ""
    malformed = parts.username is not None or parts.path or parts.query or parts.fragment
    return "" if malformed else parts.hostname or ""


def same_origin(origin: str, host: str, *, secure: bool) -> bool:
    """Whether a page of this origin was served under this ``Host`` header, by this protocol."""
    return origin.lower() == f"{'https' if secure else 'http'}://{host.lower()}"
