"""Fields of Hesai data packets as columns, and which payloads are packets of one sensor."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cache

import numpy as np
from numpy.typing import NDArray

from recon4.kernels.hesai_packets import SOUND, FieldPlaces, SoundFields, first_faults
from recon4.recording.limits import LIMITS
from recon4.recording.packets.family import Payloads
from recon4.recording.packets.hesai import checksums
from recon4.recording.packets.hesai.layouts import (
    ECHO_AT,
    HEADER,
    PANDAR40P_BLOCK,
    RETURNED_AT,
    HesaiLayout,
)
from recon4.recording.packets.hesai.models import RETURNS
from recon4.recording.packets.hesai.tuning import HESAI_PACKETS
from recon4.recording.report import ImportReport
from recon4.units import SECOND_NS


@dataclass(frozen=True, slots=True, eq=False)
class Fields:
    """Fields of packets of one layout."""

    payloads: Payloads
    """The packets, (N, size)."""
    layout: HesaiLayout
    """Theirs."""

    @property
    def date(self) -> NDArray[np.uint8]:
        """Date of the stamp, (N, 6)."""
        at = self.layout.tail_at + self.layout.tail.date
        return self.payloads[:, at : at + 6]

    @property
    def micros(self) -> NDArray[np.uint32]:
        """Microseconds of the stamp, (N,)."""
        return self._u4(self.layout.tail_at + self.layout.tail.micros)

    @property
    def returns(self) -> NDArray[np.int64]:
        """Returns of each shot, (N,)."""
        at = self.layout.tail.mode
        if at < 0:
            return np.ones(len(self.payloads), dtype=np.int64)
        return RETURNS[self.payloads[:, self.layout.tail_at + at]]

    @property
    def mode(self) -> NDArray[np.uint8]:
        """Return mode byte, (N,); 0 = the packets have none."""
        at = self.layout.tail.mode
        if at < 0:
            return np.zeros(len(self.payloads), dtype=np.uint8)
        return self.payloads[:, self.layout.tail_at + at]

    @property
    def speed(self) -> NDArray[np.uint16]:
        """Speed of the motor in the unit of the model, (N,); 0 = the packets do not say."""
        at = self.layout.tail.speed
        if at < 0:
            return np.zeros(len(self.payloads), dtype=np.uint16)
        return self._u2(self.layout.tail_at + at)

    @property
    def azimuth_cdeg(self) -> NDArray[np.int64]:
        """Azimuth of each block [0.01°], (N, B)."""
        return np.column_stack([self.azimuth_of(block) for block in range(self.layout.blocks)])

    def azimuth_of(self, block: int) -> NDArray[np.int64]:
        """Azimuth of one block of each packet [0.01°], (N,)."""
        layout = self.layout
        at = layout.blocks_at + block * layout.block_bytes + layout.azimuth_at
        return self._u2(at).astype(np.int64)

    def firing_key(self) -> NDArray[np.int64]:
        """What selects the table of firing times: `key_parts` takes it apart, (N,)."""
        tail, at = self.layout.tail, self.layout.tail_at
        key = self.returns
        if tail.sequence >= 0:
            key = key + (self.payloads[:, at + tail.sequence] & 1).astype(np.int64) * 4
        if tail.azimuth_flag >= 0:
            flags = self._u2(at + tail.azimuth_flag).astype(np.int64) >> 12
            state = (self.payloads[:, at + tail.state] & 0x0F != 0).astype(np.int64)  # 0 = high
            key = key + 4 * flags + 64 * state
        return key

    def _u2(self, at: int) -> NDArray[np.uint16]:
        return np.ascontiguousarray(self.payloads[:, at : at + 2]).view("<u2")[:, 0]

    def _u4(self, at: int) -> NDArray[np.uint32]:
        return np.ascontiguousarray(self.payloads[:, at : at + 4]).view("<u4")[:, 0]


def sound_packets(
    fields: Fields, header: bytes, speed_rpm: float, *, report: ImportReport
) -> NDArray[np.bool_]:
    """Which payloads are data packets of the sensor, (N,).

    Counts ``packets`` and what is dropped: ``packets_wrong_header`` (another header than the first
    packets of the sensor), ``packets_wrong_azimuth`` (above 360°), ``packets_wrong_stamp`` (no date
    or more than 999 999 µs), ``packets_wrong_speed`` (above 3600 revolutions a
    minute) and ``packets_wrong_crc`` (that of the tail, where there is one).

    Args:
        fields: Of the payloads.
        header: First bytes of the packets of the sensor.
        speed_rpm: Revolutions a minute in one unit of the speed.
        report: Takes the counts.
    """
    report.count("packets", len(fields.payloads))
    if not len(fields.payloads):
        return np.zeros(0, dtype=np.bool_)
    faults = first_faults(
        np.ascontiguousarray(fields.payloads),
        _places(fields.layout),
        _right(fields.layout, header, speed_rpm),
    )
    counts = np.bincount(faults, minlength=len(_FAULTS) + 1)
    for name, count in zip(_FAULTS, counts[1:].tolist(), strict=True):
        report.count(name, count)
    return faults == SOUND


_FAULTS = (
    *("packets_wrong_header", "packets_wrong_azimuth", "packets_wrong_stamp"),
    *("packets_wrong_speed", "packets_wrong_crc"),
)
"""Counters of what `first_faults` finds, from 1 on."""


@cache
def _places(layout: HesaiLayout) -> FieldPlaces:
    tail = layout.tail
    return FieldPlaces(
        blocks=layout.blocks,
        block=layout.block_bytes,
        start=layout.blocks_at if layout.azimuth_at == len(PANDAR40P_BLOCK) else -1,
        azimuth=layout.blocks_at + layout.azimuth_at,
        date=layout.tail_at + tail.date,
        micros=layout.tail_at + tail.micros,
        speed=layout.tail_at + tail.speed if tail.speed >= 0 else -1,
        summed=layout.crc_from,
        crc=layout.crc_at,
    )


@cache
def _right(layout: HesaiLayout, header: bytes, speed_rpm: float) -> SoundFields:
    """Header of the sensor, but for what depends on the return mode; all other limits."""
    wanted = np.zeros(HEADER, np.uint8)
    wanted[: len(header[:HEADER])] = np.frombuffer(header[:HEADER], np.uint8)
    fixed = np.ones(HEADER, dtype=np.bool_)
    fixed[[4, 5, ECHO_AT, RETURNED_AT]] = False
    fixed[min(layout.blocks_at, layout.tail_at) :] = False
    return SoundFields(
        header=wanted,
        fixed=fixed,
        start=int.from_bytes(PANDAR40P_BLOCK, "little"),
        most_speed=HESAI_PACKETS.fastest_rpm / speed_rpm if speed_rpm > 0 else math.inf,
        latest_s=LIMITS.latest_ns // SECOND_NS,
        tables=checksums.TABLES,
    )
