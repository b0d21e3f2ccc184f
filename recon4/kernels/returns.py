"""The returns of many shots, step by step: each step is a loop without branches.

A return that is missing or too far at random is what a processor cannot foresee; without branches
it computes eight at once. A kernel reads the distances of a column into `ColumnShots`, and then::

    in_order (of two) ──► sift ──► ``xyz`` (the kernel's own) ──► pack ──► decoded (of all)
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numba import njit
from numpy.typing import NDArray

from recon4.kernels.spinning import Decoded


class ColumnShots(NamedTuple):
    """Scratch memory; rows are the first and the second returns of C shots."""

    units: NDArray[np.int32]
    """Distance in units of the sensor, 0 = no return, (2, C)."""
    marks: NDArray[np.uint32]
    """Intensity in bits 0-15; `sift` adds the ring in bits 16-23 and the echo in bit 24, (2, C)."""
    kept: NDArray[np.int32]
    """1 = it is a point, (2, C)."""
    xyz: NDArray[np.float32]
    """Where it is [m], (2, 3, C)."""
    t_ns: NDArray[np.int64]
    """Time of the shots, (C,)."""
    counts: NDArray[np.int32]
    """Of all so far, by place, shots without return, returns too near and too far, (3, C)."""


class PointRows(NamedTuple):
    """Memory for the points of some packets, and for one more."""

    t_ns: NDArray[np.int64]
    """(N + 1,)."""
    xyz: NDArray[np.float32]
    """(N + 1, 3)."""
    marks: NDArray[np.uint32]
    """Those of `ColumnShots`, (N + 1,)."""


@njit(cache=True, nogil=True, error_model="numpy")
def new_returns(shots: int) -> ColumnShots:
    """Memory of C shots."""
    return ColumnShots(
        np.zeros((2, shots), np.int32),
        np.zeros((2, shots), np.uint32),
        np.zeros((2, shots), np.int32),
        np.zeros((2, 3, shots), np.float32),
        np.zeros(shots, np.int64),
        np.zeros((3, shots), np.int32),
    )


@njit(cache=True, nogil=True, error_model="numpy")
def new_points(most: int) -> PointRows:
    """Memory of up to N points; the last row takes what `pack` does not keep."""
    return PointRows(
        np.empty(most + 1, np.int64),
        np.empty((most + 1, 3), np.float32),
        np.empty(most + 1, np.uint32),
    )


@njit(cache=True, nogil=True, error_model="numpy")
def ring_marks(ring: NDArray[np.uint8]) -> NDArray[np.uint32]:
    """Rings as `sift` adds them to marks, (C,)."""
    marks = np.empty(len(ring), np.uint32)
    for c in range(len(ring)):
        marks[c] = np.uint32(ring[c]) << np.uint32(16)
    return marks


@njit(cache=True, nogil=True, error_model="numpy")
def in_order(of: ColumnShots, by_intensity: bool) -> None:
    """Put the more intense return first, or the only one; drop a second one that equals it."""
    units, marks = of.units, of.marks
    for c in range(len(of.t_ns)):
        one, other = units[0, c], units[1, c]
        mark, other_mark = marks[0, c], marks[1, c]
        swapped = (other != 0) & ((one == 0) | (by_intensity & (other_mark > mark)))
        units[0, c] = other if swapped else one
        units[1, c] = 0 if one == other else (one if swapped else other)
        marks[0, c] = other_mark if swapped else mark
        marks[1, c] = mark if swapped else other_mark


@njit(cache=True, nogil=True, error_model="numpy", inline="always")
def sift(of: ColumnShots, echo: int, ring: NDArray[np.uint32], limits: tuple[int, int]) -> None:
    """Find out which returns are within the limits, and count the others.

    One count a loop and a place: sums of all would be of 64 bits, half as fast.

    Args:
        of: Distances and intensities; receives ``kept``, ``counts`` and the rest of ``marks``.
        echo: Their row, 0 before 1: a second return is a further one if the first is kept.
        ring: Of each shot, see `ring_marks`, (C,).
        limits: Smallest and largest distance [units].
    """
    units, marks, kept, counts = of.units, of.marks, of.kept, of.counts
    least, most = np.int32(max(limits[0], 1)), np.int32(limits[1])
    for c in range(len(of.t_ns)):
        one = units[echo, c]
        kept[echo, c] = np.int32(one >= least) & np.int32(one <= most)
        marks[echo, c] |= ring[c]
    for c in range(len(of.t_ns)):
        one = units[echo, c]
        counts[1, c] += np.int32(one < least) & np.int32(one != 0)
    for c in range(len(of.t_ns)):
        counts[2, c] += np.int32(units[echo, c] > most)
    if echo == 0:
        for c in range(len(of.t_ns)):
            counts[0, c] += np.int32(units[0, c] == 0)
    else:
        for c in range(len(of.t_ns)):
            marks[1, c] |= np.uint32(kept[0, c] << 24)


@njit(cache=True, nogil=True, error_model="numpy")
def pack(n: np.int64, of: ColumnShots, returns: int, points: PointRows) -> np.int64:
    """Append the returns that are kept, shot by shot; returns how many there are then.

    Each return is written where the next point belongs, and the next one overwrites it unless it
    is kept.

    Args:
        n: Points so far.
        of: The returns.
        returns: Of a shot, 1 or 2.
        points: Receives them.
    """
    marks, kept, xyz, t_ns = of.marks, of.kept, of.xyz, of.t_ns
    out_t, out_xyz, out_marks = points.t_ns, points.xyz, points.marks
    at = np.uintp(n)  # an index without sign: numba need not ask whether it is negative
    if returns == 1:
        for c in range(len(of.t_ns)):
            out_t[at] = t_ns[c]
            out_xyz[at, 0] = xyz[0, 0, c]
            out_xyz[at, 1] = xyz[0, 1, c]
            out_xyz[at, 2] = xyz[0, 2, c]
            out_marks[at] = marks[0, c]
            at += np.uintp(kept[0, c])
        return np.int64(at)
    for c in range(len(of.t_ns)):
        out_t[at] = t_ns[c]
        out_xyz[at, 0] = xyz[0, 0, c]
        out_xyz[at, 1] = xyz[0, 1, c]
        out_xyz[at, 2] = xyz[0, 2, c]
        out_marks[at] = marks[0, c]
        at += np.uintp(kept[0, c])
        out_t[at] = t_ns[c]
        out_xyz[at, 0] = xyz[1, 0, c]
        out_xyz[at, 1] = xyz[1, 1, c]
        out_xyz[at, 2] = xyz[1, 2, c]
        out_marks[at] = marks[1, c]
        at += np.uintp(kept[1, c])
    return np.int64(at)


@njit(cache=True, nogil=True, error_model="numpy")
def decoded(n: np.int64, points: PointRows, of: ColumnShots) -> Decoded:
    """The first N points as columns, and the counts."""
    intensity = np.empty(n, np.uint16)
    ring = np.empty(n, np.uint8)
    echo = np.empty(n, np.uint8)
    for k in range(n):
        mark = points.marks[k]
        intensity[k] = np.uint16(mark)
        ring[k] = np.uint8(mark >> np.uint32(16))
        echo[k] = np.uint8(mark >> np.uint32(24))
    counts = np.zeros(3, np.int64)
    for row in range(3):
        for count in of.counts[row]:
            counts[row] += count
    return points.t_ns[:n], points.xyz[:n], intensity, ring, echo, counts
