"""A server behind a reverse proxy on the same computer, which does TLS (``--behind URL``).

The address may have a path (``https://example.org/recon4/``), the prefix: the proxy then gives the
server what is below it. Inside the server paths begin after the prefix (`route_path`); only what
browsers read has it (`public_path`, `recon4_app.pages`, ``web/shared/address.js``).
"""

from __future__ import annotations

import ipaddress
import re
from dataclasses import dataclass
from urllib.parse import urlsplit

from starlette.datastructures import Headers
from starlette.types import ASGIApp, Receive, Scope, Send

from recon4.errors import ConfigError
from recon4.locales.coded import CodedText

_SECURE = {"http": "https", "ws": "wss"}
_PREFIX = re.compile(r"(/(?!\.\.?(/|$))[A-Za-z0-9._-]+)*")
"""Neither quoted in addresses nor in names of cookies."""


@dataclass(frozen=True, slots=True)
class PublicAddress:
    """Where browsers reach a server that is behind a proxy."""

    url: str
    """As ``https://maps.example.org/``, with a slash at its end."""
    host: str
    """Its host name, lower case."""
    prefix: str = ""
    """Its path without the slash at the end, as ``/recon4``; empty = the server has the host."""

    def seen_through(self, scope: Scope) -> Scope:
        """A request as the proxy received it: over TLS, from the client's address, with the prefix.

        Forwarded headers count only from the proxy, which is on this computer: every other
        connection keeps its own address. A proxy may have removed the prefix.
        """
        path = scope["path"]
        if not f"{path}/".startswith(f"{self.prefix}/"):
            path = self.prefix + path
        scope = {**scope, "path": path, "root_path": self.prefix}
        client = scope.get("client")
        if client is None or not _is_loopback(client[0]):
            return scope
        # the proxy appends the address it saw; what is before that is the client's claim
        named = Headers(scope=scope).getlist("x-forwarded-for")
        last = named[-1].rpartition(",")[2].strip() if named else ""
        seen = (last, 0) if _is_address(last) else client
        return {**scope, "scheme": _SECURE.get(scope["scheme"], scope["scheme"]), "client": seen}


def public_address(url: str) -> PublicAddress:
    """The address in ``--behind``.

    Raises:
        ConfigError: If it is not the https address of a host, or its path cannot be a prefix.
    """
    try:
        parts = urlsplit(url)
        _ = parts.port
    except ValueError as error:
        raise ConfigError(CodedText("behind-invalid", url=url[:200], why=str(error))) from None
    if parts.scheme != "https" or not parts.hostname or parts.username or parts.query:
        raise ConfigError(CodedText("behind-address", url=url[:200]))
    prefix = parts.path.removesuffix("/")
    if not _PREFIX.fullmatch(prefix) or parts.fragment:
        raise ConfigError(CodedText("behind-path", hostname=parts.hostname, url=url[:200]))
    url = f"https://{parts.netloc.lower()}{prefix}/"
    return PublicAddress(url, parts.hostname.lower(), prefix)


class ProxyMiddleware:
    """Shows the application each request as the proxy received it. The outermost middleware."""

    def __init__(self, app: ASGIApp, *, address: PublicAddress) -> None:
        self._app, self._address = app, address

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Run the application for one request."""
        if scope["type"] in ("http", "websocket"):
            # in place: what is outside reads the route and the prefix from the same scope
            scope.update(self._address.seen_through(scope))
        await self._app(scope, receive, send)


def prefix_of(scope: Scope) -> str:
    """The prefix of the server that a request came to; empty = it has the host for itself."""
    return str(scope.get("app_root_path", scope.get("root_path", "")))


def route_path(scope: Scope) -> str:
    """The path of a request as the routes name it, without the prefix."""
    return str(scope["path"]).removeprefix(prefix_of(scope))


def public_path(scope: Scope, path: str) -> str:
    """A path of this server as browsers name it, with the prefix; ``path`` begins with a slash."""
    return prefix_of(scope) + path


def _is_address(text: str) -> bool:
    try:
        ipaddress.ip_address(text)
    except ValueError:
        return False
    return True


def _is_loopback(text: str) -> bool:
    return _is_address(text) and ipaddress.ip_address(text).is_loopback
