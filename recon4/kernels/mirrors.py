"""Kernel that decodes the packets of an AT128: a drum of mirrors turns its beams."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numba import njit
from numpy.typing import NDArray

from recon4.kernels.spinning import Decoded, Distances

_UNIT_RAD = np.float32(np.deg2rad(1 / 25600))
_TURN = 360 * 25600
_NODE = 2 * 25600
"""From one correction to the next [1/25600°]."""


class Shape(NamedTuple):
    """Where the numbers lie in a packet [bytes]."""

    blocks: int
    """Blocks of a packet B."""
    first: int
    """Offset of the first block; it begins with its azimuth, u2 [0.01°] and u1 [1/256 of it]."""
    block: int
    """From one block to the next."""
    channel_first: int
    """Offset of the first channel in a block: distance u2, intensity u1."""
    channel: int
    """From one channel to the next."""


class Drum(NamedTuple):
    """Directions of M mirrors and C channels."""

    start: NDArray[np.int64]
    """Azimuth where each mirror begins [1/25600°], ascending, (M,)."""
    azimuth: NDArray[np.float32]
    """Cosine and sine of what each channel adds to twice the angle since then, (C, 2)."""
    elevation: NDArray[np.float32]
    """Cosine and sine of the elevation of each channel, (C, 2)."""
    azimuth_correction: NDArray[np.float32]
    """Added to the azimuth at every 2° of the drum [rad], (180, C)."""
    elevation_correction: NDArray[np.float32]
    """Added to the elevation [rad], (180, C)."""
    ring: NDArray[np.uint8]
    """Ring, 0 = lowest elevation, (C,)."""


@njit(cache=True, nogil=True, fastmath=True, error_model="numpy", inline="always")
def _turned(
    cosine: np.float32, sine: np.float32, by_rad: np.float32
) -> tuple[np.float32, np.float32]:
    """Cosine and sine of an angle that a correction of up to 2.6° is added to."""
    half = np.float32(0.5) * by_rad * by_rad
    cos_by = np.float32(1.0) - half
    sin_by = by_rad * (np.float32(1.0) - half * np.float32(1.0 / 3.0))
    return cosine * cos_by - sine * sin_by, sine * cos_by + cosine * sin_by


@njit(cache=True, nogil=True, fastmath=True, error_model="numpy")
def decode_mirrors(
    payloads: NDArray[np.uint8],
    t_ns: NDArray[np.int64],
    returns: NDArray[np.int64],
    block_ns: NDArray[np.int64],
    shape: Shape,
    drum: Drum,
    distances: Distances,
    circle: NDArray[np.float32],
) -> Decoded:
    """Decode packets that passed the filter to points; azimuth 0 is +y, clockwise.

    Args:
        payloads: Data packets, (P, size).
        t_ns: Time of the first shot of each packet [ns], (P,).
        returns: Returns of each shot, 1 or 2: blocks that follow each other, (P,).
        block_ns: Time of each block after the first shot in single return mode [ns], (B,).
        shape: Where the numbers lie.
        drum: Directions.
        distances: Unit and limits.
        circle: `recon4.kernels.spinning.CIRCLE`.

    Returns:
        As `recon4.kernels.spinning.decode`; no azimuth jumps are counted.
    """
    channels = len(drum.azimuth)
    size = payloads.shape[0] * shape.blocks * channels
    out_t = np.empty(size, np.int64)
    out_xyz = np.empty((size, 3), np.float32)
    out_intensity = np.empty(size, np.uint16)
    out_ring = np.empty(size, np.uint8)
    out_echo = np.empty(size, np.uint8)
    counts = np.zeros(4, np.int64)
    n = 0
    for p in range(payloads.shape[0]):
        payload, group = payloads[p], returns[p]
        for b in range(0, shape.blocks - group + 1, group):
            at = shape.first + b * shape.block
            azimuth = (int(payload[at]) | (int(payload[at + 1]) << 8)) * 256 + payload[at + 2]
            azimuth %= _TURN
            mirror = len(drum.start) - 1
            for m in range(len(drum.start)):
                if drum.start[m] <= azimuth:
                    mirror = m
            angle = 2 * ((azimuth - drum.start[mirror]) % _TURN) % _TURN
            start = circle[angle // 256]
            cos_block, sin_block = _turned(start[0], start[1], np.float32(angle % 256) * _UNIT_RAD)
            node = azimuth // _NODE
            after = (node + 1) % drum.azimuth_correction.shape[0]
            weight = np.float32(azimuth % _NODE) / np.float32(_NODE)
            t = t_ns[p] + block_ns[b // group]
            for c in range(channels):
                at = shape.first + b * shape.block + shape.channel_first + c * shape.channel
                distance = int(payload[at]) | (int(payload[at + 1]) << 8)
                intensity = payload[at + 2]
                other, other_intensity = 0, np.uint8(0)
                if group == 2:
                    # As in `spinning.decode`: the more intense return first, equal ones once.
                    other, other_intensity = distance, intensity
                    at += shape.block
                    distance = int(payload[at]) | (int(payload[at + 1]) << 8)
                    intensity = payload[at + 2]
                    if distance == 0 or (other_intensity > intensity and other != 0):
                        distance, other = other, distance
                        intensity, other_intensity = other_intensity, intensity
                    if other == distance:
                        other = 0
                if distance == 0:
                    counts[0] += 1
                    continue
                cos_c, sin_c = drum.azimuth[c, 0], drum.azimuth[c, 1]
                by_rad = drum.azimuth_correction[node, c]
                by_rad += (drum.azimuth_correction[after, c] - by_rad) * weight
                cos_az, sin_az = _turned(
                    cos_block * cos_c - sin_block * sin_c,
                    sin_block * cos_c + cos_block * sin_c,
                    by_rad,
                )
                by_rad = drum.elevation_correction[node, c]
                by_rad += (drum.elevation_correction[after, c] - by_rad) * weight
                cos_el, sin_el = _turned(drum.elevation[c, 0], drum.elevation[c, 1], by_rad)
                echo = np.uint8(0)
                while distance != 0:
                    if distance < distances.least:
                        counts[1] += 1
                    elif distance > distances.most:
                        counts[2] += 1
                    else:
                        r = np.float32(distance) * distances.unit_m
                        out_t[n] = t
                        out_xyz[n, 0] = r * cos_el * sin_az
                        out_xyz[n, 1] = r * cos_el * cos_az
                        out_xyz[n, 2] = r * sin_el
                        out_intensity[n] = intensity
                        out_ring[n] = drum.ring[c]
                        out_echo[n] = echo
                        n += 1
                        echo = np.uint8(1)
                    distance, intensity = other, other_intensity
                    other = 0
    return out_t[:n], out_xyz[:n], out_intensity[:n], out_ring[:n], out_echo[:n], counts
