"""UDP datagrams in batches, whatever they were read from."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from recon4.model.trajectory import Times

MAX_UDP_BYTES = 65_507
"""Of the contents of a datagram of UDP over IPv4."""


@dataclass(frozen=True, slots=True, eq=False)
class Datagrams:
    """A batch of UDP datagrams in file order."""

    t_ns: Times
    """Times of capture [ns], (N,)."""
    source: NDArray[np.uint32]
    """IPv4 address of the sender, `address_text` spells it, (N,)."""
    port: NDArray[np.uint16]
    """Destination port, (N,)."""
    length: NDArray[np.int64]
    """Bytes of payload, (N,)."""
    start: NDArray[np.int64]
    """Offset of each payload in ``buffer``, (N,)."""
    buffer: NDArray[np.uint8]
    """Bytes that contain the payloads, (B,)."""

    def __len__(self) -> int:
        return len(self.t_ns)

    def payloads(self, rows: NDArray[np.integer], size: int) -> NDArray[np.uint8]:
        """First ``size`` bytes of the payloads of some rows, which are at least that long.

        Returns:
            A copy, (M, size).
        """
        if not len(rows):
            return np.zeros((0, size), np.uint8)
        windows = np.lib.stride_tricks.sliding_window_view(self.buffer, size)
        return windows[self.start[rows]]

    def payload(self, row: int) -> bytes:
        """The whole payload of one row."""
        start = int(self.start[row])
        return self.buffer[start : start + int(self.length[row])].tobytes()

    def take(self, rows: NDArray[np.generic] | slice) -> Datagrams:
        """Some of the datagrams, in the same buffer."""
        return Datagrams(
            self.t_ns[rows],
            self.source[rows],
            self.port[rows],
            self.length[rows],
            self.start[rows],
            self.buffer,
        )

    def compact(self) -> Datagrams:
        """The same in a buffer that holds nothing but their payloads."""
        places = zip(self.start.tolist(), self.length.tolist(), strict=True)
        parts = [self.buffer[at : at + size] for at, size in places]
        buffer = np.concatenate(parts) if parts else self.buffer[:0]
        start = np.cumsum(self.length) - self.length
        return replace(self, start=start, buffer=buffer)


NO_DATAGRAMS = Datagrams(
    np.zeros(0, np.int64),
    np.zeros(0, np.uint32),
    np.zeros(0, np.uint16),
    np.zeros(0, np.int64),
    np.zeros(0, np.int64),
    np.zeros(0, np.uint8),
)


def join_datagrams(parts: Sequence[Datagrams]) -> Datagrams:
    """Batches one after the other."""
    parts = [part for part in parts if len(part)]
    if not parts:
        return NO_DATAGRAMS
    if len(parts) == 1:
        return parts[0]
    before = np.cumsum([0, *(len(part.buffer) for part in parts[:-1])])
    starts = [part.start + offset for part, offset in zip(parts, before.tolist(), strict=True)]
    return Datagrams(
        np.concatenate([part.t_ns for part in parts]),
        np.concatenate([part.source for part in parts]),
        np.concatenate([part.port for part in parts]),
        np.concatenate([part.length for part in parts]),
        np.concatenate(starts),
        np.concatenate([part.buffer for part in parts]),
    )


def datagrams_of(t_ns: Sequence[int], payloads: Sequence[bytes]) -> Datagrams:
    """Payloads that came another way than by a capture, as in messages; sender and port are 0."""
    length = np.array([len(payload) for payload in payloads], np.int64)
    return Datagrams(
        np.array(t_ns, np.int64),
        np.zeros(len(payloads), np.uint32),
        np.zeros(len(payloads), np.uint16),
        length,
        np.cumsum(length) - length,
        np.frombuffer(b"".join(payloads), np.uint8),
    )


def address_text(source: int) -> str:
    """``192.168.1.201`` for 0xC0A801C9."""
    return ".".join(str((int(source) >> shift) & 255) for shift in (24, 16, 8, 0))


def address_number(address: str) -> int:
    """0xC0A801C9 for ``192.168.1.201``."""
    a, b, c, d = (int(part) for part in address.split("."))
    return a << 24 | b << 16 | c << 8 | d
