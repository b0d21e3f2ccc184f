"""Limits of orders."""

from __future__ import annotations

from msgspec import Struct


class OrderLimits(Struct, frozen=True, kw_only=True):
    """What an order may be, and how long it may take."""

    message_bytes: int = 32 << 20
    """Of one message; a million tiles need half of it."""
    items: int = 1 << 20
    """Parts of one order."""
    number: int = 1 << 31
    """Numbers of a part are smaller."""
    depth: int = 4
    """Folders between the project and the files of an order, these included."""
    name: int = 160
    """Letters of a folder's name."""
    failure: int = 500
    """Letters of the reason of a failure."""
    reply_bytes: int = 1 << 14
    """Of a maker."""
    said_bytes: int = 1 << 12
    """What a maker writes beside a reply is kept up to this length."""
    within_s: float = 1800.0
    """Longest time for one part; a maker that takes longer is ended [s]."""
    idle_s: float = 60.0
    """A maker without orders is ended after this long [s]."""
    looks_every_s: float = 1.0
    """Who waits looks this often whether it is to stop [s]."""


ORDERS = OrderLimits()
