"""Packets of LiDARs in the messages of a bag."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import islice
from typing import Any

import numpy as np

from recon4.errors import ConfigError
from recon4.locales.coded import CodedText
from recon4.model.rig import Rig, Sensor
from recon4.model.samples import GnssSamples, ImuSamples
from recon4.recording.assembly.shots import Shots
from recon4.recording.clocks.compare import note_lidar_lag
from recon4.recording.formats.bags import Bag, BagMessage, BagTopic
from recon4.recording.formats.datagrams import Datagrams, datagrams_of, join_datagrams
from recon4.recording.formats.shared_topics import SOURCE_MARK
from recon4.recording.limits import LIMITS
from recon4.recording.packets.companions import described_in
from recon4.recording.packets.decoder import PacketDecoder, open_decoder
from recon4.recording.packets.families import FAMILIES
from recon4.recording.packets.family import Companion, PacketSensor, Recognized, same_start
from recon4.recording.packets.lidar_imu import LidarImu
from recon4.recording.packets.makes import can_be_of
from recon4.recording.packets.messages import DATA_MESSAGES, PACKET_MESSAGES
from recon4.recording.packets.senders import packets_of
from recon4.recording.packets.streams import first_datagrams, recognized
from recon4.recording.packets.tuning import HEAD
from recon4.recording.report import ImportReport
from recon4.recording.rigs.choice import Stream, assign_topics
from recon4.recording.rigs.mismatch import mismatch_text
from recon4.recording.tuning import PROBE
from recon4.settings import IngestSettings

_STRING = "std_msgs/msg/String"


class BagPackets:
    """The packets of a bag: heads of topics, each read once, and what describes the LiDARs.

    What was read while the bag was open stays known.
    """

    def __init__(self, bag: Bag, companions: Sequence[Companion]) -> None:
        """Read the texts of drivers, as the metadata of an Ouster.

        Args:
            bag: An open bag.
            companions: Files that describe its LiDARs.
        """
        self.bag = bag
        self._texts = _texts(bag)
        self.companions = [*self._texts, *companions]
        self._heads: dict[str, Datagrams] = {}
        self._found: dict[str, Recognized | None] = {}

    def head(self, topic: str) -> Datagrams:
        """The first packets of a topic."""
        if topic not in self._heads:
            self._heads[topic] = head_of(self.bag, topic)
        return self._heads[topic]

    def found(self, topic: str) -> Recognized | None:
        """What the packets of a topic are; None = not those of a known LiDAR."""
        if topic not in self._found:
            self._found[topic] = recognized(self.head(topic), self.companions)
        return self._found[topic]

    def model(self, topic: str) -> str:
        """The model of a topic's LiDAR; ``generic`` = not known."""
        found = self.found(topic)
        return found.model if found is not None and found.model else "generic"

    @property
    def data_topics(self) -> list[BagTopic]:
        """Topics with data packets."""
        topics = [t for t in self.bag.topics if t.type in DATA_MESSAGES and t.messages]
        return [topic for topic in topics if not self._has_samples(topic)]

    @property
    def sample_topics(self) -> list[str]:
        """Topics with other packets of LiDARs; some drivers send all in one type of message."""
        topics = [t for t in self.bag.topics if t.type in PACKET_MESSAGES and t.messages]
        return [topic.name for topic in topics if self._has_samples(topic)]

    @property
    def describing_topics(self) -> set[str]:
        """Topics whose text describes a LiDAR."""
        texts = self._texts
        return {one.name for one in texts if any(family.describes(one) for family in FAMILIES)}

    def _has_samples(self, topic: BagTopic) -> bool:
        found = self.found(topic.name)
        is_samples = found is not None and found.kind == "samples"
        return PACKET_MESSAGES[topic.type].samples or is_samples


@dataclass(frozen=True, slots=True, eq=False)
class PacketTopics:
    """Opens the readers of the packets of a bag."""

    packets: BagPackets
    rig: Rig
    """With the topics of its LiDARs."""
    settings: IngestSettings
    imu: LidarImu
    report: ImportReport
    """Receives counts, and what was derived."""

    def readers(self, row: int, sensor: Sensor) -> dict[str, PacketReader]:
        """The reader of a sensor's packets, by topic: those with points, and the others.

        Raises:
            ConfigError: If its packets cannot be decoded.
        """
        reader = PacketReader(self._decoder(row, sensor), sensor.name, self.imu)
        return dict.fromkeys((sensor.topic, *self._samples_of(sensor)), reader)

    def have_imu(self, row: int, sensor: Sensor) -> bool:
        """Whether the first packets of a sensor have samples of its IMU.

        Raises:
            ConfigError: If its packets cannot be decoded.
        """
        decoder = self._decoder(row, sensor)
        heads = [self.packets.head(name) for name in (sensor.topic, *self._samples_of(sensor))]
        head = join_datagrams(heads)
        whole = np.flatnonzero(head.length == decoder.size)
        decoder.push(head.t_ns[whole], head.payloads(whole, decoder.size))
        found = decoder.samples(head.take(np.isin(head.length, list(decoder.sample_sizes))))
        return found is not None and found.imu is not None

    def _decoder(self, row: int, sensor: Sensor) -> PacketDecoder:
        found, head = self.packets.found(sensor.topic), self.packets.head(sensor.topic)
        if not can_be_of(sensor, found, head=head, companions=self.packets.companions):
            model = found.model or found.family if found else ""
            found = CodedText("rig-topic-packets", topic=sensor.topic, model=model)
            raise ConfigError(mismatch_text(self.rig, found))
        beside = self._samples_of(sensor)
        of = PacketSensor(
            row=row,
            sensor=sensor,
            head=head,
            beside=join_datagrams([self.packets.head(name) for name in beside]),
            companions=[*described_in(self.rig), *self.packets.companions],
            settings=self.settings,
            report=self.report,
        )
        return open_decoder(of, alone=len(self.rig.sensors) == 1)

    def _samples_of(self, sensor: Sensor) -> list[str]:
        """Topics with other packets, each of the sensor whose topic is most alike."""
        lidars = [other.topic for other in self.rig.sensors if other.topic]
        names = self.packets.sample_topics
        return [name for name in names if _most_alike(name, lidars) == sensor.topic]


class PacketReader:
    """Decodes messages of packets of one sensor."""

    def __init__(self, decoder: PacketDecoder, name: str, imu: LidarImu) -> None:
        """Prepare.

        Args:
            decoder: Of the sensor; the readers of its topics share it.
            name: Of the sensor.
            imu: Says whether the samples of its IMU are read.
        """
        self._decoder, self._name, self._imu = decoder, name, imu
        self._report = decoder.report

    def push(self, message: BagMessage, content: Any) -> Iterator[Shots | ImuSamples | GnssSamples]:
        """Shots, and samples of the LiDAR's IMU and GPS, of a message."""
        datagrams = packets_in(message, content)
        decoder = self._decoder
        whole = datagrams.length == decoder.size
        beside = np.isin(datagrams.length, list(decoder.sample_sizes))
        self._report.count("packets_wrong_length", int((~whole & ~beside).sum()))
        rows = np.flatnonzero(whole)
        if len(rows):
            shots = decoder.push(datagrams.t_ns[rows], datagrams.payloads(rows, decoder.size))
            if len(shots):
                note_lidar_lag(self._name, message.t_ns - int(shots.t_ns[-1]), self._report)
                yield shots
        samples = decoder.samples(datagrams.take(beside)) if beside.any() else None
        if samples is None:
            return
        read = self._imu.of(self._name, samples)
        yield from (found for found in (read.imu, read.gnss) if found is not None)

    def flush(self) -> Iterator[Shots]:
        """Shots that were held back."""
        if len(shots := self._decoder.flush()):
            yield shots


def imu_in_packets(
    packets: BagPackets, rig: Rig | None, streams: Sequence[Stream], *, settings: IngestSettings
) -> str:
    """Name of the LiDAR whose packets have the IMU that a rig names; empty = none has.

    Args:
        packets: Of an open bag.
        rig: Names a LiDAR whose IMU is read, or none.
        streams: The LiDARs of the bag.
        settings: Of the reader.

    Raises:
        ConfigError: If the rig has no LiDAR of the bag, or its packets cannot be decoded.
    """
    if rig is None or not rig.imu_sensor or not streams:
        return ""
    quiet = ImportReport()
    rig = assign_topics(rig, streams, quiet)
    row = [sensor.name for sensor in rig.sensors].index(rig.imu_sensor)
    if rig.sensors[row].topic not in {topic.name for topic in packets.data_topics}:
        return ""
    imu = LidarImu(rig, other="", report=quiet)
    topics = PacketTopics(packets, rig, settings, imu, quiet)
    has_imu = topics.have_imu(row, rig.sensors[row])
    return rig.imu_sensor * has_imu


def packets_in(message: BagMessage, content: Any) -> Datagrams:
    """The packets of a decoded message, with their times of arrival."""
    packets = packets_of(message.type, content)
    return datagrams_of(
        [t_ns if t_ns > 0 else message.t_ns for t_ns, _ in packets], [data for _, data in packets]
    )


def head_of(bag: Bag, topic: str) -> Datagrams:
    """The first packets of a topic."""
    parts: list[Datagrams] = []
    count = size = 0
    for message in bag.messages([topic]):
        content = bag.decode(message)
        if content is not None:
            parts.append(packets_in(message, content))
            count += len(parts[-1])
            size += len(parts[-1].buffer)
        if count >= PROBE.packets or size >= HEAD.bytes:
            break
    return first_datagrams(join_datagrams(parts))


def _texts(bag: Bag) -> list[Companion]:
    texts = [topic for topic in bag.topics if topic.type == _STRING and topic.messages]
    found = []
    for topic in texts:
        for message in islice(bag.messages([topic.name]), 1):
            content = bag.decode(message)
            if content is not None and len(content.data) <= LIMITS.text_message_bytes:
                found.append(Companion(topic.name, content.data.encode()))
    return found


def _most_alike(name: str, others: list[str]) -> str:
    """The topic with the same source, if several sensors share both, and the same beginning."""
    source = name.partition(SOURCE_MARK)[2]
    return max(
        others,
        key=lambda other: (other.partition(SOURCE_MARK)[2] == source, same_start(name, other)),
        default="",
    )
