"""What a family of LiDARs gives so that its packets are read.

One module, which `recon4.recording.packets.families` finds by the maker in the table of models.
Everything else is common to all families: finding the senders in a capture, clocks, order, holes,
bags, live capture. A family tells what its packets look like and turns packets into points::

    head of a sender ──► `PacketFamily.recognize` ──► `Recognized`
    `PacketSensor` ────► `PacketFamily.open` ───────► `PacketFormat` (one per sensor)

`recon4.recording.packets.decoder.PacketDecoder` drives the `PacketFormat`.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any, Protocol

import numpy as np
from numpy.typing import NDArray

from recon4.locales.coded import CodedText
from recon4.model.finding import Finding
from recon4.model.rig import Sensor
from recon4.model.samples import GnssSamples, ImuSamples
from recon4.model.trajectory import Times
from recon4.recording.assembly.shots import Shots
from recon4.recording.formats.datagrams import NO_DATAGRAMS, Datagrams
from recon4.recording.packets.sensor_clock import SensorClock
from recon4.recording.report import ImportReport
from recon4.settings import IngestSettings
from recon4.units import SECOND_NS

Payloads = NDArray[np.uint8]
"""UDP payloads of one size as rows of bytes, (N, size)."""


@dataclass(frozen=True, slots=True)
class Companion:
    """A small file beside a recording, or a text in a bag: metadata, a table of angles."""

    name: str
    """Display name: file name, or topic."""
    content: bytes
    likeness: int = 0
    """At how many characters its name begins like that of the recording (`same_start`)."""


def same_start(one: str, other: str) -> int:
    """How many characters two names have in common at their beginning."""
    pairs = zip(one, other, strict=False)
    return next((k for k, (a, b) in enumerate(pairs) if a != b), min(len(one), len(other)))


@dataclass(frozen=True, slots=True, eq=False)
class PacketSamples:
    """Samples in the packets of a LiDAR; None where there are none."""

    imu: ImuSamples | None = None
    """In the frame of the points and on the clock of the packets: m/s², rad/s."""
    gnss: GnssSamples | None = None


@dataclass(frozen=True, slots=True, kw_only=True)
class Recognized:
    """What the first packets of one sender to one port are."""

    family: str
    """Name of the family."""
    kind: str
    """``data``: points; ``samples``: other packets of a LiDAR (IMU, positions, device data);
    ``other``: the size is of this family and the contents are not (a remark says why)."""
    model: str = ""
    """Name in `recon4.model.lidars.LIDARS`; empty = not known."""
    mode: str = ""
    """Return mode in words, as ``dual``; empty = not known."""
    packet_s: float = float("nan")
    """Usual time from one data packet to the next [s]."""
    rotation_hz: float = float("nan")
    """Revolutions a second; NaN = does not spin, or not known."""
    serial: str = ""
    """Serial number, if the packets or the companions tell it."""
    size: int = 0
    """Bytes of a data packet."""
    utc_offset_ns: int | None = None
    """UTC minus time of arrival, where positions prove that GPS drives the sensor's clock."""
    findings: tuple[Finding, ...] = ()
    """Warnings, as about a model byte that contradicts the data."""
    refused: CodedText | None = None
    """Why packets of this make are not read; None for other kinds than ``other``."""
    rows: NDArray[np.bool_] | None = None
    """Which of the datagrams are of this sensor, (N,); None = all."""
    readable_as: tuple[str, ...] = ()
    """Models whose decoder reads these packets; empty = `PacketFamily.open` refuses the others."""
    others: tuple[Recognized, ...] = ()
    """Further sensors that send from the same address to the same port, with their rows."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class PacketSensor:
    """One sensor whose packets are to be decoded."""

    row: int
    """Row in ``Rig.sensors``."""
    sensor: Sensor
    """Its model selects the tables."""
    head: Datagrams = NO_DATAGRAMS
    """First data packets of the sensor; none if it is silent at the beginning."""
    beside: Datagrams = NO_DATAGRAMS
    """First other packets of the sensor, wherever it sends them: device data with angles."""
    companions: Sequence[Companion] = ()
    """Files beside the recording; the family finds out which are of this sensor."""
    settings: IngestSettings
    """Limits of the range."""
    report: ImportReport
    """Receives counts, warnings and what was derived."""

    def without_head(self) -> PacketSensor:
        """The same for the rest of the recording: the first packets are kept no longer."""
        return replace(self, head=NO_DATAGRAMS, beside=NO_DATAGRAMS)


class PacketFormat(Protocol):
    """The packets of one sensor: sound or not, time, points.

    All methods but `samples` are given data packets of one size.
    """

    @property
    def size(self) -> int:
        """Bytes of a data packet."""
        ...

    @property
    def sample_sizes(self) -> frozenset[int]:
        """Bytes of the packets that `samples` reads: IMU, positions, device data; also those of the
        data packets if they carry samples.
        """
        ...

    @property
    def stamps_past_hour(self) -> bool:
        """Whether stamps count from the full hour; False = they never start again."""
        ...

    @property
    def packet_s(self) -> float:
        """Usual time from one data packet to the next [s], of those that `sound` saw last."""
        ...

    def sound(self, payloads: Payloads) -> NDArray[np.bool_]:
        """Which payloads are data packets of this sensor, (N,).

        Counts ``packets`` and each reason for which one is dropped (``packets_wrong_flag``, …).
        """
        ...

    def stamps_ns(self, payloads: Payloads) -> Times:
        """Time of the first shot of each packet on the clock of the sensor [ns], (N,)."""
        ...

    def azimuth_cdeg(self, payloads: Payloads) -> NDArray[np.int64] | None:
        """Direction at the start of each packet, clockwise [0.01°], (N,); None = does not spin.

        From it come the rotation rate and the holes of a limited field of view.
        """
        ...

    def decode(self, t_ns: Times, payloads: Payloads) -> Shots:
        """Points of sound packets in order of time.

        Counts ``points``, ``points_no_return``, ``points_near`` and ``points_far``.

        Args:
            t_ns: Time of the first shot of each packet on the clock of the rig [ns],
                non-decreasing, (P,): the clock of the stamps, moved.
            payloads: The packets, (P, size).
        """
        ...

    def likely_models(self, usual_s: float) -> tuple[str, ...]:
        """Models of the family whose packets come at this interval [s]; empty = cannot tell."""
        ...

    def samples(self, datagrams: Datagrams, clock: SensorClock) -> PacketSamples | None:
        """What the other packets of the sender tell: IMU, positions; None = nothing.

        Args:
            datagrams: What the sender sends in packets of `sample_sizes` bytes.
            clock: Turns their stamps into times of the rig (`SensorClock.at_ns`).
        """
        ...


class PacketFamily(Protocol):
    """The LiDARs of one maker, as far as their packets are alike."""

    @property
    def name(self) -> str:
        """As in `recon4.model.lidar_facts.LidarFacts.maker`."""
        ...

    @property
    def messages(self) -> Mapping[str, MessagePackets]:
        """Type of a message in a bag (``pandar_msgs/msg/PandarScan``) -> how to get its packets."""
        ...

    def describes(self, companion: Companion) -> bool:
        """Whether a small file is one that `open` can use; other files beside a recording are not
        inputs of the map.
        """
        ...

    def recognize(self, head: Datagrams, companions: Sequence[Companion]) -> Recognized | None:
        """What the datagrams of one sender to one port are; None = not of this family.

        A right answer needs few packets; a wrong one makes recon4 read noise: flags, sizes and
        values must all fit in more than half of the datagrams.
        """
        ...

    def open(self, sensor: PacketSensor) -> PacketFormat:
        """Prepare to decode the packets of one sensor.

        Raises:
            ConfigError: If it cannot be: says what is missing (a metadata file, an angle table)
                and where it is looked for.
        """
        ...

    def restamped(
        self, payloads: Payloads, shift_ns: int, companions: Sequence[Companion]
    ) -> Payloads | None:
        """Packets as if they were sent later, as a replay sends them: their times and the sums over
        them change, nothing else; None = most are no packets of this family, or have no time.

        Args:
            payloads: Packets of one sender to one port, of one size; damaged ones stay, (N, size).
            shift_ns: Added to their times, a whole number of microseconds [ns].
            companions: Files beside the recording.
        """
        ...


def no_sender(payloads: Payloads) -> list[str]:
    """Nothing in the packets says which sensor sent them: the names of the senders, (N,)."""
    return [""] * len(payloads)


def stamp_ns(stamped: Any) -> int:
    """The stamp of a decoded header or packet [ns]."""
    return int(stamped.stamp.sec) * SECOND_NS + int(stamped.stamp.nanosec)


def stamped_packet(packet: Any) -> tuple[int, bytes]:
    """Time of arrival [ns] and bytes of a decoded packet with ``stamp`` and ``data``; of a fixed
    room for ``data`` those that ``size`` counts.
    """
    size = int(getattr(packet, "size", len(packet.data)))
    return stamp_ns(packet), np.asarray(packet.data, np.uint8)[:size].tobytes()


@dataclass(frozen=True, slots=True)
class MessagePackets:
    """A type of message that carries packets."""

    definitions: Mapping[str, str]
    """The type and those it is made of, each in ROS's language, for bags that do not bring them:
    name (``velodyne_msgs/msg/VelodynePacket``) -> text."""
    packets: Callable[[Any], list[tuple[int, bytes]]]
    """The packets of a decoded message: arrival time [ns] (0 = that of the message), bytes."""
    samples: bool = False
    """Whether they are other packets of the LiDAR (IMU, device data), not points."""
    versions: tuple[Mapping[str, str], ...] = ()
    """Further versions of `definitions`, as other releases of the driver have them; each is whole.
    A message is decoded by the first that takes all of its bytes."""
    senders: Callable[[Payloads], list[str]] = no_sender
    """Which sensor sent each packet, as its own bytes say: its serial number or its model, (N,);
    empty = they do not. Topics that several sensors share are taken apart by it."""
