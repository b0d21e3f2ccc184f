"""Kernel that decodes Velodyne data packets to points."""

from __future__ import annotations

import numpy as np
from numba import njit
from numpy.typing import NDArray

_BLOCK_BYTES = 100
_MAX_STEP_CDEG = 1000
"""A larger step of azimuth between two blocks is a jump (limited field of view), not rotation."""

_CDEG = np.deg2rad(0.01)
COS = np.cos(_CDEG * np.arange(36000)).astype(np.float32)
SIN = np.sin(_CDEG * np.arange(36000)).astype(np.float32)
"""Cosine and sine of every azimuth on the wire, the last tables of `decode`, (36000,)."""


@njit(cache=True, nogil=True, error_model="numpy", inline="always")
def _word(payload: NDArray[np.uint8], at: int) -> np.int32:
    return np.int32(payload[at]) | (np.int32(payload[at + 1]) << 8)


@njit(cache=True, nogil=True, error_model="numpy")
def _steps(payload: NDArray[np.uint8], pair: int, steps: NDArray[np.int32]) -> int:
    """Write the rotation during each block [0.01°]; returns the number of azimuth jumps.

    ``pair`` = 2 if two blocks belong to one firing.
    """
    jumps, last, first = 0, np.int32(0), -1
    for b in range(12):
        steps[b] = last
        if b + pair < 12:
            at = b * _BLOCK_BYTES + 2
            step = (_word(payload, at + pair * _BLOCK_BYTES) - _word(payload, at)) % 36000
            if step <= _MAX_STEP_CDEG:
                last = step
                steps[b] = step
                first = b if first < 0 else first
            else:
                jumps += 1
    for b in range(max(first, 0)):
        steps[b] = steps[first]
    return jumps


@njit(cache=True, nogil=True, fastmath=True, error_model="numpy")
def decode(
    payloads: NDArray[np.uint8],
    t_ns: NDArray[np.int64],
    pair: int,
    unit_m: np.float32,
    limits: NDArray[np.int64],
    cos_el: NDArray[np.float32],
    sin_el: NDArray[np.float32],
    height_m: NDArray[np.float32],
    offset_cdeg: NDArray[np.int32],
    fraction: NDArray[np.float32],
    time_ns: NDArray[np.int64],
    ring: NDArray[np.uint8],
    cos: NDArray[np.float32],
    sin: NDArray[np.float32],
) -> tuple[
    NDArray[np.int64],
    NDArray[np.float32],
    NDArray[np.uint16],
    NDArray[np.uint8],
    NDArray[np.uint8],
    NDArray[np.int64],
]:
    """Decode packets that passed the filter to points.

    Args:
        payloads: Data packets, (P, 1206).
        t_ns: Time of the first shot of each packet [ns], (P,).
        pair: 2 in dual return mode, else 1.
        unit_m: Meters per unit of distance.
        limits: Smallest and largest distance kept [units], (2,).
        cos_el: Cosine of the elevation of each of the 32 channels of a block, (32,).
        sin_el: Sine of it, (32,).
        height_m: Height of the beam's origin above the center [m], (32,).
        offset_cdeg: Added to the azimuth [0.01°], (32,).
        fraction: Firing time of each channel as a fraction of the block's duration, (32,).
        time_ns: Firing time of each return after the packet's time [ns], (12, 32).
        ring: Ring of each channel, (32,).
        cos: Cosines of 0, 0.01, … 359.99°, (36000,).
        sin: Sines of them.

    Returns:
        ``t_ns, xyz, intensity, ring, echo`` of the N points in firing order, and counts of
        shots without return, returns too near, too far and jumps of azimuth, (4,).
    """
    size = payloads.shape[0] * 12 * 32
    out_t = np.empty(size, np.int64)
    out_xyz = np.empty((size, 3), np.float32)
    out_intensity = np.empty(size, np.uint16)
    out_ring = np.empty(size, np.uint8)
    out_echo = np.empty(size, np.uint8)
    counts = np.zeros(4, np.int64)
    steps = np.zeros(12, np.int32)
    n = 0
    for p in range(payloads.shape[0]):
        payload = payloads[p]
        counts[3] += _steps(payload, pair, steps)
        for b in range(0, 12, pair):
            base = b * _BLOCK_BYTES
            azimuth = _word(payload, base + 2) % 36000
            step_rad = np.float32(steps[b]) * np.float32(_CDEG)
            for c in range(32):
                at = base + 4 + 3 * c
                distance = _word(payload, at)
                intensity = payload[at + 2]
                other, other_intensity = np.int32(0), np.uint8(0)
                if pair == 2:
                    # Even block: last return. Odd block: strongest, or second strongest if the
                    # last is the strongest; both are equal if there was a single return.
                    other, other_intensity = distance, intensity
                    distance = _word(payload, at + _BLOCK_BYTES)
                    intensity = payload[at + _BLOCK_BYTES + 2]
                    if distance == 0 or (other_intensity > intensity and other != 0):
                        distance, other = other, distance
                        intensity, other_intensity = other_intensity, intensity
                    if other == distance:
                        other = np.int32(0)
                if distance == 0:
                    counts[0] += 1
                    continue
                turn = step_rad * fraction[c]
                half = np.float32(0.5) * turn * turn
                cos_turn = np.float32(1.0) - half
                sin_turn = turn * (np.float32(1.0) - half * np.float32(1.0 / 3.0))
                index = azimuth + offset_cdeg[c]
                if index < 0:
                    index += 36000
                elif index >= 36000:
                    index -= 36000
                cos_az = cos[index] * cos_turn - sin[index] * sin_turn
                sin_az = sin[index] * cos_turn + cos[index] * sin_turn
                echo = np.uint8(0)
                while distance != 0:
                    if distance < limits[0]:
                        counts[1] += 1
                    elif distance > limits[1]:
                        counts[2] += 1
                    else:
                        r = np.float32(distance) * unit_m
                        flat = r * cos_el[c]
                        out_t[n] = t_ns[p] + time_ns[b, c]
                        out_xyz[n, 0] = flat * cos_az
                        out_xyz[n, 1] = -flat * sin_az
                        out_xyz[n, 2] = r * sin_el[c] + height_m[c]
                        out_intensity[n] = intensity
                        out_ring[n] = ring[c]
                        out_echo[n] = echo
                        n += 1
                        echo = np.uint8(1)
                    distance, intensity = other, other_intensity
                    other = np.int32(0)
    return out_t[:n], out_xyz[:n], out_intensity[:n], out_ring[:n], out_echo[:n], counts
