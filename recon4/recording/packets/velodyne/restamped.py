"""Velodyne packets as if they were sent later: microseconds past the hour."""

from __future__ import annotations

import numpy as np

from recon4.recording.packets.family import Payloads
from recon4.recording.packets.velodyne.models import DATA_PACKET, DATA_SIZE, POSITION_SIZE
from recon4.units import HOUR_US


class _Position:
    """The packet with positions."""

    STAMP_AT = 198
    """Offset of its time [bytes]."""


def restamped(payloads: Payloads, *, shift_ns: int) -> Payloads | None:
    """Packets of one size, later by ``shift_ns``; None = of another size than Velodyne's.

    Stamps that run on past the full hour, as without GPS, stay as they are. So do the sentences of
    position packets: a shift by no whole hours takes their proof of GPS time away.
    """
    assert DATA_PACKET.fields is not None
    stamp_at = {DATA_SIZE: DATA_PACKET.fields["time_us"][1], POSITION_SIZE: _Position.STAMP_AT}
    at = stamp_at.get(payloads.shape[1])
    if at is None:
        return None
    out = payloads.copy()
    stamp_us = np.ascontiguousarray(out[:, at : at + 4]).view("<u4")[:, 0].astype(np.int64)
    later_us = np.where(stamp_us < HOUR_US, (stamp_us + shift_ns // 1000) % HOUR_US, stamp_us)
    out[:, at : at + 4] = later_us.astype("<u4").view(np.uint8).reshape(-1, 4)
    return out
