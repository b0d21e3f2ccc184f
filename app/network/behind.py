"""A server behind a reverse proxy on the same computer, which does TLS (``--behind URL``)."""

from __future__ import annotations

import ipaddress
from dataclasses import dataclass
from urllib.parse import urlsplit

from starlette.datastructures import Headers
from starlette.types import Scope

from recon4.errors import ConfigError

_SECURE = {"http": "https", "ws": "wss"}


@dataclass(frozen=True, slots=True)
class PublicAddress:
    """Where browsers reach a server that is behind a proxy."""

    url: str
    """As ``https://maps.example.org/``."""
    host: str
    """Its host name, lower case."""

    def seen_through(self, scope: Scope) -> Scope:
        """A request as the proxy received it: over TLS, and from the client's address.

        Forwarded headers count only from the proxy, which is on this computer: every other
        connection keeps its own address.
        """
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
        ConfigError: If it is not the https address of a host, without a path.
    """
    try:
        parts = urlsplit(url)
        _ = parts.port
    except ValueError as error:
        raise ConfigError(f"--behind: {url!r:.200} is no address: {error}") from None
    if parts.scheme != "https" or not parts.hostname or parts.username or parts.query:
        raise ConfigError(
            f"--behind must be the address that browsers use, as https://maps.example.org/, got "
            f"{url!r:.200}"
        )
    if parts.path not in ("", "/") or parts.fragment:
        raise ConfigError(
            f"--behind: the pages need a host name of their own, not the path {parts.path!r:.100}: "
            f"give the server a name such as https://maps.{parts.hostname}/"
        )
    return PublicAddress(f"https://{parts.netloc.lower()}/", parts.hostname.lower())


def _is_address(text: str) -> bool:
    try:
        ipaddress.ip_address(text)
    except ValueError:
        return False
    return True


def _is_loopback(text: str) -> bool:
    return _is_address(text) and ipaddress.ip_address(text).is_loopback
