"""How many streams may be open: in all, of one person, from one address.

A stream is a connection that stays: live map, events, viewer. Whoever may run a capture finds a
place when others have filled theirs.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass

from starlette.requests import HTTPConnection

from app.access.login.login_backoff import network
from app.access.people import LOCAL, Permission, person
from app.errors import TooMany

TOO_MANY = 4429
"""Close code of a WebSocket that is one too many; the reason says so in words."""
RETRY_AFTER_S = 10.0


@dataclass(frozen=True, slots=True, kw_only=True)
class StreamLimits:
    """How many streams of a kind may be open."""

    most: int
    """In all."""
    per_person: int
    """Of one person; not where there is no login, as everybody is the same person there."""
    per_address: int
    """From one address, of people who may not run a capture; not where there is no login."""
    reserved: int
    """Of ``most``, only for people who may run a capture."""


class Streams:
    """The open streams of a kind."""

    def __init__(self, what: str, limits: StreamLimits) -> None:
        self._what, self._limits = what, limits
        self._people: Counter[str] = Counter()
        self._addresses: Counter[str] = Counter()
        self.open = 0
        """In all."""
        self.refused = 0
        """Since the server started."""

    @contextmanager
    def place(self, connection: HTTPConnection) -> Iterator[None]:
        """Hold a place for a request or WebSocket.

        Raises:
            TooMany: If there is none, in words.
        """
        name = person(connection).name
        address = network(connection.client.host if connection.client else "")
        if (words := self._refusal(connection, name, address)) is not None:
            self.refused += 1
            raise TooMany(words, retry_after_s=RETRY_AFTER_S)
        self.open += 1
        self._people[name] += 1
        self._addresses[address] += 1
        try:
            yield
        finally:
            self.open -= 1
            _leave(self._people, name)
            _leave(self._addresses, address)

    def _refusal(self, connection: HTTPConnection, name: str, address: str) -> str | None:
        who, limits = person(connection), self._limits
        runs_captures = who.may(Permission.CAPTURE)
        most = limits.most if runs_captures else limits.most - limits.reserved
        if self.open >= most:
            return f"{self.open} {self._what} are open, {most} are possible: close one, try again"
        if who is LOCAL:
            return None
        if self._people[name] >= limits.per_person:
            return f"you have {limits.per_person} {self._what} open: close one and try again"
        if not runs_captures and self._addresses[address] >= limits.per_address:
            return f"your address has {limits.per_address} {self._what} open: close one, try again"
        return None


def _leave(counts: Counter[str], key: str) -> None:
    counts[key] -= 1
    if not counts[key]:
        del counts[key]  # names of strangers are not kept
