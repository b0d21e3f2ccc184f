"""RoboSense packets as if they were sent later; they have no sums."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from recon4.model.trajectory import Times
from recon4.recording.packets.family import Payloads
from recon4.recording.packets.robosense.imu_packets import is_imu
from recon4.recording.packets.robosense.models import IMU_PACKET, IMU_SIZE, MODELS, SIZE
from recon4.recording.packets.robosense.packets import (
    sound_packets,
    stamp_bytes,
    stamps,
    stamps_of,
)
from recon4.recording.packets.robosense.solid import (
    SOLID_MODELS,
    SOLID_STAMP_AT,
    solid_stamps,
    sound_solid,
)
from recon4.recording.report import ImportReport


def restamped(payloads: Payloads, *, shift_ns: int) -> Payloads | None:
    """Packets of one size, later by ``shift_ns``; unsound ones as they are.

    Args:
        payloads: Points, or samples of an inertial unit, (N, size).
        shift_ns: Added to the stamps [ns].

    Returns:
        The packets, (N, size); None = most are of no model.
    """
    size = payloads.shape[1]
    if size == IMU_SIZE:
        assert IMU_PACKET.fields is not None
        at, sound = IMU_PACKET.fields["stamp"][1], is_imu(payloads)
        t_ns = stamps_of(np.ascontiguousarray(payloads[:, at : at + 10]), ns=False)[0]
        return _written(payloads, sound, t_ns + shift_ns, at=at, kind="us")
    if any(size == solid.size for solid in SOLID_MODELS.values()):
        sound, t_ns = sound_solid(payloads, ImportReport()), solid_stamps(payloads)[0]
        return _written(payloads, sound, t_ns + shift_ns, at=SOLID_STAMP_AT, kind="us")
    for model in MODELS.values() if size == SIZE else ():
        sound = sound_packets(payloads, model, ImportReport())
        if 2 * sound.sum() > len(payloads):
            t_ns = stamps(payloads, model)[0] + shift_ns
            return _written(payloads, sound, t_ns, at=model.stamp_at, kind=model.stamp)
    return None


def _written(
    payloads: Payloads, sound: NDArray[np.bool_], t_ns: Times, *, at: int, kind: str
) -> Payloads | None:
    """Sound packets with other times; None = most are not sound."""
    if 2 * sound.sum() <= len(payloads):
        return None
    rows = np.flatnonzero(sound & (t_ns >= 0))
    out = payloads.copy()
    out[rows, at : at + 10] = stamp_bytes(t_ns[rows], kind)
    return out
