"""A bag as a recording: finds the topics of LiDARs, IMU and positions and reads their data."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import islice
from pathlib import Path
from typing import Any, Protocol

import numpy as np

from recon4.errors import EmptyRecording, RecordingError
from recon4.model.derived_kinds import DerivedKind
from recon4.model.point_recipes import PointRecipe
from recon4.model.rig import Rig
from recon4.model.samples import GnssSamples, ImuSamples
from recon4.model.trajectory import Trajectory
from recon4.recording.assembly.shots import Shots
from recon4.recording.bags.clouds import CloudReader
from recon4.recording.bags.driver_topics import (
    no_lidar_text,
    say_drivers,
    unread_text,
    warn_of_drivers,
)
from recon4.recording.bags.lidar_choice import (
    CloudTopic,
    is_cloud,
    judged_clouds,
    say_clouds_left_out,
    shared_topics,
)
from recon4.recording.bags.messages import (
    SampleBatch,
    first_stamps,
    fix_row,
    join_fixes,
    join_poses,
    pose_row,
    set_clock,
    stamp_clock,
)
from recon4.recording.bags.packets import BagPackets, PacketTopics, imu_in_packets
from recon4.recording.bags.topic_choice import (
    FIX_KIND,
    ODOMETRY_KIND,
    ImuTopics,
    Named,
    choose_imu,
    choose_topic,
    imu_batches,
    named_fixes,
    named_imu,
    require_topic,
)
from recon4.recording.bags.tuning import LIDAR_CHOICE
from recon4.recording.clocks.compare import warn_of_other_joint_clock
from recon4.recording.clocks.stamps import require_forward
from recon4.recording.clouds.cloud_points import CloudDecoder, model_of_points
from recon4.recording.formats.bags import CLOUD, Bag, BagMessage, BagTopic
from recon4.recording.formats.cloud_tables import cloud_table
from recon4.recording.mounts.bag_rig import SampleTopics, on_their_joints, read_mounts
from recon4.recording.mounts.check import mounted_rig
from recon4.recording.packets.family import Companion
from recon4.recording.packets.lidar_imu import LidarImu
from recon4.recording.packets.messages import DATA_MESSAGES
from recon4.recording.recipes.bag_points import declared_recipes, say_columns, unknown_points
from recon4.recording.recipes.refuse import require_known
from recon4.recording.report import ImportReport
from recon4.recording.rigs.choice import Stream
from recon4.recording.tuning import PROBE
from recon4.settings import IngestSettings

Item = Shots | ImuSamples | GnssSamples | Trajectory


class TopicReader(Protocol):
    """Decodes the messages of one topic of a LiDAR."""

    def push(self, message: BagMessage, content: Any, /) -> Iterator[Item]:
        """What a message gives."""
        ...

    def flush(self) -> Iterator[Item]:
        """The rest; call once, at the end."""
        ...


@dataclass(frozen=True, slots=True)
class Given:
    """What a person gives with a bag that describes its LiDARs."""

    companions: Sequence[Companion] = ()
    """Files with their metadata or angles."""
    fields: PointRecipe | None = None
    """What the columns of its points are, without a rig."""


_NOTHING = Given()


class BagRecording:
    """Streams shots and samples of one bag or of several consecutive ones."""

    def __init__(
        self,
        paths: Sequence[Path],
        rig: Rig | None,
        *,
        settings: IngestSettings,
        report: ImportReport,
        given: Given = _NOTHING,
    ) -> None:
        """Read the head of the bag and choose the rig.

        Args:
            paths: The bags.
            rig: None = chosen from what is in the bag.
            settings: Topics, units and limits.
            report: Receives what was found and detected.
            given: What describes the LiDARs.

        Raises:
            RecordingError: If the bag cannot be read or has no LiDAR data.
            ConfigError: If the rig does not fit.
        """
        self._paths, self._settings, self._report = paths, settings, report
        with Bag(paths, report) as bag:
            self.seconds = bag.seconds
            self._shared = shared_topics(bag, report)
            bag.use_sources(self._shared)
            self._recipes = declared_recipes(bag, rig, given.fields, report=report)
            bag.use_recipes(self._recipes)
            self.topics = bag.topics
            self._packets = BagPackets(bag, given.companions)
            self.streams = lidar_streams(self._packets, rig, settings, report=report)
            lidars = [stream.topic for stream in self.streams]
            beside = [topic for topic in bag.topics if topic.name in lidars]
            self.imu = choose_imu(bag, named_imu(rig, settings), report, lidars=beside)
            if self.imu.topic and not settings.imu_topic and self._is_in_packets(rig):
                self.imu = ImuTopics()
            self.imu_topic = self.imu.topic
            self.fix_topic = choose_topic(bag, named_fixes(rig, settings), FIX_KIND, report=report)
            by_setting = Named(settings.odometry_topic)
            self.odometry_topic = choose_topic(bag, by_setting, ODOMETRY_KIND, report=report)
            mounts = read_mounts(bag, [*lidars, self.imu_topic, self.fix_topic], report)
            mounts = on_their_joints(bag, mounts, lidars=lidars, imu=self.imu_topic, report=report)
        if not self.streams:
            raise EmptyRecording(no_lidar_text(paths[0].name, self.topics))
        samples = SampleTopics(self.imu_topic, self.fix_topic)
        mounted = mounted_rig(rig, self.streams, samples, mounts=mounts, report=report)
        self._lidar_imu = LidarImu(mounted, other=self.imu_topic, report=report)
        self.rig = self._lidar_imu.rig
        self._moving = mounts.moving

    def _is_in_packets(self, rig: Rig | None) -> bool:
        found = imu_in_packets(self._packets, rig, self.streams, settings=self._settings)
        if found:
            self._report.derive(DerivedKind.IMU_CHOSEN, sensor=found, other=self.imu.topic)
        return bool(found)

    def read(self) -> Iterator[Item]:
        """Stream the bag once; messages of one topic are in order of time."""
        # OpenRequest was reported already when the head was read.
        with Bag(self._paths, ImportReport()) as bag:
            bag.report = self._report
            bag.use_sources(self._shared)
            bag.use_recipes(self._recipes)
            yield from self._read(bag)

    def _read(self, bag: Bag) -> Iterator[Item]:
        lidars = self._lidars(bag)
        fix = stamp_clock(bag, self.fix_topic)
        samples = {
            **imu_batches(bag, self.imu, self._report),
            self.fix_topic: SampleBatch(fix_row, join_fixes, self._report, kind="gnss", stamps=fix),
            self.odometry_topic: SampleBatch(pose_row, join_poses, self._report),
        }
        wanted = {*lidars, *samples, *bag.strays} - {""}
        for message in bag.messages(wanted):
            if message.topic in bag.strays:
                self._report.count("messages_of_no_lidar")
                continue
            self._report.count("messages")
            content = bag.decode(message)
            if content is None:
                continue
            if message.topic in lidars:
                yield from self._on_joint(
                    message.topic, lidars[message.topic].push(message, content)
                )
            else:
                yield from samples[message.topic].push(message, content)
        for topic, lidar in lidars.items():
            yield from self._on_joint(topic, lidar.flush())
        for mount in self._moving.values():
            warn_of_other_joint_clock(mount.text, self._report)
        for batch in samples.values():
            yield from batch.flush()

    def _on_joint(self, topic: str, items: Iterator[Item]) -> Iterator[Item]:
        """What a LiDAR gives, its points in the frame of what carries its joint if it has one."""
        mount = self._moving.get(topic)
        for item in items:
            if mount is None or not isinstance(item, Shots):
                yield item
                continue
            placed, unknown = mount.place(item)
            self._report.count("points_without_joint", unknown)
            if len(placed):
                yield placed

    def _lidars(self, bag: Bag) -> dict[str, TopicReader]:
        kinds = {topic.name: topic for topic in bag.topics}
        found: dict[str, TopicReader] = {}
        packets = PacketTopics(
            self._packets,
            self.rig,
            self._settings,
            self._lidar_imu,
            self._report,
        )
        for row, sensor in enumerate(self.rig.sensors):
            topic = kinds.get(sensor.topic)
            if topic is not None and topic.type in DATA_MESSAGES:
                found |= packets.readers(row, sensor)
            elif topic is not None:
                clouds = CloudDecoder(
                    row,
                    sensor,
                    report=self._report,
                    settings=self._settings,
                )
                head = first_stamps(bag, topic.name)
                require_forward(topic.name, head)
                found[sensor.topic] = CloudReader(
                    clouds,
                    sensor.time_offset_s,
                    _period_ns(head),
                    stamps=set_clock(bag, topic.name, head),
                    report=self._report,
                )
        return found


def lidar_streams(
    packets: BagPackets, rig: Rig | None, settings: IngestSettings, *, report: ImportReport
) -> list[Stream]:
    """LiDARs of an open bag: raw packets if there are any, else clouds as measured.

    Args:
        packets: Packets of an open bag.
        rig: Topics that it names are read, whatever they hold.
        settings: Names the only LiDAR to read, if it is chosen.
        report: Receives which clouds are not read, and why.

    Raises:
        ConfigError: If the settings name a topic that is not there, or the points need a recipe.
    """
    bag, scans = packets.bag, packets.data_topics
    clouds = [t for t in bag.topics if is_cloud(t)]
    if settings.lidar_topic:
        there = [t.name for t in (*scans, *clouds, *(t for t in bag.topics if t.columns))]
        require_topic(settings.lidar_topic, there, "ingest.lidar_topic")
        scans = [t for t in scans if t.name == settings.lidar_topic]
        clouds = [t for t in clouds if t.name == settings.lidar_topic]
    by_rig = {sensor.topic for sensor in rig.sensors} if rig is not None else set()
    if scans:
        beside = _beside_packets(clouds, by_rig, report)
        return [
            *(Stream(t.name, packets.model(t.name), topic=t.name) for t in scans),
            *(Stream(t.name, _model(bag, t), topic=t.name) for t in beside),
        ]
    found = judged_clouds(bag, clouds, by_rig) if clouds else []
    used = [one for one in found if not one.why_not and one.has_places]
    if unread_text(bag.topics):
        named = {settings.lidar_topic, *by_rig}
        lidars = [one for one in used if one.is_measured or one.topic.name in named]
        if lidars:
            say_drivers(bag.topics, report)
        else:
            warn_of_drivers(bag.topics, report)
        used = lidars  # a map or a depth camera does not stand in for the LiDAR
    say_clouds_left_out(used, found, report)
    unknown = unknown_points(bag, found, only=settings.lidar_topic)
    if not used:
        require_known([(one.stream, one.proposal) for one in unknown], bag.paths[0].name)
    say_columns(bag, used, unknown, report=report)
    return [_cloud_stream(bag, one) for one in used]


def _cloud_stream(bag: Bag, one: CloudTopic) -> Stream:
    name = one.topic.name
    return Stream(
        name,
        _model(bag, one.topic),
        topic=name,
        frame=one.frame,
        points=one.points,
        detail=one.detail,
        fields=bag.recipes.get(name),
    )


def _beside_packets(
    clouds: Sequence[BagTopic], by_rig: set[str], report: ImportReport
) -> list[BagTopic]:
    """Clouds that do not repeat packets: named by the rig, or in messages of another make.

    Those that a driver publishes of its packets are the same points.
    """
    read = [t for t in clouds if t.name in by_rig or t.type != CLOUD]
    if repeated := [t.name for t in clouds if t not in read]:
        report.derive(DerivedKind.CLOUDS_OF_PACKETS, topics=", ".join(repeated))
    return read


def _model(bag: Bag, topic: BagTopic) -> str:
    """Detect the sensor of a topic from its first readable messages."""
    for message in islice(bag.messages([topic.name]), PROBE.messages):
        content = bag.decode(message)
        if content is None:
            continue
        if content.width * content.height:
            try:
                return model_of_points(cloud_table(content))
            except RecordingError:
                continue
    return "generic"


def _period_ns(head: Sequence[tuple[int, int]]) -> int:
    """Median time between the first messages [ns], at most a quarter of a second.

    Args:
        head: Their stamps and times of recording [ns].
    """
    steps = np.abs(np.diff(np.array(head, np.float64).reshape(-1, 2), axis=0))
    for period in np.median(steps, axis=0) if len(steps) else ():
        if 1e6 < period < 250e6:
            return round(float(period))
    return LIDAR_CHOICE.assumed_period_ns
