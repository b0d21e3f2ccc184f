"""Packets of one sensor to points: filter, clock, order, decode."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from recon4.errors import ConfigError
from recon4.locales.coded import CodedText
from recon4.model.derived_kinds import DerivedKind
from recon4.model.finding_kinds import FindingKind
from recon4.model.lidars import LIDARS, lidar_model
from recon4.model.rig import Sensor
from recon4.model.trajectory import Times
from recon4.recording.assembly.shots import Shots
from recon4.recording.formats.datagrams import Datagrams
from recon4.recording.packets.families import FAMILIES
from recon4.recording.packets.family import PacketFormat, PacketSamples, PacketSensor, Payloads
from recon4.recording.packets.one_sender import require_one_sender
from recon4.recording.packets.packet_holes import PacketHoles
from recon4.recording.packets.packet_order import PacketOrder
from recon4.recording.packets.rotation_rate import Rotation
from recon4.recording.packets.sensor_clock import SensorClock
from recon4.recording.packets.tuning import SLOTS
from recon4.recording.report import ImportReport
from recon4.recording.tuning import IngestTuning
from recon4.settings.tuning import tuned
from recon4.units import SECOND_NS


def open_decoder(
    of: PacketSensor, *, utc_offset_ns: int | None = None, alone: bool = True
) -> PacketDecoder:
    """The decoder of a sensor, by the family that makes its model.

    Raises:
        ConfigError: If its packets cannot be decoded: which file or model is missing, or whether
            they are of two sensors.
    """
    facts = lidar_model(of.sensor.model)
    maker = facts.maker
    if facts.alike:
        about = {"sensor": of.sensor.name, "model": facts.name, "alike": facts.alike}
        of.report.derive(DerivedKind.MODEL_ALIKE, **about)
    family = next((family for family in FAMILIES if family.name == maker), None)
    if family is None:
        known = ", ".join(name for name, facts in LIDARS.items() if facts.maker)
        raise ConfigError(
            CodedText("packets-unknown", source=of.sensor.topic or of.sensor.name, known=known)
        )
    trial = ImportReport()
    layout = family.open(replace(of, report=trial))
    if all(found.kind is not FindingKind.MODEL_CONTRADICTED for found in trial.findings):
        require_one_sender(layout, of)  # of another model, packets come as often as theirs do
    return PacketDecoder(family.open(of), of, utc_offset_ns=utc_offset_ns, alone=alone)


class PacketDecoder:
    """Turns the packets of one sensor into shots; one object a sensor.

    The model is that of the rig file, whatever the packets say of themselves; packets at an
    interval that contradicts it give a warning.
    """

    def __init__(
        self,
        layout: PacketFormat,
        of: PacketSensor,
        *,
        utc_offset_ns: int | None = None,
        alone: bool = True,
    ) -> None:
        """Start with nothing held back.

        Args:
            layout: What its family tells of its packets.
            of: The sensor, its settings and the report that takes counts and warnings.
            utc_offset_ns: UTC minus time of arrival [ns], where GPS is known to drive the sensor.
            alone: Whether it is the only LiDAR.
        """
        self.clock = SensorClock(
            of.sensor.name,
            packet_s=layout.packet_s,
            report=of.report,
            utc_offset_ns=utc_offset_ns,
            alone=alone,
        )
        self.clock.past_hour = layout.stamps_past_hour
        self._layout = layout
        self.report = of.report
        """Takes counts and warnings."""
        self._sensor: Sensor = of.sensor
        self._rotation = Rotation()
        window_s = tuned(IngestTuning, of.settings).reorder_window_s
        self._order = PacketOrder(round(window_s * SECOND_NS), of.report)
        self._offset_ns = round(of.sensor.time_offset_s * SECOND_NS)
        self._holes = PacketHoles()

    @property
    def size(self) -> int:
        """Bytes of a data packet."""
        return self._layout.size

    @property
    def rotation_hz(self) -> float:
        """Measured rotation rate [Hz]; NaN before the first packets, and if it does not spin."""
        return self._rotation.hz

    def push(self, t_arrival_ns: Times, payloads: Payloads) -> Shots:
        """Take packets in, give out the shots that are certain to be in order.

        Counts, besides those of the family and of `PacketOrder`: ``packets_wrong_length``,
        ``packets_missing``, also as ``packets_missing_NAME``.

        Args:
            t_arrival_ns: When the host received each packet [ns], (N,).
            payloads: UDP payloads, (N, size) or any other width (then all are dropped, counted).

        Returns:
            Shots in firing order; after a hole, those of the last ``reorder_window_s`` are
            held back.
        """
        return self._shots(*self._in_order(t_arrival_ns, payloads))

    def push_in_parts(self, t_arrival_ns: Times, payloads: Payloads) -> Iterator[Shots]:
        """As `push`, in parts of about `SlotTuning.part_ns`: fewer points are in memory at once."""
        t_ns, payloads = self._in_order(t_arrival_ns, payloads)
        most = max(1, round(SLOTS.part_ns / SECOND_NS / self._layout.packet_s))
        set_back = self._order.is_set_back
        for first in range(0, max(1, len(t_ns)), most):
            self._order.is_set_back = set_back
            yield self._shots(t_ns[first : first + most], payloads[first : first + most])

    def _in_order(self, t_arrival_ns: Times, payloads: Payloads) -> tuple[Times, Payloads]:
        """Times and bytes of the packets that are certain to be in order."""
        t_arrival_ns = np.asarray(t_arrival_ns, dtype=np.int64)
        if payloads.ndim != 2 or payloads.shape[1] != self.size:
            self.report.count("packets", len(payloads))
            self.report.count("packets_wrong_length", len(payloads))
            t_arrival_ns, payloads = t_arrival_ns[:0], np.zeros((0, self.size), np.uint8)
        sound = self._layout.sound(payloads)
        if not sound.all():
            t_arrival_ns, payloads = t_arrival_ns[sound], payloads[sound]
        if not len(payloads):
            return self._order.push(t_arrival_ns, payloads)
        self._order.step_ns = round(self._layout.packet_s * SECOND_NS)
        t_ns, trusted = self.clock.push_ns(t_arrival_ns, self._layout.stamps_ns(payloads))
        if not trusted.all():
            t_arrival_ns, t_ns = t_arrival_ns[trusted], t_ns[trusted]
            payloads = payloads[trusted]
        return self._order.push_arrived(t_ns, payloads, t_arrival_ns)

    @property
    def sample_sizes(self) -> frozenset[int]:
        """Bytes of the packets that `samples` reads, maybe of the data packets too."""
        return self._layout.sample_sizes

    def samples(self, datagrams: Datagrams) -> PacketSamples | None:
        """What the other packets of the sensor tell, as stamped; None = nothing.

        `Rig.imu_clock_offset_s` is added where the samples of all kinds of recordings are cleaned.
        """
        return self._layout.samples(datagrams, self.clock)

    def flush(self) -> Shots:
        """Give out what was held back."""
        self.clock.finish()
        shots = self._shots(*self._order.flush())
        self._count_missing(self._holes.rest())
        return shots

    def _shots(self, t_ns: Times, payloads: Payloads) -> Shots:
        if len(t_ns):
            self._check_interval(t_ns, payloads)
        else:
            payloads = np.zeros((0, self.size), np.uint8)
        shots = self._layout.decode(t_ns + self._offset_ns, payloads)
        set_back = self._order.is_set_back and len(shots) > 0
        self._order.is_set_back &= not set_back
        return replace(shots, set_back=set_back, rotation_hz=self._rotation.hz)

    def _check_interval(self, t_ns: Times, payloads: Payloads) -> None:
        """Count missing packets, measure rotation, and see whether the model can be true."""
        packet_s = self._layout.packet_s
        azimuth_cdeg = self._layout.azimuth_cdeg(payloads)
        if azimuth_cdeg is not None:
            self._rotation.push(t_ns, azimuth_cdeg, packet_s)
        self._count_missing(self._holes.missing(t_ns, azimuth_cdeg, packet_s))
        usual_s = self._holes.usual_s()
        fits = self._layout.likely_models(usual_s) if usual_s else ()
        if fits and self._sensor.model not in fits:
            self.report.warn(
                FindingKind.MODEL_UNLIKELY,
                sensor=self._sensor.name,
                interval_ms=1e3 * usual_s,
                likely=fits[0],
                model=self._sensor.model,
            )

    def _count_missing(self, number: int) -> None:
        self.report.count("packets_missing", number)
        self.report.count(f"packets_missing_{self._sensor.name}", number)
