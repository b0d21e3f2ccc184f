"""Kernel that decodes the packets of LiDARs that spin to points; arguments as named arrays.

A packet is a row of blocks, a block an azimuth and a row of channels, a channel a distance of two
bytes and an intensity of one. A *firing* is what one or several blocks tell of all lasers, once.
P packets, B blocks, C channels in a block, K blocks that are read, V variants of packets, T rows of
tables of channels.
"""

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
from recon4.units import CDEG_RAD

_AZIMUTH = CDEG_RAD * (np.arange(72000) % 36000)
CIRCLE = np.column_stack([np.cos(_AZIMUTH), np.sin(_AZIMUTH)]).astype(np.float32)
"""Cosine and sine of every azimuth on the wire plus any offset, the last argument of `decode`:
numba compiles arrays of modules into the code. (72000, 2)."""


class BeamRows(NamedTuple):
    """Where the numbers of the beams begin, a room of `AT` each."""

    cos_el: int = 0
    sin_el: int = 256
    """Cosine and sine of the elevation of a beam."""
    along: int = 512
    right: int = 768
    height: int = 1024
    """Where it begins: along f, to the right of f as seen from above, above the center [m]."""
    range: int = 1280
    """Added to every distance [m]."""
    fraction: int = 1536
    """Firing time as a fraction of the time from a firing to the next: of the turn in between."""
    offset: int = 1792
    """The small rest of the offset of the azimuth beside whole 0.01° [rad]."""
    end: int = 2048
    """Places of all rows."""


BEAM = BeamRows()


class TurnRows(NamedTuple):
    """Where the numbers of the shots of a block begin, a room of `AT` each."""

    cos: int = 0
    sin: int = 256
    """Cosine and sine of the azimuth; of that of the block at first."""
    right_sin: int = 512
    right_cos: int = 768
    """How far the beam begins to the right, times sine and cosine of the azimuth [m]."""
    end: int = 1024
    """Places of all rows."""


TURN = TurnRows()


class Layout(NamedTuple):
    """Where the numbers lie in a packet, and what azimuths may do."""

    blocks: int
    """Blocks of a packet B, at most 64."""
    channels: int
    """Channels of a block C."""
    first: int
    """Offset of the first block in a packet [bytes]."""
    block: int
    """From one block to the next [bytes]."""
    azimuth: int
    """Offset of the azimuth in a block [bytes]; 0.01°, modulo 36000."""
    channel_first: int
    """Offset of the first channel in a block [bytes]."""
    channel: int
    """From one channel to the next, which starts with the distance [bytes]."""
    intensity: int
    """Offset of the intensity in a channel [bytes]."""
    big_endian: bool
    """Byte order of azimuths and distances."""
    min_step_cdeg: int
    """A smaller turn from one firing to the next is a jump, not rotation [0.01°]; -18000 = any."""
    max_step_cdeg: int
    """And so is a larger one (limited field of view) [0.01°]."""
    distance_mask: int = 0xFFFF
    """Bits of the two bytes that are the distance."""


class BlockRoles(NamedTuple):
    """Which blocks of a packet hold what; a row per variant of packets, as the return modes."""

    group: NDArray[np.int64]
    """Blocks from a firing to the next: both returns, all rows of the table, (V,)."""
    block: NDArray[np.int64]
    """The blocks to read, in order of time; their azimuth counts; -1 = no more, (V, K)."""
    twin: NDArray[np.int64]
    """The block with the second return of the same shots, -1 = none, (V, K)."""
    table: NDArray[np.int64]
    """Row of the tables of channels, (V, K)."""
    time_ns: NDArray[np.int64]
    """Firing time of each shot after the packet's time [ns], (V, K, C)."""


class Channels(NamedTuple):
    """The beam of each channel, (T, C).

    The beam of azimuth a (clockwise from x as seen from above) runs along f = (cos a, -sin a) and
    up; it does not begin at the center of the sensor.
    """

    beam: NDArray[np.float32]
    """Rows of `BeamRows`, (T, 8 * room)."""
    offset_cdeg: NDArray[np.int32]
    """Added to the azimuth of the block: whole 0.01°, 0 to 35999, (T, C)."""
    ring: NDArray[np.uint8]
    """Ring, 0 = lowest elevation, (T, C)."""
    order: NDArray[np.uintp]
    """The channels in the order in which they fire, (T, C)."""


class Distances(NamedTuple):
    """Unit and limits of distances."""

    unit_m: np.float32
    """Meters of one unit."""
    least: int
    """Smaller ones are too near [units]; 0 is no return."""
    most: int
    """Larger ones are too far [units]."""


@njit(cache=True, nogil=True, error_model="numpy", inline="always")
def _word(payload: NDArray[np.uint8], at: int, big_endian: bool) -> np.int32:
    low = int(big_endian)
    return np.int32(payload[at + low]) | (np.int32(payload[at + 1 - low]) << 8)


@njit(cache=True, nogil=True, error_model="numpy")
def _steps(payload: NDArray[np.uint8], layout: Layout, group: int, steps: NDArray[np.int32]) -> int:
    """Write the turn to the next firing at each block [0.01°]; returns the number of jumps."""
    jumps, last, first = 0, np.int32(0), -1
    ahead = group * layout.block
    for b in range(layout.blocks):
        steps[b] = last
        if b + group < layout.blocks:
            at = layout.first + b * layout.block + layout.azimuth
            step = _word(payload, at + ahead, layout.big_endian) - _word(
                payload, at, layout.big_endian
            )
            step = (step + 18000) % 36000 - 18000
            if layout.min_step_cdeg <= step <= layout.max_step_cdeg:
                last = np.int32(step)
                steps[b] = last
                first = b if first < 0 else first
            else:
                jumps += 1
    for b in range(max(first, 0)):
        steps[b] = steps[first]
    return jumps


@njit(cache=True, nogil=True, error_model="numpy", forceinline=True)
def _read(payload: NDArray[np.uint8], base: int, layout: Layout, row: int, of: ColumnShots) -> None:
    """Read one return of all shots of a block, whose channels begin at ``base``.

    The usual sizes of a channel are numbers that the compiler knows: it reads eight at once.
    """
    shots, whole = payload[base:], of.whole[row * AT.room :]
    if layout.channel == 3 and layout.intensity == 2:
        for c in range(layout.channels):
            whole[AT.units + c] = np.int32(shots[3 * c]) | (np.int32(shots[3 * c + 1]) << 8)
            whole[AT.marks + c] = np.int32(shots[3 * c + 2])
    elif layout.channel == 4 and layout.intensity == 2:
        for c in range(layout.channels):
            whole[AT.units + c] = np.int32(shots[4 * c]) | (np.int32(shots[4 * c + 1]) << 8)
            whole[AT.marks + c] = np.int32(shots[4 * c + 2])
    else:
        for c in range(layout.channels):
            whole[AT.units + c] = _word(shots, c * layout.channel, False)
            whole[AT.marks + c] = np.int32(shots[c * layout.channel + layout.intensity])
    mask = np.int32(layout.distance_mask)
    if layout.big_endian:
        for c in range(layout.channels):
            word = whole[AT.units + c]
            whole[AT.units + c] = (word >> 8) | ((word & 0xFF) << 8)
    if mask != 0xFFFF:
        for c in range(layout.channels):
            whole[AT.units + c] &= mask


@njit(cache=True, nogil=True, fastmath=True, error_model="numpy", forceinline=True)
def _turn(
    azimuth_cdeg: np.int32,
    step_rad: np.float32,
    beam: NDArray[np.float32],
    offset_cdeg: NDArray[np.int32],
    circle: NDArray[np.float32],
    turned: NDArray[np.float32],
) -> None:
    """Azimuths of the shots of a block, see `TurnRows`.

    Args:
        azimuth_cdeg: Of the block [0.01°].
        step_rad: Turn from a firing to the next [rad].
        beam: Rows of `BeamRows`.
        offset_cdeg: Added to the azimuth of the block [0.01°], (C,).
        circle: `CIRCLE`.
        turned: Receives the rows, (4 * room,).
    """
    for c in range(len(offset_cdeg)):  # on its own: what is looked up forbids eight at once
        at = (azimuth_cdeg + offset_cdeg[c]) & 131071  # masked, an index is not negative
        turned[TURN.cos + c] = circle[at, 0]
        turned[TURN.sin + c] = circle[at, 1]
    for c in range(len(offset_cdeg)):
        turn = step_rad * beam[BEAM.fraction + c] + beam[BEAM.offset + c]
        half = np.float32(0.5) * turn * turn
        cos_turn = np.float32(1.0) - half
        sin_turn = turn * (np.float32(1.0) - half * np.float32(1.0 / 3.0))
        cos, sin = turned[TURN.cos + c], turned[TURN.sin + c]
        turned[TURN.cos + c] = cos * cos_turn - sin * sin_turn
        turned[TURN.sin + c] = sin * cos_turn + cos * sin_turn
    for c in range(len(offset_cdeg)):
        turned[TURN.right_sin + c] = beam[BEAM.right + c] * turned[TURN.sin + c]
        turned[TURN.right_cos + c] = beam[BEAM.right + c] * turned[TURN.cos + c]


@njit(cache=True, nogil=True, fastmath=True, error_model="numpy", forceinline=True)
def _place(
    beam: NDArray[np.float32],
    turned: NDArray[np.float32],
    unit_m: np.float32,
    row: int,
    of: ColumnShots,
) -> None:
    """Points of one return of all shots of a block.

    Args:
        beam: Rows of `BeamRows`.
        turned: Rows of `TurnRows`.
        unit_m: Meters of one unit of the distance.
        row: Which return.
        of: Has the distances, receives the points.
    """
    units, xyz = of.whole[row * AT.room :], of.xyz[row * AT.echo :]
    for c in range(len(of.t_ns)):
        r = np.float32(units[AT.units + c]) * unit_m + beam[BEAM.range + c]
        flat = r * beam[BEAM.cos_el + c] + beam[BEAM.along + c]
        xyz[c] = flat * turned[TURN.cos + c] - turned[TURN.right_sin + c]
        xyz[AT.room + c] = -(flat * turned[TURN.sin + c] + turned[TURN.right_cos + c])
        xyz[2 * AT.room + c] = r * beam[BEAM.sin_el + c] + beam[BEAM.height + c]


@njit(cache=True, nogil=True, error_model="numpy")
def _all_ring_marks(ring: NDArray[np.uint8]) -> NDArray[np.int32]:
    """`ring_marks` of each row of the tables, (T, C)."""
    marks = np.empty(ring.shape, np.int32)
    for row in range(len(ring)):
        marks[row] = ring_marks(ring[row])
    return marks


@njit(cache=True, nogil=True, error_model="numpy")
def decode(
    payloads: NDArray[np.uint8],
    t_ns: NDArray[np.int64],
    variant: NDArray[np.uint8],
    layout: Layout,
    roles: BlockRoles,
    channels: Channels,
    distances: Distances,
    circle: NDArray[np.float32],
    turn_rad: NDArray[np.float32],
) -> Decoded:
    """Decode packets that passed the filter to points.

    Nothing is checked here: the layout must fit into the payloads.

    Args:
        payloads: Data packets, (P, size).
        t_ns: Time of the first shot of each packet [ns], (P,).
        variant: Row of ``roles`` of each packet, (P,).
        layout: Where the numbers lie.
        roles: Which blocks hold what.
        channels: Beams.
        distances: Unit and limits.
        circle: `CIRCLE`.
        turn_rad: Turn from a firing to the next in each packet [rad], (P,); empty = the steps of
            the azimuth in the packet tell.

    Returns:
        Points in firing order, and counts of shots without return, returns too near, too far and
        jumps of azimuth, (4,).
    """
    points = new_points(len(payloads), layout.blocks * layout.channels)
    of, turned = new_returns(layout.channels), np.zeros(TURN.end, np.float32)
    marks, steps, jumps = _all_ring_marks(channels.ring), np.zeros(64, np.int32), 0
    limits, is_given = (distances.least, distances.most), len(turn_rad) > 0
    for p in range(len(payloads)):
        payload, v = payloads[p], variant[p]
        jumps += _steps(payload, layout, roles.group[v], steps)
        for k in range(roles.block.shape[1]):
            b, twin, row = roles.block[v, k], roles.twin[v, k], roles.table[v, k]
            if b < 0:
                break
            base = layout.first + b * layout.block
            azimuth = _word(payload, base + layout.azimuth, layout.big_endian) % 36000
            step_rad = turn_rad[p] if is_given else np.float32(steps[b]) * np.float32(CDEG_RAD)
            base += layout.channel_first
            returns = 2 if twin >= 0 else 1
            # Of equal returns the twin's is the first: sensors repeat a single return, or leave
            # one of the two empty.
            _read(payload, base, layout, returns - 1, of)
            if returns == 2:
                _read(payload, base + (twin - b) * layout.block, layout, 0, of)
                in_order(of, True)
            beam = channels.beam[row]
            _turn(np.int32(azimuth), step_rad, beam, channels.offset_cdeg[row], circle, turned)
            for echo in range(returns):
                sift(of, echo, marks[row], limits)
                _place(beam, turned, distances.unit_m, echo, of)
            for c in range(layout.channels):
                of.t_ns[c] = t_ns[p] + roles.time_ns[v, k, c]
            pack(of, channels.order[row], returns, points)
        unpack(points)
    found = decoded(points, of)
    counts = np.append(found[5], np.int64(jumps))
    return found[0], found[1], found[2], found[3], found[4], counts
