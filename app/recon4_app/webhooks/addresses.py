"""Where webhooks may go: the internet, and networks that the settings name.

An address that an admin typed, or a name that its owner points elsewhere later, must not make the
server call what only the server can reach: itself, the rig, routers, the metadata of a cloud. So
every connection goes to an address that was judged, never to a name.
"""

from __future__ import annotations

import asyncio
import ipaddress
import socket
from collections.abc import Sequence
from dataclasses import dataclass
from urllib.parse import urlsplit

from recon4.errors import ConfigError
from recon4.locales.coded import CodedText
from recon4_app.settings import Network
from recon4_app.webhooks.tuning import WEBHOOKS

IpAddress = ipaddress.IPv4Address | ipaddress.IPv6Address
_NAT64 = ipaddress.IPv6Network("64:ff9b::/96")


class NotReachable(Exception):
    """An address to which nothing is posted, or that does not answer; the message says why."""


@dataclass(frozen=True, slots=True)
class Target:
    """An address to post to, taken apart."""

    secure: bool
    host: str
    """Name or address, without brackets."""
    port: int
    path: str
    """Path and query."""
    authority: str
    """Value of the header ``Host``."""


def target_of(url: str) -> Target:
    """An address, taken apart.

    Raises:
        ConfigError: If it is not one to post to.
    """
    try:
        parts = urlsplit(url)
        port = parts.port
    except ValueError as error:
        raise ConfigError(CodedText("webhook-url", detail=str(error))) from error
    plain = url.isascii() and url.isprintable() and " " not in url
    if parts.scheme not in ("http", "https") or not parts.hostname or not plain:
        raise ConfigError(CodedText("webhook-url-malformed"))
    if parts.username is not None or parts.fragment:
        raise ConfigError(CodedText("webhook-url-parts"))
    if len(url) > WEBHOOKS.max_url:
        raise ConfigError(CodedText("webhook-url-long", limit=WEBHOOKS.max_url))
    secure = parts.scheme == "https"
    path = (parts.path or "/") + (f"?{parts.query}" if parts.query else "")
    usual = socket.getservbyname("https" if secure else "http")
    return Target(secure, parts.hostname, port or usual, path, parts.netloc)


async def address_of(target: Target, networks: Sequence[Network]) -> str:
    """The address of a host, of those that may be called.

    Args:
        target: The host.
        networks: Those that may be called though they are not of the internet, also without TLS.

    Raises:
        NotReachable: If the name is not known, or none of its addresses may be called.
    """
    try:
        found = await asyncio.get_running_loop().getaddrinfo(
            target.host, target.port, type=socket.SOCK_STREAM
        )
    except (OSError, UnicodeError) as error:
        text = CodedText("host-unknown", host=target.host, reason=str(error))
        raise NotReachable(text) from error
    addresses = [ipaddress.ip_address(str(one[4][0]).partition("%")[0]) for one in found]
    for address in addresses:
        if _is_named(address, networks) or (target.secure and is_public(address)):
            return str(address)
    if any(is_public(address) for address in addresses):
        raise NotReachable(CodedText("host-needs-https", host=target.host))
    shown = ", ".join(dict.fromkeys(map(str, addresses)))
    raise NotReachable(CodedText("host-not-public", host=target.host, addresses=shown))


def is_public(address: IpAddress) -> bool:
    """Whether an address is of the internet, and so are those that are written within it."""
    within = _within(address)
    return address.is_global and not address.is_multicast and (within is None or is_public(within))


def _within(address: IpAddress) -> IpAddress | None:
    """The IPv4 address to which an IPv6 address leads through a gateway; None = there is none."""
    if address.version == 4:
        return None
    teredo = address.teredo[1] if address.teredo else None
    nat64 = ipaddress.IPv4Address(address.packed[-4:]) if address in _NAT64 else None
    return address.ipv4_mapped or address.sixtofour or teredo or nat64


def _is_named(address: IpAddress, networks: Sequence[Network]) -> bool:
    mapped = address.ipv4_mapped if address.version == 6 else None
    return any((mapped or address) in network for network in networks)
