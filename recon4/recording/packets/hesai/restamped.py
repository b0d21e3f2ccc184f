"""Hesai packets as if they were sent later: date and microseconds changed, sums made right."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from recon4.recording.packets.family import Payloads
from recon4.recording.packets.hesai import checksums, stamps
from recon4.recording.packets.hesai.inertial import JT16_SAMPLE, jt16_sums
from recon4.recording.packets.hesai.layouts import HesaiLayout


def restamped_data(
    payloads: Payloads, sound: NDArray[np.bool_], layout: HesaiLayout, *, shift_ns: int
) -> Payloads:
    """Data packets of one layout, later by ``shift_ns``; unsound ones as they are, (N, size).

    The sum of the tail is the only one that covers the time.
    """
    later = payloads[sound]
    date = later[:, layout.tail_at + layout.tail.date :][:, :6]
    micros = later[:, layout.tail_at + layout.tail.micros :][:, :4]
    date[:], micros[:] = _later(date, micros, shift_ns)
    checksums.write(later, layout)
    out = payloads.copy()
    out[sound] = later
    return out


def restamped_jt16(payloads: Payloads, *, shift_ns: int) -> Payloads:
    """Inertial packets of a JT16, later by ``shift_ns``; those with a wrong sum as they are."""
    out = np.ascontiguousarray(payloads).copy()
    packets = out.view(JT16_SAMPLE)[:, 0]
    sound = stamps.is_date(packets["date"], packets["micros"])
    sound &= jt16_sums(out) == packets["crc"]
    micros = np.ascontiguousarray(packets["micros"][sound]).view(np.uint8).reshape(-1, 4)
    date, micros = _later(packets["date"][sound], micros, shift_ns)
    packets["date"][sound] = date
    packets["micros"][sound] = np.ascontiguousarray(micros).view("<u4")[:, 0]
    packets["crc"][sound] = jt16_sums(out)[sound]
    return out


def _later(
    date: NDArray[np.uint8], micros: NDArray[np.uint8], shift_ns: int
) -> tuple[NDArray[np.uint8], NDArray[np.uint8]]:
    """Times in the form they have: seconds after a zero, or years after 1900 or 2000.

    Args:
        date: See `stamps.is_date`, (N, 6).
        micros: Microseconds of the second, little-endian, (N, 4).
        shift_ns: Added [ns].
    """
    us = np.ascontiguousarray(micros).view("<u4")[:, 0]
    seconds, rest_us = np.divmod((stamps.time_ns(date, us) + shift_ns) // 1000, 1_000_000)
    calendar = stamps.date_of(seconds)
    calendar[:, 0] -= np.where((date[:, 0] < 70) & (calendar[:, 0] >= 100), 100, 0).astype(np.uint8)
    counted = seconds.astype(">u8").view(np.uint8).reshape(-1, 8)[:, 2:]
    later = np.where((date[:, 0] == 0)[:, None], counted, calendar)
    return later, rest_us.astype("<u4").view(np.uint8).reshape(-1, 4)
