"""Kernels for Ouster packets: points of data packets, and checksums."""

from __future__ import annotations

import numpy as np
from numba import njit
from numpy.typing import NDArray

_POLYNOMIAL = 0xC96C5795D7870F42
"""ECMA-182, lowest bit first."""
_ALL_ONES = np.uint64(0xFFFFFFFFFFFFFFFF)


def _checksum_tables() -> NDArray[np.uint64]:
    """What each byte changes, followed by 0 to 7 further bytes, (8, 256)."""
    tables = np.zeros((8, 256), dtype=np.uint64)
    for byte in range(256):
        value = byte
        for _ in range(8):
            value = value >> 1 ^ (_POLYNOMIAL if value & 1 else 0)
        tables[0, byte] = value
    for row in range(1, 8):
        before = tables[row - 1]
        tables[row] = before >> np.uint64(8) ^ tables[0][before & np.uint64(0xFF)]
    return tables


CHECKSUM_TABLES = _checksum_tables()


_LANES = 4
"""Rows whose sums are computed side by side: each step waits for the one before it."""


@njit(cache=True, nogil=True, error_model="numpy")
def checksums(
    words: NDArray[np.uint64], rest: NDArray[np.uint8], tables: NDArray[np.uint64]
) -> NDArray[np.uint64]:
    """CRC-64/XZ of each row, (N,).

    Args:
        words: The rows, eight bytes at a time, (N, W).
        rest: What is left of them, (N, K).
        tables: `CHECKSUM_TABLES`.
    """
    low = np.uint64(0xFF)
    out = np.empty(words.shape[0], np.uint64)
    out[:] = _ALL_ONES
    for first in range(0, words.shape[0], _LANES):
        last = min(first + _LANES, words.shape[0])
        for w in range(words.shape[1]):
            for row in range(first, last):
                x = out[row] ^ words[row, w]
                out[row] = (
                    tables[7, x & low]
                    ^ tables[6, x >> np.uint64(8) & low]
                    ^ tables[5, x >> np.uint64(16) & low]
                    ^ tables[4, x >> np.uint64(24) & low]
                    ^ tables[3, x >> np.uint64(32) & low]
                    ^ tables[2, x >> np.uint64(40) & low]
                    ^ tables[1, x >> np.uint64(48) & low]
                    ^ tables[0, x >> np.uint64(56)]
                )
        for row in range(first, last):
            for k in range(rest.shape[1]):
                x = out[row]
                out[row] = x >> np.uint64(8) ^ tables[0, (x ^ np.uint64(rest[row, k])) & low]
    return out ^ _ALL_ONES


@njit(cache=True, nogil=True, error_model="numpy", inline="always")
def _range(payload: NDArray[np.uint8], at: np.uintp, mask: int) -> np.int32:
    units = np.int32(payload[at]) | np.int32(payload[at + np.uintp(1)]) << 8
    return np.int32((units | np.int32(payload[at + np.uintp(2)]) << 16) & mask)


@njit(cache=True, nogil=True, error_model="numpy", inline="always")
def _intensity(payload: NDArray[np.uint8], at: np.uintp, mask: int) -> np.int32:
    return np.int32(np.int32(payload[at]) | (np.int32(payload[at + np.uintp(1)]) << 8) & mask)


@njit(cache=True, nogil=True, fastmath=True, error_model="numpy")
def decode(
    payloads: NDArray[np.uint8],
    columns: tuple[NDArray[np.int64], NDArray[np.int64], NDArray[np.int64]],
    layout: tuple[tuple[int, int, int, int], ...],
    pixel: tuple[int, bool, np.float32],
    limits: NDArray[np.int64],
    turns: NDArray[np.float32],
    beams: tuple[NDArray[np.float32], NDArray[np.float32], NDArray[np.uint8]],
) -> tuple[
    NDArray[np.int64],
    NDArray[np.float32],
    NDArray[np.uint16],
    NDArray[np.uint8],
    NDArray[np.uint8],
    NDArray[np.int64],
]:
    """Decode sound packets to points.

    Args:
        payloads: Data packets, (P, S).
        columns: Time of each column [ns], (P, C); its row in ``turns``, negative = not valid,
            (P, C); and where its pixels begin in a packet, (C,).
        layout: For each return of a pixel: offset and mask of its range, offset and mask of the
            second byte of its intensity.
        pixel: Bytes of a pixel; whether of two returns the one of the higher intensity is the
            first; meters per unit of the range.
        limits: Smallest and largest range kept [units], (2,).
        turns: Maps the frame that turns with the beams into that of the sensor at each column,
            rotation and translation, (W, 3, 4).
        beams: Origin [m] and direction of each beam in the turning frame, (B, 3) each; its ring,
            (B,).

    Returns:
        ``t_ns, xyz, intensity, ring, echo`` of the N points in order of time, and counts of
        shots without return, returns too near and too far, (3,).
    """
    t_ns, turn_rows, pixels_at = columns
    pixel_bytes, by_intensity, unit_m = pixel
    origin, direction, ring = beams
    near, far = np.int32(limits[0]), np.int32(limits[1])
    echoes = len(layout)
    range_at, range_mask, intensity_at, intensity_mask = layout[0]
    other_at, other_mask, other_intensity_at, other_intensity_mask = layout[-1]
    size = payloads.shape[0] * turn_rows.shape[1] * origin.shape[0] * echoes
    out_t = np.empty(size, np.int64)
    out_xyz = np.empty((size, 3), np.float32)
    out_intensity = np.empty(size, np.uint16)
    out_ring = np.empty(size, np.uint8)
    out_echo = np.empty(size, np.uint8)
    silent, too_near, too_far = 0, 0, 0
    n = np.uintp(0)
    for p in range(payloads.shape[0]):
        payload = payloads[p]
        for c in range(turn_rows.shape[1]):
            row = turn_rows[p, c]
            if row < 0:
                continue
            t = t_ns[p, c]
            m = turns[row]
            xx, xy, xz, x0 = m[0, 0], m[0, 1], m[0, 2], m[0, 3]
            yx, yy, yz, y0 = m[1, 0], m[1, 1], m[1, 2], m[1, 3]
            zx, zy, zz, z0 = m[2, 0], m[2, 1], m[2, 2], m[2, 3]
            for b in range(origin.shape[0]):
                at = np.uintp(pixels_at[c] + b * pixel_bytes)
                units = _range(payload, at + np.uintp(range_at), range_mask)
                intensity = _intensity(payload, at + np.uintp(intensity_at), intensity_mask)
                other, other_intensity = np.int32(0), np.int32(0)
                if echoes == 2:
                    other = _range(payload, at + np.uintp(other_at), other_mask)
                    other_intensity = _intensity(
                        payload, at + np.uintp(other_intensity_at), other_intensity_mask
                    )
                    stronger = by_intensity and other_intensity > intensity
                    if other != 0 and (units == 0 or stronger):
                        units, other = other, units
                        intensity, other_intensity = other_intensity, intensity
                    if other == units:
                        other = np.int32(0)
                if units == 0:
                    silent += 1
                    continue
                echo = np.uint8(0)
                while units != 0:
                    if units < near:
                        too_near += 1
                    elif units > far:
                        too_far += 1
                    else:
                        r = np.float32(units) * unit_m
                        x = origin[b, 0] + r * direction[b, 0]
                        y = origin[b, 1] + r * direction[b, 1]
                        z = origin[b, 2] + r * direction[b, 2]
                        out_t[n] = t
                        out_xyz[n, 0] = xx * x + xy * y + xz * z + x0
                        out_xyz[n, 1] = yx * x + yy * y + yz * z + y0
                        out_xyz[n, 2] = zx * x + zy * y + zz * z + z0
                        out_intensity[n] = intensity
                        out_ring[n] = ring[b]
                        out_echo[n] = echo
                        n += np.uintp(1)
                        echo = np.uint8(1)
                    units, intensity = other, other_intensity
                    other = np.int32(0)
    counts = np.array([silent, too_near, too_far], np.int64)
    return out_t[:n], out_xyz[:n], out_intensity[:n], out_ring[:n], out_echo[:n], counts
