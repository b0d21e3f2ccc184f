"""Fields of Hesai data packets as columns, and which payloads are packets of one sensor."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from recon4.recording.packets.family import Payloads
from recon4.recording.packets.hesai import checksums, stamps
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
from recon4.units import TURN_CDEG


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
    sound = _same_header(fields, header)
    report.count("packets_wrong_header", int((~sound).sum()))
    checks = (
        ("packets_wrong_azimuth", (fields.azimuth_cdeg <= TURN_CDEG).all(axis=1)),
        ("packets_wrong_stamp", stamps.is_date(fields.date, fields.micros)),
        ("packets_wrong_speed", fields.speed * speed_rpm <= HESAI_PACKETS.fastest_rpm),
        ("packets_wrong_crc", checksums.are_right(fields.payloads, fields.layout)),
    )
    for name, passed in checks:
        report.count(name, int((sound & ~passed).sum()))
        sound = sound & passed
    return sound


def _same_header(fields: Fields, header: bytes) -> NDArray[np.bool_]:
    """Header of the sensor, but for what depends on the return mode, (N,)."""
    payloads, layout = fields.payloads, fields.layout
    if header[:2] == PANDAR40P_BLOCK:
        starts = layout.blocks_at + layout.block_bytes * np.arange(layout.blocks)
        pairs = payloads[:, starts[:, None] + np.arange(2)]
        return np.asarray((pairs == np.frombuffer(header[:2], np.uint8)).all(axis=(1, 2)))
    wanted = np.frombuffer(header[:HEADER], np.uint8)
    fixed = np.ones(HEADER, dtype=np.bool_)
    fixed[[4, 5, ECHO_AT, RETURNED_AT]] = False
    fixed[min(layout.blocks_at, layout.tail_at) :] = False
    return np.asarray((payloads[:, :HEADER] == wanted)[:, fixed].all(axis=1))
