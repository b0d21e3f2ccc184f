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

from recon4.units import CDEG_RAD

_AZIMUTH = CDEG_RAD * (np.arange(72000) % 36000)
CIRCLE = np.column_stack([np.cos(_AZIMUTH), np.sin(_AZIMUTH)]).astype(np.float32)
"""Cosine and sine of every azimuth on the wire plus any offset, the last argument of `decode`:
numba compiles arrays of modules into the code. (72000, 2)."""


class BeamNumbers(NamedTuple):
    """Where the numbers of a beam are."""

    cos_el: int = 0
    sin_el: int = 1
    """Cosine and sine of the elevation of a beam."""
    along: int = 2
    right: int = 3
    height: int = 4
    """Where it begins: along f, to the right of f as seen from above, above the center [m]."""
    range: int = 5
    """Added to every distance [m]."""
    fraction: int = 6
    """Firing time as a fraction of the time from a firing to the next: of the turn in between."""
    offset: int = 7
    """The small rest of the offset of the azimuth beside whole 0.01° [rad]."""


BEAM = BeamNumbers()


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
    """See `BeamNumbers`, (T, C, 8)."""
    offset_cdeg: NDArray[np.int64]
    """Added to the azimuth of the block: whole 0.01°, 0 to 35999, (T, C)."""
    ring: NDArray[np.uint8]
    """Ring, 0 = lowest elevation, (T, C)."""
    order: NDArray[np.int64]
    """The channels in the order in which they fire, (T, C)."""


class Distances(NamedTuple):
    """Unit and limits of distances."""

    unit_m: np.float32
    """Meters of one unit."""
    least: int
    """Smaller ones are too near [units]; 0 is no return."""
    most: int
    """Larger ones are too far [units]."""


Decoded = tuple[
    NDArray[np.int64],
    NDArray[np.float32],
    NDArray[np.uint16],
    NDArray[np.uint8],
    NDArray[np.uint8],
    NDArray[np.int64],
]


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


@njit(cache=True, nogil=True, fastmath=True, error_model="numpy")
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
        ``t_ns, xyz, intensity, ring, echo`` of the N points in firing order, and counts of
        shots without return, returns too near, too far and jumps of azimuth, (4,).
    """
    size = payloads.shape[0] * layout.blocks * layout.channels
    out_t = np.empty(size, np.int64)
    out_xyz = np.empty((size, 3), np.float32)
    out_intensity = np.empty(size, np.uint16)
    out_ring = np.empty(size, np.uint8)
    out_echo = np.empty(size, np.uint8)
    counts = np.zeros(4, np.int64)
    steps = np.zeros(64, np.int32)
    n = 0
    is_given = turn_rad.shape[0] > 0
    for p in range(payloads.shape[0]):
        payload, start_ns, v = payloads[p], t_ns[p], variant[p]
        counts[3] += _steps(payload, layout, roles.group[v], steps)
        for k in range(roles.block.shape[1]):
            b = roles.block[v, k]
            if b < 0:
                break
            twin = roles.twin[v, k]
            time_ns = roles.time_ns[v, k]
            beams = channels.beam[roles.table[v, k]]
            offset_cdeg = channels.offset_cdeg[roles.table[v, k]]
            ring = channels.ring[roles.table[v, k]]
            order = channels.order[roles.table[v, k]]
            base = layout.first + b * layout.block
            azimuth = _word(payload, base + layout.azimuth, layout.big_endian) % 36000
            step_rad = turn_rad[p] if is_given else np.float32(steps[b]) * np.float32(CDEG_RAD)
            base += layout.channel_first
            to_twin = (twin - b) * layout.block
            for i in range(layout.channels):
                c = order[i] & 255  # masked, an index is not negative: numba need not ask
                at = base + layout.channel * c
                distance = _word(payload, at, layout.big_endian) & layout.distance_mask
                intensity = payload[at + layout.intensity]
                other, other_intensity = np.int32(0), np.uint8(0)
                if twin >= 0:
                    # The more intense return comes first, the twin's if both are as intense;
                    # sensors repeat a single return, or leave one of the two empty.
                    other, other_intensity = distance, intensity
                    at += to_twin
                    distance = _word(payload, at, layout.big_endian) & layout.distance_mask
                    intensity = payload[at + layout.intensity]
                    if distance == 0 or (other_intensity > intensity and other != 0):
                        distance, other = other, distance
                        intensity, other_intensity = other_intensity, intensity
                    if other == distance:
                        other = np.int32(0)
                if distance == 0:
                    counts[0] += 1
                    continue
                beam = beams[c]
                turn = step_rad * beam[BEAM.fraction] + beam[BEAM.offset]
                half = np.float32(0.5) * turn * turn
                cos_turn = np.float32(1.0) - half
                sin_turn = turn * (np.float32(1.0) - half * np.float32(1.0 / 3.0))
                start = circle[(azimuth + offset_cdeg[c]) & 131071]
                cos_az = start[0] * cos_turn - start[1] * sin_turn
                sin_az = start[1] * cos_turn + start[0] * sin_turn
                echo = np.uint8(0)
                while distance != 0:
                    if distance < distances.least:
                        counts[1] += 1
                    elif distance > distances.most:
                        counts[2] += 1
                    else:
                        r = np.float32(distance) * distances.unit_m + beam[BEAM.range]
                        flat = r * beam[BEAM.cos_el] + beam[BEAM.along]
                        right = beam[BEAM.right]
                        out_t[n] = start_ns + time_ns[c]
                        out_xyz[n, 0] = flat * cos_az - right * sin_az
                        out_xyz[n, 1] = -(flat * sin_az + right * cos_az)
                        out_xyz[n, 2] = r * beam[BEAM.sin_el] + beam[BEAM.height]
                        out_intensity[n] = intensity
                        out_ring[n] = ring[c]
                        out_echo[n] = echo
                        n += 1
                        echo = np.uint8(1)
                    distance, intensity = other, other_intensity
                    other = np.int32(0)
    return out_t[:n], out_xyz[:n], out_intensity[:n], out_ring[:n], out_echo[:n], counts
