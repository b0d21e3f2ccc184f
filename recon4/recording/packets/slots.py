"""Groups datagrams by arrival time, so that the result is independent of the reads.

A file that grows is read in many small pieces, a finished one in few large ones. What follows
(clocks, order, cutting into frames) gets the same pieces either way.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator

import numpy as np

from recon4.recording.formats.datagrams import Datagrams, join_datagrams
from recon4.recording.packets.tuning import SLOTS


def in_slots(batches: Iterable[Datagrams]) -> Iterator[Datagrams]:
    """All datagrams in order, in slots of `SlotTuning.slot_ns` of the recorder's clock.

    A slot ends early where it has `SlotTuning.bytes`.
    """
    parts: list[Datagrams] = []
    end_ns: int | None = None
    room = SLOTS.bytes
    for batch in batches:
        start = 0
        if end_ns is None and len(batch):
            end_ns = int(batch.t_ns[0]) + SLOTS.first_ns
        while end_ns is not None and start < len(batch):
            t_ns, size = batch.t_ns[start:], np.cumsum(batch.length[start:])
            outside = (t_ns >= end_ns) | (t_ns < end_ns - SLOTS.set_back_ns)
            beyond = np.flatnonzero(outside | (size > room))
            cut = start + int(beyond[0]) if len(beyond) else len(batch)
            parts.append(batch.take(slice(start, cut)))
            room -= int(batch.length[start:cut].sum())
            start = cut
            if len(beyond):
                slot, parts = join_datagrams(parts), []  # first: the batches go
                yield slot
                room = SLOTS.bytes
                end_ns = (int(batch.t_ns[cut]) // SLOTS.slot_ns + 1) * SLOTS.slot_ns
    if parts:
        yield join_datagrams(parts)
