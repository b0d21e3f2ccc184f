"""Kernels for Ouster packets: points of data packets, and checksums."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numba import njit
from numpy.typing import NDArray

from recon4.kernels.returns import (
    AT,
    ColumnShots,
    Decoded,
    decoded,
    in_order,
    new_points,
    new_returns,
    pack,
    ring_marks,
    sift,
    unpack,
)

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


@njit(cache=True, nogil=True, error_model="numpy", inline="always")
def _after(word: np.uint64, tables: NDArray[np.uint64]) -> np.uint64:
    """The sum after eight bytes; ``word``: those, changed by the sum before them."""
    low = np.uint64(0xFF)
    return np.uint64(
        tables[7, word & low]
        ^ tables[6, word >> np.uint64(8) & low]
        ^ tables[5, word >> np.uint64(16) & low]
        ^ tables[4, word >> np.uint64(24) & low]
        ^ tables[3, word >> np.uint64(32) & low]
        ^ tables[2, word >> np.uint64(40) & low]
        ^ tables[1, word >> np.uint64(48) & low]
        ^ tables[0, word >> np.uint64(56)]
    )


@njit(cache=True, nogil=True, error_model="numpy", inline="always")
def _carried(words: NDArray[np.uint64], at: int) -> np.uint64:
    """What a word takes over from those in front of it, of which the first is 120 words earlier.

    Modulo the polynomial, with y = x^64, y^120 is the sum of y^k over the 15 numbers k here: a word
    counts as much as itself 120 - k words later. Elimination found this sum, a test checks it.
    """
    return np.uint64(
        words[at]
        ^ words[at + 4 * 7]
        ^ words[at + 4 * 9]
        ^ words[at + 4 * 15]
        ^ words[at + 4 * 17]
        ^ words[at + 4 * 24]
        ^ words[at + 4 * 26]
        ^ words[at + 4 * 38]
        ^ words[at + 4 * 43]
        ^ words[at + 4 * 53]
        ^ words[at + 4 * 62]
        ^ words[at + 4 * 68]
        ^ words[at + 4 * 69]
        ^ words[at + 4 * 78]
        ^ words[at + 4 * 94]
    )


@njit(cache=True, nogil=True, error_model="numpy")
def _fold(words: NDArray[np.uint64], last: NDArray[np.uint64]) -> None:
    """Find short rows that have the same checksum as long ones.

    No table is looked up, and a processor does all four rows at once.

    Args:
        words: 120 zeros and the words of four rows, word by word; is used up, (4 * (120 + W),).
        last: Receives the short rows, word by word, (4 * W or less,).
    """
    long = len(words) - 4 * 120 - len(last)
    for k in range(long):
        words[k + 4 * 120] ^= _carried(words, k)
    before, end = words[long:], words[long + 4 * 120 :]
    for k in range(len(last)):
        last[k] = end[k]
        end[k] = 0
    for k in range(len(last) if long else 0):
        last[k] ^= _carried(before, k)


@njit(cache=True, nogil=True, error_model="numpy")
def checksums(
    words: NDArray[np.uint64], rest: NDArray[np.uint8], tables: NDArray[np.uint64]
) -> NDArray[np.uint64]:
    """CRC-64/XZ of each row, (N,).

    Four rows side by side, as each step waits for the one before it.

    Args:
        words: The rows, eight bytes at a time, (N, W).
        rest: What is left of them, (N, K).
        tables: `CHECKSUM_TABLES`.
    """
    low, rows, width = np.uint64(0xFF), words.shape[0], words.shape[1]
    out, four = np.empty(rows, np.uint64), np.zeros(4 * (120 + width), np.uint64)
    last, start = np.empty(4 * min(width, 120), np.uint64), _ALL_ONES * np.uint64(width == 0)
    for row in range(0, rows, 4):
        one, two, three = min(row + 1, rows - 1), min(row + 2, rows - 1), min(row + 3, rows - 1)
        begun = four[4 * 120 :]
        for w in range(width):
            begun[4 * w] = words[row, w]
            begun[4 * w + 1] = words[one, w]
            begun[4 * w + 2] = words[two, w]
            begun[4 * w + 3] = words[three, w]
        for k in range(min(4, len(begun))):
            begun[k] ^= _ALL_ONES
        _fold(four, last)
        a = b = c = d = start
        for w in range(0, len(last), 4):
            a = _after(a ^ last[w], tables)
            b = _after(b ^ last[w + 1], tables)
            c = _after(c ^ last[w + 2], tables)
            d = _after(d ^ last[w + 3], tables)
        out[row], out[one], out[two], out[three] = a, b, c, d
    for row in range(rows):
        for k in range(rest.shape[1]):
            x = out[row]
            out[row] = x >> np.uint64(8) ^ tables[0, (x ^ np.uint64(rest[row, k])) & low]
    return out ^ _ALL_ONES


class EchoWords(NamedTuple):
    """Where a return lies in a pixel: words of four bytes."""

    range_word: int
    range_mask: int
    intensity_word: int
    intensity_shift: int
    intensity_mask: int


@njit(cache=True, nogil=True, error_model="numpy")
def _read(
    pixels: NDArray[np.uint32], step: int, echo: EchoWords, row: int, of: ColumnShots
) -> None:
    """Read one return of all pixels of a column, of ``step`` words each."""
    whole = of.whole[row * AT.room :]
    ranges = pixels[echo.range_word :: step]
    intensities = pixels[echo.intensity_word :: step]
    range_mask, shift = np.uint32(echo.range_mask), np.uint32(echo.intensity_shift)
    intensity_mask = np.uint32(echo.intensity_mask)
    for b in range(len(ranges)):
        whole[AT.units + b] = np.int32(ranges[b] & range_mask)
        whole[AT.marks + b] = np.int32((intensities[b] >> shift) & intensity_mask)


@njit(cache=True, nogil=True, fastmath=True, error_model="numpy")
def _place(
    m: NDArray[np.float32],
    beam: NDArray[np.float32],
    unit_m: np.float32,
    row: int,
    of: ColumnShots,
) -> None:
    """Points of one return of all pixels of a column.

    Args:
        m: Rotation and translation of the column, (3, 4).
        beam: Origin [m] and direction of each beam, (6, B).
        unit_m: Meters per unit of the range.
        row: Which return.
        of: Has the distances, receives the points.
    """
    units, xyz = of.whole[row * AT.room :], of.xyz[row * AT.echo :]
    xx, xy, xz, x0 = m[0, 0], m[0, 1], m[0, 2], m[0, 3]
    yx, yy, yz, y0 = m[1, 0], m[1, 1], m[1, 2], m[1, 3]
    zx, zy, zz, z0 = m[2, 0], m[2, 1], m[2, 2], m[2, 3]
    for b in range(beam.shape[1]):
        r = np.float32(units[AT.units + b]) * unit_m
        x = beam[0, b] + r * beam[3, b]
        y = beam[1, b] + r * beam[4, b]
        z = beam[2, b] + r * beam[5, b]
        xyz[b] = xx * x + xy * y + xz * z + x0
        xyz[AT.room + b] = yx * x + yy * y + yz * z + y0
        xyz[2 * AT.room + b] = zx * x + zy * y + zz * z + z0


@njit(cache=True, nogil=True, error_model="numpy")
def decode(
    words: NDArray[np.uint32],
    columns: tuple[NDArray[np.int64], NDArray[np.int64], NDArray[np.int64]],
    layout: tuple[EchoWords, ...],
    pixel: tuple[int, bool, np.float32],
    limits: tuple[int, int],
    turns: NDArray[np.float32],
    beams: tuple[NDArray[np.float32], NDArray[np.uint8]],
) -> Decoded:
    """Decode sound packets to points.

    Args:
        words: Data packets, four bytes at a time, (P, S).
        columns: Time of each column [ns], (P, C); its row in ``turns``, negative = not valid,
            (P, C); and the first word of its pixels in a packet, (C,).
        layout: One or two returns of a pixel.
        pixel: Words of a pixel; whether of two returns the one of the higher intensity is the
            first; meters per unit of the range.
        limits: Smallest and largest range kept [units].
        turns: Maps the frame that turns with the beams into that of the sensor at each column,
            rotation and translation, (W, 3, 4).
        beams: Origin [m] and direction of each beam in the turning frame, (6, B); its ring, (B,).

    Returns:
        Points in order of time.
    """
    t_ns, turn_rows, first = columns
    step, by_intensity, unit_m = pixel
    ring, returns = ring_marks(beams[1]), len(layout)
    of, order = new_returns(len(ring)), np.arange(len(ring)).astype(np.uintp)
    points = new_points(len(words), turn_rows.shape[1] * len(ring) * returns)
    for p in range(words.shape[0]):
        for c in range(turn_rows.shape[1]):
            if turn_rows[p, c] < 0:
                continue
            pixels = words[p, first[c] : first[c] + step * len(ring)]
            of.t_ns[:] = t_ns[p, c]
            for row in range(returns):
                _read(pixels, step, layout[row], row, of)
            if returns == 2:
                in_order(of, by_intensity)
            for row in range(returns):
                sift(of, row, ring, limits)
                _place(turns[turn_rows[p, c]], beams[0], unit_m, row, of)
            pack(of, order, returns, points)
        unpack(points)
    return decoded(points, of)
