"""Names and addresses of this computer."""

from __future__ import annotations

import fcntl
import re
import socket
import struct

LOOPBACK = frozenset({"127.0.0.1", "localhost", "::1"})
"""Names for this computer on itself; a forwarded port (ssh -L) keeps them."""

NAME = re.compile(r"[a-z0-9]([a-z0-9-]{0,62}[a-z0-9])?(\.[a-z0-9]([a-z0-9-]{0,62}[a-z0-9])?)*")
GET_ADDRESS = 0x8915
"""SIOCGIFADDR of Linux."""


def own_names() -> frozenset[str]:
    """Host names and addresses this computer has, loopback included."""
    name = socket.gethostname().lower()
    short = name.split(".")[0]
    candidates = {name, short, f"{short}.local"}
    names = {one for one in candidates if NAME.fullmatch(one)}
    return frozenset(names | own_addresses()) | LOOPBACK


def own_addresses() -> set[str]:
    """IPv4 addresses of all interfaces that have one, and the IPv6 address used for going out."""
    found = set()
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as asking:
        for _, interface in socket.if_nameindex():
            request = struct.pack("256s", interface.encode()[:15])
            try:
                answer = fcntl.ioctl(asking, GET_ADDRESS, request)
            except OSError:
                continue  # down, without address, or not Linux
            found.add(socket.inet_ntoa(answer[20:24]))
    for family, far in ((socket.AF_INET, "192.0.2.1"), (socket.AF_INET6, "2001:db8::1")):
        with socket.socket(family, socket.SOCK_DGRAM) as going_out:
            try:
                going_out.connect((far, 9))  # sends nothing: the kernel only selects a route
            except OSError:
                continue
            found.add(going_out.getsockname()[0])
    return found
