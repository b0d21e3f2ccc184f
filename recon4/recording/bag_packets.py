"""Packets of LiDARs in the messages of a bag."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import islice
from typing import Any

import numpy as np

from recon4.model.rig import Rig, Sensor
from recon4.model.samples import GnssSamples, ImuSamples
from recon4.recording.assembly.shots import Shots
from recon4.recording.clock_compare import LIDAR
from recon4.recording.formats.bags import Bag, BagMessage, BagTopic
from recon4.recording.formats.datagrams import Datagrams, datagrams_of, join_datagrams
from recon4.recording.packets.companions import companions_of, described_in
from recon4.recording.packets.decoder import PacketDecoder, open_decoder
from recon4.recording.packets.families import FAMILIES
from recon4.recording.packets.family import Companion, PacketSensor, same_start
from recon4.recording.packets.lidar_imu import LidarImu
from recon4.recording.packets.messages import PACKET_MESSAGES
from recon4.recording.packets.streams import recognized
from recon4.recording.report import ImportReport
from recon4.settings import IngestSettings

_STRING = "std_msgs/msg/String"
_PROBED_MESSAGES = 50
_PROBED_PACKETS = 4500
"""Packets at the beginning of a topic from which its sensor is known: more than a second, as some
send their angles once a second."""
_MOST_TEXT = 1 << 20


class PacketTopics:
    """The topics of a bag with packets, and what describes their LiDARs."""

    def __init__(
        self,
        bag: Bag,
        rig: Rig,
        settings: IngestSettings,
        *,
        imu_topic: str,
        report: ImportReport,
    ) -> None:
        """Read what describes the LiDARs: files beside the bag, texts in it.

        Args:
            bag: An open bag.
            rig: With the topics of its LiDARs.
            settings: Limits of the range.
            imu_topic: Topic of an IMU whose messages are read; empty = that of a LiDAR.
            report: Receives counts, and what was derived.
        """
        self._bag, self._rig, self._settings, self._report = bag, rig, settings, report
        self._imu = LidarImu(rig, other=imu_topic, report=report)
        self._companions = [*described_in(rig), *bag_companions(bag)]

    def readers(self, row: int, sensor: Sensor) -> dict[str, PacketReader]:
        """The reader of a sensor's packets, by topic: those with points, and the others.

        Raises:
            ConfigError: If its packets cannot be decoded.
        """
        of = PacketSensor(
            row=row,
            sensor=sensor,
            head=head_of(self._bag, sensor.topic),
            beside=join_datagrams([head_of(self._bag, name) for name in self._samples_of(sensor)]),
            companions=self._companions,
            settings=self._settings,
            report=self._report,
        )
        decoder = open_decoder(of, alone=len(self._rig.sensors) == 1)
        topics = [sensor.topic, *self._samples_of(sensor)]
        return {topic: PacketReader(decoder, sensor.name, self._imu) for topic in topics}

    def _samples_of(self, sensor: Sensor) -> list[str]:
        """Topics with other packets, each of the sensor whose topic is most alike."""
        lidars = [other.topic for other in self._rig.sensors if other.topic]
        beside = [t.name for t in self._bag.topics if has_samples(self._bag, t)]
        return [name for name in beside if _most_alike(name, lidars) == sensor.topic]


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
                self._report.note_lag(LIDAR, message.t_ns - int(shots.t_ns[-1]))
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


def packets_in(message: BagMessage, content: Any) -> Datagrams:
    """The packets of a decoded message, with their times of arrival."""
    packets = PACKET_MESSAGES[message.type].packets(content)
    return datagrams_of(
        [t_ns if t_ns > 0 else message.t_ns for t_ns, _ in packets], [data for _, data in packets]
    )


def head_of(bag: Bag, topic: str) -> Datagrams:
    """The first packets of a topic."""
    parts: list[Datagrams] = []
    for message in islice(bag.messages([topic]), _PROBED_PACKETS):
        content = bag.decode(message)
        if content is not None:
            parts.append(packets_in(message, content))
        if sum(map(len, parts)) >= _PROBED_PACKETS:
            break
    return join_datagrams(parts)


def model_of_packets(bag: Bag, topic: BagTopic) -> str:
    """The model of a topic's LiDAR; ``generic`` = not known."""
    found = recognized(head_of(bag, topic.name), bag_companions(bag))
    return found.model if found is not None and found.model else "generic"


def has_samples(bag: Bag, topic: BagTopic) -> bool:
    """Whether a topic has packets of a LiDAR without points: some drivers send all in one type."""
    row = PACKET_MESSAGES.get(topic.type)
    if row is None or not topic.messages:
        return False
    found = None if row.samples else recognized(head_of(bag, topic.name))
    return row.samples or (found is not None and found.kind == "samples")


def describing_topics(bag: Bag) -> set[str]:
    """Topics whose text describes a LiDAR."""
    return {one.name for one in _texts(bag) if any(family.describes(one) for family in FAMILIES)}


def bag_companions(bag: Bag) -> list[Companion]:
    """Files beside a bag, and the texts of its drivers, as the metadata of an Ouster."""
    return [*_texts(bag), *companions_of(bag.paths)]


def _texts(bag: Bag) -> list[Companion]:
    texts = [topic for topic in bag.topics if topic.type == _STRING and topic.messages]
    found = []
    for topic in texts:
        for message in islice(bag.messages([topic.name]), 1):
            content = bag.decode(message)
            if content is not None and len(content.data) <= _MOST_TEXT:
                found.append(Companion(topic.name, content.data.encode()))
    return found


def _most_alike(name: str, others: list[str]) -> str:
    return max(others, key=lambda other: same_start(name, other), default="")
