"""Kernel that decodes Livox data packets to points."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numba import njit
from numpy.typing import NDArray


class PointNumbers(NamedTuple):
    """What the numbers of a shot are."""

    words: int = 0
    """Coordinates of 32 bits …"""
    halves: int = 1
    """… or of 16 bits …"""
    depths: int = 2
    """… or depths along the direction of the shot."""


NUMBERS = PointNumbers()


_TURN = np.deg2rad(0.01) * np.arange(36000)
COS, SIN = np.cos(_TURN).astype(np.float32), np.sin(_TURN).astype(np.float32)
"""Of every angle on the wire, the last tables of `decode`, (36000,)."""


@njit(cache=True, nogil=True, error_model="numpy", inline="always")
def _half(packet: NDArray[np.uint8], at: int) -> np.int32:
    return np.int32(packet[at]) | (np.int32(packet[at + 1]) << 8)


@njit(cache=True, nogil=True, error_model="numpy", inline="always")
def _word(packet: NDArray[np.uint8], at: int) -> np.int64:
    return np.int64(_half(packet, at)) | (np.int64(_half(packet, at + 2)) << 16)


@njit(cache=True, nogil=True, error_model="numpy", inline="always")
def _signed(packet: NDArray[np.uint8], at: int, numbers: int) -> np.float32:
    if numbers == NUMBERS.words:
        value = _word(packet, at)
        return np.float32(value - (1 << 32) if value >= 1 << 31 else value)
    half = _half(packet, at)
    return np.float32(half - (1 << 16) if half >= 1 << 15 else half)


@njit(cache=True, nogil=True, error_model="numpy")
def _direction(
    packet: NDArray[np.uint8],
    at: int,
    cos: NDArray[np.float32],
    sin: NDArray[np.float32],
    out: NDArray[np.float32],
) -> None:
    """Write the direction of a shot from its angles to z and from x to y [0.01°]."""
    theta, phi = _half(packet, at) % 36000, _half(packet, at + 2) % 36000
    out[0] = sin[theta] * cos[phi]
    out[1] = sin[theta] * sin[phi]
    out[2] = cos[theta]


@njit(cache=True, nogil=True, error_model="numpy")
def decode(
    packets: NDArray[np.uint8],
    t_ns: NDArray[np.int64],
    step_ns: NDArray[np.float64],
    plan: NDArray[np.int64],
    limits: NDArray[np.float32],
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
        packets: Data packets, (P, header + shots * bytes of a shot).
        t_ns: Time of the first shot of each packet [ns], (P,).
        step_ns: From one shot to the next [ns], (P,).
        plan: Bytes of the header; shots of a packet; bytes of a shot; its returns; offset and bytes
            of a return; offsets of reflectivity and tag in a return (-1 = no tag); one of
            `PointNumbers`; offset of the angles; number of lines; whether tags name noise,
            (12,).
        limits: Smallest and largest range [m], and the unit of a number [m], (3,).
        cos: Cosines of 0, 0.01, … 359.99°, (36000,).
        sin: Sines of them.

    Returns:
        ``t_ns, xyz, intensity, ring, echo`` of the N points in firing order, and counts of shots
        without return, returns too near, too far, and of noise, (4,).
    """
    header, shots, stride, returns, first, size, shine, tag_at, numbers, angles, lines, named = plan
    most = packets.shape[0] * shots * returns
    out_t = np.empty(most, np.int64)
    out_xyz = np.empty((most, 3), np.float32)
    out_intensity = np.empty(most, np.uint16)
    out_ring = np.empty(most, np.uint8)
    out_echo = np.empty(most, np.uint8)
    counts = np.zeros(4, np.int64)
    found = np.zeros((returns, 3), np.float32)
    direction = np.zeros(3, np.float32)
    n = 0
    for p in range(packets.shape[0]):
        packet = packets[p]
        for s in range(shots):
            begin = header + s * stride
            if numbers == NUMBERS.depths:
                _direction(packet, begin + angles, cos, sin, direction)
            different = 0
            for r in range(returns):
                at = begin + first + r * size
                if numbers == NUMBERS.depths:
                    depth = np.float32(_word(packet, at)) * limits[2]
                    for axis in range(3):
                        found[r, axis] = depth * direction[axis]
                else:
                    width = 4 if numbers == NUMBERS.words else 2
                    for axis in range(3):
                        found[r, axis] = _signed(packet, at + width * axis, numbers) * limits[2]
                x, y, z = found[r, 0], found[r, 1], found[r, 2]
                is_new = x != 0.0 or y != 0.0 or z != 0.0
                for o in range(r):
                    is_new &= found[o, 0] != x or found[o, 1] != y or found[o, 2] != z
                if not is_new:
                    continue
                different += 1
                echo = np.uint8(different > 1)
                tag = packet[at + tag_at] if tag_at >= 0 and named else np.uint8(0)
                if returns == 1:
                    # Bits 4-5 count returns from 1; 0 is one close to the window.
                    echo = np.uint8(((tag >> 4) & 3) > 1)
                distance = np.sqrt(x * x + y * y + z * z)
                if distance < limits[0]:
                    counts[1] += 1
                elif distance > limits[1]:
                    counts[2] += 1
                elif (tag & 0x03) == 0x01 or (tag & 0x0C) == 0x04:
                    counts[3] += 1
                else:
                    out_t[n] = t_ns[p] + np.int64(np.rint(s * step_ns[p]))
                    out_xyz[n, 0], out_xyz[n, 1], out_xyz[n, 2] = x, y, z
                    out_intensity[n] = packet[at + shine]
                    out_ring[n] = s % lines
                    out_echo[n] = echo
                    n += 1
            counts[0] += different == 0
    return out_t[:n], out_xyz[:n], out_intensity[:n], out_ring[:n], out_echo[:n], counts
