"""Joins the IP fragments of UDP datagrams that are larger than a packet of the network."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

_LONGEST_NS = 5_000_000_000
"""Fragments of one datagram follow each other at once; numbers of datagrams repeat later."""
_MOST_OPEN = 256
"""Datagrams of which fragments are missing that are kept waiting."""
_MOST_BYTES = 65535
"""Of a datagram."""
_UDP_HEADER = 8


@dataclass(frozen=True, slots=True, kw_only=True)
class Fragment:
    """One IP fragment."""

    t_ns: int
    """Time of capture [ns]."""
    source: int
    destination: int
    """IPv4 addresses."""
    number: int
    """Of the datagram, as the sender counts them; it repeats after 65 536."""
    offset: int
    """Of its data in the datagram [bytes]."""
    is_last: bool
    data: bytes

    @property
    def key(self) -> tuple[int, int, int]:
        """What fragments of one datagram have in common."""
        return self.source, self.destination, self.number


@dataclass(frozen=True, slots=True)
class JoinedDatagram:
    """A datagram whose fragments are all there."""

    t_ns: int
    """Capture of the fragment that completed it [ns]."""
    source: int
    port: int
    payload: bytes


@dataclass(slots=True)
class _Open:
    """The fragments of one datagram so far, by offset."""

    t_ns: int
    parts: dict[int, bytes] = field(default_factory=dict)
    size: int = -1
    """Of the datagram; -1 = the last fragment is missing."""

    def joined(self) -> bytes:
        """The datagram with its UDP header; empty = a part is missing."""
        if self.size < 0 or sum(map(len, self.parts.values())) < self.size:
            return b""
        data, at = [], 0
        for offset, part in sorted(self.parts.items()):
            if offset != at:
                return b""
            data.append(part)
            at += len(part)
        return b"".join(data) if at == self.size else b""


class IpFragments:
    """Waits for all fragments of each datagram; the lost ones are given by port."""

    def __init__(self) -> None:
        """Start with nothing open."""
        self._open: dict[tuple[int, int, int], _Open] = {}
        self._lost: list[int] = []

    def push(self, fragment: Fragment) -> Iterator[JoinedDatagram]:
        """The datagram that a fragment completes, if it does."""
        if fragment.offset + len(fragment.data) > _MOST_BYTES:
            self._lost.append(-1)
            return
        key = fragment.key
        waiting = self._open.get(key)
        if waiting is not None and abs(fragment.t_ns - waiting.t_ns) > _LONGEST_NS:
            self._give_up(key)
            waiting = None
        if waiting is None:
            self._make_room()
            waiting = self._open[key] = _Open(fragment.t_ns)
        waiting.parts[fragment.offset] = fragment.data
        if fragment.is_last:
            waiting.size = fragment.offset + len(fragment.data)
        data = waiting.joined()
        if not data:
            return
        del self._open[key]
        length = int.from_bytes(data[4:6], "big") or len(data)  # 0: left to the network card
        if not _UDP_HEADER <= length <= len(data):
            self._lost += [-1] * len(waiting.parts)
            return
        port = int.from_bytes(data[2:4], "big")
        yield JoinedDatagram(fragment.t_ns, fragment.source, port, data[_UDP_HEADER:length])

    def end(self) -> None:
        """Give up what is incomplete at the end of a file."""
        for key in list(self._open):
            self._give_up(key)

    def lost(self) -> NDArray[np.int64]:
        """Fragments given up since the last call: the port in a first one, else -1, (N,)."""
        lost, self._lost = self._lost, []
        return np.array(lost, np.int64)

    def _make_room(self) -> None:
        if len(self._open) >= _MOST_OPEN:
            self._give_up(next(iter(self._open)))

    def _give_up(self, key: tuple[int, int, int]) -> None:
        for offset, part in self._open.pop(key).parts.items():
            named = offset == 0 and len(part) >= _UDP_HEADER
            self._lost.append(int.from_bytes(part[2:4], "big") if named else -1)
