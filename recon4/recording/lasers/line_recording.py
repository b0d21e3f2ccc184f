"""A bag of a backpack with a profiler: line scans, angles of its head, a 2-D laser, an IMU."""

from __future__ import annotations

from array import array
from collections.abc import Iterator, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from recon4.errors import ConfigError, CorruptFile, EmptyRecording
from recon4.locales.coded import CodedText
from recon4.model.derived_kinds import DerivedKind
from recon4.model.finding_kinds import FindingKind
from recon4.model.laser_scans import LaserScans
from recon4.model.line_scans import LineScans
from recon4.model.rig import Rig, Sensor
from recon4.model.samples import ImuSamples
from recon4.recording.assembly.assembler import moved
from recon4.recording.assembly.shots import Shots
from recon4.recording.bags.messages import stamp_clock, stamp_ns
from recon4.recording.bags.topic_choice import choose_imu, imu_batches, named_imu
from recon4.recording.clocks.compare import LIDAR
from recon4.recording.clocks.set_back import say_set_back
from recon4.recording.clocks.stamp_order import StampOrder
from recon4.recording.clocks.stamps import StampClock
from recon4.recording.clouds.cloud_points import CloudDecoder
from recon4.recording.formats.bags import (
    CLOUD,
    JOINT_STATES,
    LASER_SCAN,
    Bag,
    BagMessage,
)
from recon4.recording.formats.cloud_tables import cloud_table
from recon4.recording.lasers.head_angles import Head, HeadAngles
from recon4.recording.lasers.joint_head import JointHead
from recon4.recording.lasers.line_topics import line_topic
from recon4.recording.lasers.range_units import LaserUnit, line_factor
from recon4.recording.lasers.scan_messages import ScanCollector, line_of_scan
from recon4.recording.lasers.tuning import LINES
from recon4.recording.mounts.bag_rig import SampleTopics, read_mounts
from recon4.recording.mounts.check import compare_mounts
from recon4.recording.mounts.driven_joints import several_joints
from recon4.recording.mounts.moving import MovingMount, moving_mount
from recon4.recording.mounts.transform_messages import has_frames
from recon4.recording.report import ImportReport
from recon4.recording.tuning import LISTED
from recon4.settings import IngestSettings

LineItem = Shots | LineScans | LaserScans | ImuSamples


class LineRecording:
    """Streams the points of line scans with the lines themselves, 2-D scans and IMU samples.

    The points are in the frame of the profiler, which does not turn with the head.
    """

    def __init__(
        self,
        paths: Sequence[Path],
        rig: Rig,
        *,
        report: ImportReport,
        settings: IngestSettings | None = None,
    ) -> None:
        """Find the topics; the settings name that of the IMU, else rig or content decide.

        Raises:
            RecordingError: If the bag cannot be read.
            EmptyRecording: If there are no line scans.
            ConfigError: If the angles of the head are missing.
        """
        self._paths, self._report = paths, report
        with Bag(paths, report) as bag:
            self.seconds, self.topics = bag.seconds, bag.topics
            named = named_imu(rig, settings or IngestSettings())
            self._imu = choose_imu(bag, named, report)
        row = rig.row_of("profiler")
        assert row is not None
        self._row, self._laser_row, sensor = row, rig.row_of("laser2d"), rig.sensors[row]
        self._lines = line_topic(sensor.topic, sensor.name, self.topics)
        if not self._lines:
            names = ", ".join(f"{t.name} ({t.type})" for t in self.topics[: LISTED.names])
            text = CodedText("lines-none", name=paths[0].name, sensor=sensor.name, topics=names)
            raise EmptyRecording(text)
        self._joint = self._find_joint(sensor)
        self._head = "" if self._joint else self._find_head(rig, row)
        self._scans = self._find_scans(rig)
        found = {row: self._lines} | ({self._laser_row: self._scans} if self._scans else {})
        sensors = [replace(s, topic=found.get(k, s.topic)) for k, s in enumerate(rig.sensors)]
        self.rig = replace(rig, sensors=tuple(sensors))
        self._check_mounts()

    def _check_mounts(self) -> None:
        """Compare the rig with the transforms of the bag."""
        if not has_frames(self.topics):
            return
        with Bag(self._paths, ImportReport()) as bag:
            mounts = read_mounts(bag, [self._scans, self.imu_topic], self._report)
        samples = SampleTopics(imu=self.imu_topic)
        compare_mounts(self.rig, samples, mounts, report=self._report)

    @property
    def imu_topic(self) -> str:
        """Topic of the IMU; empty = there is none."""
        return self._imu.topic

    @property
    def lines_topic(self) -> str:
        """Topic of the line scans."""
        return self._lines

    @property
    def head_topic(self) -> str:
        """Topic of the head's angles; empty = it turns at a constant rate, or by transforms."""
        return self._head

    @property
    def joint(self) -> MovingMount | None:
        """How transforms move the profiler; None = a head with angles does."""
        return self._joint

    @property
    def scans_topic(self) -> str:
        """Topic of the 2-D laser; empty = there is none."""
        return self._scans

    def read(self) -> Iterator[LineItem]:
        """Stream the bag once; points and lines are in order of time."""
        with Bag(self._paths, ImportReport()) as bag:
            bag.report = self._report
            yield from self._read(bag)

    def _read(self, bag: Bag) -> Iterator[LineItem]:
        sensor = self.rig.sensors[self._row]
        angles = HeadAngles(sensor.name, sensor.head_rate_rad_s, self._report)
        head: Head = angles
        if self._joint is not None:
            head = JointHead(sensor.name, self._joint, self._report)
        topics = (self._lines, self._head, self._scans)
        stamps = {topic: stamp_clock(bag, topic) for topic in topics}
        lines = LineAssembly(
            self._row, self.rig, head, report=self._report, stamps=stamps[self._lines]
        )
        imu = imu_batches(bag, self._imu, self._report)
        scans = ScanCollector(
            self._offset_ns(self._laser_row), self._report, stamps=stamps[self._scans]
        )
        unit = LaserUnit(self._report)
        wanted = {self._lines, self._head, self._scans, *imu} - {""}
        for message in bag.messages(wanted):
            self._report.count("messages")
            content = bag.decode(message)
            if content is None:
                continue
            if message.topic == self._head:
                self._push_angle(angles, message, content, stamps=stamps[self._head])
            elif message.topic == self._lines:
                yield from lines.push(message, content)
            elif message.topic == self._scans:
                yield from map(unit.in_meters, scans.push(message, content))
            else:
                yield from imu[message.topic].push(message, content)
        yield from lines.flush()
        yield from map(unit.in_meters, scans.flush())
        for batch in imu.values():
            yield from batch.flush()
        head.finish(self.seconds)

    def _push_angle(
        self, head: HeadAngles, message: BagMessage, content: Any, *, stamps: StampClock
    ) -> None:
        if len(content.position) > 1:
            raise several_joints(message.topic, content.name)
        t_ns = stamp_ns(content.header.stamp)
        known = stamps.offset_ns is not None
        sound = stamps.is_sound(t_ns, message.t_ns)
        if len(content.position) == 0 or (known and not sound):
            self._report.count("head_angles_invalid")
            return
        t_ns = t_ns + stamps.shift_ns if sound else message.t_ns
        head.push(t_ns + self._offset_ns(self._row), float(content.position[0]))

    def _offset_ns(self, row: int | None) -> int:
        return 0 if row is None else round(1e9 * self.rig.sensors[row].time_offset_s)

    def _find_joint(self, sensor: Sensor) -> MovingMount | None:
        """How transforms move the profiler, if the rig names their topic or no angles are there.

        Raises:
            ConfigError: If the rig names transforms, and no joint of them moves the profiler.
        """
        is_named = has_frames([t for t in self.topics if t.name == sensor.head_topic])
        types = {topic.type for topic in self.topics if topic.messages}
        has_angles = bool(sensor.head_rate_rad_s or sensor.head_topic) or JOINT_STATES in types
        if not is_named and (has_angles or not has_frames(self.topics)):
            return None
        with Bag(self._paths, ImportReport()) as bag:
            mounts = read_mounts(bag, [self._lines], ImportReport())
            frame = mounts.frame_of(self._lines)
            joint = moving_mount(bag, mounts.graph, frame, report=self._report)
        if joint is None and is_named:
            raise ConfigError(
                CodedText(
                    "head-joint-none",
                    sensor=sensor.name,
                    topic=sensor.head_topic,
                    frame=frame or "–",
                )
            )
        if joint is not None:
            self._report.derive(DerivedKind.MOUNT_MOVES, sensor=sensor.name, **joint.values)
        return joint

    def _find_head(self, rig: Rig, row: int) -> str:
        """Topic of the head's angles; empty = it turns at a constant rate.

        Raises:
            ConfigError: If the angles are missing.
        """
        sensor = rig.sensors[row]
        if sensor.head_rate_rad_s:
            self._report.derive(
                DerivedKind.HEAD_ANGLES, sensor=sensor.name, rate_rad_s=sensor.head_rate_rad_s
            )
            return ""
        joints = [t for t in self.topics if t.type == JOINT_STATES and t.messages]
        named = [t.name for t in joints if t.name == sensor.head_topic]
        if named:
            return named[0]
        if len(joints) == 1 and not sensor.head_topic:
            self._report.derive(DerivedKind.HEAD_ANGLES, sensor=sensor.name, topic=joints[0].name)
            return joints[0].name
        raise ConfigError(
            CodedText(
                "head-angles-none",
                sensor=sensor.name,
                topic=sensor.head_topic or "–",
                type=JOINT_STATES,
                there=", ".join(t.name for t in joints) or "–",
            )
        )

    def _find_scans(self, rig: Rig) -> str:
        if self._laser_row is None:
            self._report.warn(FindingKind.LASER_NOT_IN_RIG)
            return ""
        sensor = rig.sensors[self._laser_row]
        topics = [t for t in self.topics if t.type == LASER_SCAN]
        found = line_topic(sensor.topic, sensor.name, topics)
        if not found:
            self._report.warn(FindingKind.SENSOR_NOT_RECORDED, sensor=sensor.name)
        return found


class LineAssembly:
    """Turns the lines of a profiler into its frame as soon as the angle of its head is known."""

    def __init__(
        self,
        row: int,
        rig: Rig,
        head: Head,
        *,
        report: ImportReport,
        stamps: StampClock | None = None,
    ) -> None:
        self._row, self._head, self._report = row, head, report
        self._stamps = stamps or StampClock()
        self._sensor = rig.sensors[row]
        self._offset_ns = round(1e9 * self._sensor.time_offset_s)
        self._clouds = CloudDecoder(row, self._sensor, report=report)
        self._order: StampOrder[Shots] = StampOrder()
        self._waiting: list[Shots] = []
        self._done: list[tuple[Shots, float]] = []
        self._scale = 0.0
        """To meters; 0 = not known yet."""
        self._starts_ns = array("q")
        self._last_ns = 0

    def push(self, message: BagMessage, content: Any) -> Iterator[LineItem]:
        """Add a line of a bag; returns those that are complete, in batches."""
        shots = self._shots(message, content)
        if shots is None or not len(shots):
            self._report.count("lines_empty")
            return
        self._report.note_lag(LIDAR, message.t_ns - int(shots.t_ns[-1]))
        for t_ns, ordered in self._order.push(int(shots.t_ns[0]), shots):
            yield from self.push_shots(moved(ordered, t_ns - int(ordered.t_ns[0])))

    def push_shots(self, shots: Shots) -> Iterator[LineItem]:
        """Add the returns of a line, in the x-z plane of the head, in order of time."""
        if not len(shots):
            self._report.count("lines_empty")
            return
        if int(shots.t_ns[0]) <= self._last_ns:
            self._report.count("lines_out_of_order")
            return
        self._last_ns = int(shots.t_ns[0])
        self._report.count("lines")
        self._starts_ns.append(self._last_ns)
        self._waiting.append(shots)
        self._turn(int(shots.t_ns[-1]))
        if len(self._done) >= LINES.lines_at_once:
            yield from self.deliver()

    def flush(self) -> Iterator[LineItem]:
        """The remaining lines."""
        for t_ns, shots in self._order.flush():
            yield from self.push_shots(moved(shots, t_ns - int(shots.t_ns[0])))
        say_set_back(self._sensor.name, self._order.steps, self._report)
        self._report.count("lines_out_of_order", self._order.too_late)
        self._turn(self._last_ns, final=True)
        yield from self.deliver()
        self._count_missing()
        lost = self._report.counts["lines_without_angle"]
        if lost:
            self._report.warn(FindingKind.LINES_WITHOUT_ANGLE, sensor=self._sensor.name, lines=lost)

    def _count_missing(self) -> None:
        """Lines that were lost between others, by the usual time from line to line."""
        steps = np.diff(np.frombuffer(self._starts_ns, np.int64))
        if not len(steps):
            return
        periods = np.rint(steps / np.median(steps)).astype(np.int64)
        missing = int(np.sum(np.maximum(periods - 1, 0))) - self._report.counts["lines_empty"]
        missing = max(0, missing)
        self._report.count("lines_missing", missing)
        ratio = missing / (missing + len(self._starts_ns))
        if ratio > LINES.missing_ratio:
            self._report.warn(
                FindingKind.LINES_MISSING,
                sensor=self._sensor.name,
                ratio=ratio,
                missing=missing,
                lines=missing + len(self._starts_ns),
            )

    def _shots(self, message: BagMessage, content: Any) -> Shots | None:
        t_ns = stamp_ns(content.header.stamp)
        if not self._stamps.is_sound(t_ns, message.t_ns):
            self._report.count("lines_wrong_time")
            t_ns = self._stamps.expected_ns(message.t_ns)
        else:
            t_ns += self._stamps.shift_ns
        t_ns += self._offset_ns
        try:
            if message.type == CLOUD:
                table = cloud_table(content)
                return self._clouds.decode(table, t_ns=t_ns, period_ns=10_000_000)
            return line_of_scan(
                content, self._row, t_ns, report=self._report, across=self._head.across
            )
        except CorruptFile as error:
            self._report.count("messages_corrupt")
            self._report.warn(FindingKind.MESSAGE_LEFT_OUT, where=message.topic, error=error)
            return None

    def _turn(self, now_ns: int, *, final: bool = False) -> None:
        while self._waiting:
            shots = self._waiting[0]
            end_ns = int(shots.t_ns[-1])
            if not (final or self._head.ready(end_ns) or self._head.overdue(end_ns, now_ns)):
                return
            self._waiting.pop(0)
            turned = self._head.turn(shots)
            if turned is None:
                self._report.count("lines_without_angle")
            else:
                self._done.append(turned)

    def deliver(self) -> Iterator[LineItem]:
        """The lines whose head angle is known by now."""
        if not self._done:
            return
        parts = [shots for shots, _ in self._done]
        xyz = np.concatenate([part.xyz for part in parts])
        if not self._scale:
            away_m = np.linalg.norm(xyz, axis=1)
            self._scale = line_factor(away_m, self._sensor.name, self._report)
        if self._scale != 1.0:
            self._report.count("lines_converted", len(parts))
        yield LineScans(
            np.array([part.t_ns[0] for part in parts], np.int64),
            np.array([angle for _, angle in self._done]),
            np.array([len(part) for part in parts], np.int64),
        )
        self._done = []
        yield Shots(
            self._row,
            np.concatenate([part.t_ns for part in parts]),
            (self._scale * xyz).astype(np.float32) if self._scale != 1.0 else xyz,
            np.concatenate([part.intensity for part in parts]),
            np.concatenate([part.ring for part in parts]),
            np.concatenate([part.echo for part in parts]),
        )
