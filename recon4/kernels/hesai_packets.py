"""Kernel that checks the packets of Hesai sensors, each in one pass."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numba import njit
from numpy.typing import NDArray

from recon4.kernels.checksums import crc32_of
from recon4.units import SECOND_US, TURN_CDEG


class FieldPlaces(NamedTuple):
    """Where what is checked lies in a packet [bytes]; -1 = packets have no such field."""

    blocks: int
    """Number of blocks."""
    block: int
    """From one block to the next."""
    start: int
    """Of the two bytes in front of the first block that all blocks have."""
    azimuth: int
    """Of the first block, u2."""
    date: int
    micros: int
    """u4."""
    speed: int
    """u2."""
    summed: int
    """First byte of the sum."""
    crc: int


class SoundFields(NamedTuple):
    """What sound packets hold."""

    header: NDArray[np.uint8]
    """First bytes, (12,)."""
    fixed: NDArray[np.bool_]
    """Which of them are alike in all packets, (12,)."""
    start: int
    """In front of each block, u2; without meaning where there is none."""
    most_speed: float
    latest_s: int
    """Largest number of seconds since 1970."""
    tables: NDArray[np.uint32]
    """Of the checksum, see `recon4.kernels.checksums.crc32_of`, (4, 256)."""


SOUND, HEADER, AZIMUTH, STAMP, SPEED, CRC = range(6)
"""What is wrong first with a packet."""


@njit(cache=True, nogil=True, error_model="numpy", inline="always")
def _word(payload: NDArray[np.uint8], at: int) -> int:
    return int(payload[at]) | (int(payload[at + 1]) << 8)


@njit(cache=True, nogil=True, error_model="numpy", inline="always")
def _is_stamp(payload: NDArray[np.uint8], at: FieldPlaces, latest_s: int) -> bool:
    micros = _word(payload, at.micros) | (_word(payload, at.micros + 2) << 16)
    d = payload[at.date : at.date + 6]
    if d[0] == 0:
        seconds = 0
        for k in range(1, 6):
            seconds = (seconds << 8) | int(d[k])
        return micros < SECOND_US and seconds < latest_s
    day = 1 <= d[1] <= 12 and 1 <= d[2] <= 31
    return micros < SECOND_US and day and d[3] <= 23 and d[4] <= 59 and d[5] <= 60


@njit(cache=True, nogil=True, error_model="numpy")
def first_faults(
    payloads: NDArray[np.uint8], at: FieldPlaces, right: SoundFields
) -> NDArray[np.uint8]:
    """What is wrong first with each packet, `SOUND` if nothing is, (N,).

    Args:
        payloads: Packets, (N, size).
        at: Where the fields lie.
        right: What they may be.
    """
    out = np.zeros(len(payloads), np.uint8)
    for row in range(len(payloads)):
        payload = payloads[row]
        same, turned = True, True
        for k in range(len(right.header)):
            same &= not right.fixed[k] or payload[k] == right.header[k]
        for b in range(at.blocks):
            place = b * at.block
            same &= at.start < 0 or _word(payload, at.start + place) == right.start
            turned &= _word(payload, at.azimuth + place) <= TURN_CDEG
        if not same:
            out[row] = HEADER
        elif not turned:
            out[row] = AZIMUTH
        elif not _is_stamp(payload, at, right.latest_s):
            out[row] = STAMP
        elif at.speed >= 0 and _word(payload, at.speed) > right.most_speed:
            out[row] = SPEED
        elif at.crc >= 0:
            stated = _word(payload, at.crc) | (_word(payload, at.crc + 2) << 16)
            if int(crc32_of(payload[at.summed : at.crc], right.tables)) != stated:
                out[row] = CRC
    return out
