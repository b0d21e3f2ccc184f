"""Hesai: the family of its LiDARs for `recon4.recording.packets.families`."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from types import MappingProxyType
from typing import Any

import numpy as np
from numpy.typing import NDArray

from recon4.errors import ConfigError
from recon4.locales.coded import CodedText
from recon4.model.derived_kinds import DerivedKind
from recon4.model.finding import Finding
from recon4.model.finding_kinds import FindingKind
from recon4.recording.formats.datagrams import Datagrams
from recon4.recording.packets.family import (
    Companion,
    MessagePackets,
    PacketFamily,
    PacketFormat,
    PacketSensor,
    Payloads,
    Recognized,
    stamped_packet,
)
from recon4.recording.packets.hesai import checksums, stamps
from recon4.recording.packets.hesai.angles import Angles, angles_of, is_table
from recon4.recording.packets.hesai.data_packets import HesaiFormat, HesaiPackets
from recon4.recording.packets.hesai.fields import Fields, sound_packets
from recon4.recording.packets.hesai.firing import firing_mode, packet_s
from recon4.recording.packets.hesai.inertial import JT16_SAMPLE, jt16_sums
from recon4.recording.packets.hesai.layouts import (
    HEADER,
    JT16_IMU_SIZE,
    START,
    UNREAD,
    HesaiLayout,
    read_layout,
)
from recon4.recording.packets.hesai.mirrors import MirrorTable, mirrors_of, read_mirrors
from recon4.recording.packets.hesai.models import MODELS, RETURN_MODES, HesaiModel, model_of
from recon4.recording.packets.hesai.tuning import HESAI_PACKETS
from recon4.recording.packets.tuning import HEAD
from recon4.recording.report import ImportReport, warning

_JT16_IMU = START + bytes((1, 8))
_HEADER = "std_msgs/Header header\n"


def _scans(scan: str, packet: str, *, data: str, header: str = _HEADER) -> dict[str, str]:
    """Definitions of a message of packets, by the names of both types."""
    short = packet.replace("/msg/", "/")
    return {
        scan: f"{header}{short}[] packets\n",
        packet: f"builtin_interfaces/Time stamp\n{data} data\nuint32 size\n",
    }


def _messages() -> dict[str, MessagePackets]:
    """Of all drivers of Hesai; each has had its packets in arrays of fixed and of any length."""
    found = {}
    for package, usual, other in (
        ("pandar_msgs", "uint8[1500]", "uint8[]"),
        ("hesai_lidar", "uint8[]", "uint8[1500]"),
    ):
        kind, one = f"{package}/msg/PandarScan", f"{package}/msg/PandarPacket"
        found[kind] = MessagePackets(
            _scans(kind, one, data=usual),
            _packets,
            senders=senders,
            versions=(_scans(kind, one, data=other),),
        )
    kind, one = "hesai_ros_driver/msg/UdpFrame", "hesai_ros_driver/msg/UdpPacket"
    found[kind] = MessagePackets(
        _scans(kind, one, data="uint8[]"),
        _packets,
        senders=senders,
        versions=(_scans(kind, one, data="uint8[]", header=""),),
    )
    return found


def _packets(message: Any) -> list[tuple[int, bytes]]:
    """Arrival times [ns] and payloads of a message."""
    return [stamped_packet(packet) for packet in message.packets]


def senders(payloads: Payloads) -> list[str]:
    """The models that send packets, by their headers."""
    heads, of = np.unique(payloads[:, :HEADER], axis=0, return_inverse=True)
    first = [int(np.flatnonzero(of.reshape(-1) == k)[0]) for k in range(len(heads))]
    found = [_data_packets(payloads[row : row + 1]) for row in first]
    names = [one.model.name if one is not None else "" for one in found]
    return [names[k] for k in of.reshape(-1).tolist()]


class Hesai:
    """A `recon4.recording.packets.family.PacketFamily`."""

    name = "Hesai"
    messages: Mapping[str, MessagePackets] = MappingProxyType(_messages())

    def recognize(self, head: Datagrams, companions: Sequence[Companion]) -> Recognized | None:
        """What the datagrams are, by the header of the most frequent size; None = not Hesai's."""
        payloads = _most_frequent(head)
        if payloads is None:
            return None
        found = _data_packets(payloads)
        if found is None:
            return self._samples(payloads) or self._unread(payloads)
        sound = _sound(payloads, found)
        if not sound.mean() * np.mean(head.length == found.layout.size) > 0.5:
            return None
        model, fields = found.model, Fields(payloads[sound], found.layout)
        mode = int(np.bincount(fields.mode).argmax())
        speed = float(np.median(fields.speed)) * model.speed_rpm / 60.0
        return Recognized(
            family=self.name,
            kind="data",
            model=model.name,
            mode=RETURN_MODES.get(mode, ("", 1))[0],
            packet_s=packet_s(model, found.layout.blocks, found.mode),
            rotation_hz=speed if speed > 0 and model.name != "AT128" else float("nan"),
            size=found.layout.size,
            findings=_findings(mode),
        )

    def describes(self, companion: Companion) -> bool:
        """Whether a file is a table of angles, sound or not."""
        return is_table(companion) or read_mirrors(companion) is not None

    def open(self, sensor: PacketSensor) -> PacketFormat:
        """Prepare to decode the packets of one sensor.

        Raises:
            ConfigError: If its packets are of another shape than its model's, or there is no table
                of angles where one is needed.
        """
        name = sensor.sensor.name
        model = MODELS.get(sensor.sensor.model)
        if model is None:
            known = ", ".join(MODELS)
            raise ConfigError(
                CodedText("packets-no-decoder", name=name, model=sensor.sensor.model, known=known)
            )
        payloads = _most_frequent(sensor.head)
        found = _data_packets(payloads) if payloads is not None else None
        packets = _usual(model) if found is None else found
        if packets.layout.channels != model.channels:
            raise ConfigError(
                CodedText(
                    "hesai-channels",
                    name=name,
                    got=packets.layout.channels,
                    got_model=packets.model.name,
                    model=model.name,
                    expected=model.channels,
                )
            )
        if packets.model is not model:
            sensor.report.warn(
                FindingKind.MODEL_CONTRADICTED,
                sensor=name,
                says=packets.model.name,
                model=model.name,
            )
            packets = HesaiPackets(model, packets.layout, packets.header, packets.mode)
        return HesaiFormat(packets, _directions(model, sensor), sensor)

    def restamped(
        self, payloads: Payloads, shift_ns: int, companions: Sequence[Companion]
    ) -> Payloads | None:
        """Points, and inertial samples of a JT16, later; None = most are neither."""
        del companions
        if not HEADER <= payloads.shape[1] <= HESAI_PACKETS.longest:
            return None
        found = _data_packets(payloads)
        if found is None:
            is_imu = self._samples(payloads) is not None
            return restamped_jt16(payloads, shift_ns=shift_ns) if is_imu else None
        sound = _sound(payloads, found)
        if 2 * sound.sum() <= len(payloads):
            return None
        return restamped_data(payloads, sound, found.layout, shift_ns=shift_ns)

    def _samples(self, payloads: Payloads) -> Recognized | None:
        """Packets of a JT16 that hold no points."""
        if payloads.shape[1] != JT16_IMU_SIZE:
            return None
        start = np.frombuffer(_JT16_IMU, np.uint8)
        if not (payloads[:, : len(start)] == start).all(axis=1).mean() > 0.5:
            return None
        return Recognized(family=self.name, kind="samples", model="JT16")

    def _unread(self, payloads: Payloads) -> Recognized | None:
        """Packets of a Hesai that is not decoded, by name."""
        begins = (payloads[:, :2] == np.frombuffer(START, np.uint8)).all(axis=1)
        if not begins.mean() > 0.5:
            return None
        version = tuple(np.median(payloads[begins, 2:4], axis=0).astype(int).tolist())
        name = UNREAD.get(version, "")
        if not name:
            return None
        reason = CodedText("refused-model", name=name)
        return Recognized(family=self.name, kind="other", refused=reason)


FAMILY: PacketFamily = Hesai()


def _most_frequent(head: Datagrams) -> Payloads | None:
    """The first payloads of the most frequent size; None = there are none of a packet's size."""
    if not len(head):
        return None
    sizes, counts = np.unique(head.length, return_counts=True)
    size = int(sizes[counts.argmax()])
    if not HEADER <= size <= HESAI_PACKETS.longest:
        return None
    return head.payloads(np.flatnonzero(head.length == size)[: HEAD.packets], size)


def _data_packets(payloads: Payloads) -> HesaiPackets | None:
    """What payloads of one size are, by the most frequent header among them."""
    heads, counts = np.unique(payloads[:, :HEADER], axis=0, return_counts=True)
    for head in heads[np.argsort(-counts, kind="stable")][:8]:
        row = int(np.flatnonzero((payloads[:, :HEADER] == head).all(axis=1))[0])
        layout = read_layout(payloads[row])
        model = model_of(payloads[row], layout) if layout else None
        if layout is not None and model is not None:
            key = int(np.bincount(Fields(payloads, layout).firing_key()).argmax())
            mode = firing_mode(key, layout.blocks)
            return HesaiPackets(model, layout, head.tobytes(), mode)
    return None


def _sound(payloads: Payloads, found: HesaiPackets) -> NDArray[np.bool_]:
    fields, speed_rpm = Fields(payloads, found.layout), found.model.speed_rpm
    return sound_packets(fields, found.header, speed_rpm, report=ImportReport())


def _usual(model: HesaiModel) -> HesaiPackets:
    """What a sensor sends that has not sent anything yet."""
    layout = model.layout
    header = model.header.ljust(HEADER, b"\0")
    return HesaiPackets(model, layout, header, firing_mode(1, layout.blocks))


def _findings(mode: int) -> tuple[Finding, ...]:
    known = mode in RETURN_MODES or mode == 0
    return () if known else (warning(FindingKind.RETURN_MODE, mode=mode),)


def _directions(model: HesaiModel, sensor: PacketSensor) -> Angles | MirrorTable:
    """Directions of the beams of a sensor."""
    name = sensor.sensor.name
    if model.name == "AT128":
        found = mirrors_of(sensor.companions)
        if found is None:
            raise ConfigError(CodedText("hesai-at128-angles", name=name))
        sensor.report.derive(DerivedKind.ANGLES_FOUND, sensor=name, of="mirrors", source=found[0])
        return found[1]
    angles = angles_of(sensor, model.channels, model.angles)
    if angles is None:
        raise ConfigError(
            CodedText("hesai-needs-angles", name=name, model=model.name, channels=model.channels)
        )
    return angles


def restamped_data(
    payloads: Payloads, sound: NDArray[np.bool_], layout: HesaiLayout, *, shift_ns: int
) -> Payloads:
    """Data packets of one layout, later by ``shift_ns``; unsound ones as they are, (N, size).

    The sum of the tail is the only one that covers the time.
    """
    later = payloads[sound]
    date = later[:, layout.tail_at + layout.tail.date :][:, :6]
    micros = later[:, layout.tail_at + layout.tail.micros :][:, :4]
    date[:], micros[:] = _later(date, micros, shift_ns)
    checksums.write(later, layout)
    out = payloads.copy()
    out[sound] = later
    return out


def restamped_jt16(payloads: Payloads, *, shift_ns: int) -> Payloads:
    """Inertial packets of a JT16, later by ``shift_ns``; those with a wrong sum as they are."""
    out = np.ascontiguousarray(payloads).copy()
    packets = out.view(JT16_SAMPLE)[:, 0]
    sound = stamps.is_date(packets["date"], packets["micros"])
    sound &= jt16_sums(out) == packets["crc"]
    micros = np.ascontiguousarray(packets["micros"][sound]).view(np.uint8).reshape(-1, 4)
    date, micros = _later(packets["date"][sound], micros, shift_ns)
    packets["date"][sound] = date
    packets["micros"][sound] = np.ascontiguousarray(micros).view("<u4")[:, 0]
    packets["crc"][sound] = jt16_sums(out)[sound]
    return out


def _later(
    date: NDArray[np.uint8], micros: NDArray[np.uint8], shift_ns: int
) -> tuple[NDArray[np.uint8], NDArray[np.uint8]]:
    """Times in the form they have: seconds after a zero, or years after 1900 or 2000.

    Args:
        date: See `stamps.is_date`, (N, 6).
        micros: Microseconds of the second, little-endian, (N, 4).
        shift_ns: Added [ns].
    """
    us = np.ascontiguousarray(micros).view("<u4")[:, 0]
    seconds, rest_us = np.divmod((stamps.time_ns(date, us) + shift_ns) // 1000, 1_000_000)
    calendar = stamps.date_of(seconds)
    calendar[:, 0] -= np.where((date[:, 0] < 70) & (calendar[:, 0] >= 100), 100, 0).astype(np.uint8)
    counted = seconds.astype(">u8").view(np.uint8).reshape(-1, 8)[:, 2:]
    later = np.where((date[:, 0] == 0)[:, None], counted, calendar)
    return later, rest_us.astype("<u4").view(np.uint8).reshape(-1, 4)
