"""Hesai data packets to points: one `HesaiFormat` a sensor.

The frame of the points is that of Hesai's driver: azimuth 0 along +y, clockwise seen from above, so
x points to the right and z up.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from recon4.model.samples import ImuSamples
from recon4.model.trajectory import Times
from recon4.recording.assembly.shots import Shots
from recon4.recording.formats.datagrams import Datagrams
from recon4.recording.packets.family import PacketSamples, PacketSensor, Payloads
from recon4.recording.packets.hesai import stamps
from recon4.recording.packets.hesai.angles import Angles
from recon4.recording.packets.hesai.fields import Fields, sound_packets
from recon4.recording.packets.hesai.firing import (
    FiringMode,
    FiringVariants,
    firing_mode,
    packet_s,
)
from recon4.recording.packets.hesai.inertial import inertial_of
from recon4.recording.packets.hesai.layouts import HesaiLayout
from recon4.recording.packets.hesai.mirrors import MirrorTable
from recon4.recording.packets.hesai.models import HesaiModel
from recon4.recording.packets.hesai.points import MirrorPoints, SpinningPoints
from recon4.recording.packets.sensor_clock import SensorClock


@dataclass(frozen=True, slots=True, eq=False)
class HesaiPackets:
    """What the data packets of one sensor are."""

    model: HesaiModel
    layout: HesaiLayout
    header: bytes
    """First bytes of its packets."""
    mode: FiringMode
    """Of its first packets."""


class HesaiFormat:
    """The data packets of one Hesai: a `recon4.recording.packets.family.PacketFormat`."""

    stamps_past_hour = False

    def __init__(
        self, packets: HesaiPackets, directions: Angles | MirrorTable, sensor: PacketSensor
    ) -> None:
        """Prepare the tables.

        Args:
            packets: What the sensor sends.
            directions: Of its beams; `MirrorTable` for an AT128.
            sensor: Where the packets come from; its report receives the counts.
        """
        layout, model = packets.layout, packets.model
        self.size = layout.size
        self.packet_s = packet_s(model, layout.blocks, packets.mode)
        self.packets, self._sensor = packets, sensor
        self._firing = FiringVariants(model, layout)
        self._inertial = inertial_of(packets.layout, packets.header)
        self.sample_sizes = frozenset({self._inertial.size} if self._inertial.size else ())
        self._imu_ns = 0
        self._points: SpinningPoints | MirrorPoints
        if isinstance(directions, MirrorTable):
            self._points = MirrorPoints(self._firing, directions, sensor)
        else:
            self._points = SpinningPoints(self._firing, directions, sensor)

    def sound(self, payloads: Payloads) -> NDArray[np.bool_]:
        """See `recon4.recording.packets.hesai.fields.sound_packets`."""
        packets, fields = self.packets, self._fields(payloads)
        speed_rpm = packets.model.speed_rpm
        sound = sound_packets(fields, packets.header, speed_rpm, report=self._sensor.report)
        if sound.any():
            first = int(sound.argmax())
            key = self._fields(payloads[first : first + 1]).firing_key()
            mode = firing_mode(int(key[0]), fields.layout.blocks)
            self.packet_s = packet_s(packets.model, fields.layout.blocks, mode)
        return sound

    def stamps_ns(self, payloads: Payloads) -> Times:
        """Time of the first shot of sound packets on the clock of the sensor [ns], (N,)."""
        fields = self._fields(payloads)
        key = fields.firing_key()
        self._firing.meet(key)
        stamp_ns = stamps.time_ns(fields.date, fields.micros)
        return np.asarray(stamp_ns + self._firing.first_ns[key])

    def azimuth_cdeg(self, payloads: Payloads) -> NDArray[np.int64] | None:
        """Azimuth of the first block of each packet [0.01°], (N,)."""
        return self._fields(payloads).azimuth_of(0)

    def decode(self, t_ns: Times, payloads: Payloads) -> Shots:
        """Points of sound packets in order of time.

        Counts ``points``, ``points_no_return``, ``points_near``, ``points_far`` and
        ``azimuth_jumps``.
        """
        return self._points.decode(t_ns, self._fields(payloads))

    def likely_models(self, usual_s: float) -> tuple[str, ...]:
        """Empty: the header tells the model, whatever the interval [s]."""
        del usual_s
        return ()

    def samples(self, datagrams: Datagrams, clock: SensorClock) -> PacketSamples | None:
        """Inertial samples in the data packets, or in own ones (JT16); counts ``imu_samples``."""
        if not self.sample_sizes:
            return None
        rows = np.flatnonzero(datagrams.length == self._inertial.size)
        payloads = datagrams.payloads(rows, self._inertial.size)
        found, taken = self._inertial.samples(payloads)
        t_ns, timed = clock.at_ns(datagrams.t_ns[rows[taken]], found.t_ns)
        later = timed & (np.diff(np.maximum.accumulate(t_ns), prepend=self._imu_ns) > 0)
        if not later.any():
            return None
        self._imu_ns = int(t_ns[later][-1])
        self._sensor.report.count("imu_samples", int(later.sum()))
        imu = ImuSamples(t_ns[later], found.gyro_rad_s[later], found.accel_m_s2[later])
        return PacketSamples(imu=imu)

    def _fields(self, payloads: Payloads) -> Fields:
        return Fields(payloads, self.packets.layout)
