"""Ouster packets as if they were sent later: times of columns and samples changed, sums too."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from recon4.recording.packets.family import Companion, Payloads
from recon4.recording.packets.ouster.columns import sound_columns
from recon4.recording.packets.ouster.data_packets import checksums
from recon4.recording.packets.ouster.imu_packets import imu_samples_in, sound_imu
from recon4.recording.packets.ouster.layouts import (
    CHECKSUM_BYTES,
    HEADER_BYTES,
    IMU_SAMPLE,
    LEGACY_IMU,
    NMEA_BYTES,
    USUAL_LAYOUTS,
    PacketLayout,
)
from recon4.recording.packets.ouster.metadata_choice import find_metadata


def restamped(
    payloads: Payloads, companions: Sequence[Companion], *, shift_ns: int
) -> Payloads | None:
    """Packets of one size, later by ``shift_ns``; unsound ones as they are.

    Args:
        payloads: Points or inertial samples, (N, size).
        companions: Files beside the recording; usual layouts need no metadata.
        shift_ns: Added to all times that are set [ns].

    Returns:
        The packets, (N, size); None = most are not of an Ouster.
    """
    if imu_samples_in(payloads.shape[1]):
        return _samples(payloads, shift_ns)
    known = [found.layout for found in find_metadata(companions).metadata]
    for layout in (*known, *USUAL_LAYOUTS):
        if layout.size == payloads.shape[1]:
            sound = sound_columns(layout, payloads)
            if 2 * sound.sum() > len(payloads):
                return _columns(layout, payloads, sound, shift_ns=shift_ns)
    return None


def _columns(
    layout: PacketLayout, payloads: Payloads, sound: NDArray[np.bool_], *, shift_ns: int
) -> Payloads:
    later = np.ascontiguousarray(payloads[sound])
    stamp_ns = layout.records(later)["columns"]["stamp_ns"]
    _shift(stamp_ns, shift_ns)
    return _with_sums(payloads, sound, later, summed=layout.profile.has_header)


def _samples(payloads: Payloads, shift_ns: int) -> Payloads | None:
    sound = sound_imu(payloads)
    if 2 * sound.sum() <= len(payloads):
        return None
    later = np.ascontiguousarray(payloads[sound])
    is_legacy = payloads.shape[1] == LEGACY_IMU.itemsize
    if is_legacy:
        packets = later.view(LEGACY_IMU)[:, 0]
        for name in ("sent_ns", "accel_ns", "gyro_ns"):
            _shift(packets[name], shift_ns)
    else:
        inner = later[:, HEADER_BYTES + NMEA_BYTES : -HEADER_BYTES]
        samples = np.ascontiguousarray(inner).view(IMU_SAMPLE)
        _shift(samples["t_ns"], shift_ns)
        inner[:] = samples.view(np.uint8).reshape(inner.shape)
    return _with_sums(payloads, sound, later, summed=not is_legacy)


def _shift(t_ns: NDArray[np.uint64], shift_ns: int) -> None:
    """Shift times in place; zeros, which are no times, and what would be before zero stay."""
    later = t_ns.astype(np.int64) + shift_ns
    t_ns[...] = np.where((t_ns == 0) | (later < 0), t_ns, later.astype(np.uint64))


def _with_sums(
    payloads: Payloads, sound: NDArray[np.bool_], later: Payloads, *, summed: bool
) -> Payloads:
    """All packets; the changed ones have a right sum if they had one."""
    out = payloads.copy()
    if summed:
        stated = np.ascontiguousarray(later[:, -CHECKSUM_BYTES:]).view("<u8")[:, 0]
        right = stated == checksums(payloads[sound])
        total = checksums(later[right]).astype("<u8").view(np.uint8)
        later[right, -CHECKSUM_BYTES:] = total.reshape(-1, CHECKSUM_BYTES)
    out[sound] = later
    return out
