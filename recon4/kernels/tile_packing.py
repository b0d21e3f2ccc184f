"""Kernels that take columns of a tile apart into bytes that compress well, and join them again."""

from __future__ import annotations

from typing import Any

import numpy as np
from numba import njit
from numpy.typing import NDArray


@njit(cache=True, nogil=True, error_model="numpy")
def spatial_rows(
    count: int,
    strata: NDArray[np.int64],
    first: int,
    stop: int,
    rows: NDArray[np.int32],
    places: NDArray[np.int32],
) -> None:
    """Rows of a block in spatial order.

    Args:
        count: Rows of the part of a tile, in the order of `recon4.mapping.tile_order.progressive`.
        strata: The strata in their stored order, int64 (S,).
        first: First row of the block.
        stop: Row after its last.
        rows: Receives the rows from ``first`` on, int32 (stop - first,).
        places: Receives the place of each in the spatial order of the part, increasing, int32
            (stop - first,).
    """
    begins = np.zeros(len(strata), np.int64)
    at = 0
    for s in strata:
        begins[s] = at
        at += max(0, (count - s + len(strata) - 1) // len(strata))
    met = np.empty(len(strata), np.int64)
    many = 0
    longest = (count + len(strata) - 1) // len(strata)
    for s in range(len(strata)):
        if begins[s] < stop and begins[s] + longest >= first:
            met[many] = s
            many += 1
    found = 0
    for q in range(longest):
        for m in range(many):
            row = begins[met[m]] + q
            if first <= row < stop and q * len(strata) + met[m] < count:
                rows[found] = row - first
                places[found] = q * len(strata) + met[m]
                found += 1


@njit(cache=True, nogil=True, error_model="numpy", inline="always")
def _width_of(every: np.uint64) -> int:
    """Bytes that the largest of some numbers needs, by all of their bits; at least 1."""
    width = 1
    while width < 8 and every >> np.uint64(8 * width):
        width += 1
    return width


@njit(cache=True, nogil=True, error_model="numpy")
def lengths_to_bits(
    values: NDArray[np.float32], step: float, along: bool, out: NDArray[np.uint64]
) -> int:
    """Whole steps of lengths as `numbers_to_bits` gives those of numbers.

    Args:
        values: float32 (N, K).
        step: What they are rounded to.
        along: Whether each number is stored as its difference to the one before it.
        out: Receives the bits, uint64 (K, N).
    """
    every = np.uint64(0)
    for k in range(values.shape[1]):
        last = np.int64(0)
        for n in range(len(values)):
            value = np.int64(np.rint(np.float64(values[n, k]) / step))
            away = value - last
            if along:
                last = value
            bits = np.uint64((away << 1) ^ (away >> 63))
            out[k, n] = bits
            every |= bits
    return _width_of(every)


@njit(cache=True, nogil=True, error_model="numpy")
def numbers_to_bits(
    values: NDArray[np.int64],
    along: bool,
    halves: bool,
    out: NDArray[np.uint64],
) -> int:
    """Numbers with their sign in the lowest bit, so that the upper bytes of small ones are zero.

    Args:
        values: int64 (N, K).
        along: Whether each number is stored as its difference to the one before it.
        halves: Whether numbers have 16 bits: differences wrap, and sums of them wrap back.
        out: Receives the bits, uint64 (K, N).

    Returns:
        Bytes that the largest of them needs, at least 1.
    """
    every = np.uint64(0)
    for k in range(values.shape[1]):
        last = np.int64(0)
        for n in range(len(values)):
            value = values[n, k]
            step = value - last
            if along:
                last = value
            if halves:
                step = np.int64(np.int16(step & 0xFFFF))
            bits = np.uint64((step << 1) ^ (step >> 63))
            out[k, n] = bits
            every |= bits
    return _width_of(every)


@njit(cache=True, nogil=True, error_model="numpy")
def bits_to_bytes(bits: NDArray[np.uint64], out: NDArray[np.uint8]) -> None:
    """The bytes of numbers apart: the lowest of all first, (K, N) -> (K, W, N)."""
    for k in range(out.shape[0]):
        for byte in range(out.shape[1]):
            shift = np.uint64(8 * byte)
            for n in range(out.shape[2]):
                out[k, byte, n] = (bits[k, n] >> shift) & np.uint64(0xFF)


@njit(cache=True, nogil=True, error_model="numpy")
def bytes_to_numbers(
    packed: NDArray[np.uint8],
    rows: NDArray[np.int32],
    along: bool,
    step: Any,
    out: NDArray[Any],
) -> None:
    """The numbers of `numbers_to_bits` and `bits_to_bytes`, times a step.

    Args:
        packed: The bytes, uint8 (K, W, N).
        rows: Row of each number, int32 (N,).
        along: As given to it.
        step: Factor of the numbers, whole for whole ones.
        out: Receives them, float32 or whole numbers of any size, (at least N, K).
    """
    count = packed.shape[2]
    steps = np.empty(count, np.int64)
    few = np.empty(count, np.int32)
    for k in range(packed.shape[0]):
        if packed.shape[1] > 3:
            _steps(packed[k], steps)
            _spread(steps, rows, along, step, out[:, k])
        else:
            _few_steps(packed[k], few)
            _spread(few, rows, along, step, out[:, k])


@njit(cache=True, nogil=True, error_model="numpy", inline="always")
def _few_steps(packed: NDArray[np.uint8], steps: NDArray[np.int32]) -> None:
    """Numbers of up to three bytes: loops that the compiler makes of vectors."""
    if packed.shape[0] == 1:
        for n in range(len(steps)):
            bits = np.int32(packed[0, n])
            steps[n] = (bits >> 1) ^ -(bits & 1)
    elif packed.shape[0] == 2:
        for n in range(len(steps)):
            bits = np.int32(packed[0, n]) | (np.int32(packed[1, n]) << 8)
            steps[n] = (bits >> 1) ^ -(bits & 1)
    else:
        for n in range(len(steps)):
            low = np.int32(packed[0, n]) | (np.int32(packed[1, n]) << 8)
            bits = low | (np.int32(packed[2, n]) << 16)
            steps[n] = (bits >> 1) ^ -(bits & 1)


@njit(cache=True, nogil=True, error_model="numpy", inline="always")
def _steps(packed: NDArray[np.uint8], steps: NDArray[np.int64]) -> None:
    """Numbers of up to eight bytes."""
    one = np.uint64(1)
    for n in range(len(steps)):
        bits = np.uint64(0)
        for byte in range(packed.shape[0]):
            bits |= np.uint64(packed[byte, n]) << np.uint64(8 * byte)
        steps[n] = np.int64(bits >> one) ^ -np.int64(bits & one)


@njit(cache=True, nogil=True, error_model="numpy", inline="always")
def _spread(
    steps: NDArray[Any], rows: NDArray[np.int32], along: bool, step: Any, out: NDArray[Any]
) -> None:
    """Numbers, or their sums, times a step, to the rows that they are of."""
    value = np.int64(0)
    if along:
        for n in range(len(steps)):
            value += steps[n]
            out[rows[n]] = value * step
    else:
        for n in range(len(steps)):
            out[rows[n]] = steps[n] * step
