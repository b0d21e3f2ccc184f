"""Which payloads are data packets of a Velodyne."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from recon4.recording.packets.family import Payloads
from recon4.recording.packets.velodyne.models import (
    BLOCK_FLAG,
    DATA_PACKET,
    DATA_SIZE,
    LOWER_BLOCK_FLAG,
)
from recon4.recording.report import ImportReport


def as_packets(payloads: Payloads) -> NDArray[np.void]:
    """Payloads seen as `DATA_PACKET` records, (N,)."""
    return np.ascontiguousarray(payloads).view(DATA_PACKET)[:, 0]


def sound_packets(payloads: Payloads, report: ImportReport) -> NDArray[np.bool_]:
    """Which of the payloads are data packets, (N,).

    Counts ``packets`` and what is dropped: ``packets_wrong_length`` (not 1206 bytes),
    ``packets_hdl64`` (blocks of the lower lasers of an HDL-64E), ``packets_wrong_flag`` (any of
    the 12 blocks without 0xEEFF) and ``packets_wrong_azimuth`` (above 360°, which itself is sent
    now and then for 0°). The time is judged by `SensorClock`.
    """
    report.count("packets", len(payloads))
    if payloads.ndim != 2 or payloads.shape[1] != DATA_SIZE:
        report.count("packets_wrong_length", len(payloads))
        return np.zeros(len(payloads), dtype=np.bool_)
    packets = as_packets(payloads)
    flags = packets["blocks"]["flag"]
    flagged = (flags == BLOCK_FLAG).all(axis=1)
    turned = (packets["blocks"]["azimuth_cdeg"] <= 36000).all(axis=1)
    sound = flagged & turned
    if sound.all():
        return sound
    known = (flags == BLOCK_FLAG) | (flags == LOWER_BLOCK_FLAG)
    lower = ~flagged & known.all(axis=1)
    report.count("packets_hdl64", int(lower.sum()))
    report.count("packets_wrong_flag", int((~flagged & ~lower).sum()))
    report.count("packets_wrong_azimuth", int((flagged & ~turned).sum()))
    return sound
