"""Groups datagrams by arrival time, so that the result is independent of the reads.

A file that grows is read in many small pieces, a finished one in few large ones. What follows
(clocks, order, cutting into frames) gets the same pieces either way.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator

import numpy as np

from recon4.recording.formats.pcap import Datagrams

SLOT_NS = 100_000_000
FIRST_SLOT_NS = 1_000_000_000
"""The first slot is longer, because the clocks of the sensors are compared in it."""
_SET_BACK_NS = 2_000_000_000
"""A datagram this far before the end of its slot means that the clock was set back."""


def in_slots(batches: Iterable[Datagrams]) -> Iterator[Datagrams]:
    """All datagrams in order, in slots of `SLOT_NS` of the recorder's clock."""
    parts: list[Datagrams] = []
    end_ns: int | None = None
    for batch in batches:
        start = 0
        if end_ns is None and len(batch):
            end_ns = int(batch.t_ns[0]) + FIRST_SLOT_NS
        while end_ns is not None and start < len(batch):
            t_ns = batch.t_ns[start:]
            beyond = np.flatnonzero((t_ns >= end_ns) | (t_ns < end_ns - _SET_BACK_NS))
            cut = start + int(beyond[0]) if len(beyond) else len(batch)
            parts.append(_rows(batch, start, cut))
            start = cut
            if len(beyond):
                yield _joined(parts)
                parts = []
                end_ns = (int(batch.t_ns[cut]) // SLOT_NS + 1) * SLOT_NS
    if parts:
        yield _joined(parts)


def _rows(batch: Datagrams, start: int, stop: int) -> Datagrams:
    rows = slice(start, stop)
    return Datagrams(
        batch.t_ns[rows],
        batch.source[rows],
        batch.port[rows],
        batch.length[rows],
        batch.start[rows],
        batch.buffer,
    )


def _joined(parts: list[Datagrams]) -> Datagrams:
    parts = [part for part in parts if len(part)]
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
