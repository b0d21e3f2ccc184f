"""Livox packets as if they were sent later: stamps changed, sums made right."""

from __future__ import annotations

import zlib

import numpy as np
from numpy.typing import NDArray

from recon4.recording.packets.family import Payloads
from recon4.recording.packets.livox.models import (
    CRC_FROM,
    SDK1_HEADER,
    SDK2_HEADER,
    UTC_TIME_TYPE,
)
from recon4.recording.packets.livox.sound import date_stamps, has_crc, stamps_ns


def restamped(payloads: Payloads, sound: NDArray[np.bool_], sdk: int, *, shift_ns: int) -> Payloads:
    """Packets of one protocol, later by ``shift_ns``; unsound ones as they are, (N, size).

    Args:
        payloads: Points or inertial samples, (N, size).
        sound: Which have the header of a packet, and a time, (N,).
        sdk: 1 or 2.
        shift_ns: Added to the stamps [ns].
    """
    out = payloads.copy()
    header = SDK1_HEADER if sdk == 1 else SDK2_HEADER
    assert header.fields is not None
    at = header.fields["stamp"][1]
    timed = np.flatnonzero(sound)
    t_ns = stamps_ns(payloads[timed], sdk) + shift_ns
    timed, t_ns = timed[t_ns >= 0], t_ns[t_ns >= 0]
    out[timed, at : at + 8] = t_ns.astype("<u8").view(np.uint8).reshape(-1, 8)
    if sdk == 1:
        dated = payloads[timed, header.fields["time_type"][1]] == UTC_TIME_TYPE
        out[timed[dated], at : at + 8] = date_stamps(t_ns[dated])
    else:
        crc_at = header.fields["crc"][1]
        for row in timed[has_crc(payloads[timed])].tolist():
            total = zlib.crc32(out[row, CRC_FROM:].tobytes())
            out[row, crc_at : crc_at + 4] = np.frombuffer(total.to_bytes(4, "little"), np.uint8)
    return out
