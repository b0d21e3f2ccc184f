"""UDP datagrams of a capture file, streamed in batches; a cut file is read up to the cut."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from recon4.model.trajectory import Times
from recon4.recording.report import ImportReport


@dataclass(frozen=True, slots=True, eq=False)
class Datagrams:
    """Some UDP datagrams in the order of the file."""

    t_ns: Times
    """Times of capture [ns], (N,)."""
    source: NDArray[np.uint32]
    """IPv4 address of the sender, `address_text` spells it, (N,)."""
    port: NDArray[np.uint16]
    """Destination port, (N,)."""
    length: NDArray[np.int64]
    """Bytes of payload, (N,)."""
    start: NDArray[np.int64]
    """Where each payload starts in ``buffer``, (N,)."""
    buffer: NDArray[np.uint8]
    """Bytes of the file around the payloads, at least one packet longer than the last, (B,)."""

    def __len__(self) -> int:
        return len(self.t_ns)

    def payloads(self, rows: NDArray[np.integer], size: int) -> NDArray[np.uint8]:
        """First ``size`` bytes of the payloads of some rows, (M, size); zeros beyond the end."""
        raise NotImplementedError


def address_text(source: int) -> str:
    """``192.168.1.201`` for 0xC0A801C9."""
    return ".".join(str((int(source) >> shift) & 255) for shift in (24, 16, 8, 0))


def read_pcap(path: Path, report: ImportReport) -> Iterator[Datagrams]:
    """Stream the UDP datagrams of a pcap (µs or ns, either byte order) or pcapng file.

    Other packets, IP fragments and records that do not fit are counted in the report. A file
    that ends inside a record yields all before it, and ``report.outcome`` becomes ``lossy``.

    Raises:
        UnknownFormat: If the file is not a capture of Ethernet or raw IP packets.
        EmptyRecording: If it holds no packet at all.
    """
    raise NotImplementedError
