"""Addresses of this computer for captures of tests, so that tests beside each other never hear
each other.
"""

from __future__ import annotations

import secrets


def an_address() -> str:
    """One of the loopback network that nobody else is likely to use."""
    return ".".join(["127", *(str(secrets.randbelow(250) + 2) for _ in range(3))])
