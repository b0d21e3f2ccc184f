"""Loopback addresses for captures of tests, so that parallel tests do not receive each other's
packets.
"""

from __future__ import annotations

import secrets


def an_address() -> str:
    """A random address of the loopback network, so that parallel tests do not share it."""
    return ".".join(["127", *(str(secrets.randbelow(250) + 2) for _ in range(3))])
