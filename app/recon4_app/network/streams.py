"""Limits of open streams: in all, per person, per address.

A stream is a long-lived connection: live map, events, viewer. Some slots are reserved for people
who may run a capture.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass

from starlette.requests import HTTPConnection

from recon4.locales.coded import CodedText
from recon4_app.access.login.login_backoff import network
from recon4_app.access.people import LOCAL, READER, Permission, person
from recon4_app.errors import TooMany
from recon4_app.network.tuning import STREAMS


@dataclass(frozen=True, slots=True, kw_only=True)
class StreamLimits:
    """Limits of open streams of a kind."""

    max_streams: int
    """Total."""
    max_per_person: int
    """Per person; not without login, where all callers are the same person."""
    max_per_address: int
    """Per address, of people who may not run a capture; not without login."""
    reserved_for_capture: int
    """Part of ``max_streams`` reserved for people who may run a capture."""


class Streams:
    """The open streams of a kind."""

    def __init__(self, what: str, limits: StreamLimits) -> None:
        self._what, self._limits = what, limits
        self._people: Counter[str] = Counter()
        self._addresses: Counter[str] = Counter()
        self.open = 0
        """Open streams."""
        self.refused = 0
        """Rejected streams since the server started."""

    @contextmanager
    def place(self, connection: HTTPConnection) -> Iterator[None]:
        """Take a slot for a request or WebSocket.

        Raises:
            TooMany: If there is none.
        """
        name = person(connection).name
        address = network(connection.client.host if connection.client else "")
        if (reason := self._rejection(connection, name, address)) is not None:
            self.refused += 1
            raise TooMany(reason, retry_after_s=STREAMS.retry_after_s)
        self.open += 1
        self._people[name] += 1
        self._addresses[address] += 1
        try:
            yield
        finally:
            self.open -= 1
            _leave(self._people, name)
            _leave(self._addresses, address)

    def _rejection(self, connection: HTTPConnection, name: str, address: str) -> CodedText | None:
        who, limits = person(connection), self._limits
        runs_captures = who.may(Permission.CAPTURE)
        available = limits.max_streams - (0 if runs_captures else limits.reserved_for_capture)
        if self.open >= available:
            return CodedText("streams-full", open=self.open, what=self._what, limit=available)
        if who in (LOCAL, READER):
            return None
        if self._people[name] >= limits.max_per_person:
            return CodedText("own-streams-full", limit=limits.max_per_person, what=self._what)
        if not runs_captures and self._addresses[address] >= limits.max_per_address:
            limit = limits.max_per_address
            return CodedText("address-streams-full", limit=limit, what=self._what)
        return None


def _leave(counts: Counter[str], key: str) -> None:
    counts[key] -= 1
    if not counts[key]:
        del counts[key]  # names of strangers are not stored
