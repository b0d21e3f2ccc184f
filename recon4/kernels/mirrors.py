"""Kernel that decodes the packets of an AT128: a drum of mirrors turns its beams."""

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
from recon4.kernels.spinning import Distances

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


class DrumRows(NamedTuple):
    """Where the numbers of the channels begin, a room of `AT` each."""

    cos_az: int = 0
    sin_az: int = 256
    """Cosine and sine of what a channel adds to twice the angle since its mirror begins."""
    cos_el: int = 512
    sin_el: int = 768
    """Cosine and sine of its elevation."""
    end: int = 1024
    """Places of all rows."""


OF = DrumRows()


class Drum(NamedTuple):
    """MirrorRows of M mirrors and C channels."""

    start: NDArray[np.int64]
    """Azimuth where each mirror begins [1/25600°], ascending, (M,)."""
    channel: NDArray[np.float32]
    """Rows of `DrumRows`, (4 * room,)."""
    azimuth_correction: NDArray[np.float32]
    """Added to the azimuth at every 2° of the drum [rad], (180, C)."""
    elevation_correction: NDArray[np.float32]
    """Added to the elevation [rad], (180, C)."""
    ring: NDArray[np.uint8]
    """Ring, 0 = lowest elevation, (C,)."""


class MirrorRows(NamedTuple):
    """Where the numbers of the shots of a block begin, a room of `AT` each."""

    x: int = 0
    y: int = 256
    """At first sine and cosine of the azimuth."""
    z: int = 512
    """Where one unit of the distance leads [m]."""
    end: int = 768
    """Places of all rows."""


TO = MirrorRows()


@njit(cache=True, nogil=True, fastmath=True, error_model="numpy", inline="always")
def _turned(
    cosine: np.float32, sine: np.float32, by_rad: np.float32
) -> tuple[np.float32, np.float32]:
    """Cosine and sine of an angle that a correction of up to 2.6° is added to."""
    half = np.float32(0.5) * by_rad * by_rad
    cos_by = np.float32(1.0) - half
    sin_by = by_rad * (np.float32(1.0) - half * np.float32(1.0 / 3.0))
    return cosine * cos_by - sine * sin_by, sine * cos_by + cosine * sin_by


@njit(cache=True, nogil=True, error_model="numpy")
def _read(payload: NDArray[np.uint8], base: int, channel: int, row: int, of: ColumnShots) -> None:
    """Read one return of all shots of a block: distance u2, intensity u1."""
    shots, whole = payload[base:], of.whole[row * AT.room :]
    if channel == 4:  # a number that the compiler knows: it reads eight at once
        for c in range(len(of.t_ns)):
            whole[AT.units + c] = np.int32(shots[4 * c]) | (np.int32(shots[4 * c + 1]) << 8)
            whole[AT.marks + c] = np.int32(shots[4 * c + 2])
    else:
        for c in range(len(of.t_ns)):
            at = c * channel
            whole[AT.units + c] = np.int32(shots[at]) | (np.int32(shots[at + 1]) << 8)
            whole[AT.marks + c] = np.int32(shots[at + 2])


@njit(cache=True, nogil=True, fastmath=True, error_model="numpy")
def _direct(
    azimuth: int,
    drum: Drum,
    unit_m: np.float32,
    circle: NDArray[np.float32],
    to: NDArray[np.float32],
) -> None:
    """MirrorRows of the shots of a block.

    Args:
        azimuth: Of the drum [1/25600°], below a turn.
        drum: Its mirrors.
        unit_m: Meters of one unit of the distance.
        circle: `recon4.kernels.spinning.CIRCLE`.
        to: Receives rows of `MirrorRows`, (3 * room,).
    """
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
    channel = drum.channel
    first, second = drum.azimuth_correction[node], drum.azimuth_correction[after]
    for c in range(len(drum.ring)):
        cos_c, sin_c = channel[OF.cos_az + c], channel[OF.sin_az + c]
        by_rad = first[c] + (second[c] - first[c]) * weight
        to[TO.y + c], to[TO.x + c] = _turned(
            cos_block * cos_c - sin_block * sin_c, sin_block * cos_c + cos_block * sin_c, by_rad
        )
    first, second = drum.elevation_correction[node], drum.elevation_correction[after]
    for c in range(len(drum.ring)):
        by_rad = first[c] + (second[c] - first[c]) * weight
        cos_el, sin_el = _turned(channel[OF.cos_el + c], channel[OF.sin_el + c], by_rad)
        flat = cos_el * unit_m
        to[TO.x + c] *= flat
        to[TO.y + c] *= flat
        to[TO.z + c] = sin_el * unit_m


@njit(cache=True, nogil=True, error_model="numpy")
def _place(to: NDArray[np.float32], row: int, of: ColumnShots) -> None:
    """Points of one return of all shots of a block."""
    units, xyz = of.whole[row * AT.room :], of.xyz[row * AT.echo :]
    for c in range(len(of.t_ns)):
        distance = np.float32(units[AT.units + c])
        xyz[c] = distance * to[TO.x + c]
        xyz[AT.room + c] = distance * to[TO.y + c]
        xyz[2 * AT.room + c] = distance * to[TO.z + c]


@njit(cache=True, nogil=True, error_model="numpy")
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
        drum: MirrorRows of at most one room of channels.
        distances: Unit and limits.
        circle: `recon4.kernels.spinning.CIRCLE`.

    Returns:
        As `recon4.kernels.spinning.decode`; no azimuth jumps are counted.
    """
    channels = len(drum.ring)
    points = new_points(len(payloads), shape.blocks * channels)
    of, to = new_returns(channels), np.zeros(TO.end, np.float32)
    marks, order = ring_marks(drum.ring), np.arange(channels).astype(np.uintp)
    limits = (distances.least, distances.most)
    for p in range(len(payloads)):
        payload, group = payloads[p], returns[p]
        for b in range(0, shape.blocks - group + 1, group):
            at = shape.first + b * shape.block
            azimuth = (int(payload[at]) | (int(payload[at + 1]) << 8)) * 256 + payload[at + 2]
            at += shape.channel_first
            _read(payload, at, shape.channel, group - 1, of)
            if group == 2:  # as in `spinning.decode`: of equal returns the second one is the first
                _read(payload, at + shape.block, shape.channel, 0, of)
                in_order(of, True)
            _direct(azimuth % _TURN, drum, distances.unit_m, circle, to)
            for echo in range(group):
                sift(of, echo, marks, limits)
                _place(to, echo, of)
            of.t_ns[:] = t_ns[p] + block_ns[b // group]
            pack(of, order, group, points)
        unpack(points)
    found = decoded(points, of)
    counts = np.append(found[5], np.int64(0))
    return found[0], found[1], found[2], found[3], found[4], counts
