"""The returns of many shots, step by step: each step is a loop without branches.

A return that is missing or too far at random is what a processor cannot foresee; without branches
it computes eight at once. A kernel reads the distances of a column into `ColumnShots`, and then::

    in_order (of two) ──► sift ──► ``xyz`` (the kernel's own) ──► pack ──► unpack (a packet) ──► all

Numbers of several rows lie in one array, a constant number of places from row to row. So the
compiler knows that rows do not overlap; it asks no more than a few times before it gives up.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numba import njit
from numpy.typing import NDArray

Decoded = tuple[
    NDArray[np.int64],
    NDArray[np.float32],
    NDArray[np.uint16],
    NDArray[np.uint8],
    NDArray[np.uint8],
    NDArray[np.int64],
]
"""``t_ns, xyz, intensity, ring, echo`` of the points, and counts."""


class ShotRows(NamedTuple):
    """Where the rows of `ColumnShots` begin; second returns are one room behind first ones."""

    room: int = 256
    """Places of a row: the most shots of a column."""
    units: int = 0
    """Distance in units of the sensor, 0 = no return."""
    marks: int = 512
    """Intensity in bits 0-15; `sift` adds the ring in bits 16-23 and the echo in bit 24."""
    kept: int = 1024
    """1 = it is a point."""
    counts: int = 1536
    """Of all so far, by place: shots without return, returns too near and too far; three rows."""
    end: int = 2304
    """Places of all rows."""
    echo: int = 768
    """From x, y and z of a first return to those of the second one."""


AT = ShotRows()


class ColumnShots(NamedTuple):
    """Scratch memory of up to C shots; each has a first and a second return."""

    whole: NDArray[np.int32]
    """Rows of `ShotRows`, (9 * room,)."""
    xyz: NDArray[np.float32]
    """Where the first returns are, and the second ones: x, y, z in a row each [m], (6 * room,)."""
    t_ns: NDArray[np.int64]
    """Time of the shots, (C,)."""


class PointRows(NamedTuple):
    """Memory for the points of some packets, and for one more."""

    t_ns: NDArray[np.int64]
    """(N + 1,)."""
    xyz: NDArray[np.float32]
    """(N + 1, 3)."""
    intensity: NDArray[np.uint16]
    """(N,)."""
    ring: NDArray[np.uint8]
    """(N,)."""
    echo: NDArray[np.uint8]
    """(N,)."""
    marks: NDArray[np.int32]
    """Those of a packet, until `unpack`: it stays in the cache, (most of a packet + 1,)."""
    filled: NDArray[np.int64]
    """Points so far, and those before the packet, (2,)."""


@njit(cache=True, nogil=True, error_model="numpy")
def new_returns(shots: int) -> ColumnShots:
    """Memory of C shots, at most one room."""
    return ColumnShots(
        np.zeros(AT.end, np.int32),
        np.zeros(2 * AT.echo, np.float32),
        np.zeros(shots, np.int64),
    )


@njit(cache=True, nogil=True, error_model="numpy")
def new_points(packets: int, most: int) -> PointRows:
    """Memory of packets of up to ``most`` points; the last row takes what `pack` does not keep."""
    size = packets * most
    return PointRows(
        np.empty(size + 1, np.int64),
        np.empty((size + 1, 3), np.float32),
        np.empty(size, np.uint16),
        np.empty(size, np.uint8),
        np.empty(size, np.uint8),
        np.empty(most + 1, np.int32),
        np.zeros(2, np.int64),
    )


@njit(cache=True, nogil=True, error_model="numpy")
def ring_marks(ring: NDArray[np.uint8]) -> NDArray[np.int32]:
    """Rings as `sift` adds them to marks, (C,)."""
    marks = np.empty(len(ring), np.int32)
    for c in range(len(ring)):
        marks[c] = np.int32(ring[c]) << np.int32(16)
    return marks


@njit(cache=True, nogil=True, error_model="numpy", forceinline=True)
def in_order(of: ColumnShots, by_intensity: bool) -> None:
    """Put the more intense return first, or the only one; drop a second one that equals it."""
    whole = of.whole
    for c in range(len(of.t_ns)):
        one, other = whole[AT.units + c], whole[AT.units + AT.room + c]
        mark, other_mark = whole[AT.marks + c], whole[AT.marks + AT.room + c]
        swapped = (other != 0) & ((one == 0) | (by_intensity & (other_mark > mark)))
        whole[AT.units + c] = other if swapped else one
        whole[AT.units + AT.room + c] = 0 if one == other else (one if swapped else other)
        whole[AT.marks + c] = other_mark if swapped else mark
        whole[AT.marks + AT.room + c] = mark if swapped else other_mark


@njit(cache=True, nogil=True, error_model="numpy", forceinline=True)
def sift(of: ColumnShots, echo: int, ring: NDArray[np.int32], limits: tuple[int, int]) -> None:
    """Find out which returns are within the limits, and count the others.

    Args:
        of: Distances and intensities; receives which are kept, counts and the rest of the marks.
        echo: Their row, 0 before 1: a second return is a further one if the first is kept.
        ring: Of each shot, see `ring_marks`, (C,).
        limits: Smallest and largest distance [units].
    """
    whole, second = of.whole, np.int32(echo)
    first = np.int32(1) - second
    least, most = np.int32(max(limits[0], 1)), np.int32(limits[1])
    rows = whole[echo * AT.room :]
    counts = whole[AT.counts :]
    for c in range(len(of.t_ns)):
        one = rows[AT.units + c]
        none = np.int32(one == 0)
        near, far = np.int32(one < least) - none, np.int32(one > most)
        rows[AT.kept + c] = np.int32(1) - (none | near | far)
        counts[c] += none & first
        counts[AT.room + c] += near
        counts[2 * AT.room + c] += far
    for c in range(len(of.t_ns)):
        further = (whole[AT.kept + c] & second) << np.int32(24)
        rows[AT.marks + c] |= ring[c] | further


@njit(cache=True, nogil=True, error_model="numpy", forceinline=True)
def pack(of: ColumnShots, order: NDArray[np.uintp], returns: int, points: PointRows) -> None:
    """Append the returns that are kept, shot by shot.

    Each return is written where the next point belongs, and the next one overwrites it unless it
    is kept. Indices have no sign: numba need not ask whether they are negative.

    Args:
        of: The returns.
        order: The shots in the order in which they were fired, (C,).
        returns: Of a shot, 1 or 2.
        points: Receives them.
    """
    whole, xyz, t_ns = of.whole, of.xyz, of.t_ns
    out_t, out_xyz, out_marks = points.t_ns, points.xyz, points.marks
    room, y, z = np.uintp(AT.room), np.uintp(AT.room), np.uintp(2 * AT.room)
    marks, kept, echo = np.uintp(AT.marks), np.uintp(AT.kept), np.uintp(AT.echo)
    at, first = np.uintp(points.filled[0]), np.uintp(points.filled[1])
    for shot in order:
        c = np.uintp(shot)
        out_t[at] = t_ns[c]
        out_xyz[at, 0] = xyz[c]
        out_xyz[at, 1] = xyz[c + y]
        out_xyz[at, 2] = xyz[c + z]
        out_marks[at - first] = whole[c + marks]
        at += np.uintp(whole[c + kept])
        if returns == 2:
            out_t[at] = t_ns[c]
            out_xyz[at, 0] = xyz[c + echo]
            out_xyz[at, 1] = xyz[c + echo + y]
            out_xyz[at, 2] = xyz[c + echo + z]
            out_marks[at - first] = whole[c + marks + room]
            at += np.uintp(whole[c + kept + room])
    points.filled[0] = np.int64(at)


@njit(cache=True, nogil=True, error_model="numpy", forceinline=True)
def unpack(points: PointRows) -> None:
    """Write the marks of a packet as columns; the next one begins."""
    end, first, marks = points.filled[0], points.filled[1], points.marks
    intensity, ring, echo = points.intensity[first:], points.ring[first:], points.echo[first:]
    for k in range(end - first):
        mark = marks[k]
        intensity[k] = np.uint16(mark)
        ring[k] = np.uint8(mark >> np.int32(16))
        echo[k] = np.uint8(mark >> np.int32(24))
    points.filled[1] = end


@njit(cache=True, nogil=True, error_model="numpy")
def decoded(points: PointRows, of: ColumnShots) -> Decoded:
    """The points as columns, and the counts of shots without return, too near and too far, (3,)."""
    n = points.filled[0]
    counts = np.zeros(3, np.int64)
    for row in range(3):
        start = AT.counts + row * AT.room
        for count in of.whole[start : start + AT.room]:
            counts[row] += count
    columns = points.intensity[:n], points.ring[:n], points.echo[:n]
    return points.t_ns[:n], points.xyz[:n], columns[0], columns[1], columns[2], counts
