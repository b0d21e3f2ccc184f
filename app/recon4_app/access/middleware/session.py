"""Session middleware: requires a session, and ends requests that outlive their session."""

from __future__ import annotations

import asyncio
import hmac
import re
from dataclasses import dataclass
from urllib.parse import quote

from starlette.datastructures import Headers
from starlette.types import ASGIApp, Message, Receive, Scope, Send

from recon4.locales.coded import CodedText
from recon4_app.access.login.login_backoff import TokenBuckets
from recon4_app.access.login.login_service import Access
from recon4_app.access.login.sessions import AuthenticatedSession, Session, form_token
from recon4_app.access.middleware.rejection import Rejection, note
from recon4_app.access.people import NOBODY, SAFE_METHODS, Role
from recon4_app.access.tuning import GUEST_LINK, SESSION_WATCH
from recon4_app.network.behind import prefix_of, public_path, route_path

FORM_HEADER = "X-Recon4-Token"

PAIRING = frozenset({"/pair", "/api/pairing/redeem", "/api/pairing/requests", "/api/pairing/claim"})
GUESTS = frozenset({"/guest", "/api/guests/open"})
OPEN_PATHS = PAIRING | GUESTS | {"/login", "/api/login", "/api/setup", "/healthz", "/metrics"}
"""Paths answered without a session, besides the files of `OPEN_FOLDER`; tested."""
OPEN_FOLDER = "/web/"

MCP_PATH = "/mcp"
"""Where assistants are answered."""

TOKEN = re.compile(r"[A-Za-z0-9_-]{43}")


@dataclass(frozen=True, slots=True)
class CookieNames:
    """Cookies of this server; servers on other paths of the host have others."""

    session: str
    browser: str
    path: str
    """Path below which browsers send them."""


def cookie_names(prefix: str) -> CookieNames:
    """The cookies of a server.

    Browsers accept a ``__Host-`` cookie only over TLS, for this host alone and its root path, a
    ``__Secure-`` cookie only over TLS. Below a prefix the path alone is not enough: a server at
    ``/maps/old/`` is sent the cookies of ``/maps/``, too.

    Args:
        prefix: As ``/recon4``; empty = the server has the host for itself.
    """
    if not prefix:
        return CookieNames("__Host-sid", "__Host-browser", "/")
    place = prefix[1:].replace("/", "~")
    return CookieNames(f"__Secure-sid-{place}", f"__Secure-browser-{place}", f"{prefix}/")


class SessionMiddleware:
    """Finds the session of each request; used where there is a login."""

    def __init__(self, app: ASGIApp) -> None:
        self._app = app
        self._requests = TokenBuckets(burst=60, per_s=20.0)
        self._guests = TokenBuckets(burst=GUEST_LINK.burst, per_s=GUEST_LINK.per_s)

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        if scope["type"] not in ("http", "websocket"):
            await self._app(scope, receive, send)
            return
        access: Access = scope["app"].state.parts.access
        token, program = presented(scope)
        authenticated = await find(access, token, program=program)
        state = scope["state"]
        state.update(person=NOBODY, signed_in_s=float("inf"), session=None)
        if authenticated is not None:
            session = authenticated.session
            signed_in_s = float("inf") if program else access.sessions.age_s(session)
            state.update(person=authenticated.person, signed_in_s=signed_in_s, session=session)
            state["form_token"] = form_token(token)
        if (rejection := self._judge(scope, authenticated)) is not None:
            if rejection.status == 403:
                await note(scope, rejection)
            await rejection.answer(scope, receive, send)
        elif authenticated is None:
            await self._app(scope, receive, send)
        else:
            if access.sessions.unnoted(authenticated.session):
                await asyncio.to_thread(access.sessions.note, authenticated.session)
            await SessionMonitor(access, authenticated.session, scope).run(self._app, receive, send)

    def _judge(self, scope: Scope, authenticated: AuthenticatedSession | None) -> Rejection | None:
        path = route_path(scope)
        stranger = authenticated is None or authenticated.person.role is Role.GUEST
        if path.startswith(OPEN_FOLDER) or (stranger and path in OPEN_PATHS):
            return None
        if authenticated is None:
            return sign_in_first(scope)
        if wait_s := self._wait_s(authenticated.session):
            retry = {"Retry-After": str(int(wait_s) + 1)}
            return Rejection(429, "TooMany", CodedText("requests-too-many"), retry)
        by_page = not authenticated.session.access_token  # a page of another site has no token
        if by_page and scope["type"] == "http" and scope["method"] not in SAFE_METHODS:
            given = Headers(scope=scope).get(FORM_HEADER, "")
            if not hmac.compare_digest(given.encode(), scope["state"]["form_token"].encode()):
                detail = CodedText("token-stale", header=FORM_HEADER)
                return Rejection(403, "StaleToken", detail)
        return None

    def _wait_s(self, session: Session) -> float:
        """How long a request must wait; all guests of a link wait together."""
        wait_s = self._requests.take(session.id)
        if not wait_s and session.guest_link:
            wait_s = self._guests.take(session.guest_link)
        return wait_s


class SessionMonitor:
    """Runs the application for one request, and ends it if it outlives its session."""

    def __init__(self, access: Access, session: Session, scope: Scope) -> None:
        self._access, self._session, self._scope = access, session, scope
        self._begun = self._ended = self._sized = False
        self._active = False

    async def run(self, app: ASGIApp, receive: Receive, send: Send) -> None:
        """Run the application until it is done or the session has ended."""

        async def receive_and_note() -> Message:
            message = await receive()
            self._active |= message["type"] == "websocket.receive"
            return message

        async def send_and_note(message: Message) -> None:
            self._notice(message)
            await send(message)

        running = asyncio.ensure_future(app(self._scope, receive_and_note, send_and_note))
        try:
            while not (await asyncio.wait({running}, timeout=SESSION_WATCH.look_again_s))[0]:
                if self._begun and not await asyncio.to_thread(self._still):
                    await cancelled(running)
                    await self._end(send)
                    return
        finally:
            running.cancel()
        await running

    def _still(self) -> bool:
        """Whether the session is still valid; messages of a browser keep it from going idle."""
        session = self._access.sessions.alive(self._session.id)
        if session is not None and self._active and self._access.sessions.unnoted(session):
            self._active = False
            self._access.sessions.note(session)
        return session is not None

    def _notice(self, message: Message) -> None:
        kind = message["type"]
        if kind == "http.response.start":
            names = {name.lower() for name, _ in message.get("headers", [])}
            self._begun, self._sized = True, b"content-length" in names
        elif kind == "websocket.accept":
            self._begun = True
        elif kind == "websocket.close" or (
            kind == "http.response.body" and not message.get("more_body", False)
        ):
            self._ended = True

    async def _end(self, send: Send) -> None:
        if self._ended:
            return
        if self._scope["type"] == "websocket":
            await send({"type": "websocket.close", "code": 1008, "reason": "signed out"})
        elif not self._sized:  # else the server closes the connection: the file is incomplete
            await send({"type": "http.response.body", "body": b"", "more_body": False})


async def cancelled(running: asyncio.Future[None]) -> None:
    """Cancel a task until it has ended: a library may lose a cancellation."""
    while not running.done():
        running.cancel()
        await asyncio.wait({running}, timeout=SESSION_WATCH.cancel_again_s)


async def find(access: Access, token: str, *, program: bool) -> AuthenticatedSession | None:
    """The session of a token; the database is queried in a thread.

    Args:
        access: Has the sessions.
        token: As it was presented.
        program: Whether it came in the header of programs. A cookie never opens what a program's
            token does, nor the other way round.
    """
    if not TOKEN.fullmatch(token):
        return None
    found = access.sessions.cached_sessions(token) or await asyncio.to_thread(
        access.sessions.find, token
    )
    return found if found and bool(found.session.access_token) is program else None


def presented(scope: Scope) -> tuple[str, bool]:
    """The token of a request, and whether it is in the header of programs.

    The cookie of a request with a bearer token is not read. Other schemes are for a proxy.
    """
    given = [line.split(maxsplit=1) for line in Headers(scope=scope).getlist("authorization")]
    bearers = [words for words in given if words and words[0].lower() == "bearer"]
    if not bearers:
        return cookie(scope, cookie_names(prefix_of(scope)).session), False
    return (bearers[0][-1].strip() if len(bearers) == 1 else ""), True


def cookie(scope: Scope, name: str) -> str:
    """The value of a cookie; empty if there is none, or more than one."""
    pairs = (
        pair.strip().partition("=")
        for line in Headers(scope=scope).getlist("cookie")
        for pair in line.split(";")
    )
    values = [value for key, _, value in pairs if key == name]
    return values[0] if len(values) == 1 else ""


def sign_in_first(scope: Scope) -> Rejection:
    """Redirect a browser to the login; answer a program with status 401."""
    accept, path = Headers(scope=scope).get("accept", ""), route_path(scope)
    page = scope["type"] == "http" and scope["method"] == "GET" and "text/html" in accept
    if not page:
        headers = {"WWW-Authenticate": "Bearer"} if path == MCP_PATH else {}
        return Rejection(401, "Unknown", CodedText("sign-in-first"), headers)
    # A paired phone knows no password: the pairing page offers both.
    there = "/pair" if path == "/live" else f"/login#next={quote(path)}"
    return Rejection(
        303, "Unknown", CodedText("sign-in-page"), {"Location": public_path(scope, there)}
    )
